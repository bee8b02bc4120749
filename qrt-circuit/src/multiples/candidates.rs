//! Sets of multiples, and the count of the wanted ones that each would help.

/// Returns the place at which the search for the number begins, of places up to `last`.
#[inline(always)]
fn first_place(number: i64, last: usize) -> usize {
    // A product of 32 bits by 32 bits cannot overflow.
    let folded = (number ^ number >> 32) as u32 as u64;
    ((folded * 0x9e37_79b1) >> 24) as usize & last
}

/// A set of odd numbers.
pub(super) struct Set {
    /// The numbers in the order of insertion; `held` of them are set.
    pub(super) all: Box<[i64]>,
    pub(super) held: usize,
    /// The hash table: 0 in a free place. Its length is a power of two, and twice that of `all`.
    places: Box<[i64]>,
}

impl Set {
    pub(super) fn new() -> Self {
        Self {
            all: Box::new([0; 32]),
            held: 0,
            places: Box::new([0; 64]),
        }
    }

    /// Returns the place of the number, or the free place for it.
    #[inline(always)]
    fn place(places: &[i64], number: i64) -> usize {
        let last = places.len() - 1;
        let mut place = first_place(number, last);
        while places[place] != 0 && places[place] != number {
            place = (place + 1) & last;
        }
        place
    }

    #[inline(always)]
    pub(super) fn contains(&self, number: i64) -> bool {
        self.places[Self::place(&self.places, number)] == number
    }

    /// Inserts a number. False if it was there.
    #[inline(always)]
    pub(super) fn insert(&mut self, number: i64) -> bool {
        let places: &mut [i64] = &mut self.places;
        let place = Self::place(places, number);
        if places[place] == number {
            return false;
        }
        places[place] = number;
        self.all[self.held] = number;
        self.held += 1;
        if self.held == self.all.len() {
            self.grow();
        }
        true
    }

    fn grow(&mut self) {
        let mut all = vec![0; 4 * self.all.len()].into_boxed_slice();
        all[..self.held].copy_from_slice(&self.all);
        let mut places = vec![0; 2 * all.len()].into_boxed_slice();
        let mut next = 0;
        while next < self.held {
            places[Self::place(&places, all[next])] = all[next];
            next += 1;
        }
        (self.all, self.places) = (all, places);
    }
}

/// A multiple that is near, or from which wanted ones would be one sum.
#[derive(Clone, Copy)]
struct Between {
    /// The multiple, or 0 in a free place.
    number: i64,
    /// Number of wanted multiples that would be one sum from it.
    helped: u32,
    /// True if it is one sum away from the known ones.
    is_near: bool,
}

impl Between {
    const FREE: Self = Self {
        number: 0,
        helped: 0,
        is_near: false,
    };
}

/// All multiples that may come next, and those that would help.
pub(super) struct Candidates {
    /// The numbers in the order of insertion; `held` of them are set.
    all: Box<[i64]>,
    held: usize,
    /// The hash table. Its length is a power of two, and twice that of `all`.
    places: Box<[Between]>,
    /// By number of helped ones, the near multiples that help that many wanted multiples. A list may have a multiple
    /// that helped that many before and no longer does.
    by_helped: Vec<Vec<i64>>,
}

impl Candidates {
    pub(super) fn new() -> Self {
        Self {
            all: Box::new([0; 32]),
            held: 0,
            places: Box::new([Between::FREE; 64]),
            by_helped: Vec::new(),
        }
    }

    /// Returns the place of the number, or the free place for it.
    #[inline(always)]
    fn place(places: &[Between], number: i64) -> usize {
        let last = places.len() - 1;
        let mut place = first_place(number, last);
        while places[place].number != 0 && places[place].number != number {
            place = (place + 1) & last;
        }
        place
    }

    /// Returns the place of the number, which is inserted if it is not there.
    #[inline(always)]
    fn inserted(&mut self, number: i64) -> usize {
        let places: &mut [Between] = &mut self.places;
        let place = Self::place(places, number);
        if places[place].number == number {
            return place;
        }
        places[place].number = number;
        self.all[self.held] = number;
        self.held += 1;
        if self.held < self.all.len() {
            return place;
        }
        self.grow();
        Self::place(&self.places, number)
    }

    fn grow(&mut self) {
        let mut all = vec![0; 4 * self.all.len()].into_boxed_slice();
        all[..self.held].copy_from_slice(&self.all);
        let mut places = vec![Between::FREE; 2 * all.len()].into_boxed_slice();
        let mut next = 0;
        while next < self.places.len() {
            let between = self.places[next];
            if between.number != 0 {
                places[Self::place(&places, between.number)] = between;
            }
            next += 1;
        }
        (self.all, self.places) = (all, places);
    }

    /// Notes that a wanted multiple would be one sum from `number`.
    #[inline(always)]
    pub(super) fn helps(&mut self, number: i64) {
        let place = self.inserted(number);
        self.places[place].helped += 1;
        self.note(place);
    }

    /// Notes that the wanted multiple that would be one sum from `number` is no longer wanted.
    #[inline(always)]
    pub(super) fn helps_no_more(&mut self, number: i64) {
        let place = Self::place(&self.places, number);
        self.places[place].helped -= 1;
        self.note(place);
    }

    /// Notes that `number` is one sum away from the known ones.
    #[inline(always)]
    pub(super) fn reach(&mut self, number: i64) {
        let place = self.inserted(number);
        if !self.places[place].is_near {
            self.places[place].is_near = true;
            self.note(place);
        }
    }

    #[inline(always)]
    fn note(&mut self, place: usize) {
        let Between {
            number,
            helped,
            is_near,
        } = self.places[place];
        if is_near && helped > 0 {
            self.note_helpful(number, helped as usize);
        }
    }

    fn note_helpful(&mut self, number: i64, helped: usize) {
        while self.by_helped.len() <= helped {
            self.by_helped.push(Vec::new());
        }
        self.by_helped[helped].push(number);
    }

    /// Returns the near multiples that help the most wanted ones, in ascending order, and how many
    /// they help.
    pub(super) fn most_helpful(&mut self) -> (usize, &[i64]) {
        let places: &[Between] = &self.places;
        while let Some(mut best) = self.by_helped.pop() {
            let helped = self.by_helped.len();
            best.retain(|&number| places[Self::place(places, number)].helped as usize == helped);
            best.sort_unstable();
            best.dedup();
            if !best.is_empty() {
                self.by_helped.push(best);
                return (helped, &self.by_helped[helped]);
            }
        }
        (0, &[])
    }

    /// Removes all numbers, and keeps the memory of the table.
    pub(super) fn clear(&mut self) {
        self.by_helped.clear();
        let last = self.places.len() - 1;
        while self.held > 0 {
            self.held -= 1;
            // From the first place on, all places up to the number's own are taken.
            let mut place = first_place(self.all[self.held], last);
            while self.places[place].number != 0 {
                self.places[place] = Between::FREE;
                place = (place + 1) & last;
            }
        }
    }
}
