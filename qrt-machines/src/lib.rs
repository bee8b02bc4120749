//! Machines that run reversible programs and circuits, without rays.
//!
//! Each machine executes what [`qrt_circuit`] defines, and shares no code with the others:
//!
//! * [`FixedMachine`] evaluates a program operation by operation on lanes of integers;
//! * [`GatesMachine`] executes a circuit gate by gate on lanes of bits, one row a qubit;
//! * [`State`] runs code over [`qrt_circuit::Machine`] on one basis state, by the operations'
//!   definition, and checks what is undone;
//! * [`statevector`] follows amplitudes, for circuits with Hadamards and rotations.
//!
//! [`run`] runs a routine on the first three. `qrt-runtime` builds the machines that trace a scene's
//! paths upon these.
//!
//! ```
//! use qrt_circuit::format::{Reg, UInt};
//! use qrt_circuit::{Machine, Recorder, Style, When};
//! use qrt_machines::run;
//!
//! let mut recorder = Recorder::new(Style::InPlace);
//! let a: Reg<_, UInt<4>> = Reg::input(&mut recorder, "a");
//! let mut b: Reg<_, UInt<4>> = Reg::input(&mut recorder, "b");
//! recorder.add_into(b.register_mut(), a.word().into(), false, When::Always);
//! assert_eq!(run::on_gates(&recorder.finish(), &[[3, 4]])?, [[3, 7]]);
//! # Ok::<(), run::RunError>(())
//! ```

#![forbid(unsafe_code)]

mod fixed;
mod gates;
mod instructions;
pub mod run;
mod span;
mod state;
pub mod statevector;
mod transpose;

pub use fixed::{Extremes, FixedLanes, FixedMachine, contents_by_definition};
pub use gates::{Dirty, GatesMachine, InvalidGate, Queue, Rows, Template};
pub use instructions::{InstructionSet, InstructionsError};
pub use span::PixelLanes;
pub use state::{State, UncleanRegister};
