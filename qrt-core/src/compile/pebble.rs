//! The order of instructions with the fewest qubits: the reversible pebble game, solved exactly where that is quick.
//!
//! A pebble on an operation stands for its results (Bennett 1989). An operation may run, or be undone, while
//! the operations that compute its inputs have pebbles. A game starts without pebbles and ends as soon as the
//! roots have theirs; the program runs backwards later, so that other pebbles may stay. A position is the set
//! of pebbles. It takes the qubits of their registers, and a move those that the operation borrows.
//!
//! A sum may be computed into the register of one of its operands, its host. Such a move slides a pebble from the
//! host to the sum, or back, and needs no further register. A register then holds one number at a time. Which sums
//! are computed in place is chosen one after the other, the best first.
//!
//! For a growing number of qubits, an A* search looks for the game with the fewest Toffolis. The first number
//! with which there is a game is the least, unless a search for fewer qubits had to stop: positions are limited.

use super::draft::{Draft, Renamed};
use super::in_place::{Hosted, in_place, result, sums_in_place};
use super::known::{Known, locked};
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{Instruction, RegisterId};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::collections::hash_map::Entry;
use std::sync::Mutex;

/// Most operations of a game: a position has one bit for each.
const MOST_OPERATIONS: usize = 64;

/// The positions that a search may still reach.
struct Limit {
    left: usize,
    /// The least number for each number of qubits.
    more: usize,
}

impl Limit {
    /// The positions of a search, of which at least `more` belong to each number of qubits.
    fn with(more: usize) -> Self {
        Self {
            left: 1 << 18,
            more,
        }
    }

    fn first() -> Self {
        Self::with(1 << 13)
    }
}

/// A set of operations, one bit for each.
type Pebbles = u64;

/// A move: an operation that runs or is undone.
#[derive(Clone, Copy, Debug)]
struct Move {
    /// The operations that compute its inputs, its host included.
    inputs: Pebbles,
    /// The operation into whose register a sum is computed; empty if its results have registers of their own.
    host: Pebbles,
    /// The other operations whose results its register holds at other times.
    shares: Pebbles,
    /// The qubits of its registers.
    width: u32,
    /// The qubits that it borrows while it runs.
    borrowed: u32,
    toffoli: u64,
}

impl Move {
    /// The qubits that the move of the operation `own` takes beside the pebbles on `pebbles`; none if it is not
    /// possible there.
    fn room(&self, pebbles: Pebbles, own: Pebbles) -> Option<u32> {
        let runs = pebbles & own == 0;
        let without_host = self.inputs & !self.host;
        let is_possible = without_host & !pebbles == 0
            && if self.host == 0 {
                !runs || self.shares & pebbles == 0
            } else {
                !runs || self.host & pebbles != 0
            };
        let registers = if runs && self.host == 0 {
            self.width
        } else {
            0
        };
        is_possible.then_some(registers + self.borrowed)
    }
}

/// A game that was played.
struct Played {
    qubits: u32,
    toffoli: u64,
    moves: Vec<usize>,
    /// True if the search ended long before its limit of positions.
    is_exact: bool,
}

impl Played {
    fn cost(&self) -> (u32, u64) {
        (self.qubits, self.toffoli)
    }
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

/// A program's draft with an order of its instructions.
#[derive(Debug)]
pub(super) struct Schedule {
    pub(super) draft: Draft,
    pub(super) order: Vec<Instruction>,
    /// Registers whose numbers end in another register.
    pub(super) renamed: Renamed,
}

/// Orders the instructions so that the program takes the fewest qubits, and of such orders one with the fewest
/// Toffolis, or such an order that is nearly as good if an exact answer would take too long. Then computes sums in
/// place, as long as one more makes a better order. `after` is the number of
/// qubits that are in use at the end, beside the program's. None if the program is too large.
pub(super) fn schedule(
    draft: &Draft,
    roots: &[RegisterId],
    after: u32,
    known: &Mutex<Known>,
) -> Option<Schedule> {
    if draft.ops.len() > MOST_OPERATIONS {
        return None;
    }
    let play = |hosted: &[Hosted], below: Option<(u32, u64)>, limit: &mut Limit| {
        let adapted = in_place(draft, hosted)?;
        let game = Game::new(draft, &adapted, hosted, (roots, after), known);
        let played = game.is_possible().then(|| game.solve(below, limit))??;
        Some((game, adapted, played))
    };
    let mut best = play(&[], None, &mut Limit::first())?;
    // The games with sums in place share one limit.
    let mut limit = Limit::with(0);
    let mut hosted: Vec<Hosted> = Vec::new();
    let mut left = if best.2.is_exact {
        sums_in_place(draft)
    } else {
        Vec::new()
    };
    // Adds the sum in place that makes the best game, as long as one makes a better game than none.
    loop {
        let mut added = None;
        for sum in &left {
            let more: Vec<Hosted> = hosted.iter().chain([sum]).copied().collect();
            if let Some(better) = play(&more, Some(best.2.cost()), &mut limit) {
                best = better;
                added = Some(*sum);
            }
        }
        let Some(sum) = added else { break };
        left.retain(|other| other.sum != sum.sum);
        hosted.push(sum);
    }
    let (game, adapted, played) = best;
    Some(game.scheduled(&played.moves, draft, adapted))
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
    /// The game of `draft` whose sums of `hosted` are computed in place, as in `adapted`. `after` is as in
    /// [`schedule`].
    fn new(
        draft: &Draft,
        adapted: &Draft,
        hosted: &[Hosted],
        (roots, after): (&[RegisterId], u32),
        known: &Mutex<Known>,
    ) -> Self {
        let ops = || draft.ops.iter().map(|(op, _)| op);
        let mut computed: QuickMap<RegisterId, usize> = QuickMap::default();
        for (place, op) in ops().enumerate() {
            computed.extend(op.targets().into_iter().map(|target| (target, place)));
        }
        let pebbles = |registers: &[RegisterId]| {
            let places = registers.iter().filter_map(|id| computed.get(id));
            places.fold(0, |pebbles, place| pebbles | 1 << place)
        };
        let width = |id: &RegisterId| adapted.registers[id.index()].width;
        let changed = || adapted.ops.iter().map(|(op, _)| op);
        let figures = locked(known).figures(changed(), &adapted.registers);
        let moves = ops().zip(changed()).zip(figures);
        let moves = moves.map(|((op, changed), figures)| Move {
            inputs: pebbles(&op.reads()),
            host: 0,
            shares: 0,
            width: changed.fresh().iter().map(width).sum(),
            borrowed: figures.borrowed,
            toffoli: figures.costs[0].toffoli,
        });
        let mut game = Self {
            moves: moves.collect(),
            roots: pebbles(roots),
            after,
        };
        for sum in hosted {
            game.share(sum.host, sum.sum);
        }
        game
    }

    /// Computes the sum of the move `sum` in the register of the move `host`.
    fn share(&mut self, host: usize, sum: usize) {
        let shares = self.moves[host].shares | self.moves[sum].shares;
        let all = shares | 1 << host | 1 << sum;
        self.moves[sum].inputs |= 1 << host;
        self.moves[sum].host = 1 << host;
        let computes = |place: &usize| self.moves[*place].host == 0;
        let width = places(all)
            .find(computes)
            .map_or(0, |root| self.moves[root].width);
        for place in places(all) {
            self.moves[place].shares = all & !(1 << place);
            self.moves[place].width = width;
        }
    }

    /// The order of the instructions of `adapted` that makes `moves`. `draft` is the draft without sums in place.
    fn scheduled(&self, moves: &[usize], draft: &Draft, adapted: Draft) -> Schedule {
        let mut pebbles: Pebbles = 0;
        // The operations in the order in which they first run.
        let mut ops: Vec<usize> = Vec::new();
        let instruction = |&op: &usize| {
            let inverse = pebbles >> op & 1 == 1;
            pebbles ^= self.moved(op);
            let known = ops.iter().position(|&other| other == op);
            if known.is_none() {
                ops.push(op);
            }
            Instruction {
                op: known.unwrap_or(ops.len() - 1) as u32,
                inverse,
                block: draft.ops[op].1,
            }
        };
        let order = moves.iter().map(instruction).collect();
        let shared = places(pebbles).filter(|&place| self.moves[place].shares != 0);
        let renamed = shared.map(|place| {
            let [from, to] = [draft, &adapted].map(|draft| result(&draft.ops[place].0));
            (from, to)
        });
        Schedule {
            order,
            renamed: renamed.collect(),
            draft: Draft {
                ops: ops.iter().map(|&op| adapted.ops[op].clone()).collect(),
                ..adapted
            },
        }
    }

    /// The pebbles that a move of the operation at `place` puts or takes.
    fn moved(&self, place: usize) -> Pebbles {
        1 << place | self.moves[place].host
    }

    /// True unless a move takes two numbers of one register as its inputs.
    fn is_possible(&self) -> bool {
        let shared = |inputs| places(inputs).any(|place| self.moves[place].shares & inputs != 0);
        !self.moves.iter().any(|one| shared(one.inputs))
    }

    /// Returns the best game; none if the search reaches too many positions, or no game is better than `below`,
    /// which is the qubits and Toffolis of one.
    fn solve(&self, below: Option<(u32, u64)>, limit: &mut Limit) -> Option<Played> {
        let all = self.moves.iter().map(|one| one.width + one.borrowed);
        let most = all.sum::<u32>() + self.after;
        let most = below.map_or(most, |(qubits, _)| qubits.min(most));
        let (qubits, moves) = (self.least()..=most).find_map(|qubits| {
            limit.left = limit.left.max(limit.more);
            let moves = self.within(qubits, &mut limit.left)?;
            Some((qubits, moves))
        })?;
        let toffoli = moves.iter().map(|&place| self.moves[place].toffoli);
        let played = Played {
            qubits,
            toffoli: toffoli.sum(),
            moves,
            is_exact: limit.left > limit.more,
        };
        below
            .is_none_or(|below| played.cost() < below)
            .then_some(played)
    }

    /// A number of qubits that no game goes below.
    fn least(&self) -> u32 {
        let room = |place: usize| {
            let one = &self.moves[place];
            let own = if one.host == 0 { one.width } else { 0 };
            self.width(one.inputs) + own + one.borrowed
        };
        let needed = places(self.needed(0)).map(room).max();
        needed.unwrap_or(0).max(self.width(self.roots) + self.after)
    }

    /// The qubits of the registers of `pebbles`.
    fn width(&self, pebbles: Pebbles) -> u32 {
        places(pebbles).map(|place| self.moves[place].width).sum()
    }

    /// The operations that need a pebble at least once more if those in `pebbles` have one.
    fn needed(&self, pebbles: Pebbles) -> Pebbles {
        let mut needed = self.roots & !pebbles;
        let mut new = needed;
        while new != 0 {
            // A pebble may slide back to a host, whose inputs are then not needed.
            let run = places(new).filter(|&place| self.moves[place].shares & pebbles == 0);
            let inputs = run.fold(0, |all, place| all | self.moves[place].inputs);
            new = inputs & !pebbles & !needed;
            needed |= new;
        }
        needed
    }

    /// The fewest Toffolis that put a pebble on each of `needed`, from a position with `pebbles`.
    fn toffoli(&self, needed: Pebbles, pebbles: Pebbles) -> u64 {
        let least = |place: usize| {
            let one = &self.moves[place];
            // Sliding another number of this register back may already yield this one, at its own cost.
            let shared = if one.shares & pebbles == 0 {
                0
            } else {
                one.shares
            };
            let costs = places(shared | 1 << place).map(|place| self.moves[place].toffoli);
            costs.min().unwrap_or(0)
        };
        places(needed).map(least).sum()
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
                return Some(self.moves_to(pebbles, &reached));
            }
            for (place, one) in self.moves.iter().enumerate() {
                let Some(room) = one.room(pebbles, 1 << place) else {
                    continue;
                };
                if width + room > qubits {
                    continue;
                }
                let next = pebbles ^ self.moved(place);
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
                let rest = self.toffoli(needed, next);
                let total = new.toffoli + rest;
                open.push(Reverse((total, needed.count_ones(), new.toffoli, next)));
            }
        }
        None
    }

    /// The moves from the start to `pebbles`.
    fn moves_to(&self, mut pebbles: Pebbles, reached: &QuickMap<Pebbles, Reached>) -> Vec<usize> {
        let mut moves = Vec::new();
        while let Some(place) = reached[&pebbles].by {
            moves.push(place);
            pebbles ^= self.moved(place);
        }
        moves.reverse();
        moves
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_circuit::{
        Bit, Block, BlockId, Contents, Op, Operand, Parameter, Program, Register, Type, Word,
    };

    fn operation(inputs: Pebbles, width: u32, borrowed: u32, toffoli: u64) -> Move {
        Move {
            inputs,
            host: 0,
            shares: 0,
            width,
            borrowed,
            toffoli,
        }
    }

    /// The pebbles after a move, and the qubits that it takes; none if the rules forbid it.
    fn after(game: &Game, pebbles: Pebbles, place: usize) -> Option<(Pebbles, u32)> {
        let one = game.moves[place];
        let own = 1 << place;
        let is_held = |set: Pebbles| pebbles & set == set;
        let next = match (one.host, is_held(own)) {
            (0, true) => pebbles & !own,
            (0, false) if pebbles & one.shares == 0 => pebbles | own,
            (0, false) => return None,
            (host, true) => pebbles & !own | host,
            (host, false) if is_held(host) => pebbles & !host | own,
            (_, false) => return None,
        };
        let both = if one.host == 0 { pebbles | next } else { next };
        is_held(one.inputs & !one.host).then_some((next, game.width(both) + one.borrowed))
    }

    /// Returns the most qubits and the Toffolis of the game, after a check that it keeps the rules.
    fn played(game: &Game) -> (u32, u64) {
        let (mut pebbles, mut most, mut toffoli): (Pebbles, u32, u64) = (0, 0, 0);
        let played = game.solve(None, &mut Limit::first()).unwrap();
        for &place in &played.moves {
            let (next, room) = after(game, pebbles, place).expect("a move of the rules");
            most = most.max(room);
            toffoli += game.moves[place].toffoli;
            pebbles = next;
        }
        assert_eq!(game.roots & !pebbles, 0, "a root is missing");
        let found = (most.max(game.width(pebbles) + game.after), toffoli);
        assert_eq!(found, played.cost());
        found
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
                        let Some((next, room)) = after(game, pebbles as Pebbles, place) else {
                            continue;
                        };
                        let value = step(best[pebbles], room, one.toffoli);
                        let next = &mut best[next as usize];
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
        let mut games = 0;
        for _ in 0..60 {
            let operations = 3 + random(7) as usize;
            let moves: Vec<Move> = (0..operations)
                .map(|place| {
                    let inputs = random(1 << place) & random(1 << place) as Pebbles;
                    operation(inputs, 1 + random(6) as u32, random(4) as u32, random(5))
                })
                .collect();
            let roots = 1 << (operations - 1) | random(1 << operations) & random(1 << operations);
            let mut game = Game {
                moves,
                roots,
                after: random(8) as u32,
            };
            assert_eq!(played(&game), relaxed(&game), "{game:?}");
            game.roots = 1 << (operations - 1);
            // Sums in registers of others; some hosts are sums themselves.
            for _ in 0..random(4) {
                let sum = 1 + random(operations as u64 - 1) as usize;
                if game.moves[sum].host == 0 {
                    game.share(random(sum as u64) as usize, sum);
                    games += u32::from(game.solve(None, &mut Limit::first()).is_some());
                }
            }
            if game.solve(None, &mut Limit::first()).is_some() {
                assert_eq!(played(&game), relaxed(&game), "{game:?}");
            }
        }
        assert!(games > 40, "{games} games with sums in place");
    }

    /// A random number below another, by a linear congruential generator.
    struct Random(u64);

    impl Random {
        fn below(&mut self, most: u64) -> u64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
            self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) % most
        }

        /// A number read from one of the registers: mostly all of its bits.
        fn word(&mut self, registers: &[Register]) -> Word {
            let place = self.below(registers.len() as u64);
            let register = registers[place as usize].width;
            let offset = self.below(4).saturating_sub(2).min(u64::from(register) - 1) as u32;
            Word {
                register: RegisterId(place as u32),
                offset,
                width: register - offset,
                signed: self.below(3) == 0,
                shift: self.below(5).saturating_sub(3) as u32,
            }
        }

        fn operand(&mut self, registers: &[Register]) -> Operand {
            match self.below(4) {
                0 => Operand::Constant(self.below(7) as i64 - 3),
                _ => Operand::Word(self.word(registers)),
            }
        }

        /// A program of sums, of an input of four bits and a parameter of three.
        fn draft(&mut self) -> Draft {
            let mut draft = Draft {
                registers: vec![Register::new("input", Type::UInt, 4)],
                blocks: vec![Block::default()],
                ops: Vec::new(),
            };
            for _ in 0..4 + self.below(5) {
                let registers = &draft.registers;
                let target = RegisterId(registers.len() as u32);
                let mut width = 1 + self.below(6) as u32;
                let op = match self.below(6) {
                    0 => {
                        width = 3;
                        Op::Load {
                            parameter: 0,
                            target,
                        }
                    }
                    1 => Op::Select {
                        when: Bit {
                            register: RegisterId(0),
                            index: self.below(4) as u32,
                            inverted: false,
                        },
                        a: self.operand(registers),
                        b: self.operand(registers),
                        target,
                    },
                    2 => Op::Copy {
                        a: self.word(registers),
                        target,
                    },
                    _ => Op::Add {
                        a: self.operand(registers),
                        b: self.operand(registers),
                        subtract: self.below(2) == 0,
                        target,
                    },
                };
                draft.ops.push((op, BlockId::ROOT));
                let name = format!("r{}", target.0);
                draft.registers.push(Register::new(name, Type::UInt, width));
            }
            draft
        }
    }

    fn program(draft: &Draft, instructions: Vec<Instruction>) -> Program {
        Program {
            registers: draft.registers.clone(),
            blocks: draft.blocks.clone(),
            parameters: vec![Parameter {
                name: "parameter".into(),
                width: 8,
            }],
            ops: draft.ops.iter().map(|(op, _)| op.clone()).collect(),
            instructions,
            inputs: vec![RegisterId(0)],
        }
    }

    fn followed(program: &Program, contents: &mut Contents) {
        for &instruction in &program.instructions {
            contents.follow(program, instruction).unwrap();
        }
    }

    /// Checks that both programs compute the same roots, and that the second one's inverse leaves the input alone.
    fn compute_the_same(draft: &Draft, schedule: &Schedule, roots: &[RegisterId]) {
        let in_order = (0..draft.ops.len() as u32).map(|op| Instruction {
            op,
            inverse: false,
            block: BlockId::ROOT,
        });
        let plain = program(draft, in_order.collect());
        let ordered = program(&schedule.draft, schedule.order.clone());
        for (input, parameter) in (0..16).flat_map(|i| (0..8).map(move |p| (i, p))) {
            let mut expected = Contents::new(&plain, &[input], &[parameter]);
            followed(&plain, &mut expected);
            let start = Contents::new(&ordered, &[input], &[parameter]);
            let mut found = start.clone();
            followed(&ordered, &mut found);
            for root in roots {
                let home = schedule.renamed.get(root).unwrap_or(root);
                let bits = (1 << draft.registers[root.index()].width) - 1;
                let found = found.registers[home.index()] & bits;
                assert_eq!(
                    found,
                    expected.registers[root.index()],
                    "{root:?} of {schedule:?}"
                );
            }
            followed(&ordered.inverse(), &mut found);
            assert_eq!(found, start, "{schedule:?}");
        }
    }

    #[test]
    fn sums_in_place_compute_the_same() {
        let mut random = Random(1);
        let (mut sets, mut wider) = (0, 0);
        for _ in 0..600 {
            let draft = random.draft();
            let last = RegisterId(draft.ops.len() as u32);
            let roots = [last, RegisterId(1 + random.below(u64::from(last.0)) as u32)];
            let sums = sums_in_place(&draft);
            let one = sums.iter().map(|sum| vec![*sum]);
            let two = sums.windows(2).map(<[Hosted]>::to_vec);
            let three = sums.windows(3).map(<[Hosted]>::to_vec);
            for hosted in one.chain(two).chain(three) {
                let twice =
                    |sum: &Hosted| hosted.iter().filter(|other| other.sum == sum.sum).count() > 1;
                let Some(adapted) = in_place(&draft, &hosted).filter(|_| !hosted.iter().any(twice))
                else {
                    continue;
                };
                let homes = &adapted.registers[draft.registers.len()..];
                let is_wider = |home: &Register| {
                    let own = draft
                        .registers
                        .iter()
                        .find(|own| home.name == format!("{}'", own.name));
                    own.is_some_and(|own| own.width < home.width)
                };
                wider += u32::from(homes.iter().any(is_wider));
                let known = Mutex::new(Known::default());
                locked(&known)
                    .of_recorded
                    .resize(draft.registers.len(), None);
                let game = Game::new(&draft, &adapted, &hosted, (&roots, 0), &known);
                let played = game
                    .is_possible()
                    .then(|| game.solve(None, &mut Limit::first()));
                if let Some(played) = played.flatten() {
                    sets += 1;
                    let schedule = game.scheduled(&played.moves, &draft, adapted);
                    compute_the_same(&draft, &schedule, &roots);
                }
            }
        }
        assert!(
            sets > 300 && wider > 30,
            "{sets} sets, {wider} with a wider register"
        );
    }
}
