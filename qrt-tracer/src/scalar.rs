//! Plain numbers: the arithmetic of one path, for tests.

use super::{Arith, Axis, Coordinate, Sampled};
use qrt_syntax::expr::Function;

/// The arithmetic of one path, with a record of its operations.
#[derive(Default)]
pub(crate) struct Scalar {
    /// The sample indices of the ray after the first bounce.
    pub(crate) cell: [u32; 2],
    /// The names of the real numbers' operations, in the order of their calls.
    pub(crate) calls: Vec<&'static str>,
}

impl Scalar {
    /// The path of this sample cell.
    pub(crate) fn at(cell: [u32; 2]) -> Self {
        Self {
            cell,
            calls: vec![],
        }
    }
}

/// Operations of numbers that are recorded by name.
macro_rules! recorded {
    ($($name:ident($($operand:ident),+) -> $result:ty = $value:expr;)+) => {$(
        fn $name(&mut self, $($operand: f64),+) -> $result {
            self.calls.push(stringify!($name));
            $value
        }
    )+};
}

impl Arith for Scalar {
    type Real = f64;
    type Bool = bool;
    type Index = u32;

    recorded! {
        add(a, b) -> f64 = a + b;
        sub(a, b) -> f64 = a - b;
        mul(a, b) -> f64 = a * b;
        neg(a) -> f64 = -a;
        abs(a) -> f64 = a.abs();
        sqrt(a) -> f64 = a.sqrt();
        min(a, b) -> f64 = a.min(b);
        max(a, b) -> f64 = a.max(b);
        pow(a, b) -> f64 = libm::pow(a, b);
        atan2(y, x) -> f64 = libm::atan2(y, x);
        less(a, b) -> bool = a < b;
        less_equal(a, b) -> bool = a <= b;
    }
    fn real(&mut self, value: f64) -> f64 {
        value
    }
    fn div(&mut self, a: f64, b: f64, _most: f64) -> f64 {
        a / b
    }
    fn cosine(&mut self, a: f64) -> f64 {
        a.clamp(-1.0, 1.0)
    }
    fn function(&mut self, function: Function, a: f64) -> f64 {
        function.value(a)
    }
    fn truth(&mut self, value: bool) -> bool {
        value
    }
    fn odd(&mut self, a: f64) -> bool {
        qrt_scene::Checker::is_odd(a)
    }
    fn and(&mut self, a: bool, b: bool) -> bool {
        a && b
    }
    fn or(&mut self, a: bool, b: bool) -> bool {
        a || b
    }
    fn not(&mut self, a: bool) -> bool {
        !a
    }
    fn any(&mut self, a: bool) -> bool {
        a
    }
    fn select(&mut self, c: bool, a: f64, b: f64) -> f64 {
        if c { a } else { b }
    }
    fn index(&mut self, value: u32) -> u32 {
        value
    }
    fn select_index(&mut self, c: bool, a: u32, b: u32) -> u32 {
        if c { a } else { b }
    }
    fn is(&mut self, a: u32, value: u32) -> bool {
        a == value
    }
    fn same(&mut self, a: u32, b: u32) -> bool {
        a == b
    }
    fn below(&mut self, a: u32, value: u32) -> bool {
        a < value
    }
    fn rows<const K: usize>(&mut self, table: &[[f64; K]], row: u32) -> [f64; K] {
        table[row as usize]
    }
    fn entry(&mut self, table: &[u32], row: u32) -> u32 {
        table[row as usize]
    }
    fn coordinate(&mut self, coordinate: Coordinate) -> u32 {
        assert_eq!(coordinate.depth, 1);
        self.cell[usize::from(coordinate.axis == Axis::V)]
    }
    fn centre(&mut self, index: u32, bits: u32) -> f64 {
        qrt_scene::sampling::cell_centre(index, bits)
    }
    fn sampled(&mut self, function: &Sampled, index: u32) -> f64 {
        function.at(index)
    }
    fn pixel(&mut self) -> [f64; 2] {
        [0.0; 2]
    }
}
