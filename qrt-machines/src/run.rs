//! Runs routines, which are programs that change their inputs in place, on the machines.
//!
//! A *state* is the contents of the program's inputs, in their order: bits, as unsigned integers.
//! The same registers are read after the program, and everything else must be zero again.
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
//! let program = recorder.finish();
//!
//! let states = [[3, 4], [9, 9]];
//! assert_eq!(run::on_definition(&program, &states)?, [[3, 7], [9, 2]]);
//! assert_eq!(run::on_fixed(&program, &states)?, [[3, 7], [9, 2]]);
//! assert_eq!(run::on_gates(&program, &states)?, [[3, 7], [9, 2]]);
//! # Ok::<(), run::RunError>(())
//! ```

use crate::{FixedMachine, GatesMachine, InvalidGate};
use qrt_circuit::{Contents, Op, Operand, Program, Qubit, RegisterId, Word, lower};

/// Reason for which a program did not run as a routine.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RunError {
    /// The number of a state's contents differs from the number of the program's inputs.
    #[error("state {state} does not hold {expected} contents, one an input")]
    Inputs {
        /// Position of the state in the list `states`, from 0.
        state: usize,
        /// Number of inputs of the program.
        expected: usize,
    },
    /// A state's content has more bits than its register.
    #[error("state {state} holds more than fits into `{register}`")]
    TooWide {
        /// Position of the state in the list `states`, from 0.
        state: usize,
        /// The register's name.
        register: String,
    },
    /// The program has classical parameters, which only a scene's pixels determine.
    #[error("the program has classical parameters")]
    Parameters,
    /// The lowering made a list of gates that is not a valid circuit: a defect of qrt.
    #[error(transparent)]
    Gate(InvalidGate),
    /// A register is not freed.
    #[error("`{register}` is never freed")]
    Kept {
        /// The register's name.
        register: String,
    },
    /// The program frees a register that is not zero, or undoes one after its operands have
    /// changed.
    #[error("`{register}` is freed, and is not zero from state {state}")]
    Dirty {
        /// Position of the state in the list `states`, from 0.
        state: usize,
        /// The register's name, or the qubit.
        register: String,
    },
}

/// Runs a program by the definition of its operations, one state at a time. At each inverse, the
/// register is compared with the value that its operation computes at that moment.
///
/// # Errors
/// If a state does not fit the program, or the program leaves garbage in a register.
pub fn on_definition(
    program: &Program,
    states: &[impl AsRef<[u64]>],
) -> Result<Vec<Vec<u64>>, RunError> {
    check(program, states)?;
    let run = |(state, inputs): (usize, &[u64])| {
        let mut contents = Contents::new(program, inputs, &[]);
        for instruction in &program.instructions {
            let dirty = contents.follow(program, *instruction);
            dirty.map_err(|unclean| RunError::Dirty {
                state,
                register: name(program, unclean.register),
            })?;
        }
        let inputs = program.inputs.iter();
        Ok(inputs.map(|id| contents.registers[id.index()]).collect())
    };
    let states = states.iter().map(AsRef::as_ref).enumerate();
    states.map(run).collect()
}

/// Result of a block of states on a machine: columns of contents by input, or the lane and the name
/// of a register or qubit that is not zero.
type BlockRun = Result<Vec<Vec<u64>>, (usize, String)>;

/// Runs a program on all states, `lanes` of them at a time.
fn on_blocks(
    program: &Program,
    states: &[impl AsRef<[u64]>],
    lanes: usize,
    mut run: impl FnMut(&[Vec<u64>], usize) -> BlockRun,
) -> Result<Vec<Vec<u64>>, RunError> {
    let mut results = Vec::with_capacity(states.len());
    for (block, states) in states.chunks(lanes).enumerate() {
        let column = |input| states.iter().map(|state| state.as_ref()[input]).collect();
        let columns: Vec<Vec<u64>> = (0..program.inputs.len()).map(column).collect();
        let outputs = run(&columns, states.len()).map_err(|(lane, register)| RunError::Dirty {
            state: block * lanes + lane,
            register,
        })?;
        let state = |lane: usize| outputs.iter().map(|output| output[lane]).collect();
        results.extend((0..states.len()).map(state));
    }
    Ok(results)
}

/// Runs a program on the fixed machine. That machine undoes nothing. Instead, the registers that
/// the routine allocates are read after the program and must be zero.
///
/// # Errors
/// If a state does not fit the program, or the program leaves garbage in a register.
pub fn on_fixed(
    program: &Program,
    states: &[impl AsRef<[u64]>],
) -> Result<Vec<Vec<u64>>, RunError> {
    check(program, states)?;
    let read = |id: RegisterId| Word::unsigned(id, 0, program.width(id));
    let own = own(program);
    let held = program.inputs.iter().chain(&own).map(|id| read(*id));
    let machine = FixedMachine::new(program, &held.collect::<Vec<_>>());
    let mut lanes = machine.lanes();
    on_blocks(program, states, FixedMachine::LANES, |columns, count| {
        let inputs: Vec<&[u64]> = columns.iter().map(Vec::as_slice).collect();
        let mut outputs = vec![vec![0_i64; count]; program.inputs.len() + own.len()];
        let mut slices: Vec<&mut [i64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        machine.run(&mut lanes, &inputs, &[], &mut slices);
        let own_outputs = outputs.split_off(program.inputs.len());
        for (id, contents) in own.iter().zip(&own_outputs) {
            if let Some(lane) = contents.iter().position(|bits| *bits != 0) {
                return Err((lane, name(program, *id)));
            }
        }
        let unsigned = |column: Vec<i64>| column.into_iter().map(i64::cast_unsigned).collect();
        Ok(outputs.into_iter().map(unsigned).collect())
    })
}

/// Runs every gate of a program's circuit on the gates machine. All qubits except those of the
/// inputs must be zero afterwards.
///
/// # Errors
/// If a state does not fit the program, or the program leaves garbage in a register.
pub fn on_gates(
    program: &Program,
    states: &[impl AsRef<[u64]>],
) -> Result<Vec<Vec<u64>>, RunError> {
    check(program, states)?;
    let circuit = lower::circuit(program);
    let machine = GatesMachine::new(&[&circuit]).map_err(RunError::Gate)?;
    let qubits = |id: &RegisterId| -> &[Qubit] {
        let mut held = circuit.inputs.iter();
        held.find(|(held, _)| held == id)
            .map_or(&[], |(_, qubits)| qubits)
    };
    let inputs: Vec<&[Qubit]> = program.inputs.iter().map(qubits).collect();
    let mut rows = machine.rows();
    on_blocks(program, states, machine.lanes(), |columns, count| {
        rows.clear();
        for (qubits, column) in inputs.iter().zip(columns) {
            rows.set(qubits, column);
        }
        machine.run(0, &mut rows);
        if let Some(dirty) = rows.dirty(&inputs.concat(), count) {
            return Err((dirty.lane, format!("qubit {}", dirty.qubit)));
        }
        let mut outputs = vec![vec![0; count]; inputs.len()];
        for (qubits, output) in inputs.iter().zip(&mut outputs) {
            rows.get(qubits, output);
        }
        Ok(outputs)
    })
}

fn name(program: &Program, register: RegisterId) -> String {
    program.registers[register.index()].name.clone()
}

/// Registers that a routine allocates, changes in place and frees. They are recorded as 0 + 0.
fn own(program: &Program) -> Vec<RegisterId> {
    let zero = |op: &Op| match op {
        Op::Add {
            a: Operand::Constant(0),
            b: Operand::Constant(0),
            target,
            ..
        } => Some(*target),
        _ => None,
    };
    program.ops.iter().filter_map(zero).collect()
}

fn check(program: &Program, states: &[impl AsRef<[u64]>]) -> Result<(), RunError> {
    if !program.parameters.is_empty() {
        return Err(RunError::Parameters);
    }
    let outputs = program.outputs();
    if let Some(kept) = outputs.iter().find(|id| !program.inputs.contains(id)) {
        let register = name(program, *kept);
        return Err(RunError::Kept { register });
    }
    for (state, contents) in states.iter().map(AsRef::as_ref).enumerate() {
        let expected = program.inputs.len();
        if contents.len() != expected {
            return Err(RunError::Inputs { state, expected });
        }
        let mut held = program.inputs.iter().zip(contents);
        if let Some((id, _)) = held.find(|(id, bits)| *bits >> program.width(**id) != 0) {
            let register = name(program, *id);
            return Err(RunError::TooWide { state, register });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_circuit::format::{Reg, UInt};
    use qrt_circuit::{Declaration, Machine, Recorder, Style, Type, When};

    /// Returns a program that frees a scratch register while it still holds the content of `a`.
    fn leaves() -> Program {
        let mut m = Recorder::new(Style::InPlace);
        let a: Reg<_, UInt<4>> = Reg::input(&mut m, "a");
        let mut t: Reg<_, UInt<4>> = Reg::zero(&mut m, "t");
        m.add_into(t.register_mut(), a.word().into(), false, When::Always);
        t.free(&mut m);
        m.finish()
    }

    #[test]
    fn what_is_left_behind_is_found() {
        let program = leaves();
        let states = [[0], [0], [3]];
        let dirty = |register: &str| RunError::Dirty {
            state: 2,
            register: register.to_owned(),
        };
        assert_eq!(on_definition(&program, &states), Err(dirty("t")));
        assert_eq!(on_fixed(&program, &states), Err(dirty("t")));
        assert_eq!(on_gates(&program, &states), Err(dirty("qubit 4")));
        assert_eq!(on_gates(&program, &[[0]]), Ok(vec![vec![0]]));
    }

    #[test]
    fn what_is_undone_after_its_operands_changed_is_found() {
        let mut m = Recorder::new(Style::InPlace);
        let mut a: Reg<_, UInt<4>> = Reg::input(&mut m, "a");
        let declared = Declaration::work("copy", Type::UInt, 4);
        let copy = m.copy(&declared, a.word());
        m.add_into(a.register_mut(), Operand::Constant(1), false, When::Always);
        m.undo([copy]);
        let program = m.finish();
        assert!(matches!(
            on_definition(&program, &[[7]]),
            Err(RunError::Dirty { .. })
        ));
        assert!(matches!(
            on_gates(&program, &[[7]]),
            Err(RunError::Dirty { .. })
        ));
    }

    #[test]
    fn states_must_fit() {
        let program = leaves();
        assert!(matches!(
            on_fixed(&program, &[[16]]),
            Err(RunError::TooWide { .. })
        ));
        assert!(matches!(
            on_gates(&program, &[[0, 0]]),
            Err(RunError::Inputs { .. })
        ));
        let mut kept = program;
        kept.instructions.pop();
        assert!(matches!(
            on_fixed(&kept, &[[0]]),
            Err(RunError::Kept { .. })
        ));
    }
}
