//! One basis state: reversible code, run on integers by the definition of its operations.

use qrt_circuit::{
    Call, Contents, Declaration, Machine, Operand, Program, Recorded, Recorder, Style, Word,
};

/// A register that was not left clean.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UncleanRegister {
    /// The register did not hold the expected value when it was undone or freed.
    #[error(
        "`{register}` held {held} when it was undone, and not {expected}: something it was \
         computed from, or itself, was changed"
    )]
    Undone {
        /// The register's name.
        register: String,
        /// The register's content when it was undone.
        held: u64,
        /// The content from which the inverse leaves 0.
        expected: u64,
    },
    /// The register was never undone.
    #[error("`{register}` holds {held} and was never uncomputed: undo what was computed into it")]
    Left {
        /// The register's name.
        register: String,
        /// The register's content.
        held: u64,
    },
}

/// A machine of one basis state, which shows the contents of registers and checks each inverse.
///
/// ```
/// use qrt_circuit::{Declaration, Machine, Type, When, Word};
/// use qrt_machines::State;
///
/// let mut state = State::new();
/// let a = state.input(&Declaration::work("a", Type::UInt, 4), 9);
/// let mut b = state.input(&Declaration::work("b", Type::UInt, 4), 12);
/// state.add_into(&mut b, Word::unsigned(&a, 0, 4).into(), false, When::Always);
/// assert_eq!(state.bits(&b), 5);
/// ```
#[derive(Clone, Debug)]
pub struct State {
    recorder: Recorder,
    contents: Contents,
    unclean: Option<UncleanRegister>,
}

impl State {
    /// A state without registers.
    pub fn new() -> Self {
        Self::with_inputs(Recorder::new(Style::InPlace), &[], &[])
    }

    /// A state of the registers that `recorder` has declared. Each of `inputs` holds the lowest bits of the
    /// number beside it, and `parameters` are the classical parameters. Instructions that `recorder` has
    /// recorded are not run.
    ///
    /// # Panics
    /// If another recorder made one of the registers.
    pub fn with_inputs(
        recorder: Recorder,
        inputs: &[(&Recorded, u64)],
        parameters: &[u64],
    ) -> Self {
        let mut state = Self {
            recorder,
            contents: Contents::new(&Program::default(), &[], parameters),
            unclean: None,
        };
        state.declared();
        for (register, bits) in inputs {
            let place = state.recorder.own(register).index();
            state.contents.registers[place] = lowest(*bits, register.width());
        }
        state
    }

    /// A register that holds the lowest of `bits` from the start.
    pub fn input(&mut self, t: &Declaration, bits: u64) -> Recorded {
        let register = self.recorder.input(t);
        self.declared();
        self.contents.registers[register.id().index()] = lowest(bits, t.width);
        register
    }

    /// Returns the content of a register.
    ///
    /// # Panics
    /// If another machine made the register.
    pub fn bits(&self, register: &Recorded) -> u64 {
        self.contents.registers[self.recorder.own(register).index()]
    }

    /// Returns the value that a word reads.
    ///
    /// # Panics
    /// If another machine made the register.
    pub fn read(&self, word: Word<&Recorded>) -> i64 {
        word.read(self.bits(word.register))
    }

    /// Returns the value that an operand reads.
    ///
    /// # Panics
    /// If another machine made the register.
    pub fn operand(&self, operand: Operand<&Recorded>) -> i64 {
        match operand {
            Operand::Word(word) => self.read(word),
            Operand::Constant(value) => value,
        }
    }

    /// Checks that every inverse left 0, and that no register except inputs still holds anything. A
    /// routine therefore computes a result into an [`input`](Self::input) of 0.
    ///
    /// # Errors
    /// The first register that was undone wrongly, or that still holds something.
    pub fn clean(&self) -> Result<(), UncleanRegister> {
        if let Some(unclean) = &self.unclean {
            return Err(unclean.clone());
        }
        let program = self.recorder.program();
        let registers = program.registers.iter().zip(&self.contents.registers);
        let is_input = |number: usize| program.inputs.iter().any(|id| id.index() == number);
        let mut left = registers.enumerate();
        match left.find(|(number, (_, held))| **held != 0 && !is_input(*number)) {
            None => Ok(()),
            Some((_, (register, &held))) => Err(UncleanRegister::Left {
                register: register.name.clone(),
                held,
            }),
        }
    }

    /// Adds new registers, which hold 0.
    fn declared(&mut self) {
        let registers = &self.recorder.program().registers;
        let known = self.contents.widths.len();
        let widths = registers[known..].iter().map(|register| register.width);
        self.contents.widths.extend(widths);
        self.contents.registers.resize(registers.len(), 0);
    }

    /// Runs the instruction that was recorded last.
    fn run_last(&mut self) {
        let program = self.recorder.program();
        let Some(instruction) = program.instructions.last() else {
            return;
        };
        if let Err(unclean) = self.contents.follow(program, *instruction) {
            self.unclean.get_or_insert_with(|| UncleanRegister::Undone {
                register: program.registers[unclean.register.index()].name.clone(),
                held: unclean.held,
                expected: unclean.expected,
            });
        }
    }
}

/// Returns the lowest `width` bits of `bits`.
fn lowest(bits: u64, width: u32) -> u64 {
    bits & u64::MAX.checked_shr(64 - width.min(64)).unwrap_or(0)
}

impl Default for State {
    fn default() -> Self {
        Self::new()
    }
}

impl Machine for State {
    type Register = Recorded;

    fn call(&mut self, call: Call<'_, Recorded>) -> Vec<Recorded> {
        let recorded = self.recorder.program().instructions.len();
        let computed = self.recorder.call(call);
        self.declared();
        if self.recorder.program().instructions.len() > recorded {
            self.run_last();
        }
        computed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_circuit::{Type, When};

    const A: Declaration = Declaration::work("a", Type::UInt, 4);
    const DOUBLE: Declaration = Declaration::work("double", Type::UInt, 5);

    fn twice(state: &mut State, a: &Recorded) -> Recorded {
        let [x, y] = [0, 1].map(|_| Operand::unsigned(a, 0, 4));
        state.add(&DOUBLE, x, y)
    }

    #[test]
    fn what_is_undone_leaves_nothing() {
        let mut state = State::new();
        let a = state.input(&A, 11);
        let double = twice(&mut state, &a);
        assert_eq!(state.bits(&double), 22);
        assert_eq!(state.read(Word::signed(&double, 0, 5)), -10);
        let id = double.id();
        state.undo([double]);
        state.clean().unwrap();
        assert_eq!(state.contents.registers[id.index()], 0);
    }

    #[test]
    fn an_operand_that_was_changed_is_found() {
        let mut state = State::new();
        let mut a = state.input(&A, 11);
        let double = twice(&mut state, &a);
        state.add_into(&mut a, Operand::Constant(1), false, When::Always);
        state.undo([double]);
        let unclean = state.clean().unwrap_err().to_string();
        assert!(unclean.starts_with("`double` held 22 when it was undone, and not 24"));
    }

    #[test]
    fn a_register_given_back_must_be_zero() {
        let mut state = State::new();
        let mut own = state.zero(&A);
        state.xor_into(&mut own, Operand::Constant(5), None);
        assert_eq!(state.bits(&own), 5);
        state.free(own);
        let unclean = state.clean().unwrap_err();
        assert!(
            matches!(unclean, UncleanRegister::Undone { held: 5, .. }),
            "{unclean}"
        );
    }

    #[test]
    fn what_nobody_undoes_is_found() {
        let mut state = State::new();
        let a = state.input(&A, 11);
        let _ = twice(&mut state, &a);
        let unclean = state.clean().unwrap_err();
        assert_eq!(
            unclean.to_string(),
            "`double` holds 22 and was never uncomputed: undo what was computed into it"
        );
        // A scratch register that is never freed is found too, even within a part that is undone.
        let mut state = State::new();
        let a = state.input(&A, 11);
        qrt_circuit::unconditional(&mut state, |state| {
            let mut own = state.zero(&A);
            state.xor_into(&mut own, Operand::unsigned(&a, 0, 4), None);
        });
        let left = UncleanRegister::Left {
            register: "a".to_owned(),
            held: 11,
        };
        assert_eq!(state.clean(), Err(left));
    }

    #[test]
    #[should_panic(expected = "register 1 belongs to another machine")]
    fn a_register_is_read_on_its_own_machine() {
        let [mut one, mut other] = [State::new(), State::new()];
        one.input(&A, 1);
        let second = one.input(&A, 2);
        other.input(&A, 3);
        other.input(&A, 4);
        other.bits(&second);
    }

    #[test]
    #[should_panic(expected = "register 0 belongs to another machine")]
    fn a_register_is_an_operand_on_its_own_machine() {
        let [mut one, mut other] = [State::new(), State::new()];
        let a = one.input(&A, 1);
        other.input(&A, 3);
        twice(&mut other, &a);
    }
}
