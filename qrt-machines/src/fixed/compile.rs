//! Compiles a program to steps on values, each of the narrowest kind that holds it.

use super::arith::{Arg, Arith, Wrap};
use super::lane::{Kind, Lane};
use super::steps::{AddressBit, Step, StepLane};
use qrt_circuit::{Bit, Operand, Program, RegisterId, Type, Word};
use std::collections::HashMap;

/// A value: its kind, and its number among all values.
pub(super) type Value = (Kind, u32);

/// Expands to `$body`, with `$K` the type of lane of `$kind`.
macro_rules! with_kind {
    ($kind:expr, $K:ident => $body:expr) => {
        match $kind {
            Kind::Truth => {
                type $K = u8;
                $body
            }
            Kind::Short => {
                type $K = i16;
                $body
            }
            Kind::Int => {
                type $K = i32;
                $body
            }
            Kind::Long => {
                type $K = i64;
                $body
            }
        }
    };
}

/// Bounds of a value that is already cut to its register.
pub(super) const CUT: [i64; 2] = [0, 0];

/// Range of the numbers of `width` bits, unsigned or in two's complement.
pub(super) fn range(width: u32, signed: bool) -> [i64; 2] {
    let all = |bits: u32| (1_i128 << bits) - 1;
    let [low, high] = if signed {
        [-1 - all(width - 1), all(width - 1)]
    } else {
        [0, all(width)]
    };
    [low as i64, i64::try_from(high).unwrap_or(i64::MAX)]
}

/// The kind of a register.
pub(super) fn kind_of(width: u32, signed: bool) -> Kind {
    if width == 1 && !signed {
        Kind::Truth
    } else {
        Kind::for_range(range(width, signed))
    }
}

/// Returns whether the type reads its top bit as a sign.
pub(super) fn negative(ty: Type) -> bool {
    matches!(ty, Type::Int | Type::Fixed { .. })
}

/// Key of an operand whose content differs from its register's: the value, its bits, and the kind.
type Reading = (u32, Option<Word>, Kind);

pub(super) struct Compiler<'a> {
    pub(super) program: &'a Program,
    pub(super) steps: Vec<Step>,
    values: u32,
    pub(super) registers: Vec<Option<Value>>,
    readings: HashMap<Reading, u32>,
    bits: HashMap<(u32, u32), u32>,
    pub(super) addresses: HashMap<Vec<AddressBit>, u32>,
    /// By value of an input register: the position of the input, and its number of bits.
    pub(super) inputs: HashMap<u32, (u32, u32)>,
    pub(super) sign: Option<u32>,
}

pub(super) use with_kind;

impl<'a> Compiler<'a> {
    pub(super) fn new(program: &'a Program) -> Self {
        let mut compiler = Self {
            program,
            steps: Vec::new(),
            values: 0,
            registers: vec![None; program.registers.len()],
            readings: HashMap::new(),
            bits: HashMap::new(),
            addresses: HashMap::new(),
            sign: None,
            inputs: HashMap::new(),
        };
        for (input, register) in program.inputs.iter().enumerate() {
            let input = input as u32;
            compiler.input(input, *register);
        }
        let all = &program.instructions;
        let in_place = |op: u32| program.ops[op as usize].targets().is_empty();
        let computed = all
            .iter()
            .rposition(|instruction| !instruction.inverse || in_place(instruction.op));
        for instruction in &all[..computed.map_or(0, |last| last + 1)] {
            let op = &program.ops[instruction.op as usize];
            if !instruction.inverse {
                compiler.op(op);
            } else if op.targets().is_empty() {
                compiler.in_place(op, true);
            }
        }
        compiler
    }

    /// Adds the steps that read `outputs`, and returns their values with their kinds.
    pub(super) fn outputs(&mut self, outputs: &[Word]) -> Vec<Value> {
        let read = outputs.iter().map(|word| {
            let kind = Kind::for_range(word.range());
            (kind, self.word(*word, kind))
        });
        read.collect()
    }

    pub(super) fn value(&mut self) -> u32 {
        self.values += 1;
        self.values - 1
    }

    pub(super) fn shape(&self, register: RegisterId) -> (u32, bool) {
        let register = &self.program.registers[register.index()];
        (register.width, negative(register.ty))
    }

    pub(super) fn kind(&self, register: RegisterId) -> Kind {
        let (width, signed) = self.shape(register);
        kind_of(width, signed)
    }

    /// Returns the register's content, which is zero if nothing has computed it.
    pub(super) fn register(&mut self, register: RegisterId) -> Value {
        if let Some(value) = self.registers[register.index()] {
            return value;
        }
        let kind = self.kind(register);
        let zero = self.constant(kind, 0);
        self.registers[register.index()] = Some((kind, zero));
        (kind, zero)
    }

    pub(super) fn cast(&mut self, from: Value, kind: Kind, wrap: Wrap<i64>) -> u32 {
        self.step(|t| Step::Cast {
            from,
            to: (kind, t),
            wrap,
        })
    }

    /// Returns the word's number, or its lowest bits if `kind` has fewer.
    pub(super) fn word(&mut self, word: Word, kind: Kind) -> u32 {
        if kind == Kind::Truth {
            return self.lowest_bit(word);
        }
        let (from, value) = self.register(word.register);
        let (width, signed) = self.shape(word.register);
        let whole = word.offset == 0 && word.width == width && word.shift == 0;
        // The kind may keep only a part of the register.
        let low = word.offset == 0 && word.shift == 0 && word.width >= kind.bits();
        let free = (whole && word.signed == signed) || low && width >= word.width;
        if free && from == kind {
            return value;
        }
        let reading = (value, (!free).then_some(word), kind);
        if let Some(read) = self.readings.get(&reading) {
            return *read;
        }
        let read = if free {
            self.cast((from, value), kind, Wrap::whole())
        } else {
            self.cut((from, value), (width, signed), word, kind)
        };
        self.readings.insert(reading, read);
        read
    }

    fn cut(&mut self, from: Value, (width, signed): (u32, bool), word: Word, kind: Kind) -> u32 {
        let wide = from.0.max(Kind::for_range(word.range())).max(kind);
        let value = if from.0 == wide {
            from.1
        } else {
            self.cast(from, wide, Wrap::whole())
        };
        let extended = word.offset + word.width == width && word.signed == signed;
        let left = if extended {
            0
        } else {
            wide.bits() - word.offset - word.width
        };
        let right = left + word.offset;
        let t = self.step(|t| {
            with_kind!(wide, K => K::step(Arith::Cut {
                a: value,
                left,
                right,
                signed: word.signed,
                up: word.shift,
                t,
            }))
        });
        if wide == kind {
            return t;
        }
        self.cast((wide, t), kind, Wrap::whole())
    }

    /// Returns the word's number mod 2, as a truth.
    pub(super) fn lowest_bit(&mut self, word: Word) -> u32 {
        if word.shift == 0 {
            return self.bit(Bit {
                register: word.register,
                index: word.offset,
                inverted: false,
            });
        }
        self.constant(Kind::Truth, 0)
    }

    pub(super) fn constant(&mut self, kind: Kind, value: i64) -> u32 {
        self.step(|t| {
            with_kind!(kind, K => K::step(Arith::Wrap {
                a: Arg::Splat(K::cut(value)),
                wrap: Wrap::whole(),
                t,
            }))
        })
    }

    pub(super) fn operand<K: Lane>(&mut self, operand: Operand, kind: Kind) -> Arg<K> {
        match operand {
            Operand::Word(word) => Arg::Row(self.word(word, kind)),
            Operand::Constant(value) => Arg::Splat(K::cut(value)),
        }
    }

    /// Returns the bit's truth before its negation.
    pub(super) fn bit(&mut self, bit: Bit) -> u32 {
        let (kind, value) = self.register(bit.register);
        if kind == Kind::Truth {
            return value;
        }
        if let Some(read) = self.bits.get(&(value, bit.index)) {
            return *read;
        }
        let index = bit.index;
        let read = self.step(|t| with_kind!(kind, K => K::step(Arith::Bit { a: value, index, t })));
        self.bits.insert((value, bit.index), read);
        read
    }

    /// Adds a step that computes a value, and returns the value.
    pub(super) fn step(&mut self, step: impl FnOnce(u32) -> Step) -> u32 {
        let t = self.value();
        self.steps.push(step(t));
        t
    }

    /// Sets the register to a value, of which it keeps the lowest bits. The value's number is in
    /// `bounds`.
    pub(super) fn set(&mut self, register: RegisterId, (kind, value): Value, bounds: [i64; 2]) {
        let (width, signed) = self.shape(register);
        let own = kind_of(width, signed);
        let [low, high] = range(width, signed);
        let fits = low <= bounds[0] && bounds[1] <= high;
        let value = if kind == own && fits {
            value
        } else if kind == own {
            self.step(|t| {
                with_kind!(kind, K => K::step(Arith::Wrap {
                    a: Arg::Row(value),
                    wrap: Wrap::new(width, signed),
                    t,
                }))
            })
        } else {
            self.cast((kind, value), own, Wrap::new(width, signed))
        };
        self.registers[register.index()] = Some((own, value));
    }
}
