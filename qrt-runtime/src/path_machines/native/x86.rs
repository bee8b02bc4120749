//! Macros that the vectors of AVX2 and AVX-512 share. In both, vectors are `Ints(simd, register)`
//! and `Longs(simd, [register, register])`, with the first half of the lanes and the last.
//!
//! They are macros, not functions that take closures: a closure uses the instruction set only if it
//! is inlined, which is left to chance.

/// An instruction on two registers.
macro_rules! whole {
    ($a:ident, $b:ident, $feature:ident.$instruction:ident) => {
        Self($a.0, $a.0.$feature.$instruction($a.1, $b.1))
    };
}

/// An instruction on both halves of two vectors.
macro_rules! halves {
    ($a:ident, $b:ident, $feature:ident.$instruction:ident) => {{
        let feature = $a.0.$feature;
        let low = feature.$instruction($a.1[0], $b.1[0]);
        let high = feature.$instruction($a.1[1], $b.1[1]);
        Self($a.0, [low, high])
    }};
}

/// Methods of two vectors that are an instruction each; `$vector` is [`whole`] or [`halves`].
macro_rules! instructions {
    ($vector:ident, $feature:ident: $($method:ident = $instruction:ident),+) => {
        $(#[inline(always)]
        fn $method(self, other: Self) -> Self {
            $vector!(self, other, $feature.$instruction)
        })+
    };
}

/// Methods of a vector and a number that is the same in all lanes.
macro_rules! shifts {
    ($vector:ident, $feature:ident: $($method:ident = $instruction:ident),+) => {
        $(#[inline(always)]
        fn $method(self, by: u32) -> Self {
            let by = Self::all(self.0, by as _);
            $vector!(self, by, $feature.$instruction)
        })+
    };
}

/// Changes lanes one by one, given those of another vector, for operations that no instruction
/// does.
macro_rules! lane_by_lane {
    ($a:expr, $b:expr, $change:ident $(, $more:expr)?) => {{
        let mut lanes: [i64; Self::LANES] = pulp::cast($a.1);
        let beside: [i64; Self::LANES] = pulp::cast($b.1);
        scalar::$change(&mut lanes, &beside $(, $more)?);
        Longs($a.0, pulp::cast(lanes))
    }};
}

/// The methods of `Vectors` that are the same for both.
macro_rules! common {
    ($lanes:literal) => {
        const LANES: usize = $lanes;
        type Truths = Masks;
        type Ints = Ints;
        type Longs = Longs;

        #[inline(always)]
        fn ints(self, all: i32) -> Ints {
            Ints::all(self, all)
        }
        #[inline(always)]
        fn longs(self, all: i64) -> Longs {
            Longs::all(self, all)
        }
        #[inline(always)]
        fn from(self, first: u64) -> Longs {
            const PLACES: [i64; $lanes] = {
                let mut places = [0; $lanes];
                let mut place = 0;
                while place < $lanes {
                    places[place] = place as i64;
                    place += 1;
                }
                places
            };
            let all = Longs::all(self, first.cast_signed());
            all.add(Longs(self, pulp::cast(PLACES)))
        }

        #[inline(always)]
        fn product_of_longs(self, a: Longs, b: Longs, drop: u32) -> Longs {
            lane_by_lane!(a, b, products, drop)
        }
        #[inline(always)]
        fn quotient_of_longs(self, a: Longs, b: Longs) -> Longs {
            lane_by_lane!(a, b, quotients)
        }
        #[inline(always)]
        fn root_of_longs(self, a: Longs) -> Longs {
            lane_by_lane!(a, a, roots)
        }

        #[inline(always)]
        fn wide_table<const L: usize>(self, table: &[i64; L], index: Ints) -> Longs {
            let index: [u32; $lanes] = pulp::cast(index.1);
            Longs(self, pulp::cast(scalar::entries(table, index)))
        }

        #[inline(always)]
        fn store(self, a: Longs, lanes: &mut [i64]) {
            let all: [i64; $lanes] = pulp::cast(a.1);
            match lanes.first_chunk_mut::<$lanes>() {
                Some(lanes) => *lanes = all,
                None => lanes.copy_from_slice(&all[..lanes.len()]),
            }
        }
    };
}

pub(super) use {common, halves, instructions, lane_by_lane, shifts, whole};
