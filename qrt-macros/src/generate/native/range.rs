//! Ranges of values. They show which values need not be cut, extended or widened.

/// The least and the greatest number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Range {
    pub(super) low: i64,
    pub(super) high: i64,
}

impl Range {
    /// The range of all numbers.
    pub(super) const ALL: Self = Self::new(i64::MIN, i64::MAX);
    /// The range of the numbers that 32 bits hold.
    pub(super) const INTS: Self = Self::new(i32::MIN as i64, i32::MAX as i64);

    pub(super) const fn new(low: i64, high: i64) -> Self {
        Self { low, high }
    }

    /// Returns the range of the numbers of `width` bits, as 64 bits read them.
    pub(super) fn of_width(width: u32, signed: bool) -> Self {
        if width >= 64 {
            return Self::ALL;
        }
        if signed {
            let half = 1_i64 << (width - 1);
            return Self::new(-half, half - 1);
        }
        Self::new(0, (u64::MAX >> (64 - width)).cast_signed())
    }

    /// True if 32 bits hold every number of the range.
    pub(super) fn narrow(self) -> bool {
        self.within(Self::INTS)
    }

    pub(super) fn within(self, other: Self) -> bool {
        other.low <= self.low && self.high <= other.high
    }

    pub(super) fn union(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    fn checked(low: Option<i64>, high: Option<i64>) -> Self {
        match (low, high) {
            (Some(low), Some(high)) => Self::new(low, high),
            _ => Self::ALL,
        }
    }

    pub(super) fn add(self, other: Self) -> Self {
        Self::checked(
            self.low.checked_add(other.low),
            self.high.checked_add(other.high),
        )
    }

    pub(super) fn sub(self, other: Self) -> Self {
        Self::checked(
            self.low.checked_sub(other.high),
            self.high.checked_sub(other.low),
        )
    }

    /// Returns the range of products of numbers that 32 bits hold each; `ALL` for other numbers.
    pub(super) fn mul(self, other: Self) -> Self {
        if !self.narrow() || !other.narrow() {
            return Self::ALL;
        }
        let ends = [self.low * other.low, self.low * other.high];
        let others = [self.high * other.low, self.high * other.high];
        let low = ends[0].min(ends[1]).min(others[0].min(others[1]));
        Self::new(low, ends[0].max(ends[1]).max(others[0].max(others[1])))
    }

    pub(super) fn left(self, by: u32) -> Self {
        let back = self.low << by >> by == self.low && self.high << by >> by == self.high;
        if back {
            Self::new(self.low << by, self.high << by)
        } else {
            Self::ALL
        }
    }

    pub(super) fn right(self, by: u32) -> Self {
        let by = by.min(63);
        Self::new(self.low >> by, self.high >> by)
    }

    /// Returns the range of the numbers that are in both.
    pub(super) fn intersection(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.min(other.high))
    }

    /// Returns the range after lanes of 32 bits have cut its numbers.
    pub(super) fn cut(self) -> Self {
        if self.narrow() { self } else { Self::INTS }
    }
}
