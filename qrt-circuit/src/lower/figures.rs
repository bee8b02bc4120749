//! Costs and numbers of qubits of operations, computed once for operations that are alike.

use super::super::{Cores, Instruction, Op, Program, RegisterId};
use super::cost::{Cost, OpFigures, counted};
use super::place::{Shape, canonical};
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// A cache of the figures of operations.
///
/// The figures of an operation depend on its kind, on the widths of its registers and on which of
/// these are the same, but not on the registers' numbers. So each is computed once.
///
/// ```
/// use qrt_circuit::lower::{KnownFigures, costs};
/// use qrt_circuit::{Op, Operand, RegisterId, Word};
///
/// let read = |id| Operand::Word(Word::unsigned(RegisterId(id), 0, 8));
/// let sum = |a, b, target| Op::Add {
///     a: read(a), b: read(b), subtract: false, target: RegisterId(target),
/// };
/// let mut known = KnownFigures::default();
/// let figures = known.figures(&sum(0, 1, 2), |_| 8);
/// assert_eq!(figures.costs, costs(&sum(0, 1, 2), |_| 8));
/// assert_eq!(known.figures(&sum(5, 3, 4), |_| 8), figures);
/// assert_eq!(known.len(), 1);
/// // A number added to itself is shifted, which takes no Toffoli.
/// assert_eq!(known.figures(&sum(5, 5, 4), |_| 8).costs[0].toffoli, 0);
/// ```
#[derive(Clone, Debug, Default)]
pub struct KnownFigures {
    /// The index in `found` of the figures of each operation.
    places: QuickMap<Shape, usize>,
    found: Vec<OpFigures>,
}

/// Returns the cost of each instruction of a program.
pub fn tally(program: &Program) -> Vec<Cost> {
    let ops: Vec<&Op> = program.ops.iter().collect();
    let width = |register| program.width(register);
    let of_ops = KnownFigures::default().all(&ops, width, Cores::All);
    let cost = |instruction: &Instruction| {
        of_ops[instruction.op as usize].costs[usize::from(instruction.inverse)]
    };
    program.instructions.iter().map(cost).collect()
}

/// Number of Toffolis of a program.
pub fn toffoli(program: &Program) -> u64 {
    tally(program).iter().map(|cost| cost.toffoli).sum()
}

/// A hash map for trusted keys: no protection against chosen collisions.
pub type QuickMap<K, V> = HashMap<K, V, BuildHasherDefault<Quick>>;

/// Number of bits above which an encoder is large.
const LARGE: usize = 1 << 12;

/// Number of operations whose shapes are held at the same time.
const AT_ONCE: usize = 1 << 16;

impl KnownFigures {
    /// Returns the figures of an operation, given the widths of its registers.
    pub fn figures(&mut self, op: &Op, width: impl Fn(RegisterId) -> u32) -> OpFigures {
        let place = self.places.entry(canonical(op, width));
        let place = *place.or_insert_with_key(|(op, widths)| {
            self.found.push(counted(op, widths));
            self.found.len() - 1
        });
        self.found[place]
    }

    /// Returns the figures of `ops`, one by one, given the widths of their registers.
    pub fn all(
        &mut self,
        ops: &[&Op],
        width: impl Fn(RegisterId) -> u32 + Sync,
        cores: Cores,
    ) -> Vec<OpFigures> {
        let shape = |op: &&Op| canonical(op, &width);
        let mut new: Vec<Shape> = Vec::new();
        let mut places = Vec::with_capacity(ops.len());
        // The shapes of all operations of a large program would take gigabytes.
        for ops in ops.chunks(AT_ONCE) {
            for shape in cores.map(ops, 64, shape) {
                let next = self.found.len() + new.len();
                let place = *self.places.entry(shape).or_insert_with_key(|shape| {
                    new.push(shape.clone());
                    next
                });
                places.push(place);
            }
        }
        // The gates of a large encoder may take a gigabyte: they are counted one encoder after the other.
        let is_large = |op: &Op| matches!(op, Op::Encode { bits, .. } if bits.len() > LARGE);
        let figures = cores.map(&new, 16, |(op, widths)| {
            (!is_large(op)).then(|| counted(op, widths))
        });
        let figures = figures.into_iter().zip(&new);
        let figures =
            figures.map(|(found, (op, widths))| found.unwrap_or_else(|| counted(op, widths)));
        self.found.extend(figures);
        places.into_iter().map(|place| self.found[place]).collect()
    }

    /// Number of different operations in the cache.
    pub fn len(&self) -> usize {
        self.found.len()
    }

    /// True if the cache has no operation.
    pub fn is_empty(&self) -> bool {
        self.found.is_empty()
    }
}

/// A hash that takes one multiplication a word, for trusted keys and unoptimised code: no
/// protection against chosen collisions.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, Default)]
pub struct Quick(u64);

impl Quick {
    #[inline(always)]
    fn word(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

impl Hasher for Quick {
    fn finish(&self) -> u64 {
        // The map uses the lowest bits and the highest bits.
        self.0 ^ (self.0 >> 32)
    }
    fn write(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks::<8>();
        for word in words {
            self.word(u64::from_le_bytes(*word));
        }
        for byte in rest {
            self.word(u64::from(*byte));
        }
    }
    #[inline(always)]
    fn write_u8(&mut self, value: u8) {
        self.word(u64::from(value));
    }
    #[inline(always)]
    fn write_u32(&mut self, value: u32) {
        self.word(u64::from(value));
    }
    #[inline(always)]
    fn write_u64(&mut self, value: u64) {
        self.word(value);
    }
    #[inline(always)]
    fn write_i64(&mut self, value: i64) {
        self.word(value.cast_unsigned());
    }
    #[inline(always)]
    fn write_usize(&mut self, value: usize) {
        self.word(value as u64);
    }
    #[inline(always)]
    fn write_isize(&mut self, value: isize) {
        self.word(value.cast_unsigned() as u64);
    }
}
