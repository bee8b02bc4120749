//! One coordinate of a path as a linear function of the path index over GF(2).
//!
//! Both sequences are of this kind, `index = XOR of the columns of the path index's set bits`, so
//! both are compiled to CNOTs (one per set bit of a column) and a pixel's shift to Xs: no Toffoli.
//! The renderer walks through consecutive path indices, where linearity makes each index one XOR:
//! `index(256 h + l) = index(256 h) XOR index(l)`, the right-hand index from a table.

/// Number of low bits of the path index that the table covers.
const BLOCK_BITS: u32 = 8;
const BLOCK: usize = 1 << BLOCK_BITS;

/// The matrix of one coordinate: column `b` holds the bits of the sample index that bit `b` of the
/// path index flips.
#[derive(Clone, Debug)]
pub(super) struct LinearMap {
    columns: Box<[u32]>,
    block: Box<[u32; BLOCK]>,
}

impl LinearMap {
    /// Creates the map with `columns`; bits of the path index beyond them flip nothing.
    pub(super) fn new(columns: impl IntoIterator<Item = u32>) -> Self {
        let columns: Box<[u32]> = columns.into_iter().collect();
        let mut block = Box::new([0; BLOCK]);
        for b in 0..BLOCK_BITS as usize {
            let column = columns.get(b).copied().unwrap_or(0);
            let (done, rest) = block.split_at_mut(1 << b);
            for (high, low) in rest.iter_mut().zip(done) {
                *high = *low ^ column;
            }
        }
        Self { columns, block }
    }

    /// The bits of the sample index that bit `id_bit` of the path index flips.
    pub(super) fn column(&self, id_bit: u32) -> u32 {
        self.columns.get(id_bit as usize).copied().unwrap_or(0)
    }

    /// The sample index of path `id`.
    pub(super) fn index(&self, id: u64) -> u32 {
        let mut index = 0;
        let mut rest = id;
        while rest != 0 {
            index ^= self.column(rest.trailing_zeros());
            rest &= rest - 1;
        }
        index
    }

    /// The indices of the paths `first_id ..`, each XORed with `offset`.
    pub(super) fn indices(&self, first_id: u64, offset: u32, out: &mut [u32]) {
        let mut id = first_id;
        let mut rest = out;
        while !rest.is_empty() {
            let low = (id as usize) % BLOCK;
            let (run, after) = rest.split_at_mut(rest.len().min(BLOCK - low));
            let base = offset ^ self.index(id - low as u64);
            for (index, entry) in run.iter_mut().zip(&self.block[low..]) {
                *index = base ^ entry;
            }
            id = id.wrapping_add(run.len() as u64);
            rest = after;
        }
    }
}
