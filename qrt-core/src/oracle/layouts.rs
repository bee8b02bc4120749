//! What a scene's circuit costs under each strategy: qubits against gates.

use super::recording::{PrimaryHit, Recording};
use super::{CallCost, Options, Oracle, OracleError};
use crate::compile::Strategy;
use crate::scene::Uncompute;
use crate::valid::ValidScene;
use qrt_circuit::lower;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// A way to lay out the circuit of a scene's channel, and what one call of it costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// What is undone when.
    pub strategy: Strategy,
    /// Qubits and Toffolis.
    pub cost: CallCost,
    /// How many ANDs there are if measurements undo them.
    pub and_measured: u64,
    /// An estimate: how many of those would be left on the same qubits if what is undone early were
    /// measured, and left ghosts until it is computed again: see [`lower::with_ghosts`].
    pub and_with_ghosts: u64,
}

impl Layout {
    /// The layout of a channel's oracle (0 red, 1 green, 2 blue) under `strategy`.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn new(
        scene: &ValidScene,
        channel: usize,
        strategy: Strategy,
    ) -> Result<Self, OracleError> {
        let options = Options {
            strategy: Some(strategy),
            ..Options::default()
        };
        let oracle = Oracle::new(scene, channel, options)?;
        Ok(Self::of(&oracle, strategy))
    }

    fn of(oracle: &Oracle, strategy: Strategy) -> Self {
        let whole = oracle.whole(0);
        let mut known = HashMap::new();
        let (mut toffoli, mut and_measured, mut and_with_ghosts) = (0, 0, 0);
        let left = lower::with_ghosts(&whole);
        for (instruction, left) in whole.instructions.iter().zip(left) {
            let costs = known.entry(instruction.op).or_insert_with(|| {
                let op = &whole.ops[instruction.op as usize];
                lower::costs(op, |register| whole.width(register))
            });
            let cost = &costs[usize::from(instruction.inverse)];
            toffoli += cost.toffoli;
            and_measured += cost.and_measured;
            and_with_ghosts += if left { cost.and_measured } else { 0 };
        }
        let cost = CallCost {
            qubits: u64::from(oracle.qubits()),
            toffoli,
        };
        Self {
            strategy,
            cost,
            and_measured,
            and_with_ghosts,
        }
    }

    /// The layout of the most expensive channel, and which that is.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn of_most_expensive(
        scene: &ValidScene,
        strategy: Strategy,
    ) -> Result<(usize, Self), OracleError> {
        let (mut number, mut most) = (0, Self::new(scene, 0, strategy)?);
        for channel in 1..3 {
            let other = Self::new(scene, channel, strategy)?;
            if other.cost.toffoli > most.cost.toffoli {
                (number, most) = (channel, other);
            }
        }
        Ok((number, most))
    }

    /// Those that no other beats in qubits without more Toffolis, or in Toffolis without more
    /// qubits; the one with the fewest Toffolis first.
    pub fn front(mut layouts: Vec<Self>) -> Vec<Self> {
        layouts.sort_by_key(|layout| (layout.cost.toffoli, layout.cost.qubits));
        let mut least = u64::MAX;
        layouts.retain(|layout| {
            let fewer = layout.cost.qubits < least;
            least = least.min(layout.cost.qubits);
            fewer
        });
        layouts
    }
}

/// The layouts of a channel's oracle, which is traced once for all strategies that need the same
/// recording.
pub struct Layouts<'a> {
    scene: &'a ValidScene,
    channel: usize,
    recordings: [Mutex<Option<Recording>>; Strategy::RECORDINGS],
}

impl<'a> Layouts<'a> {
    /// Those of channel 0 red, 1 green or 2 blue.
    pub fn new(scene: &'a ValidScene, channel: usize) -> Self {
        Self {
            scene,
            channel,
            recordings: std::array::from_fn(|_| Mutex::new(None)),
        }
    }

    /// The one under `strategy`: as [`Layout::new`].
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn under(&self, strategy: Strategy) -> Result<Layout, OracleError> {
        let oracle = {
            let recording = &self.recordings[strategy.recording()];
            let mut recording = recording.lock().unwrap_or_else(PoisonError::into_inner);
            let recording = match &mut *recording {
                Some(recording) => recording,
                none => {
                    let options = Options {
                        strategy: Some(strategy),
                        ..Options::default()
                    };
                    let traced = PrimaryHit::Traced;
                    none.insert(Recording::new(self.scene, [self.channel], options, traced)?)
                }
            };
            recording.lay_out(strategy);
            recording.oracle(&[0])
        };
        Ok(Layout::of(&oracle, strategy))
    }
}

/// The strategy of a scene's circuits. `auto` is the cheapest of [`Strategy::LADDER`] with which the
/// dearest channel's oracle fits into `budget.qubits`; the one with the fewest qubits if none does.
pub(super) fn strategy_of(scene: &ValidScene) -> Result<Strategy, OracleError> {
    let written = scene.scene();
    match written.circuit.uncompute {
        Uncompute::Keep => return Ok(Strategy::KEEP),
        Uncompute::Scoped => return Ok(Strategy::SCOPED),
        Uncompute::Auto => {}
    }
    let Some(most) = written.budget.and_then(|budget| budget.qubits) else {
        return Ok(Strategy::KEEP);
    };
    let (channel, keep) = Layout::of_most_expensive(scene, Strategy::KEEP)?;
    if keep.cost.qubits <= most {
        return Ok(Strategy::KEEP);
    }
    let all = Layouts::new(scene, channel);
    let others = Strategy::LADDER.iter();
    let layouts: Result<Vec<Layout>, OracleError> =
        others.map(|&strategy| all.under(strategy)).collect();
    let layouts = layouts?.into_iter();
    let fits = layouts.clone().filter(|layout| layout.cost.qubits <= most);
    let cheapest = fits.min_by_key(|layout| (layout.cost.toffoli, layout.cost.qubits));
    let leanest = || layouts.min_by_key(|layout| (layout.cost.qubits, layout.cost.toffoli));
    let chosen = cheapest.or_else(leanest);
    Ok(chosen.map_or(Strategy::SCOPED, |layout| layout.strategy))
}
