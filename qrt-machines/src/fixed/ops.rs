//! Compiles each operation to steps.

use super::arith::{Arith, Source, Wrap};
use super::compile::{CUT, Compiler, Value, kind_of, range, with_kind};
use super::compute::image;
use super::in_place::Pair;
use super::lane::{Float, Kind, LANES, Lane, Row};
use super::pattern_bits;
use super::product::{Factor, How, Product};
use super::quotient::Quotient;
use super::steps::{AddressBit, EncodedBit, Step, StepLane};
use super::table;
use qrt_circuit::{Bit, Op, Operand, RegisterId, Word};

/// Range of the numbers that an operand can be.
fn bounds(operand: Operand) -> [i64; 2] {
    match operand {
        Operand::Word(word) => word.range(),
        Operand::Constant(value) => [value, value],
    }
}

fn union([a, b]: [i64; 2], [c, d]: [i64; 2]) -> [i64; 2] {
    [a.min(c), b.max(d)]
}

impl Compiler<'_> {
    pub(super) fn input(&mut self, input: u32, register: RegisterId) {
        let (width, signed) = self.shape(register);
        let kind = kind_of(width, signed);
        let t = self.step(|t| {
            with_kind!(kind, K => K::step(Arith::Input { input, wrap: Wrap::new(width, signed), t }))
        });
        self.inputs.insert(t, (input, width));
        self.set(register, (kind, t), CUT);
    }

    /// Adds the steps of an operation.
    pub(super) fn op(&mut self, op: &Op) {
        match op {
            Op::Copy { a, target } => {
                let kind = self.kind(*target);
                let read = self.word(*a, kind);
                self.set(*target, (kind, read), a.range());
            }
            Op::Load { parameter, target } => {
                let (parameter, target) = (*parameter, *target);
                let (width, signed) = self.shape(target);
                let kind = kind_of(width, signed);
                let wrap = (width, signed);
                let t = self.step(|t| {
                    with_kind!(kind, K => K::step(Arith::Load {
                        parameter,
                        wrap: Wrap::new(wrap.0, wrap.1),
                        t,
                    }))
                });
                self.set(target, (kind, t), CUT);
            }
            Op::Parity {
                source,
                columns,
                parameter,
                target,
            } => self.parity(*source, columns, *parameter, *target),
            Op::And { a, b, target } => {
                let both = [(self.bit(*a), a.inverted), (self.bit(*b), b.inverted)];
                let [a, b] = both;
                let t = self.step(|t| Step::And { a, b, t });
                self.set(*target, (Kind::Truth, t), [0, 1]);
            }
            Op::Xor { a, b, target } => {
                let flip = a.inverted != b.inverted;
                let [a, b] = [self.bit(*a), self.bit(*b)];
                let t = self.step(|t| Step::Xor { a, b, flip, t });
                self.set(*target, (Kind::Truth, t), [0, 1]);
            }
            Op::Add {
                a,
                b,
                subtract,
                target,
            } => {
                let kind = self.kind(*target);
                let pair = if *subtract { Pair::Sub } else { Pair::Add };
                with_kind!(kind, K => {
                    let a = self.operand::<K>(*a, kind);
                    let b = self.operand::<K>(*b, kind);
                    self.pair(pair, *target, a, b);
                });
            }
            Op::Negate { a, when, target } => {
                let kind = self.kind(*target);
                let a = Operand::Word(*a);
                with_kind!(kind, K => {
                    let t = self.negated::<K>(a, *when, kind, *target);
                    self.set(*target, (kind, t), CUT);
                });
            }
            Op::Select { when, a, b, target } => {
                let kind = self.kind(*target);
                with_kind!(kind, K => {
                    let a = self.operand::<K>(*a, kind);
                    let b = self.operand::<K>(*b, kind);
                    let t = self.selected::<K>(*when, a, b, *target);
                    self.set(*target, (kind, t), CUT);
                });
            }
            Op::Less { a, b, target } => {
                let kind = Kind::for_range(union(bounds(*a), bounds(*b)));
                let t = with_kind!(kind, K => {
                    let a = self.operand::<K>(*a, kind);
                    let b = self.operand::<K>(*b, kind);
                    self.step(|t| K::step(Arith::Less { a, b, t }))
                });
                self.set(*target, (Kind::Truth, t), [0, 1]);
            }
            Op::Multiply {
                a, b, drop, target, ..
            } => self.product(*a, Operand::Word(*b), *drop, *target),
            Op::Square {
                a, drop, target, ..
            } => self.product(*a, Operand::Word(*a), *drop, *target),
            Op::Scale {
                a,
                factor,
                drop,
                target,
                ..
            } => self.product(*a, Operand::Constant(*factor), *drop, *target),
            Op::Multiples {
                a,
                products,
                targets,
                ..
            } => {
                for (&(factor, drop), target) in products.products().iter().zip(targets) {
                    self.product(*a, Operand::Constant(factor), drop, *target);
                }
            }
            Op::Divide {
                a,
                b,
                quotient,
                fits,
                ..
            } => self.division(*a, *b, *quotient, *fits),
            Op::SquareRoot { a, target, .. } => {
                let kind = Kind::for_range(a.range());
                let float = Float::for_bits(a.bits());
                let a_value = self.word(*a, kind);
                let t = self
                    .step(|t| with_kind!(kind, K => K::step(Arith::Root { a: a_value, float, t })));
                self.set(*target, (kind, t), range(a.bits().div_ceil(2), false));
            }
            Op::Table {
                address,
                columns,
                targets,
                ..
            } => {
                let address = self.address(address);
                for (column, target) in columns.iter().zip(targets) {
                    let (width, signed) = self.shape(*target);
                    let kind = kind_of(width, signed);
                    if kind == Kind::Truth
                        && let Some(table) = table::truths(column)
                    {
                        let t = self.step(|t| Step::TruthTable { address, table, t });
                        self.set(*target, (kind, t), CUT);
                        continue;
                    }
                    let t = with_kind!(kind, K => {
                        let wrap = Wrap::<K>::new(width, signed);
                        let entries = column.iter().map(|entry| wrap.apply(K::cut(*entry)));
                        let table = table::numbers(entries);
                        self.step(|t| K::step(Arith::Lookup { address, table, t }))
                    });
                    self.set(*target, (kind, t), CUT);
                }
            }
            Op::Encode {
                bits,
                entries,
                targets,
                ..
            } => self.encode(bits, entries, targets),
            Op::XorInto { .. } | Op::AddInto { .. } | Op::Swap { .. } | Op::Phase { .. } => {
                self.in_place(op, false);
            }
        }
    }

    fn product(&mut self, a: Word, b: Operand, drop: u32, target: RegisterId) {
        let (width, signed) = self.shape(target);
        let own = kind_of(width, signed);
        let corners = a
            .range()
            .map(|a| bounds(b).map(|b| i128::from(a) * i128::from(b)));
        let corners = corners.as_flattened();
        let low = corners.iter().copied().fold(i128::MAX, i128::min);
        let high = corners.iter().copied().fold(i128::MIN, i128::max);
        let narrow = Kind::for_range(a.range()).max(Kind::for_range(bounds(b)));
        // If the product does not fit, its lowest bits are enough if the target keeps no others.
        let fits = |bits: u32| low >= -1 << (bits - 1) && high < 1 << (bits - 1);
        let does = |kind: &Kind| fits(kind.bits()) || drop + width <= kind.bits();
        let wide = [Kind::Short, Kind::Int, Kind::Long].into_iter().find(does);
        let left = [low >> drop, high >> drop];
        let left = left.map(|end| end.clamp(i64::MIN.into(), i64::MAX.into()) as i64);
        let how = match (narrow, wide) {
            (Kind::Short, Some(Kind::Int)) => How::Short,
            (Kind::Short | Kind::Int, Some(Kind::Long)) => How::Int,
            (_, Some(kind)) => {
                let t = with_kind!(kind, K => {
                    let a = self.operand::<K>(Operand::Word(a), kind);
                    let b = self.operand::<K>(b, kind);
                    let wrap = if kind == own { Wrap::new(width, signed) } else { Wrap::whole() };
                    let drop = drop.min(kind.bits() - 1);
                    self.step(|t| K::step(Arith::Mul { a, b, drop, wrap, t }))
                });
                let left = if kind == own { CUT } else { left };
                return self.set(target, (kind, t), left);
            }
            (_, None) => How::long(a.range(), bounds(b)),
        };
        // The narrower factor comes second.
        let (a, b) = match b {
            Operand::Word(b) if How::long(b.range(), a.range()) == How::Half => {
                (b, Operand::Word(a))
            }
            b => (a, b),
        };
        let how = if wide.is_none() {
            How::long(a.range(), bounds(b))
        } else {
            how
        };
        let [least, most] = how.results();
        let to = own.clamp(least, most);
        let kind = how.factors();
        let a = self.word(a, kind);
        let b = match b {
            Operand::Word(b) => Factor::Row(self.word(b, kind)),
            Operand::Constant(b) => Factor::Splat(b),
        };
        let drop = drop.min(wide.map_or(127, |kind| kind.bits() - 1));
        let wrap = if to == own {
            Wrap::new(width, signed)
        } else {
            Wrap::whole()
        };
        let t = self.step(|t| {
            Step::Product(Product {
                how,
                a,
                b,
                drop,
                wrap,
                shape: (to == own).then_some((width, signed)),
                to: (to, t),
            })
        });
        let left = if to == own { CUT } else { left };
        self.set(target, (to, t), left);
    }

    fn division(&mut self, a: Word, b: Word, quotient: RegisterId, fits: RegisterId) {
        let (width, _) = self.shape(quotient);
        let numbers = union(union(a.range(), b.range()), range(width, false));
        let kind = Kind::for_range(numbers);
        let float = Float::for_bits(a.bits().max(b.bits()));
        let plain = [a, b].map(|word| Word { shift: 0, ..word });
        if float == Float::Double
            && width <= 52
            && plain
                .iter()
                .all(|word| Kind::for_range(word.range()) <= Kind::Int)
        {
            let up = [a.shift, b.shift];
            let [a, b] = plain.map(|word| self.word(word, Kind::Int));
            let kind = Kind::for_range(range(width, false)).max(Kind::Int);
            let (value, holds) = (self.value(), self.value());
            self.steps.push(Step::Quotient(Quotient {
                a,
                b,
                up,
                width,
                to: (kind, value),
                fits: holds,
            }));
            self.set(quotient, (kind, value), range(width, false));
            return self.set(fits, (Kind::Truth, holds), [0, 1]);
        }
        let (a, b) = (self.word(a, kind), self.word(b, kind));
        let (value, holds) = (self.value(), self.value());
        self.steps
            .push(with_kind!(kind, K => K::step(Arith::Divide {
                a,
                b,
                width,
                float,
                quotient: value,
                fits: holds,
            })));
        self.set(quotient, (kind, value), range(width, false));
        self.set(fits, (Kind::Truth, holds), [0, 1]);
    }

    /// Returns an Int whose binary digits are `bits`.
    fn address(&mut self, bits: &[Bit]) -> u32 {
        let word = bits.first().map(|first| Word {
            register: first.register,
            offset: first.index,
            width: bits.len() as u32,
            signed: false,
            shift: 0,
        });
        let neighbours = bits
            .windows(2)
            .all(|pair| pair[0].register == pair[1].register && pair[0].index + 1 == pair[1].index);
        match word {
            Some(word) if neighbours && !bits.iter().any(|bit| bit.inverted) => {
                self.word(word, Kind::Int)
            }
            _ => {
                let digits = bits.iter().enumerate().map(|(place, bit)| AddressBit {
                    truth: self.bit(*bit),
                    place: place as u32,
                    negated: bit.inverted,
                });
                let digits: Vec<_> = digits.collect();
                if let Some(address) = self.addresses.get(&digits) {
                    return *address;
                }
                let bits = digits.clone().into();
                let address = self.step(|t| Step::Address { bits, t });
                self.addresses.insert(digits, address);
                address
            }
        }
    }

    fn encode(&mut self, bits: &[Bit], entries: &[u64], targets: &[RegisterId]) {
        let widest = targets.iter().map(|target| self.shape(*target).0).max();
        let mask = u64::MAX >> (64 - widest.unwrap_or(1).clamp(1, 64));
        let encoded = bits.iter().zip(entries).map(|(bit, entry)| EncodedBit {
            truth: self.bit(*bit),
            negated: bit.inverted,
            entry: (entry & mask).cast_signed(),
        });
        let bits: Box<[EncodedBit]> = encoded.collect();
        let values: Box<[u32]> = targets.iter().map(|_| self.value()).collect();
        self.steps.push(Step::Encode {
            bits,
            targets: values.clone(),
        });
        for (target, value) in targets.iter().zip(&values) {
            let (width, signed) = self.shape(*target);
            self.set(*target, (Kind::Long, *value), range(width, signed));
        }
    }

    fn parity(
        &mut self,
        source: RegisterId,
        columns: &[u64],
        parameter: Option<u32>,
        target: RegisterId,
    ) {
        let (width, signed) = self.shape(target);
        let kind: Kind = kind_of(width, signed);
        let (_, value): Value = self.register(source);
        let (bits, source) = if let Some((input, bits)) = self.inputs.get(&value) {
            (pattern_bits(*bits), Source::Input(*input))
        } else {
            let content = Word {
                register: source,
                offset: 0,
                width: self.shape(source).0,
                signed: false,
                shift: 0,
            };
            (0, Source::Row(self.word(content, Kind::Long)))
        };
        let t = with_kind!(kind, K => {
            let mut pattern = Box::new(Row([K::default(); LANES]));
            for (lane, slot) in pattern.0.iter_mut().enumerate() {
                let low = lane as u64 & ((1 << bits) - 1);
                *slot = K::cut(image(columns, low).cast_signed());
            }
            let columns = columns.into();
            let wrap = Wrap::new(width, signed);
            self.step(|t| K::step(Arith::Parity { source, columns, pattern, parameter, wrap, t }))
        });
        self.set(target, (kind, t), CUT);
    }
}
