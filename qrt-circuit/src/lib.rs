//! Reversible programs: registers, operations, and their lowering to gates.
//!
//! # What a program means
//!
//! A [`Program`] is a straight line of [`Instruction`]s over [`Register`]s of qubits. Each is an
//! [`Op`] or an op's inverse, and permutes the basis states: given the integers that its operands
//! hold, it writes an integer into a register. There are no branches; what depends on a path is
//! selected, and every path runs every instruction.
//!
//! **Bit order.** Bit 0 of a register is its least significant. So it is for ids, indices, masks,
//! tables' addresses and what is exported.
//!
//! **Evaluation.** Before the first instruction the *inputs* hold the path's id (and the
//! comparator), and all other registers are zero. An op out of place finds its targets zero and
//! leaves its result there; each register is the target of one op, so a register has one meaning
//! wherever it isn't zero. `evaluate` says on integers what each op computes, and is the definition
//! of it.
//!
//! **Who owns ancillas.** An op that leaves something behind (carries, remainders, partial sums)
//! owns a *scratch* register that no other op reads. What it borrows and returns within itself is
//! its lowering's affair. Qubits have an owner from the instruction that computes a register to the
//! one that undoes it; in between nobody else has them, and outside of it they are zero and can be
//! anybody's.
//!
//! **What uncompute undoes.** The inverse of an op out of place returns its targets and its scratch
//! to zero, *provided that its operands hold what they held when it ran*. In
//! [`Program::inverse`], the inverses in reverse order, they do: that is why uncomputation is never
//! written by hand. Between compute and uncompute a program may therefore add ops that read its
//! results (compare the colour, flip a phase) and none that change them.
//!
//! **Three readings.** An op's meaning on integers, its lowering to X, CNOT and Toffoli, and the
//! count of these must agree for every content of its operands. Machines are built on one of the
//! three alone, so that each checks the others.

mod controlled;
mod evaluate;
pub mod format;
mod gate;
pub mod lower;
mod machine;
mod op;
mod program;
pub mod quantum;
mod record;
mod register;

pub use controlled::{Controlled, controlled, unconditional};
pub use evaluate::{Contents, Unclean};
pub use gate::{Circuit, Gate, Gates, Qubit};
pub use machine::{Call, Declaration, Machine};
pub use op::{Argument, Op, Style, When};
pub use program::{Instruction, Parameter, Program};
pub use record::{Recorded, Recorder};
pub use register::{Bit, Block, BlockId, Operand, Register, RegisterId, Tag, Type, Word};
