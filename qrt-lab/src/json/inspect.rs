//! The cost of an oracle and its parts.

use crate::inspect::InspectFigures;
use crate::verify::PixelCounts;
use qrt_circuit::lower::Cost;
use qrt_core::compile::{Label, Role};
use qrt_core::inspect::{CallPart, Inspection};
use qrt_core::oracle::{OracleCost, PARTS_OF_A_CALL};
use serde_json::{Map, Value, json};

/// Returns all figures. Costs are those of one whole call of the oracle unless said otherwise.
pub fn inspect(figures: &InspectFigures<'_>) -> Value {
    let InspectFigures {
        scene,
        inspection,
        costs,
        passes,
        plan,
        counts,
    } = figures;
    let written = scene.scene();
    let oracle = &inspection.oracle;
    let (roles, ancillas) = inspection.peak_by_role();
    let mut by_role: Map<String, Value> = Role::ALL
        .iter()
        .zip(roles)
        .map(|(role, qubits)| (role.to_string(), json!(qubits)))
        .collect();
    by_role.insert("ancilla".to_owned(), json!(ancillas));
    let mut gates = cost(inspection.total());
    gates["toffoli_depth"] = json!(inspection.toffoli_depth);
    let parts: Map<String, Value> = ["compute", "flip", "uncompute"]
        .into_iter()
        .zip(CallPart::ALL)
        .map(|(name, part)| (name.to_owned(), cost(inspection.part(part))))
        .collect();
    let stages: Vec<Value> = inspection
        .stages()
        .iter()
        .filter(|stage| stage.part == CallPart::Compute)
        .map(|stage| {
            json!({
                "name": stage.name.to_string(),
                "depth": stage.depth,
                "compute": cost(stage.cost),
                "qubits": stage.qubits,
            })
        })
        .collect();
    let blocks: Vec<Value> = inspection
        .blocks()
        .iter()
        .map(|block| {
            json!({
                "path": block.path,
                "name": block.label.stage.to_string(),
                "depth": block.label.depth,
                "own": cost(block.own),
                "total": cost(block.total),
                "compute": cost(block.compute),
                "width": block.width,
            })
        })
        .collect();
    let steps: Vec<Value> = passes
        .windows(2)
        .map(|pair| {
            let [before, after] = [pair[0], pair[1]];
            json!({
                "name": after.name,
                "toffoli": { "before": before.toffoli, "after": after.toffoli },
                "ops": { "before": before.ops, "after": after.ops },
                "qubits": { "before": before.qubits, "after": after.qubits },
            })
        })
        .collect();
    let window = written.counting.register_window();
    let complete: Map<String, Value> = (1..=8)
        .map(|bits| {
            (
                bits.to_string(),
                json!(inspection.complete_qubits(bits, window)),
            )
        })
        .collect();
    let requested = passes.last().map_or([0; 2], |pass| pass.requested);
    json!({
        "version": 1,
        "qrt": env!("CARGO_PKG_VERSION"),
        "scene": written.name,
        "scene_hash": scene.fingerprint().to_string(),
        "channel": inspection.name.channel_name(),
        "class": inspection.name.class_name(),
        "pixel": inspection.pixel.map(|pixel| pixel.place),
        "seed": inspection.pixel.map(|pixel| pixel.seed),
        "toffolis_of_tables": inspection.toffolis_of_tables(),
        "complete_qubits": complete,
        "counts": counts.map(pixel_counts),
        "includes": PARTS_OF_A_CALL,
        "oracles": costs.iter().map(oracle_cost).collect::<Vec<_>>(),
        "fraction_bits": oracle.fraction,
        "comparator_bits": oracle.comparator_bits(),
        "path_bits": oracle.points.path_bits(),
        "plan": plan.map(super::plan),
        "depths": written.sampling.depths.len(),
        "strategy": written.circuit.uncompute.name(),
        "undone_early": inspection.strategy.to_string(),
        "nearest": written.circuit.nearest.name(),
        "qubits": { "peak": inspection.qubits, "by_role": by_role, "layout": inspection.layout.height },
        "gates": gates,
        "toffoli_x_qubits": inspection.toffoli_x_qubits(),
        "parts": parts,
        "stages": stages,
        "blocks": blocks,
        "passes": steps,
        "operations": { "asked": requested[0], "shared": requested[1] },
        "registers": registers(inspection),
    })
}

/// Returns a pixel's counts beside those of real numbers.
pub fn pixel_counts(counts: PixelCounts) -> Value {
    json!({
        "good": counts.good,
        "good_in_real": counts.good_in_real,
        "total": counts.total,
        "differing": counts.differing,
        "paths": counts.paths,
        "fraction_bits": counts.fraction,
        "agrees_at": counts.agrees_at,
    })
}

/// Returns the registers, in the order of their offsets' first use.
fn registers(inspection: &Inspection) -> Vec<Value> {
    let program = &inspection.whole;
    let mut seen = vec![false; program.registers.len()];
    let lifetimes = inspection.layout.lifetimes.iter();
    let firsts =
        lifetimes.filter(|lifetime| !std::mem::replace(&mut seen[lifetime.register.index()], true));
    firsts
        .map(|lifetime| {
            let register = &program.registers[lifetime.register.index()];
            let block = &program.blocks[register.block.index()];
            json!({
                "name": register.name,
                "type": register.ty.name(register.width),
                "offset": lifetime.offset,
                "width": register.width,
                "depth": Label::from_block(block).depth,
                "role": Role::from_register(register).to_string(),
                "block": block.name,
            })
        })
        .collect()
}

/// Returns the cost of one of a scene's oracles.
pub(crate) fn oracle_cost(cost: &OracleCost) -> Value {
    json!({
        "channel": cost.name.channel_name(),
        "class": cost.name.class_name(),
        "qubits": cost.call.qubits,
        "toffoli": cost.call.toffoli,
    })
}

/// Returns the gates of a circuit.
pub fn cost(cost: Cost) -> Value {
    json!({
        "toffoli": cost.toffoli,
        "and_measured": cost.and_measured,
        "cnot": cost.cnot,
        "x": cost.x,
    })
}
