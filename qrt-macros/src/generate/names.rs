//! The names of the generated code's variables.

use qrt_circuit::RegisterId;
use qrt_core::oracle::Oracle;
use std::collections::HashSet;

/// The variables that registers are in.
pub(super) struct Names(Vec<String>);

impl Names {
    pub(super) fn new(oracle: &Oracle) -> Self {
        let registers = oracle.program.registers.iter().enumerate();
        let mut taken: HashSet<String> = HashSet::new();
        let name = |(id, register): (usize, &qrt_circuit::Register)| {
            let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
            let mut name: String = register.name.chars().map(plain).collect();
            // Generated registers are called by what computes them and their numbers.
            if !name.ends_with(&id.to_string()) && id != oracle.id.index() {
                name = format!("{name}_{id}");
            }
            if !taken.insert(name.clone()) {
                name = format!("r{id}_{name}");
            }
            name
        };
        Self(registers.map(name).collect())
    }

    /// The variable that holds a register.
    pub(super) fn of(&self, register: RegisterId) -> &str {
        &self.0[register.index()]
    }
}
