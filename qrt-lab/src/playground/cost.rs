//! The cost of a scene's oracle.

use super::{Answer, Refused};
use crate::draw;
use qrt_core::inspect::{CallPart, Inspection};
use qrt_core::oracle::Oracles;
use qrt_scene::valid::ValidScene;

/// Answers the costs of the most expensive of the scene's oracles, as `qrt inspect` reports them,
/// its stages in the order of computation, and its drawing.
pub(super) fn cost(scene: &ValidScene) -> Result<Answer, Refused> {
    let inspection = Inspection::most_expensive(&Oracles::new(scene), None)?;
    let total = inspection.total();
    let stages = inspection.stages();
    let computed: Vec<_> = stages
        .iter()
        .filter(|stage| stage.part == CallPart::Compute)
        .collect();
    let names: Vec<String> = computed.iter().map(|s| s.name.to_string()).collect();
    let depths = computed.iter().map(|stage| {
        let depth = stage.depth.map(i64::from);
        depth.map_or(-1.0, |depth| depth as f64)
    });
    let name = scene.scene().name.as_str();
    Ok(Answer::default()
        .text("channel", inspection.name.channel_name())
        .text("pixels", inspection.name.pixels())
        .number("toffoli", total.toffoli as f64)
        .number("and_measured", total.and_measured as f64)
        .number("cnot", total.cnot as f64)
        .number("qubits", inspection.qubits.into())
        .number("toffoli_depth", inspection.toffoli_depth as f64)
        .lines("stages", &names)
        .list("depths", depths)
        .list(
            "toffolis",
            computed.iter().map(|stage| stage.cost.toffoli as f64),
        )
        .text("svg", draw::frame(&inspection, name).svg()))
}
