//! Qubits against gates: the cost of a scene's circuit under every strategy.

use qrt_core::compile::Strategy;
use qrt_core::oracle::{
    CallCost, OracleCost, OracleError, OracleName, Oracles, StrategyCost, StrategyCosts,
};
use qrt_drawing::{Canvas, Drawn, Plot, PlotAxis, Series};
use qrt_runtime::workers::{Progress, ThreadsError, Workers};
use rayon::prelude::*;

/// Reason for which there are no layouts.
#[derive(Debug, thiserror::Error)]
pub enum LayoutsError {
    /// The scene has no circuit.
    #[error("{0}")]
    Oracle(OracleError),
    /// The threads can't be started.
    #[error(transparent)]
    Threads(#[from] ThreadsError),
    /// The cancel flag of the workers ended the search.
    #[error("cancelled")]
    Cancelled,
}

/// Returns the Pareto front of the layouts of an oracle in qubits and Toffolis. The layout with the
/// fewest Toffolis is first. The oracle is assembled under each strategy of [`Strategy::all`].
///
/// # Errors
/// If the scene has no circuit, threads can't be started, or the work is cancelled.
pub fn front(
    oracle: &StrategyCosts<'_>,
    workers: &Workers<'_>,
) -> Result<Vec<StrategyCost>, LayoutsError> {
    let all = Strategy::all();
    workers.report(Progress::Started {
        total: all.len() as u64,
        resumed: 0,
    });
    let call = |&place: &usize| {
        if workers.cancelled() {
            return Err(LayoutsError::Cancelled);
        }
        let call = oracle.call(all[place]).map_err(LayoutsError::Oracle)?;
        workers.report(Progress::Finished(1));
        Ok((place, call))
    };
    let mut calls: Vec<(usize, CallCost)> = Vec::with_capacity(all.len());
    for group in Strategy::groups(&all) {
        let found: Result<Vec<_>, _> =
            workers.on_threads(|| group.par_iter().map(call).collect())?;
        calls.extend(found?);
    }
    // Of strategies with one cost, the first is in the front.
    calls.sort_unstable_by_key(|(place, _)| *place);
    let calls = calls.into_iter().map(|(place, call)| (call, all[place]));
    let front = CallCost::front(calls.collect());
    let layout = |(_, strategy): &(CallCost, Strategy)| {
        if workers.cancelled() {
            return Err(LayoutsError::Cancelled);
        }
        oracle.under(*strategy).map_err(LayoutsError::Oracle)
    };
    workers.on_threads(|| front.par_iter().map(layout).collect())?
}

/// Returns the oracle with the most Toffolis, of `channel` or of all channels, and its front: see [`front`].
///
/// # Errors
/// As [`front`].
pub fn front_of_most_expensive(
    oracles: &Oracles<'_>,
    channel: Option<usize>,
    workers: &Workers<'_>,
) -> Result<(OracleName, Vec<StrategyCost>), LayoutsError> {
    let costs = oracles.costs_under(Strategy::KEEP);
    let costs = costs.map_err(LayoutsError::Oracle)?.into_iter();
    let asked = costs.filter(|cost| channel.is_none_or(|one| one == cost.name.channel));
    let Some(OracleCost { name, .. }) = OracleCost::most_expensive(asked) else {
        unreachable!("the pixels of a film have a class, which has three channels");
    };
    let front = front(&oracles.layouts(name), workers)?;
    Ok((name, front))
}

/// Draws the front: qubits to the right and Toffolis upwards. A second series has the ANDs that
/// remain if measurements undo them.
pub fn drawing(front: &[StrategyCost], scene: &str) -> Canvas {
    let points = |of: fn(&StrategyCost) -> u64| {
        let places = front.iter();
        places.map(move |layout| (layout.cost.qubits as f64, of(layout) as f64))
    };
    let toffoli = points(|layout| layout.cost.toffoli);
    let measured = points(|layout| layout.and_measured);
    let plot = Plot {
        title: format!("{scene}: one call of the oracle"),
        x: PlotAxis::log("qubits"),
        y: PlotAxis::log("gates"),
        series: vec![
            Series::new("Toffoli", toffoli, Drawn::Steps),
            Series::new("AND, undone by measurement", measured, Drawn::Steps),
        ],
    };
    plot.draw()
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_core::oracle::Oracles;
    use qrt_scene::front::load;

    #[test]
    fn the_front_of_a_room_goes_from_few_gates_to_few_qubits() {
        let file = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../scenes-yaml/floor-and-light.yaml"
        );
        let scene = load(file.as_ref(), &[]).unwrap().valid;
        let oracles = Oracles::new(&scene);
        let oracle = oracles.layouts(oracles.names()[0]);
        let front = front(&oracle, &Workers::default()).unwrap();
        assert_eq!(front[0].strategy, Strategy::KEEP);
        assert!(front.len() > 5, "{}", front.len());
        for pair in front.windows(2) {
            assert!(pair[0].cost.toffoli < pair[1].cost.toffoli);
            assert!(pair[0].cost.qubits > pair[1].cost.qubits);
            assert!(pair[0].and_measured < pair[0].cost.toffoli);
        }
        let svg = drawing(&front, "floor").svg();
        assert!(svg.contains("Toffoli") && svg.contains("measurement"));
    }
}
