//! Evaluation of operations on integers: the definition that every machine is tested against.

use super::{Bit, Instruction, Op, Operand, Program, RegisterId, When, Word};

/// An error: a register is undone that does not hold the result of its operation on the current
/// operands. The operation's inverse would not leave 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unclean {
    /// The register that is undone.
    pub register: RegisterId,
    /// The integer that the register holds.
    pub held: u64,
    /// The integer that its operation computes from its operands now.
    pub expected: u64,
}

impl std::fmt::Display for Unclean {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            register,
            held,
            expected,
        } = self;
        write!(
            f,
            "register {} is undone while it holds {held}, and its operation computes {expected}",
            register.0
        )
    }
}

impl std::error::Error for Unclean {}

/// The contents of a program's registers on one path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contents {
    /// The bits of each register. Garbage is not simulated: its registers stay 0.
    pub registers: Vec<u64>,
    /// The bits of each classical parameter.
    pub parameters: Vec<u64>,
    /// The width of each register, in bits.
    pub widths: Vec<u32>,
    /// True if the phase of the basis state is flipped: its amplitude has the factor -1.
    pub negative: bool,
}

fn mask(width: u32) -> u64 {
    u64::MAX.checked_shr(64 - width).unwrap_or(0)
}

impl Contents {
    /// Returns the contents before a program's first instruction: the inputs hold `inputs`, all
    /// other registers 0.
    ///
    /// # Panics
    /// If `inputs` has fewer entries than the program has inputs.
    pub fn new(program: &Program, inputs: &[u64], parameters: &[u64]) -> Self {
        let widths: Vec<u32> = program.registers.iter().map(|r| r.width).collect();
        let mut contents = Self {
            registers: vec![0; widths.len()],
            parameters: parameters.to_vec(),
            widths,
            negative: false,
        };
        for (place, register) in program.inputs.iter().enumerate() {
            contents.registers[register.index()] = inputs[place];
        }
        contents
    }

    /// Executes one instruction of a program.
    ///
    /// # Errors
    /// An inverse that does not find the result of its operation; its register is 0 afterwards all
    /// the same.
    pub fn follow(&mut self, program: &Program, instruction: Instruction) -> Result<(), Unclean> {
        let op = &program.ops[instruction.op as usize];
        if !instruction.inverse {
            self.compute(op);
            return Ok(());
        }
        let targets = op.targets();
        let held: Vec<u64> = targets.iter().map(|t| self.registers[t.index()]).collect();
        self.uncompute(op);
        if targets.is_empty() {
            return Ok(());
        }
        self.compute(op);
        let mut found = targets.iter().zip(held).map(|(&register, held)| Unclean {
            register,
            held,
            expected: self.registers[register.index()],
        });
        let unclean = found.find(|unclean| unclean.held != unclean.expected);
        self.uncompute(op);
        unclean.map_or(Ok(()), Err)
    }

    fn word(&self, word: Word) -> i64 {
        word.read(self.registers[word.register.index()])
    }

    fn bit(&self, bit: Bit) -> bool {
        bit.read(self.registers[bit.register.index()])
    }

    fn operand(&self, operand: Operand) -> i64 {
        match operand {
            Operand::Word(word) => self.word(word),
            Operand::Constant(value) => value,
        }
    }

    fn set(&mut self, target: RegisterId, value: i64) {
        let width = self.widths[target.index()];
        self.registers[target.index()] = value.cast_unsigned() & mask(width);
    }

    /// Runs `op`, whose targets are zero.
    pub fn compute(&mut self, op: &Op) {
        match op {
            Op::Copy { a, target } => self.set(*target, self.word(*a)),
            Op::Load { parameter, target } => {
                let value = self.parameters[*parameter as usize];
                self.set(*target, value.cast_signed());
            }
            Op::Parity {
                source,
                columns,
                parameter,
                target,
            } => {
                let source = self.registers[source.index()];
                let start = parameter.map_or(0, |p| self.parameters[p as usize]);
                let flipped = columns
                    .iter()
                    .enumerate()
                    .filter(|(bit, _)| source >> bit & 1 == 1)
                    .fold(start, |sum, (_, column)| sum ^ column);
                self.set(*target, flipped.cast_signed());
            }
            Op::And { a, b, target } => {
                let both = self.bit(*a) && self.bit(*b);
                self.set(*target, i64::from(both));
            }
            Op::Xor { a, b, target } => {
                let differ = self.bit(*a) != self.bit(*b);
                self.set(*target, i64::from(differ));
            }
            Op::Add {
                a,
                b,
                subtract,
                target,
            } => {
                let (a, b) = (self.operand(*a), self.operand(*b));
                self.set(*target, added(a, b, *subtract));
            }
            Op::Negate { a, when, target } => {
                let a = self.word(*a);
                let value = if self.bit(*when) { a.wrapping_neg() } else { a };
                self.set(*target, value);
            }
            Op::Select { when, a, b, target } => {
                let chosen = if self.bit(*when) { a } else { b };
                self.set(*target, self.operand(*chosen));
            }
            Op::Less { a, b, target } => {
                let less = self.operand(*a) < self.operand(*b);
                self.set(*target, i64::from(less));
            }
            Op::Multiply {
                a, b, drop, target, ..
            } => {
                let product = i128::from(self.word(*a)) * i128::from(self.word(*b));
                self.set(*target, (product >> drop) as i64);
            }
            Op::Square {
                a, drop, target, ..
            } => {
                let a = i128::from(self.word(*a));
                self.set(*target, ((a * a) >> drop) as i64);
            }
            Op::Scale {
                a,
                factor,
                drop,
                target,
                ..
            } => {
                let product = i128::from(self.word(*a)) * i128::from(*factor);
                self.set(*target, (product >> drop) as i64);
            }
            Op::Multiples {
                a,
                products,
                targets,
                ..
            } => {
                let a = i128::from(self.word(*a));
                for (&(factor, drop), target) in products.products().iter().zip(targets) {
                    self.set(*target, ((a * i128::from(factor)) >> drop) as i64);
                }
            }
            Op::Divide {
                a,
                b,
                quotient,
                fits,
                ..
            } => {
                let width = self.widths[quotient.index()];
                let (a, b) = (self.word(*a), self.word(*b));
                let (value, holds) = divided(a, b, width);
                self.set(*quotient, value);
                self.set(*fits, i64::from(holds));
            }
            Op::SquareRoot { a, target, .. } => {
                let a = self.word(*a).cast_unsigned();
                self.set(*target, a.isqrt().cast_signed());
            }
            Op::Table {
                address,
                columns,
                targets,
                ..
            } => {
                let bits = address.iter().enumerate();
                let address = bits.fold(0, |sum, (place, bit)| {
                    sum | usize::from(self.bit(*bit)) << place
                });
                for (column, target) in columns.iter().zip(targets) {
                    self.set(*target, column.get(address).copied().unwrap_or(0));
                }
            }
            Op::Encode {
                bits,
                entries,
                targets,
                ..
            } => {
                let held = bits.iter().zip(entries.iter());
                let held = held.filter(|(bit, _)| self.bit(**bit));
                let mut found = held.map(|(_, entry)| *entry).collect::<Vec<_>>();
                found.resize(targets.len(), 0);
                for (target, entry) in targets.iter().zip(found) {
                    self.set(*target, entry.cast_signed());
                }
            }
            Op::XorInto { .. } | Op::AddInto { .. } | Op::Swap { .. } | Op::Phase { .. } => {
                self.in_place(op, false);
            }
        }
    }

    /// Undoes `op`: its targets become zero, and its changes in place are reversed.
    pub fn uncompute(&mut self, op: &Op) {
        let targets = op.targets();
        if targets.is_empty() {
            self.in_place(op, true);
        }
        for target in targets {
            self.set(target, 0);
        }
    }

    fn in_place(&mut self, op: &Op, inverse: bool) {
        match op {
            Op::XorInto { a, when, target } if when.is_none_or(|bit| self.bit(bit)) => {
                let old = self.registers[target.index()].cast_signed();
                self.set(*target, old ^ self.operand(*a));
            }
            Op::AddInto {
                a,
                subtract,
                when,
                target,
            } => {
                let (happens, turned) = match when {
                    When::Always => (true, false),
                    When::If(bit) => (self.bit(*bit), false),
                    When::Reversed(bit) => (true, self.bit(*bit)),
                };
                if happens {
                    let old = self.registers[target.index()].cast_signed();
                    let minus = *subtract != (turned != inverse);
                    self.set(*target, added(old, self.operand(*a), minus));
                }
            }
            Op::Swap { a, b, when } if when.is_none_or(|bit| self.bit(bit)) => {
                self.registers.swap(a.index(), b.index());
            }
            Op::Phase { bit } => self.negative ^= self.bit(*bit),
            _ => {}
        }
    }
}

fn added(a: i64, b: i64, subtract: bool) -> i64 {
    if subtract {
        a.wrapping_sub(b)
    } else {
        a.wrapping_add(b)
    }
}

/// Divides unsigned numbers. Returns the quotient and whether it fits `width` bits. A dividend
/// whose quotient does not fit counts as 0; a quotient by 0 has all bits set.
fn divided(a: i64, b: i64, width: u32) -> (i64, bool) {
    let fits = i128::from(a) < i128::from(b) << width;
    let all = mask(width).cast_signed();
    let a = if fits { a } else { 0 };
    let quotient = if b == 0 { all } else { a / b };
    (quotient, fits)
}
