//! A queue of items in which each next item goes before one that is there, and places are compared.

/// Distance of the labels of neighbours, while there is room.
const GAP: u128 = 1 << 64;

/// The neighbours and the label of an item. Labels grow along the queue.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    before: Option<usize>,
    after: Option<usize>,
    label: u128,
}

/// The order of some of the items 0, 1, 2, ...
#[derive(Debug)]
pub(super) struct Queue {
    entries: Vec<Entry>,
    first: Option<usize>,
}

impl Queue {
    /// An empty queue for items below `items`.
    pub(super) fn new(items: usize) -> Self {
        Self {
            entries: vec![Entry::default(); items],
            first: None,
        }
    }

    /// Number that is smaller for items that are nearer to the front.
    pub(super) fn place(&self, item: usize) -> u128 {
        self.entries[item].label
    }

    /// Inserts `item` before `later`, or at the front if there is none.
    pub(super) fn insert(&mut self, item: usize, later: Option<usize>) {
        let after = later.or(self.first);
        let before = after.and_then(|after| self.entries[after].before);
        let Some(next) = after else {
            self.entries[item].label = u128::MAX / 2;
            self.first = Some(item);
            return;
        };
        if before.is_some_and(|before| self.place(next) - self.place(before) < 2) {
            self.relabel();
        }
        let label = match before {
            Some(before) => self.place(before) + (self.place(next) - self.place(before)) / 2,
            None => self.place(next) - GAP,
        };
        self.entries[item] = Entry {
            before,
            after,
            label,
        };
        self.entries[next].before = Some(item);
        match before {
            Some(before) => self.entries[before].after = Some(item),
            None => self.first = Some(item),
        }
    }

    fn relabel(&mut self) {
        let mut at = self.first;
        let mut label = u128::MAX / 2;
        while let Some(item) = at {
            self.entries[item].label = label;
            label += GAP;
            at = self.entries[item].after;
        }
    }

    /// The items, from the front.
    pub(super) fn items(&self) -> impl Iterator<Item = usize> {
        std::iter::successors(self.first, |&item| self.entries[item].after)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same with a vector.
    fn expected(laters: &[Option<usize>]) -> Vec<usize> {
        let mut order: Vec<usize> = Vec::new();
        for (item, later) in laters.iter().enumerate() {
            let place = later.and_then(|later| order.iter().position(|other| *other == later));
            order.insert(place.unwrap_or(0), item);
        }
        order
    }

    #[test]
    fn items_stand_where_a_vector_has_them() {
        // Draws of a linear congruential generator (Knuth).
        let mut state: u64 = 1;
        let mut draw = |below: usize| {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 33) as usize % below
        };
        for count in [0, 1, 2, 50, 400] {
            let drawn = (0..count).map(|item| (item > 0 && draw(4) > 0).then(|| draw(item)));
            let drawn: Vec<Option<usize>> = drawn.collect();
            // Many items before one exhaust the labels between two.
            let crowd = (0..count).map(|item| (item > 1).then_some(0));
            let crowd: Vec<Option<usize>> = crowd.collect();
            for laters in [drawn, crowd] {
                let mut queue = Queue::new(count);
                for (item, later) in laters.iter().enumerate() {
                    queue.insert(item, *later);
                }
                let order: Vec<usize> = queue.items().collect();
                assert_eq!(order, expected(&laters));
                let places: Vec<u128> = order.iter().map(|&item| queue.place(item)).collect();
                assert!(places.is_sorted_by(|a, b| a < b));
            }
        }
    }
}
