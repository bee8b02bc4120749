//! The order of instructions with the fewest qubits: the reversible pebble game, solved exactly.
//!
//! A pebble on an operation stands for its results (Bennett 1989). An operation may run, or be undone, while
//! the operations that compute its inputs have pebbles. A game starts without pebbles and ends as soon as the
//! roots have theirs; the program runs backwards later, so that other pebbles may stay. A position is the set
//! of pebbles. It takes the qubits of their registers, and a move those that the operation borrows.
//!
//! For a growing number of qubits, an A* search looks for the game with the fewest Toffolis. The first number
//! with which there is a game is the least, unless a search for fewer qubits had to stop: positions are limited.

use super::draft::Draft;
use super::known::{Known, locked};
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{Instruction, RegisterId};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::collections::hash_map::Entry;
use std::sync::Mutex;

/// Most operations of a game: a position has one bit for each.
const MOST_OPERATIONS: usize = 64;

/// Most positions that are reached for one program, until the least number of qubits is known.
const MOST_POSITIONS: usize = 1 << 18;

/// Most positions that are reached for each further number of qubits.
const MORE_POSITIONS: usize = 1 << 13;

/// A set of operations, one bit for each.
type Pebbles = u64;

/// A move: an operation that runs or is undone.
#[derive(Clone, Copy, Debug)]
struct Move {
    /// The operations that compute its inputs.
    inputs: Pebbles,
    /// The qubits of its registers.
    width: u32,
    /// The qubits that it borrows while it runs.
    borrowed: u32,
    toffoli: u64,
}

/// A game: its moves, and its aim.
#[derive(Debug)]
struct Game {
    moves: Vec<Move>,
    roots: Pebbles,
    /// The qubits in use at the end, beside those of pebbles.
    after: u32,
}

/// A position that is reached.
#[derive(Clone, Copy, Debug)]
struct Reached {
    /// The fewest Toffolis so far.
    toffoli: u64,
    /// The move that led there; none at the start.
    by: Option<usize>,
}

/// Orders the instructions so that the program takes the fewest qubits, and of such orders one with the fewest
/// Toffolis, or such an order that is nearly as good if an exact answer would take too long. `after` is the number of
/// qubits that are in use at the end, beside the program's. None if the program is too large.
pub(super) fn schedule(
    draft: &Draft,
    roots: &[RegisterId],
    after: u32,
    known: &Mutex<Known>,
) -> Option<Vec<Instruction>> {
    if draft.ops.len() > MOST_OPERATIONS {
        return None;
    }
    let moves = Game::new(draft, roots, after, known).solve()?;
    let mut pebbles: Pebbles = 0;
    let instruction = |op: usize| {
        let inverse = pebbles >> op & 1 == 1;
        pebbles ^= 1 << op;
        Instruction {
            op: op as u32,
            inverse,
            block: draft.ops[op].1,
        }
    };
    Some(moves.into_iter().map(instruction).collect())
}

/// The places of the operations in `pebbles`.
fn places(mut pebbles: Pebbles) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = (pebbles != 0).then(|| pebbles.trailing_zeros() as usize)?;
        pebbles &= pebbles - 1;
        Some(place)
    })
}

impl Game {
    fn new(draft: &Draft, roots: &[RegisterId], after: u32, known: &Mutex<Known>) -> Self {
        let ops = || draft.ops.iter().map(|(op, _)| op);
        let mut computed: QuickMap<RegisterId, usize> = QuickMap::default();
        for (place, op) in ops().enumerate() {
            computed.extend(op.targets().into_iter().map(|target| (target, place)));
        }
        let pebbles = |registers: &[RegisterId]| {
            let places = registers.iter().filter_map(|id| computed.get(id));
            places.fold(0, |pebbles, place| pebbles | 1 << place)
        };
        let width = |id: &RegisterId| draft.registers[id.index()].width;
        let figures = locked(known).figures(ops(), &draft.registers);
        let moves = ops().zip(figures).map(|(op, figures)| Move {
            inputs: pebbles(&op.reads()),
            width: op.fresh().iter().map(width).sum(),
            borrowed: figures.borrowed,
            toffoli: figures.costs[0].toffoli,
        });
        Self {
            moves: moves.collect(),
            roots: pebbles(roots),
            after,
        }
    }

    /// Returns the moves of the best game; none if the search reaches too many positions.
    fn solve(&self) -> Option<Vec<usize>> {
        let mut left = MOST_POSITIONS;
        let all = self.moves.iter().map(|one| one.width + one.borrowed);
        let most = all.sum::<u32>() + self.after;
        (self.least()..=most).find_map(|qubits| {
            left = left.max(MORE_POSITIONS);
            self.within(qubits, &mut left)
        })
    }

    /// A number of qubits that no game goes below.
    fn least(&self) -> u32 {
        let room = |place: usize| {
            let one = &self.moves[place];
            self.width(one.inputs) + one.width + one.borrowed
        };
        let needed = places(self.needed(0)).map(room).max();
        needed.unwrap_or(0).max(self.width(self.roots) + self.after)
    }

    /// The qubits of the registers of `pebbles`.
    fn width(&self, pebbles: Pebbles) -> u32 {
        places(pebbles).map(|place| self.moves[place].width).sum()
    }

    /// The operations that have to run at least once more if those in `pebbles` have run.
    fn needed(&self, pebbles: Pebbles) -> Pebbles {
        let mut needed = self.roots & !pebbles;
        let mut new = needed;
        while new != 0 {
            let inputs = places(new).fold(0, |all, place| all | self.moves[place].inputs);
            new = inputs & !pebbles & !needed;
            needed |= new;
        }
        needed
    }

    /// The Toffolis of one run of each of `pebbles`.
    fn toffoli(&self, pebbles: Pebbles) -> u64 {
        places(pebbles).map(|place| self.moves[place].toffoli).sum()
    }

    /// Returns the moves of a game with the fewest Toffolis on at most `qubits` qubits; none if there is no
    /// such game. `left` is the number of positions that may still be reached.
    fn within(&self, qubits: u32, left: &mut usize) -> Option<Vec<usize>> {
        let mut reached: QuickMap<Pebbles, Reached> = QuickMap::default();
        let start = Reached {
            toffoli: 0,
            by: None,
        };
        reached.insert(0, start);
        // By the least Toffolis of a whole game, and of those the position that is nearest to the end.
        let mut open = BinaryHeap::from([Reverse((0, 0, 0, 0))]);
        while let Some(Reverse((_, _, toffoli, pebbles))) = open.pop() {
            if reached[&pebbles].toffoli < toffoli {
                continue;
            }
            let width = self.width(pebbles);
            if pebbles & self.roots == self.roots && width + self.after <= qubits {
                return Some(moves_to(pebbles, &reached));
            }
            for (place, one) in self.moves.iter().enumerate() {
                let runs = pebbles >> place & 1 == 0;
                let room = width + one.borrowed + if runs { one.width } else { 0 };
                if one.inputs & !pebbles != 0 || room > qubits {
                    continue;
                }
                let next = pebbles ^ 1 << place;
                let new = Reached {
                    toffoli: toffoli + one.toffoli,
                    by: Some(place),
                };
                match reached.entry(next) {
                    Entry::Occupied(known) if known.get().toffoli <= new.toffoli => continue,
                    Entry::Occupied(mut known) => _ = known.insert(new),
                    Entry::Vacant(unknown) => {
                        *left = left.checked_sub(1)?;
                        unknown.insert(new);
                    }
                }
                let needed = self.needed(next);
                let rest = self.toffoli(needed);
                let total = new.toffoli + rest;
                open.push(Reverse((total, needed.count_ones(), new.toffoli, next)));
            }
        }
        None
    }
}

/// The moves from the start to `pebbles`.
fn moves_to(mut pebbles: Pebbles, reached: &QuickMap<Pebbles, Reached>) -> Vec<usize> {
    let mut moves = Vec::new();
    while let Some(place) = reached[&pebbles].by {
        moves.push(place);
        pebbles ^= 1 << place;
    }
    moves.reverse();
    moves
}

#[cfg(test)]
mod tests {
    use super::*;

    fn operation(inputs: Pebbles, width: u32, borrowed: u32, toffoli: u64) -> Move {
        Move {
            inputs,
            width,
            borrowed,
            toffoli,
        }
    }

    /// Returns the most qubits and the Toffolis of the game, after a check that it keeps the rules.
    fn played(game: &Game) -> (u32, u64) {
        let (mut pebbles, mut most, mut toffoli): (Pebbles, u32, u64) = (0, 0, 0);
        for place in game.solve().unwrap() {
            let one = game.moves[place];
            assert_eq!(one.inputs & !pebbles, 0, "{place} lacks an input");
            most = most.max(game.width(pebbles | 1 << place) + one.borrowed);
            toffoli += one.toffoli;
            pebbles ^= 1 << place;
        }
        assert_eq!(game.roots & !pebbles, 0, "a root is missing");
        (most.max(game.width(pebbles) + game.after), toffoli)
    }

    /// The closed form of Li and Vitanyi (1996): `k` pebbles reach the first `2^k - 1` places of a chain.
    #[test]
    fn a_chain_takes_as_many_pebbles_as_its_length_has_bits() {
        for length in 1..=20_usize {
            let inputs = |place: usize| if place == 0 { 0 } else { 1 << (place - 1) };
            let moves = (0..length).map(|place| operation(inputs(place), 1, 0, 1));
            let game = Game {
                moves: moves.collect(),
                roots: 1 << (length - 1),
                after: 0,
            };
            let (qubits, _) = played(&game);
            assert_eq!(qubits, length.ilog2() + 1, "{length}");
        }
    }

    /// The qubits and Toffolis of the best game, by relaxing all positions until nothing changes.
    fn relaxed(game: &Game) -> (u32, u64) {
        let positions = 1_usize << game.moves.len();
        let is_end = |pebbles: usize| game.roots & !(pebbles as Pebbles) == 0;
        let end = |pebbles: usize| game.width(pebbles as Pebbles) + game.after;
        let relax = |mut best: Vec<u64>, step: &dyn Fn(u64, u32, u64) -> u64| {
            best[0] = 0;
            loop {
                let mut changed = false;
                for pebbles in 0..positions {
                    if best[pebbles] == u64::MAX {
                        continue;
                    }
                    for (place, one) in game.moves.iter().enumerate() {
                        if one.inputs & !(pebbles as Pebbles) != 0 {
                            continue;
                        }
                        let both = pebbles | 1 << place;
                        let room = game.width(both as Pebbles) + one.borrowed;
                        let value = step(best[pebbles], room, one.toffoli);
                        let next = &mut best[pebbles ^ 1 << place];
                        changed |= value < *next;
                        *next = value.min(*next);
                    }
                }
                if !changed {
                    return best;
                }
            }
        };
        let unknown = || vec![u64::MAX; positions];
        let rooms = relax(unknown(), &|before, room, _| before.max(room.into()));
        let ends = (0..positions).filter(|&pebbles| is_end(pebbles) && rooms[pebbles] < u64::MAX);
        let qubits = ends.map(|pebbles| rooms[pebbles].max(end(pebbles).into()));
        let qubits = qubits.min().unwrap() as u32;
        let costs = relax(unknown(), &|before, room, toffoli| {
            if room <= qubits {
                before + toffoli
            } else {
                u64::MAX
            }
        });
        let ends = (0..positions).filter(|&pebbles| is_end(pebbles) && end(pebbles) <= qubits);
        (qubits, ends.map(|pebbles| costs[pebbles]).min().unwrap())
    }

    #[test]
    fn games_of_random_programs_are_the_best_of_all_games() {
        let mut state: u64 = 1;
        let mut random = |below: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        for _ in 0..40 {
            let operations = 3 + random(7) as usize;
            let moves: Vec<Move> = (0..operations)
                .map(|place| {
                    let inputs = random(1 << place) & random(1 << place) as Pebbles;
                    operation(inputs, 1 + random(6) as u32, random(4) as u32, random(5))
                })
                .collect();
            let roots = 1 << (operations - 1) | random(1 << operations) & random(1 << operations);
            let game = Game {
                moves,
                roots,
                after: random(8) as u32,
            };
            assert_eq!(played(&game), relaxed(&game), "{game:?}");
        }
    }
}
