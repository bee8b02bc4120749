//! The front of qubits against gates.

use qrt_core::inspect::OraclePixel;
use qrt_core::oracle::{OracleName, StrategyCost};
use serde_json::{Value, json};

/// Returns the front of qubits against gates of a scene called `name`: of `oracle`, which is that of
/// `pixel` alone if there is one.
pub fn pareto(
    name: &str,
    oracle: OracleName,
    pixel: Option<OraclePixel>,
    front: &[StrategyCost],
) -> Value {
    let layouts = front.iter().map(|layout| {
        json!({
            "qubits": layout.cost.qubits,
            "toffoli": layout.cost.toffoli,
            "and_measured": layout.and_measured,
            "estimated_and_with_ghosts": layout.and_with_ghosts,
            "strategy": layout.strategy.to_string(),
        })
    });
    json!({
        "scene": name,
        "channel": oracle.channel_name(),
        "class": oracle.class_name(),
        "pixel": pixel.map(|pixel| pixel.place),
        "front": layouts.collect::<Vec<_>>(),
    })
}
