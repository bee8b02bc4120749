//! Qubits against gates: the cost of a scene's circuit under every strategy.

use crate::workers::{Progress, ThreadsError, Workers};
use qrt_core::compile::Strategy;
use qrt_core::oracle::{Layout, Layouts, OracleError};
use qrt_core::tracer::PixelClass;
use qrt_drawing::{Axis, Canvas, Drawn, Plot, Series};
use qrt_scene::valid::ValidScene;
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

/// Returns the Pareto front of layouts in qubits and Toffolis, for a channel's oracle for pixels of
/// `class`. The layout with the fewest Toffolis is first. Each strategy of [`Strategy::all`] is
/// compiled.
///
/// # Errors
/// If the scene has no circuit, threads can't be started, or the work is cancelled.
pub fn front(
    scene: &ValidScene,
    channel: usize,
    class: PixelClass,
    workers: &Workers<'_>,
) -> Result<Vec<Layout>, LayoutsError> {
    let all = Strategy::all();
    workers.report(Progress::Started {
        total: all.len() as u64,
        resumed: 0,
    });
    let traced = Layouts::of_class(scene, channel, class);
    let layout = |strategy: &Strategy| {
        if workers.cancelled() {
            return Err(LayoutsError::Cancelled);
        }
        let layout = traced.under(*strategy).map_err(LayoutsError::Oracle);
        workers.report(Progress::Finished(1));
        layout
    };
    let layouts: Result<Vec<Layout>, LayoutsError> =
        workers.on_threads(|| all.par_iter().map(layout).collect())?;
    Ok(Layout::front(layouts?))
}

/// Draws the front: qubits to the right and Toffolis upwards. A second series has the ANDs that
/// remain if measurements undo them.
pub fn drawing(front: &[Layout], scene: &str) -> Canvas {
    let points = |of: fn(&Layout) -> u64| {
        let places = front.iter();
        places.map(move |layout| (layout.cost.qubits as f64, of(layout) as f64))
    };
    let toffoli = points(|layout| layout.cost.toffoli);
    let measured = points(|layout| layout.and_measured);
    let plot = Plot {
        title: format!("{scene}: one call of the oracle"),
        x: Axis::log("qubits"),
        y: Axis::log("gates"),
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
    use qrt_scene::front::load;

    #[test]
    fn the_front_of_a_room_goes_from_few_gates_to_few_qubits() {
        let file = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../scenes-yaml/floor-and-light.yaml"
        );
        let scene = load(file.as_ref(), &[]).unwrap().valid;
        let front = front(&scene, 0, PixelClass::default(), &Workers::default()).unwrap();
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
