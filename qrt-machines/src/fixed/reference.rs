//! A program's contents by the definition of its operations, one state at a time.

use qrt_circuit::{Contents, Program};

/// Returns the contents of the registers after the program, for the state whose input registers
/// hold `inputs`, in the pixel with these classical parameters.
///
/// # Panics
/// If there are fewer inputs or parameters than the program has.
pub fn contents_by_definition(program: &Program, inputs: &[u64], parameters: &[u64]) -> Contents {
    follow(program, inputs, parameters, |_| {})
}

fn follow(
    program: &Program,
    inputs: &[u64],
    parameters: &[u64],
    mut after: impl FnMut(&Contents),
) -> Contents {
    let mut contents = Contents::new(program, inputs, parameters);
    after(&contents);
    for instruction in &program.instructions {
        let op = &program.ops[instruction.op as usize];
        if instruction.inverse {
            contents.uncompute(op);
        } else {
            contents.compute(op);
        }
        after(&contents);
    }
    contents
}

/// The least and the greatest number that each register of a program has held, as its type reads
/// it. Every register has held 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Extremes {
    /// By register: the least and the greatest number that it held.
    pub registers: Vec<[i64; 2]>,
}

impl Extremes {
    /// Creates the extremes of no state.
    pub fn new(program: &Program) -> Self {
        Self {
            registers: vec![[0, 0]; program.registers.len()],
        }
    }

    /// Runs the program as [`contents_by_definition`] does, and records the contents of its registers on the way.
    ///
    /// # Panics
    /// As [`contents_by_definition`].
    pub fn record(&mut self, program: &Program, inputs: &[u64], parameters: &[u64]) -> Contents {
        follow(program, inputs, parameters, |contents| {
            let held = self.registers.iter_mut().zip(&program.registers);
            for ((extremes, register), bits) in held.zip(&contents.registers) {
                // A scratch register stays 0 here, and may be wider than a number.
                if register.width > 64 {
                    continue;
                }
                let unused = (64 - register.width).min(63);
                let number = if super::compile::negative(register.ty) {
                    (bits << unused).cast_signed() >> unused
                } else {
                    bits.cast_signed()
                };
                *extremes = [extremes[0].min(number), extremes[1].max(number)];
            }
        })
    }
}
