//! The cost of a scene's circuit under each strategy: qubits against gates.

use super::oracles::{Oracles, most_expensive_of};
use super::recording::Recording;
use super::{CallCost, OracleError, OracleName};
use crate::compile::{Stem, Strategy};
use qrt_circuit::Cores;
use qrt_circuit::lower;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, PoisonError};

/// A way to lay out the circuit of a scene's channel, and the cost of one call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StrategyCost {
    /// The uncomputation strategy.
    pub strategy: Strategy,
    /// Qubits and Toffolis of a call.
    pub cost: CallCost,
    /// Number of ANDs if measurements undo them.
    pub and_measured: u64,
    /// An estimate of the number of those ANDs that remain on the same qubits with ghosts: values that are
    /// undone early are measured, and leave ghosts until they are computed again. See
    /// [`lower::with_ghosts`].
    pub and_with_ghosts: u64,
}

impl StrategyCost {
    /// The name of the most expensive of the scene's oracles, and its cost.
    ///
    /// # Errors
    /// As [`super::Oracle::new`].
    pub fn of_most_expensive(
        oracles: &Oracles<'_>,
        strategy: Strategy,
    ) -> Result<(OracleName, Self), OracleError> {
        let name = most_expensive_of(&oracles.costs_under(strategy)?).name;
        let cost = oracles.layouts(name).under(strategy)?;
        Ok((name, cost))
    }
}

/// The costs of one of a scene's oracles under strategies: see [`Oracles::layouts`].
pub struct StrategyCosts<'a> {
    oracles: &'a Oracles<'a>,
    name: OracleName,
    /// The latest stems, by [`Strategy::stem`].
    stems: Mutex<VecDeque<(usize, Arc<Stem>)>>,
}

/// Most stems that are kept: strategies of one stem are costed one after the other.
const STEMS: usize = 2;

impl StrategyCosts<'_> {
    /// The cost under `strategy`.
    ///
    /// # Errors
    /// As [`super::Oracle::new`].
    pub fn under(&self, strategy: Strategy) -> Result<StrategyCost, OracleError> {
        let recording = self.oracles.recording(self.name.class, strategy)?;
        let stem = self.stem(&recording, strategy);
        let priced = recording.priced(Stem::clone(&stem), strategy, self.name.channel);
        let (steps, figures) = priced.whole();
        let left = lower::steps_with_ghosts(priced.registers(), &priced.ops(), &steps);
        let (mut and_measured, mut and_with_ghosts) = (0, 0);
        for (instruction, left) in steps.iter().zip(left) {
            let costs = &figures[instruction.op as usize].costs;
            let ands = costs[usize::from(instruction.inverse)].and_measured;
            and_measured += ands;
            and_with_ghosts += if left { ands } else { 0 };
        }
        Ok(StrategyCost {
            strategy,
            cost: priced.cost(),
            and_measured,
            and_with_ghosts,
        })
    }

    /// The cost of a call under `strategy`, without its program. Successive strategies of one of
    /// [`Strategy::groups`] take the least time.
    ///
    /// # Errors
    /// As [`super::Oracle::new`].
    pub fn call(&self, strategy: Strategy) -> Result<CallCost, OracleError> {
        let recording = self.oracles.recording(self.name.class, strategy)?;
        let stem = self.stem(&recording, strategy);
        let priced = recording.priced(Stem::clone(&stem), strategy, self.name.channel);
        Ok(priced.cost())
    }

    fn stem(&self, recording: &Recording, strategy: Strategy) -> Arc<Stem> {
        let mut stems = self.stems.lock().unwrap_or_else(PoisonError::into_inner);
        let found = stems.iter().find(|(kind, _)| *kind == strategy.stem());
        if let Some((_, stem)) = found {
            return Arc::clone(stem);
        }
        stems.truncate(STEMS - 1);
        let stem = Arc::new(recording.stem(strategy, self.name.channel));
        stems.push_front((strategy.stem(), Arc::clone(&stem)));
        stem
    }

    /// The cost of each strategy in `of`, computed on all cores.
    fn costs(&self, of: &[Strategy]) -> Result<Vec<(CallCost, Strategy)>, OracleError> {
        let mut found = Vec::with_capacity(of.len());
        for group in Strategy::groups(of) {
            let costs = Cores::All.map(&group, 1, |&place| self.call(of[place]));
            for (place, cost) in group.into_iter().zip(costs) {
                found.push((place, cost?));
            }
        }
        found.sort_unstable_by_key(|(place, _)| *place);
        let found = found.into_iter().map(|(place, cost)| (cost, of[place]));
        Ok(found.collect())
    }

    /// The strategy of [`Strategy::all`] with the fewest Toffolis on at most `qubits` qubits; the one with
    /// the fewest qubits if all have more.
    ///
    /// # Errors
    /// As [`super::Oracle::new`].
    pub fn cheapest(&self, qubits: u64) -> Result<Strategy, OracleError> {
        let pebbled = (self.call(Strategy::PEBBLED)?, Strategy::PEBBLED);
        let kept = self.cheapest_kept(qubits)?;
        let without_garbage: Vec<Strategy> = Strategy::all_without_garbage().collect();
        let anew: Vec<Strategy> = without_garbage.iter().map(|s| s.recomputing()).collect();
        if let Some((cost, strategy)) = kept {
            // Of the strategies that recompute, the one without scopes has few Toffolis, if not the fewest.
            let few = self.call(anew[0])?.toffoli;
            if cost.toffoli <= (few - few / 3).min(pebbled.0.toffoli) {
                return Ok(strategy);
            }
        }
        let rank = |(cost, _): &(CallCost, Strategy)| {
            if cost.qubits <= qubits {
                (0, cost.toffoli, cost.qubits)
            } else {
                (1, cost.qubits, cost.toffoli)
            }
        };
        let mut all = self.costs(&anew)?;
        let others = || kept.into_iter().chain([pebbled]);
        let best = all
            .iter()
            .copied()
            .chain(others())
            .map(|one| rank(&one))
            .min();
        // Running inputs again frees more qubits, and saves no Toffolis.
        let may_be_better = |one: &(CallCost, Strategy)| {
            let fits = one.0.qubits <= qubits;
            !fits && best.is_none_or(|best| best.0 == 1 || one.0.toffoli < best.1)
        };
        let again = without_garbage.iter().zip(&all);
        let again = again.filter(|(_, one)| may_be_better(one));
        let again: Vec<Strategy> = again.map(|(s, _)| s.running_again()).collect();
        let again = self.costs(&again)?;
        all.extend(again.into_iter().chain(others()));
        let best = all.into_iter().min_by_key(rank);
        Ok(best.map_or(Strategy::SCOPED, |(_, strategy)| strategy))
    }

    /// The cheapest strategy that recomputes nothing, with its cost; none if none fits.
    ///
    /// [`Strategy::CHOICES`] are decided one after another. Partial decisions that cannot lead to the
    /// cheapest are dropped: of the strategies with the same decisions, none has fewer Toffolis than the one
    /// that takes no other choice, or many fewer qubits than the one that takes all others.
    fn cheapest_kept(&self, most: u64) -> Result<Option<(CallCost, Strategy)>, OracleError> {
        // The copies that a part makes before it is undone can outweigh the qubits that it frees, by a few.
        let nearly = most.saturating_add(most / 16);
        let mut known: BTreeMap<usize, CallCost> = BTreeMap::new();
        let mut best: Option<(CallCost, Strategy)> = None;
        // Choices taken, and choices still open.
        let mut open = vec![(0, Strategy::CHOSEN - 1)];
        let mut choices = 0..Strategy::CHOICES.len();
        loop {
            let wanted = open.iter().flat_map(|&(taken, free)| [taken, taken | free]);
            let wanted: BTreeSet<usize> = wanted.filter(|bits| !known.contains_key(bits)).collect();
            let strategies = wanted.iter().map(|&bits| Strategy::of_choices(bits));
            let costs = self.costs(&strategies.collect::<Vec<_>>())?;
            for (bits, (cost, strategy)) in wanted.into_iter().zip(costs) {
                known.insert(bits, cost);
                let is_better = |best: (CallCost, _)| {
                    (cost.toffoli, cost.qubits) < (best.0.toffoli, best.0.qubits)
                };
                if cost.qubits <= most && best.is_none_or(is_better) {
                    best = Some((cost, strategy));
                }
            }
            open.retain(|(taken, free)| {
                let least = known[taken];
                least.qubits > most
                    && best.is_none_or(|(cost, _)| least.toffoli < cost.toffoli)
                    && known[&(taken | free)].qubits <= nearly
            });
            let Some(choice) = choices.next() else {
                return Ok(best);
            };
            let bit = 1 << choice;
            let decided = open.into_iter().map(|(taken, free)| (taken, free & !bit));
            open = decided
                .flat_map(|(taken, free)| [(taken, free), (taken | bit, free)])
                .collect();
        }
    }
}

impl Oracles<'_> {
    /// The layouts of one of the oracles.
    pub fn layouts(&self, name: OracleName) -> StrategyCosts<'_> {
        StrategyCosts {
            oracles: self,
            name,
            stems: Mutex::default(),
        }
    }

    /// The uncomputation strategy of the scene's circuits: under `uncompute: auto`, the cheapest one for
    /// the most expensive oracle under which all oracles fit into `budget.qubits`. It is searched for
    /// once per scene, and once for each [`Oracles::of_pixel`].
    ///
    /// # Errors
    /// As [`super::Oracle::new`].
    pub fn strategy(&self) -> Result<Strategy, OracleError> {
        let scene = self.scene();
        if let Some(strategy) = Strategy::from_uncompute(scene.scene().circuit.uncompute) {
            return Ok(strategy);
        }
        if self.pixel().is_some() {
            if let Some(strategy) = self.strategy.get() {
                return Ok(*strategy);
            }
            let strategy = auto(self)?;
            return Ok(*self.strategy.get_or_init(|| strategy));
        }
        let all = Strategy::all();
        let cached = scene.strategy_cache().get();
        if let Some(strategy) = cached.and_then(|&number| all.get(number)) {
            return Ok(*strategy);
        }
        let strategy = auto(self)?;
        if let Some(number) = all.iter().position(|one| *one == strategy) {
            let _ = scene.strategy_cache().set(number);
        }
        Ok(strategy)
    }
}

fn auto(oracles: &Oracles<'_>) -> Result<Strategy, OracleError> {
    let budget = oracles.scene().scene().budget;
    let Some(most) = budget.and_then(|budget| budget.qubits) else {
        return Ok(Strategy::KEEP);
    };
    let keep = oracles.costs_under(Strategy::KEEP)?;
    if CallCost::greatest(&keep).qubits <= most {
        return Ok(Strategy::KEEP);
    }
    let name = most_expensive_of(&keep).name;
    let layouts = oracles.layouts(name);
    let figures = |strategy| -> Result<(u64, u64), OracleError> {
        let costs = oracles.costs_under(strategy)?;
        let own = costs.iter().find(|cost| cost.name == name);
        let own = own.map_or(0, |cost| cost.call.qubits);
        Ok((own, CallCost::greatest(&costs).qubits))
    };
    fitting(most, |qubits| layouts.cheapest(qubits), figures)
}

/// The strategy that `cheapest` finds for `most` qubits, or for fewer until every oracle has at most `most`.
/// `figures` are the qubits of the oracle that `cheapest` optimizes, and the most of any oracle. If not all
/// oracles can fit, the result is the last strategy tried.
fn fitting(
    most: u64,
    cheapest: impl Fn(u64) -> Result<Strategy, OracleError>,
    figures: impl Fn(Strategy) -> Result<(u64, u64), OracleError>,
) -> Result<Strategy, OracleError> {
    let mut allowed = most;
    loop {
        let strategy = cheapest(allowed)?;
        let (own, greatest) = figures(strategy)?;
        let over = greatest.saturating_sub(most);
        if over == 0 || own > allowed {
            return Ok(strategy);
        }
        // Under another strategy, other oracles exceed this one by about the same number of qubits.
        allowed = own.saturating_sub(over);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_scene::front::load;
    use qrt_tracer::PixelClass;

    /// The costs without programs, against the programs of the same oracles.
    fn assert_costs(file: &str, sets: &[&str], strategies: &[Strategy]) {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes-yaml/");
        let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        let scene = load(format!("{root}{file}").as_ref(), &sets).unwrap().valid;
        let oracles = Oracles::new(&scene);
        let name = OracleName {
            channel: 2,
            class: PixelClass::default(),
            of_all_pixels: false,
        };
        let layouts = oracles.layouts(name);
        for &strategy in strategies {
            let recording = oracles.recording(name.class, strategy).unwrap();
            let oracle = recording.oracle_under(strategy, &[name.channel]);
            let whole = oracle.whole(0);
            let costs = lower::tally(&whole);
            let left = lower::with_ghosts(&whole);
            let left = costs.iter().zip(left).filter(|(_, left)| *left);
            let expected = StrategyCost {
                strategy,
                cost: CallCost {
                    qubits: lower::size(&whole).qubits.into(),
                    toffoli: costs.iter().map(|cost| cost.toffoli).sum(),
                },
                and_measured: costs.iter().map(|cost| cost.and_measured).sum(),
                and_with_ghosts: left.map(|(cost, _)| cost.and_measured).sum(),
            };
            let found = layouts.under(strategy).unwrap();
            assert_eq!(found, expected, "{file} {strategy}");
            assert_eq!(layouts.call(strategy).unwrap(), expected.cost);
        }
    }

    #[test]
    fn costs_are_those_of_the_programs_gates() {
        let all = Strategy::all();
        let some: Vec<Strategy> = all.iter().copied().step_by(11).collect();
        assert_costs("small/shadow.yaml", &[], &some);
        assert_costs("floor-and-light.yaml", &[], &some[40..]);
        let ends = [Strategy::PEBBLED, Strategy::SCOPED.running_again()];
        assert_costs("small/corner.yaml", &[], &ends);
        assert_costs("knot.yaml", &["precision.fraction=10"], &[Strategy::SCOPED]);
    }

    /// Another oracle may need more qubits than the one with the most Toffolis.
    #[test]
    fn a_strategy_fits_with_all_oracles() {
        // By Toffolis: own qubits, and the most of any oracle.
        let front = [(100, 103), (90, 94), (80, 81), (70, 70)];
        let place = |strategy: Strategy| {
            let front = Strategy::all().into_iter().take(front.len());
            front.into_iter().position(|one| one == strategy).unwrap()
        };
        let cheapest = |qubits| {
            let fits = front.iter().position(|(own, _)| *own <= qubits);
            Ok(Strategy::all()[fits.unwrap_or(front.len() - 1)])
        };
        let figures = |strategy| Ok(front[place(strategy)]);
        for (most, expected) in [(103, 0), (102, 1), (100, 1), (93, 2), (80, 3), (60, 3)] {
            let found = fitting(most, cheapest, figures).unwrap();
            assert_eq!(place(found), expected, "{most}");
        }
    }
}
