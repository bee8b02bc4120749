//! Random programs.

use qrt_circuit::{
    Bit, BlockId, Instruction, Multiples, Op, Operand, Parameter, Program, Register, RegisterId,
    Style, Type, When, Word,
};
use std::sync::Arc;

/// Random choices keyed by a seed.
pub(crate) struct Dice(pub(crate) u64);

impl Dice {
    pub(crate) fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }
    pub(crate) fn below(&mut self, bound: u32) -> u32 {
        (((self.word() >> 32) * u64::from(bound)) >> 32) as u32
    }
    pub(crate) fn between(&mut self, low: u32, high: u32) -> u32 {
        low + self.below(high - low + 1)
    }
    fn coin(&mut self) -> bool {
        self.below(2) == 1
    }
}

/// A program of chosen operations on random operands.
pub(crate) struct Maker {
    pub(crate) dice: Dice,
    pub(crate) program: Program,
    /// The most bits of a register.
    pub(crate) widest: u32,
}

pub(crate) const PARAMETERS: usize = 3;

impl Maker {
    /// Creates a program with registers of up to `widest` bits. The first register is the path's
    /// index, with `id` bits.
    pub(crate) fn new(seed: u64, id: u32, widest: u32) -> Self {
        let mut maker = Self {
            dice: Dice(seed),
            program: Program::default(),
            widest,
        };
        let bits = widest.min(40);
        maker.program.parameters = vec![
            Parameter {
                name: String::new(),
                width: bits
            };
            PARAMETERS
        ];
        let id = maker.register(id, false);
        let other = maker.register(widest, true);
        maker.program.inputs = vec![id, other];
        for parameter in 0..PARAMETERS as u32 {
            let target = maker.any_register();
            maker.push(Op::Load { parameter, target });
        }
        maker
    }

    pub(crate) fn register(&mut self, width: u32, signed: bool) -> RegisterId {
        let id = RegisterId(self.program.registers.len() as u32);
        let ty = if signed { Type::Int } else { Type::UInt };
        let name = format!("r{}", id.0);
        self.program.registers.push(Register::new(name, ty, width));
        id
    }

    fn any_register(&mut self) -> RegisterId {
        let width = self.dice.between(1, self.widest);
        let signed = self.dice.coin();
        self.register(width, signed)
    }

    pub(crate) fn truth(&mut self) -> RegisterId {
        self.register(1, false)
    }

    pub(crate) fn push(&mut self, op: Op) {
        self.program.instructions.push(Instruction {
            op: self.program.ops.len() as u32,
            inverse: false,
            block: BlockId::ROOT,
        });
        self.program.ops.push(op);
    }

    fn old(&mut self) -> RegisterId {
        // Later registers are chosen more often.
        let all = self.program.registers.len() as u32;
        let back = if self.dice.coin() { all.min(6) } else { all };
        RegisterId(all - 1 - self.dice.below(back))
    }

    fn bit(&mut self) -> Bit {
        let register = self.old();
        Bit {
            register,
            index: self.dice.below(self.program.width(register)),
            inverted: self.dice.coin(),
        }
    }

    fn word(&mut self, most: u32, unsigned: bool) -> Word {
        let register = self.old();
        let width = self.program.width(register);
        let whole = self.dice.below(3) == 0 && width <= most;
        let offset = if whole { 0 } else { self.dice.below(width) };
        let rest = (width - offset).min(most);
        let width = if whole {
            width
        } else {
            self.dice.between(1, rest)
        };
        let up = (most - width).min(12);
        let shift = if self.dice.below(3) == 0 {
            self.dice.below(up + 1)
        } else {
            0
        };
        Word {
            register,
            offset,
            width,
            signed: !unsigned && self.dice.coin(),
            shift,
        }
    }

    fn operand(&mut self) -> Operand {
        if self.dice.below(3) == 0 {
            let bits = self.dice.between(1, self.widest.min(60));
            let number = (self.dice.word() >> (64 - bits)) as i64;
            Operand::Constant(if self.dice.coin() { number } else { -number })
        } else {
            Operand::Word(self.word(61, false))
        }
    }

    /// Adds an operation of kind `kind`, of 20 kinds.
    pub(crate) fn op(&mut self, kind: u32) {
        let style = Style::OutOfPlace;
        let scratch = self.register(1, false);
        let drop = if self.dice.coin() {
            self.dice.below(2 * self.widest)
        } else {
            0
        };
        let op = match kind {
            0 => Op::Copy {
                a: self.word(62, false),
                target: self.any_register(),
            },
            1 => {
                let source = if self.dice.coin() {
                    RegisterId(0)
                } else {
                    self.old()
                };
                let parameter = self.dice.coin().then(|| self.dice.below(PARAMETERS as u32));
                let columns = (0..self.program.width(source)).map(|_| self.dice.word());
                let columns = columns.collect();
                Op::Parity {
                    source,
                    columns,
                    parameter,
                    target: self.any_register(),
                }
            }
            2 => Op::And {
                a: self.bit(),
                b: self.bit(),
                target: self.truth(),
            },
            3 => Op::Xor {
                a: self.bit(),
                b: self.bit(),
                target: self.truth(),
            },
            4 => Op::Add {
                a: self.operand(),
                b: self.operand(),
                subtract: self.dice.coin(),
                target: self.any_register(),
            },
            5 => Op::Negate {
                a: self.word(62, false),
                when: self.bit(),
                target: self.any_register(),
            },
            6 => Op::Select {
                when: self.bit(),
                a: self.operand(),
                b: self.operand(),
                target: self.any_register(),
            },
            7 => Op::Less {
                a: self.operand(),
                b: self.operand(),
                target: self.truth(),
            },
            8 => Op::Multiply {
                a: self.word(62, false),
                b: self.word(62, false),
                drop,
                style,
                target: self.any_register(),
                scratch,
            },
            9 => Op::Square {
                a: self.word(62, false),
                drop,
                style,
                target: self.any_register(),
                scratch,
            },
            10 if self.dice.coin() => {
                let a = self.word(62, false);
                let mut product = || {
                    let factor = self.dice.word() as i64 >> self.dice.between(24, 62);
                    (factor.abs() | 1, self.dice.between(0, 40))
                };
                let products = [product(), product()];
                Op::Multiples {
                    a,
                    products: Multiples::new(&products).unwrap().into(),
                    targets: [self.any_register(), self.any_register()].into(),
                    scratch,
                }
            }
            10 => Op::Scale {
                a: self.word(62, false),
                factor: (self.dice.word() as i64 >> self.dice.between(2, 62)) | 1,
                drop,
                style,
                target: self.any_register(),
                scratch,
            },
            11 => {
                let width = self.dice.between(1, self.widest);
                Op::Divide {
                    a: self.word(62, true),
                    b: self.word(62, true),
                    style,
                    quotient: self.register(width, false),
                    fits: self.truth(),
                    scratch,
                }
            }
            12 => Op::SquareRoot {
                a: self.word(62, true),
                style,
                target: self.any_register(),
                scratch,
            },
            13 => {
                let bits = self.dice.between(0, 9);
                let word = self.word(61, true);
                let row = self.dice.coin() && word.width >= bits;
                let address = (0..bits).map(|place| {
                    if row {
                        let index = word.offset + place;
                        Bit {
                            register: word.register,
                            index,
                            inverted: false,
                        }
                    } else {
                        self.bit()
                    }
                });
                let address: Vec<Bit> = address.collect();
                let entries = self.dice.between(1, 1 << bits);
                let columns = (0..2).map(|_| {
                    let column = (0..entries).map(|_| self.dice.word() as i64 >> 3);
                    column.collect::<Arc<[i64]>>()
                });
                let columns: Vec<_> = columns.collect();
                let targets = [self.any_register(), self.any_register()];
                Op::Table {
                    style: Style::OutOfPlace,
                    address: address.into(),
                    columns: columns.into(),
                    low: 0,
                    targets: targets.into(),
                    scratch,
                }
            }
            // An operation in place changes a copy of its own, so that no operand changes.
            14..=16 => {
                let a = self.operand();
                let bit = self.bit();
                let copied = self.word(62, false);
                let target = self.any_register();
                self.push(Op::Copy { a: copied, target });
                if kind == 14 {
                    let when = self.dice.coin().then_some(bit);
                    self.push(Op::XorInto { a, when, target });
                    return;
                }
                let when = [When::Always, When::If(bit), When::Reversed(bit)];
                let when = when[self.dice.below(3) as usize];
                let subtract = self.dice.coin();
                let op = Op::AddInto {
                    a,
                    subtract,
                    when,
                    target,
                };
                if kind == 16 {
                    // Compute, undo, and compute again.
                    self.push(op.clone());
                    self.push(op.clone());
                    let last = self.program.instructions.len() - 1;
                    self.program.instructions[last].inverse = true;
                }
                op
            }
            17 => {
                let width = self.dice.between(1, self.widest);
                let when = self.dice.coin().then(|| self.bit());
                let words = [self.word(62, false), self.word(62, false)];
                let signed = [self.dice.coin(), self.dice.coin()];
                let pair = signed.map(|signed| self.register(width, signed));
                for (a, target) in words.into_iter().zip(pair) {
                    self.push(Op::Copy { a, target });
                }
                let [a, b] = pair;
                Op::Swap { a, b, when }
            }
            18 => {
                let bits: Box<[Bit]> = (0..self.dice.between(1, 9)).map(|_| self.bit()).collect();
                let width = self.dice.between(1, self.widest.min(40));
                let entries = bits.iter().map(|_| {
                    let top = 1 << (width - 1);
                    top | self.dice.word() & (top - 1)
                });
                let entries = entries.collect();
                let targets = (0..3).map(|_| self.register(width, false)).collect();
                Op::Encode {
                    bits,
                    entries,
                    targets,
                    scratch,
                }
            }
            _ => Op::Phase { bit: self.bit() },
        };
        self.push(op);
    }
}

/// Number of the kinds of operations that [`Maker::op`] knows.
pub(crate) const KINDS: u32 = 20;

/// Contents of `width` bits that are likely to matter: any contents, and contents near the ends.
pub(crate) fn contents_of(dice: &mut Dice, width: u32, many: usize) -> Vec<u64> {
    let any = |dice: &mut Dice| match dice.below(4) {
        0 => u64::from(dice.below(3)),
        1 => !u64::from(dice.below(3)),
        2 => (1 << dice.below(64)) - u64::from(dice.below(2)),
        _ => dice.word(),
    };
    (0..many)
        .map(|_| any(dice) & (u64::MAX >> (64 - width)))
        .collect()
}
