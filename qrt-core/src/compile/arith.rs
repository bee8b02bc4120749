//! The implementation of [`Arith`] that records a program.

use super::names::Nameable;
use super::number::RegisterShape;
use super::value::{Affine, BoolValue, Index, RealValue, Value, bits_of};
use super::{BuildError, Builder, MAX_ADDRESS, StageName, negative_range};
use qrt_circuit::{Op, Operand, Word};
use qrt_syntax::expr::Function;
use qrt_tracer::{Arith, Coordinate, Named, Sampled, Segment, TracerPart, Work};

impl Arith for Builder<'_> {
    type Real = RealValue;
    type Bool = BoolValue;
    type Index = Index;

    fn real(&mut self, value: f64) -> RealValue {
        RealValue::constant(value)
    }
    fn add(&mut self, a: RealValue, b: RealValue) -> RealValue {
        self.plus(a, b)
    }
    fn sub(&mut self, a: RealValue, b: RealValue) -> RealValue {
        self.plus(a, b.negative())
    }
    fn mul(&mut self, a: RealValue, b: RealValue) -> RealValue {
        self.times(a, b)
    }
    fn div(&mut self, a: RealValue, b: RealValue, most: f64) -> RealValue {
        self.over(a, b, most)
    }
    fn ahead(&mut self, a: RealValue, b: RealValue, most: f64) -> (BoolValue, RealValue) {
        self.ahead_of(a, b, most)
    }
    fn neg(&mut self, a: RealValue) -> RealValue {
        a.negative()
    }
    fn abs(&mut self, a: RealValue) -> RealValue {
        self.magnitude(a)
    }
    fn sqrt(&mut self, a: RealValue) -> RealValue {
        self.root(a)
    }
    fn length(&mut self, v: [RealValue; 3]) -> RealValue {
        self.norm(v)
    }
    fn known(&mut self, a: RealValue, low: f64, high: f64) -> RealValue {
        self.bounded(a, low, high)
    }
    fn t_max(&mut self, most: f64) -> RealValue {
        RealValue::constant(self.farthest(most))
    }
    fn inside(&mut self, low: f64, value: RealValue, high: f64) -> BoolValue {
        // Allow one ulp outwards at each end: a hit's coordinates may be off by that much.
        let reach = self.ulp();
        let mut inside = BoolValue::Constant(true);
        if low.is_finite() {
            let below = self.is_less(value, RealValue::constant(low - reach));
            inside = self.both(inside, below.negated());
        }
        if high.is_finite() {
            let above = self.is_less(RealValue::constant(high + reach), value);
            inside = self.both(inside, above.negated());
        }
        inside
    }
    fn at_least(&mut self, value: RealValue, table: &[[f64; 1]], row: Index) -> BoolValue {
        let (value, low) = self.beside(value, table, row, -1.0);
        self.is_less(value, low).negated()
    }
    fn at_most(&mut self, value: RealValue, table: &[[f64; 1]], row: Index) -> BoolValue {
        let (value, high) = self.beside(value, table, row, 1.0);
        self.is_less(high, value).negated()
    }
    fn inward(&mut self) -> f64 {
        4.0 * self.ulp()
    }
    fn min(&mut self, a: RealValue, b: RealValue) -> RealValue {
        self.lesser(a, b)
    }
    fn max(&mut self, a: RealValue, b: RealValue) -> RealValue {
        self.greater(a, b)
    }
    fn scale(&mut self, a: RealValue, factor: f64) -> RealValue {
        self.times_constant(a, factor)
    }
    fn quotient(&mut self, a: RealValue, b: RealValue, most: f64) -> RealValue {
        if b.as_constant() == Some(0.0) && !most.is_finite() {
            self.fail(BuildError::UnboundedQuotient);
            return RealValue::constant(0.0);
        }
        self.over(a, b, most)
    }
    fn function(&mut self, function: Function, a: RealValue) -> RealValue {
        // Rounding can take a cosine beyond ±1, where the angle is undefined.
        let is_angle = matches!(function, Function::Asin | Function::Acos);
        let known = |x: f64| if is_angle { x.clamp(-1.0, 1.0) } else { x };
        self.smooth(a, |x| function.value(known(x)))
    }
    fn pow(&mut self, a: RealValue, b: RealValue) -> RealValue {
        self.power(a, b)
    }
    fn atan2(&mut self, y: RealValue, x: RealValue) -> RealValue {
        self.angle(y, x)
    }

    fn named<const K: usize>(&mut self, name: Named, a: &[RealValue; K]) {
        self.name(name, a.iter().copied().map(Nameable::Real));
    }
    fn named_truth(&mut self, name: Named, a: BoolValue) {
        self.name(name, [Nameable::Bool(a)]);
    }
    fn named_index(&mut self, name: Named, a: Index) {
        self.name(name, [Nameable::Index(a)]);
    }

    fn traced(&mut self, depth: usize, segment: Segment<Self>) {
        // Rays arrive in the order of their depths. A second call for a ray is ignored.
        if self.segments.len() == depth {
            self.segments.push(segment);
        }
    }

    fn apart<W: Work<Self>>(&mut self, work: W) -> W::Output {
        in_a_function(self, work)
    }

    fn of_surface(&mut self, surface: Option<u32>) {
        self.surface = surface;
    }

    fn truth(&mut self, value: bool) -> BoolValue {
        BoolValue::Constant(value)
    }
    fn less(&mut self, a: RealValue, b: RealValue) -> BoolValue {
        self.is_less(a, b)
    }
    fn less_equal(&mut self, a: RealValue, b: RealValue) -> BoolValue {
        self.is_less(b, a).negated()
    }
    fn odd(&mut self, a: RealValue) -> BoolValue {
        self.is_odd(a)
    }
    fn and(&mut self, a: BoolValue, b: BoolValue) -> BoolValue {
        self.both(a, b)
    }
    fn or(&mut self, a: BoolValue, b: BoolValue) -> BoolValue {
        self.either(a, b)
    }
    fn select_truth(&mut self, c: BoolValue, a: BoolValue, b: BoolValue) -> BoolValue {
        self.chosen_truth(c, a, b)
    }
    fn not(&mut self, a: BoolValue) -> BoolValue {
        a.negated()
    }
    fn any(&mut self, a: BoolValue) -> bool {
        a != BoolValue::Constant(false)
    }
    fn select(&mut self, c: BoolValue, a: RealValue, b: RealValue) -> RealValue {
        self.chosen(c, a, b)
    }

    fn index(&mut self, value: u32) -> Index {
        Index::Constant(self.code(value))
    }
    fn select_index(&mut self, c: BoolValue, a: Index, b: Index) -> Index {
        self.chosen_index(c, a, b)
    }
    fn is(&mut self, a: Index, value: u32) -> BoolValue {
        let value = self.code(value);
        self.test(a, |index| index == value)
    }
    fn below(&mut self, a: Index, value: u32) -> BoolValue {
        let value = self.code(value);
        self.test(a, |index| index < value)
    }
    fn same(&mut self, a: Index, b: Index) -> BoolValue {
        self.are_equal(a, b)
    }
    fn encode(&mut self, marked: &[(BoolValue, u32)], most: usize) -> Vec<(BoolValue, Index)> {
        self.encoded(marked, most)
    }
    fn rows<const K: usize>(&mut self, table: &[[f64; K]], row: Index) -> [RealValue; K] {
        let mut columns = [RealValue::constant(0.0); K];
        for (k, column) in columns.iter_mut().enumerate() {
            *column = self.row(row, table.len(), |row| table.get(row).map_or(0.0, |r| r[k]));
        }
        columns
    }
    fn entry(&mut self, table: &[u32], row: Index) -> Index {
        self.entry_of(row, table)
    }

    fn coordinate(&mut self, coordinate: Coordinate) -> Index {
        self.sample_index(coordinate)
    }
    fn centre(&mut self, index: Index, bits: u32) -> RealValue {
        let node = match index {
            Index::Constant(index) => {
                return RealValue::constant((f64::from(index) + 0.5) / (1_u64 << bits) as f64);
            }
            Index::Node(node) => node,
        };
        let fraction = self.fraction();
        let Operand::Word(word) = self.choice_operand(index) else {
            return RealValue::constant(0.5);
        };
        // If the index has more bits than a number has fraction bits, its lowest bits are dropped.
        // The half cell that is added below then belongs to the coarser cell.
        let (word, kept) = if bits <= fraction {
            let shift = fraction - bits;
            (Word { shift, ..word }, bits)
        } else {
            let offset = word.offset + bits - fraction;
            let width = word.width - (bits - fraction);
            let narrow = Word {
                offset,
                width,
                ..word
            };
            (narrow, fraction)
        };
        let table = self.choices[node as usize].table.clone();
        // The index's bits are in a register already: keep a table only if its address is short.
        let table = table.filter(|table| bits <= fraction && table.address.len() <= 6);
        let cells = (1_u64 << bits) as f64;
        let table = table.map(|table| table.map(|entry| entry / cells));
        let most = ((1_i64 << kept) - 1) << (fraction - kept);
        let cell = self.value(Value {
            range: [0, most],
            word: Some(word),
            table,
        });
        let half = Affine::constant(0.5 / (1_u64 << kept) as f64);
        RealValue {
            offset: cell.offset.plus(half),
            ..cell
        }
    }
    fn sampled(&mut self, function: &Sampled, index: Index) -> RealValue {
        match index {
            Index::Constant(index) => RealValue::constant(function.at(index)),
            Index::Node(_) if function.bits() <= MAX_ADDRESS => {
                self.row(index, 1 << function.bits(), |i| function.at(i as u32))
            }
            Index::Node(_) => match self.choice_operand(index) {
                Operand::Word(word) => self.fitted(word, word.range(), |i| function.at(i as u32)),
                Operand::Constant(index) => RealValue::constant(function.at(index as u32)),
            },
        }
    }
    fn pixel(&mut self) -> [RealValue; 2] {
        if let Some(pixel) = self.target.pixel {
            return pixel.map(|along| RealValue::constant(f64::from(along)));
        }
        let along = |along| {
            RealValue::fixed(Affine {
                constant: 0.0,
                along,
            })
        };
        [along([1.0, 0.0]), along([0.0, 1.0])]
    }

    fn record(&mut self, a: RealValue) {
        let plain = self.plain(a);
        if let Operand::Word(word) = plain.operand {
            self.records.push(word.register);
        }
    }
    fn recomputes(&self) -> bool {
        self.target.strategy.recomputes()
    }
    fn enter(&mut self, part: TracerPart) {
        let depth = |depth: usize| Some(depth as u32);
        match part {
            TracerPart::GenerateRay(k) => self.begin(StageName::GenerateRay, depth(k)),
            TracerPart::FindIntersection(k) => self.begin(StageName::FindIntersection, depth(k)),
            TracerPart::SampleLight(k) => self.begin(StageName::SampleLight, depth(k)),
            TracerPart::Shadow(k) => self.begin(StageName::Shadow, depth(k)),
            TracerPart::Body(number) => self.begin(StageName::Body(number as u32), None),
            TracerPart::Plane(number) => self.begin(StageName::Plane(number as u32), None),
            TracerPart::Primitive(number) => self.begin(StageName::Primitive(number as u32), None),
            TracerPart::Ball(number) => self.begin(StageName::Sphere(number as u32), None),
            TracerPart::Mesh => self.begin(StageName::Mesh, None),
            TracerPart::Edges(number) => self.begin(StageName::Edges(number as u32), None),
            TracerPart::Slot(number) => self.begin(StageName::Slot(number as u32), None),
            TracerPart::Sky(k) => self.begin(StageName::Sky, depth(k)),
            TracerPart::Side(k) => self.begin(StageName::Side, depth(k)),
            TracerPart::Normal(k) => self.begin(StageName::Normal, depth(k)),
            TracerPart::Tint => self.begin(StageName::Tint, None),
            TracerPart::Sample => self.begin(StageName::Sample, None),
            TracerPart::Component(axis) => self.begin(StageName::Component(axis as u32), None),
            TracerPart::Shade(k) => self.begin(StageName::Shade, depth(k)),
        }
    }
    fn leave(&mut self) {
        self.end();
    }
}

/// Runs `work`. The compiler then has smaller functions to optimise.
#[inline(never)]
fn in_a_function<A: Arith, W: Work<A>>(cx: &mut A, work: W) -> W::Output {
    work.run(cx)
}

impl Builder<'_> {
    /// `if when { a } else { b }`
    pub(super) fn chosen(&mut self, when: BoolValue, a: RealValue, b: RealValue) -> RealValue {
        let node = match when {
            BoolValue::Constant(true) => return a,
            BoolValue::Constant(false) => return b,
            node @ BoolValue::Node { .. } => node,
        };
        if a == b {
            return a;
        }
        if let (Some(c), Some(x), Some(y)) =
            (self.truth_table(node), self.table_of(a), self.table_of(b))
        {
            let cost = self.fraction();
            let nowhere = f64::INFINITY;
            let picked =
                super::table::joined(&c, &x, cost, |c, x| if c == 0.0 { nowhere } else { x });
            let table = picked.and_then(|picked| {
                super::table::joined(&picked, &y, cost, |x, y| if x == nowhere { y } else { x })
            });
            if let Some(table) = table {
                return self.tabulated(table);
            }
        }
        let apart = |x: RealValue| RealValue {
            offset: Affine::ZERO,
            bias: 0.0,
            ..x
        };
        if a.offset == b.offset && a.node.is_some() && b.node.is_some() {
            let offset = a.offset;
            if a.node == b.node {
                // The same number with two signs.
                let when = if a.negated { node } else { node.negated() };
                let signed = self.signed(
                    RealValue {
                        negated: false,
                        ..apart(a)
                    },
                    when,
                );
                return RealValue {
                    offset: signed.offset.plus(offset),
                    ..signed
                };
            }
            if offset != Affine::ZERO {
                let chosen = self.chosen(node, apart(a), apart(b));
                return RealValue {
                    offset: chosen.offset.plus(offset),
                    ..chosen
                };
            }
        }
        let (x, y) = (self.plain(a), self.plain(b));
        let constant = |operand| matches!(operand, Operand::Constant(_));
        // If both are negated, or one is negated and the other is a constant, negate the result
        // instead.
        let outside =
            (x.negated && (y.negated || constant(y.operand))) || (y.negated && constant(x.operand));
        let ((x, xr), (y, yr)) = if outside {
            let turned = |operand, range| match operand {
                Operand::Constant(value) => (Operand::Constant(-value), negative_range(range)),
                word @ Operand::Word(_) => (word, range),
            };
            (turned(x.operand, x.range), turned(y.operand, y.range))
        } else {
            (self.operand(a), self.operand(b))
        };
        let range = [xr[0].min(yr[0]), xr[1].max(yr[1])];
        let when = self.bit(node);
        let RegisterShape { ty, width, signed } = self.shape(range);
        let target = self.emit(Op::Select {
            when,
            a: x,
            b: y,
            target: (ty, width),
        })[0];
        debug_assert!(bits_of(range).0 <= width);
        let chosen = self.computed(Self::whole(target, width, signed), range);
        if outside { chosen.negative() } else { chosen }
    }
}
