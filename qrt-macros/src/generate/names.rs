//! The names of the generated code's variables.

use qrt_circuit::RegisterId;
use qrt_core::oracle::Oracle;
use std::collections::HashSet;

/// The variables of registers.
pub(super) struct Names(Vec<String>);

impl Names {
    pub(super) fn new(oracle: &Oracle) -> Self {
        let registers = oracle.program.registers.iter().enumerate();
        let mut taken: HashSet<String> = HashSet::new();
        let name = |(id, register): (usize, &qrt_circuit::Register)| {
            let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
            let mut name: String = register.name.chars().map(plain).collect();
            // A generated register is named after its operation, and its name ends in its number.
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

    /// Returns the variable that holds a register.
    pub(super) fn variable(&self, register: RegisterId) -> &str {
        &self.0[register.index()]
    }
}

/// Returns `name` as the name of a type beside the scene's: another one if the scene has that name.
pub(super) fn beside(scene: &str, name: &str) -> String {
    if scene == name {
        return format!("{name}_");
    }
    name.to_owned()
}

/// Returns names of fields for an author's names, in their order, all different. A character that
/// is no letter, digit or `_` becomes `_`, and a name that is already taken gets a number.
pub(super) fn identifiers<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut taken: HashSet<String> = HashSet::new();
    let own = |name: &str| {
        let plain = |c: char| {
            if c == '_' || c.is_alphanumeric() {
                c
            } else {
                '_'
            }
        };
        let mut name: String = name.chars().map(plain).collect();
        if name.trim_matches('_').is_empty() {
            name.insert_str(0, "unnamed");
        } else if name.starts_with(char::is_numeric) {
            name.insert(0, '_');
        }
        // `self` and some other keywords cannot be raw.
        match syn::parse_str::<proc_macro2::Ident>(&name) {
            Ok(_) => name,
            Err(_) => syn::parse_str::<proc_macro2::Ident>(&format!("r#{name}"))
                .map_or_else(|_| format!("{name}_"), |raw| raw.to_string()),
        }
    };
    let names = names.map(|name| {
        let name = own(name);
        let mut free = name.clone();
        let mut number = 2;
        while !taken.insert(free.clone()) {
            free = format!("{name}_{number}");
            number += 1;
        }
        free
    });
    names.collect()
}

#[cfg(test)]
mod tests {
    use super::identifiers;

    #[test]
    fn an_authors_names_are_fields() {
        let names = [
            "red",
            "warm lamp",
            "warm-lamp",
            "type",
            "self",
            "2nd",
            "",
            "_",
            "red",
            "red_2",
            "Ölfarbe",
        ];
        let fields = [
            "red",
            "warm_lamp",
            "warm_lamp_2",
            "r#type",
            "self_",
            "_2nd",
            "unnamed",
            "unnamed_",
            "red_2",
            "red_2_2",
            "Ölfarbe",
        ];
        let made = identifiers(names.into_iter());
        assert_eq!(made, fields);
        for name in &made {
            assert!(syn::parse_str::<proc_macro2::Ident>(name).is_ok(), "{name}");
        }
    }
}
