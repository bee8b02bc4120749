//! Reversible circuits: registers, word-level operations and their inverses, lowering to X, CNOT
//! and Toffoli, costs, and quantum counting around them.
//!
//! A computation that runs on a superposition has to be reversible: it may flip bits and swap
//! states, never overwrite or forget. With this crate you write a reversible computation on
//! *numbers* (add, multiply, divide, compare, look up in a table), and get its inverse, its gates
//! and its cost. The crate gives the numbers no meaning.
//!
//! # In ten minutes: a squarer
//!
//! A [`Recorder`] is a [`Machine`] that records the operations that it is called with. A
//! [`Declaration`] states a register's name, its number of qubits and their meaning.
//!
//! ```
//! use qrt_circuit::{Declaration, Machine, Program, Recorder, Style, Type, Word};
//!
//! fn squarer() -> Program {
//!     let mut m = Recorder::new(Style::InPlace);
//!     let x = m.input(&Declaration::work("x", Type::UInt, 3));
//!     // All three bits of x, as an unsigned number; no bit of the square is dropped.
//!     m.square(&Declaration::work("square", Type::UInt, 6), Word::unsigned(&x, 0, 3), 0);
//!     m.finish()
//! }
//!
//! let program = squarer();
//! assert_eq!(program.ops[0].name(), "square");
//! // What is held after it: x, the square, and the lowering's garbage.
//! let names: Vec<&str> = program.registers.iter().map(|r| r.name.as_str()).collect();
//! assert_eq!(names, ["x", "square", "scratch"]);
//! ```
//!
//! **Definition.** [`Contents`] runs the program on integers, one basis state at a time. It defines
//! the meaning of an operation; all other implementations are tested against it.
//!
//! ```
//! # use qrt_circuit::{Declaration, Machine, Program, Recorder, Style, Type, Word};
//! # fn squarer() -> Program {
//! #     let mut m = Recorder::new(Style::InPlace);
//! #     let x = m.input(&Declaration::work("x", Type::UInt, 3));
//! #     m.square(&Declaration::work("square", Type::UInt, 6), Word::unsigned(&x, 0, 3), 0);
//! #     m.finish()
//! # }
//! use qrt_circuit::Contents;
//!
//! let program = squarer();
//! let mut contents = Contents::new(&program, &[7], &[]);
//! for instruction in &program.instructions {
//!     contents.follow(&program, *instruction)?;
//! }
//! assert_eq!(contents.registers[..2], [7, 49]);
//! # Ok::<(), qrt_circuit::Unclean>(())
//! ```
//!
//! **Lowering and cost.** [`lower::circuit`] places registers on qubits and writes the gates;
//! [`lower::tally`] counts them, instruction by instruction. `Style` chooses between few gates and
//! few qubits. Measurement could undo some Toffolis for free ([`lower::Cost::and_measured`]).
//!
//! ```
//! # use qrt_circuit::{Declaration, Machine, Program, Recorder, Style, Type, Word};
//! # fn squarer() -> Program {
//! #     let mut m = Recorder::new(Style::InPlace);
//! #     let x = m.input(&Declaration::work("x", Type::UInt, 3));
//! #     m.square(&Declaration::work("square", Type::UInt, 6), Word::unsigned(&x, 0, 3), 0);
//! #     m.finish()
//! # }
//! use qrt_circuit::{Gate, lower};
//!
//! let program = squarer();
//! let circuit = lower::circuit(&program);
//! let toffoli = |gate: &&Gate| matches!(gate, Gate::Ccx(..));
//! let toffolis = circuit.gates.iter().filter(toffoli).count() as u64;
//! assert_eq!(toffolis, lower::tally(&program)[0].toffoli);
//!
//! // Run the gates on bits: 5 in the qubits of x, everything else 0.
//! let mut bits = vec![false; circuit.qubits as usize];
//! for (place, qubit) in circuit.inputs[0].1.iter().enumerate() {
//!     bits[*qubit as usize] = 5 >> place & 1 == 1;
//! }
//! for gate in &circuit.gates {
//!     match *gate {
//!         Gate::X(t) => bits[t as usize] ^= true,
//!         Gate::Cx(a, t) => bits[t as usize] ^= bits[a as usize],
//!         Gate::Ccx(a, b, t) => bits[t as usize] ^= bits[a as usize] & bits[b as usize],
//!         Gate::Load { .. } | Gate::Z(_) => unreachable!("no parameter, no phase"),
//!     }
//! }
//! let qubits = &circuit.outputs[1].1;
//! let square: u32 = qubits.iter().rev().fold(0, |sum, q| 2 * sum + u32::from(bits[*q as usize]));
//! assert_eq!(square, 25);
//! ```
//!
//! **Inverse.** [`Program::inverse`] lists the inverses in reverse order: uncomputation is never
//! written by hand. Here it returns all qubits but those of `x` to zero.
//!
//! ```
//! # use qrt_circuit::{Declaration, Machine, Program, Recorder, Style, Type, Word};
//! # fn squarer() -> Program {
//! #     let mut m = Recorder::new(Style::InPlace);
//! #     let x = m.input(&Declaration::work("x", Type::UInt, 3));
//! #     m.square(&Declaration::work("square", Type::UInt, 6), Word::unsigned(&x, 0, 3), 0);
//! #     m.finish()
//! # }
//! let mut program = squarer();
//! let undo = program.inverse().instructions;
//! program.instructions.extend(undo);
//! assert_eq!(program.outputs(), program.inputs);
//! ```
//!
//! **Export.** [`export::write_program`] writes OpenQASM that Qiskit, Q#, Cirq and others read.
//!
//! ```
//! # use qrt_circuit::{Declaration, Machine, Program, Recorder, Style, Type, Word};
//! # fn squarer() -> Program {
//! #     let mut m = Recorder::new(Style::InPlace);
//! #     let x = m.input(&Declaration::work("x", Type::UInt, 3));
//! #     m.square(&Declaration::work("square", Type::UInt, 6), Word::unsigned(&x, 0, 3), 0);
//! #     m.finish()
//! # }
//! use qrt_circuit::export::{ExportFormat, write_program};
//!
//! let mut text = Vec::new();
//! let written = write_program(&squarer(), &[], ExportFormat::OpenQasm3, &[], &mut text)?;
//! let text = String::from_utf8(text)?;
//! assert!(text.starts_with("OPENQASM 3.0;\ninclude \"stdgates.inc\";\nqubit[3] r_x;\n"));
//! assert_eq!(written.by_name["ccx"], text.matches("ccx ").count() as u64);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Further reading: [`mod@format`] gives registers types (`UInt<8>`, `Fixed<2, 14>`).
//! [`controlled`] runs code under a condition. [`quantum`] makes a phase oracle of a program that
//! flips a phase, and builds Grover's iterate and quantum counting around it.
//!
//! # Meaning of a program
//!
//! A [`Program`] is a sequence of [`Instruction`]s on [`Register`]s of qubits. Each instruction is
//! an [`Op`] or an op's inverse, and permutes the basis states: it reads the integers that its
//! operands hold and writes an integer into a register. There are no branches. A value that depends
//! on the path is selected, and every path runs every instruction.
//!
//! **Bit order.** Bit 0 of a register is its least significant bit. The same order applies to path
//! indices, sample indices, masks, tables' addresses and exported circuits.
//!
//! **Evaluation.** Before the first instruction the *inputs* hold the path index (and the
//! comparator), and all other registers are zero. An out-of-place op finds its targets zero and
//! leaves its result there. Each register is the target of one op, so its meaning is the same
//! wherever it is not zero. `evaluate` computes each op on integers, and is its definition.
//!
//! **Ownership of ancillas.** An op with garbage (carries, remainders, partial sums) owns a
//! *scratch* register for it, which no other op reads. Qubits that an op borrows and returns are
//! internal to its lowering. A register owns its qubits from the instruction that computes it to
//! the instruction that undoes it. Outside of that interval the qubits are zero, and can be
//! allocated to any register.
//!
//! **Conditions of uncompute.** The inverse of an out-of-place op returns its targets and its
//! garbage to zero, *provided that its operands hold the values that they held when the op ran*. In
//! [`Program::inverse`], which has the inverses in reverse order, they do. That is why
//! uncomputation is never written by hand. Between compute and uncompute a program may therefore
//! add ops that read its results (compare the colour, flip a phase), but none that change them.
//!
//! **Three implementations.** An op's meaning on integers, its lowering to X, CNOT and Toffoli, and
//! the count of these gates must agree for every content of its operands. Each machine is built on
//! one of the three alone, so each machine checks the others.

#![forbid(unsafe_code)]

mod controlled;
mod cores;
mod evaluate;
pub mod export;
pub mod format;
mod gate;
mod grouped;
mod host;
mod listing;
pub mod lower;
mod machine;
mod multiples;
mod op;
mod program;
pub mod quantum;
mod record;
mod register;

pub use controlled::{Controlled, controlled, unconditional};
pub use cores::Cores;
pub use evaluate::{Contents, Unclean};
pub use gate::{Gate, GateCircuit, GateSink, Qubit};
pub use grouped::grouped;
pub use host::{
    BorrowedRegister, CallFrame, Caller, Formats, Handed, Host, HostOf, HostRef, Is, Itself,
    Registers, Reversible, Running, Undetermined, Undone, demand,
};
pub use machine::{Call, Declaration, Machine};
pub use multiples::{KnownSums, Multiples};
pub use op::{Argument, Op, Style, When};
pub use program::{Instruction, Parameter, Program, WordError};
pub use record::{Recorded, Recorder};
pub use register::{Bit, Block, BlockId, Operand, Register, RegisterId, Tag, Type, Word};
