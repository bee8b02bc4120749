//! Prints the figures of `qrt inspect` for people, within 100 columns.

use qrt_circuit::lower::Cost;
use qrt_core::compile::Role;
use qrt_core::inspect::{BlockFigures, CallPart, CallStage, Inspection, grouped};
use qrt_core::oracle::PARTS_OF_A_CALL;
use qrt_lab::inspect::{InspectFigures, MOST_OPS};
use qrt_scene::{Uncompute, Window};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The width in columns of a row's name, with its branches.
const NAME: usize = 28;
/// The width in columns of an oracle's name.
const NAMES: usize = 40;

/// Returns the figures as text; with `planes`, each plane of each search. `channel_is_asked` says that the
/// channel was on the command line.
pub(super) fn text(shown: &InspectFigures<'_>, channel_is_asked: bool, planes: bool) -> String {
    let mut out = String::new();
    if let Some(plan) = shown.plan {
        let _ = writeln!(out, "{plan}");
    }
    headline(&mut out, shown, channel_is_asked);
    out.push('\n');
    oracles(&mut out, shown);
    out.push('\n');
    costs(&mut out, &shown.inspection, planes);
    out.push('\n');
    passes(&mut out, shown);
    out.push('\n');
    registers(&mut out, &shown.inspection);
    out.lines()
        .flat_map(|line| [line.trim_end(), "\n"])
        .collect()
}

fn headline(out: &mut String, shown: &InspectFigures<'_>, channel_is_asked: bool) {
    let InspectFigures {
        scene, inspection, ..
    } = shown;
    let written = scene.scene();
    let oracle = &inspection.oracle;
    let total = inspection.total();
    let undone = match written.circuit.uncompute {
        Uncompute::Auto => format!("auto ({})", inspection.strategy),
        written => written.to_string(),
    };
    let _ = writeln!(
        out,
        "{}: one call of the oracle, O_f = {PARTS_OF_A_CALL}",
        name(&written.name),
    );
    let _ = writeln!(
        out,
        "{}{}",
        inspection.which(),
        why_shown(shown, channel_is_asked)
    );
    let _ = writeln!(
        out,
        "{} path bits, {}, {} comparator bits, {} fraction bits, uncompute {undone}, nearest {}\n",
        oracle.points.path_bits(),
        match written.sampling.depths.len() {
            1 => "1 depth".to_owned(),
            depths => format!("{depths} depths"),
        },
        oracle.comparator_bits(),
        oracle.fraction,
        written.circuit.nearest,
    );
    let figures = [
        (u64::from(inspection.qubits), "qubits"),
        (total.toffoli, "Toffoli"),
        (total.and_measured, "AND, if they are undone by measurement"),
        (inspection.toffoli_depth, "Toffoli depth"),
        (inspection.toffoli_x_qubits(), "Toffoli x qubits"),
    ];
    let figures = figures.map(|(number, what)| (grouped(number), what));
    let width = figures.iter().map(|(number, _)| number.len()).max();
    let width = width.unwrap_or(0) + 2;
    for (number, what) in figures {
        let _ = writeln!(out, "{number:>width$} {what}");
    }
    if inspection.pixel.is_some() {
        out.push('\n');
        complete(out, inspection, written.counting.register_window());
    }
    if let Some(counts) = shown.counts {
        let _ = writeln!(out, "{}", counts.in_words());
    }
}

/// Writes what of a pixel's circuit is a table of path bits, and how many qubits the complete counting
/// circuit takes.
fn complete(out: &mut String, inspection: &Inspection, window: Window) {
    let tables = inspection.toffolis_of_tables();
    let all = inspection.total().toffoli;
    let share = 100.0 * tables as f64 / all.max(1) as f64;
    let _ = writeln!(
        out,
        "{} of the {} Toffolis look up tables of path bits ({share:.0} %)",
        grouped(tables),
        grouped(all)
    );
    let qubits = [2, 3, 4, 6, 8].map(|bits| {
        let qubits = u64::from(inspection.complete_qubits(bits, window));
        format!("{} at t = {bits}", grouped(qubits))
    });
    let _ = writeln!(
        out,
        "qubits with all of counting, for t phase bits: {}",
        qubits.join(", ")
    );
}

/// Returns the reason that this oracle is shown.
fn why_shown(shown: &InspectFigures<'_>, channel_is_asked: bool) -> String {
    let InspectFigures {
        inspection, costs, ..
    } = shown;
    if let Some(pixel) = inspection.pixel {
        return format!(", seed {}: as `qrt export` writes it", pixel.seed);
    }
    if channel_is_asked {
        let name = inspection.name;
        let rivals = costs
            .iter()
            .filter(|cost| cost.name.channel == name.channel);
        return match rivals.count() {
            0 | 1 => String::new(),
            n => format!(": of the channel's {n} oracles the one with the most Toffolis"),
        };
    }
    let n = costs.len();
    format!(": of the scene's {n} oracles the one with the most Toffolis")
}

/// Writes the table of all oracles of the scene.
fn oracles(out: &mut String, shown: &InspectFigures<'_>) {
    let InspectFigures {
        inspection, costs, ..
    } = shown;
    let _ = writeln!(
        out,
        "{:<NAMES$}{:>14}{:>15}",
        "oracles of the scene", "Toffoli", "qubits"
    );
    for cost in costs {
        // The oracle of a pixel alone is none of them.
        let mark = if cost.name == inspection.name && inspection.pixel.is_none() {
            '*'
        } else {
            ' '
        };
        let _ = writeln!(
            out,
            "{:<NAMES$}{:>14}{:>15}",
            format!("{mark} {}", cost.name),
            grouped(cost.call.toffoli),
            grouped(cost.call.qubits),
        );
    }
}

/// Returns a scene's name on one line, cut to 24 characters.
fn name(name: &str) -> String {
    let plain = name.chars().map(|c| if c.is_control() { ' ' } else { c });
    let text: String = plain.clone().take(24).collect();
    if plain.count() > 24 {
        format!("{}...", text.trim_end())
    } else {
        text
    }
}

/// Writes a row of the table of costs.
fn row(out: &mut String, branch: &str, name: &str, cost: Cost, all: u64, qubits: Option<u32>) {
    let percent = match all {
        0 => String::new(),
        _ => format!("{:.1}", 100.0 * cost.toffoli as f64 / all as f64),
    };
    let _ = writeln!(
        out,
        "{:<NAME$}{:>14}{percent:>6}{:>14}{:>15}{:>12}{:>11}",
        format!("{branch}{name}"),
        grouped(cost.toffoli),
        grouped(cost.and_measured),
        grouped(cost.cnot),
        grouped(cost.x),
        qubits.map_or_else(String::new, |qubits| grouped(u64::from(qubits))),
    );
}

fn costs(out: &mut String, inspection: &Inspection, planes: bool) {
    let all = inspection.total().toffoli;
    let _ = writeln!(
        out,
        "{:<NAME$}{:>14}{:>6}{:>14}{:>15}{:>12}{:>11}",
        "", "Toffoli", "%", "measured AND", "CNOT", "X", "qubits"
    );
    let part = |out: &mut String, part: CallPart| {
        let qubits = inspection.peak(inspection.instructions(part));
        let cost = inspection.part(part);
        row(out, "", part.name(), cost, all, Some(qubits));
    };
    part(out, CallPart::Compute);
    let mut stages = inspection.stages();
    stages.retain(|stage| stage.part == CallPart::Compute);
    let merged = inspection.merged_blocks();
    for stage in &mut stages {
        stage.block = stage.block.map(|block| merged[block.index()]);
    }
    let all_blocks = inspection.blocks();
    let blocks = |stage: &CallStage| blocks_of(inspection, &all_blocks, &stages, stage);
    let stages = stages.iter();
    let mut depths: Vec<(Option<u32>, Vec<&CallStage>)> = Vec::new();
    for stage in stages {
        match depths.last_mut() {
            Some((depth, stages)) if *depth == stage.depth => stages.push(stage),
            _ => depths.push((stage.depth, vec![stage])),
        }
    }
    for (place, (depth, stages)) in depths.iter().enumerate() {
        let last = place + 1 == depths.len();
        let (branch, below) = branches(last);
        match depth {
            Some(depth) => {
                let cost = stages.iter().map(|stage| stage.cost).sum();
                let qubits = stages.iter().map(|stage| stage.qubits).max();
                row(out, branch, &format!("depth {depth}"), cost, all, qubits);
                for (place, stage) in stages.iter().enumerate() {
                    let (branch, further) = branches(place + 1 == stages.len());
                    let branch = format!("{below}{branch}");
                    row(
                        out,
                        &branch,
                        &stage.name.to_string(),
                        stage.cost,
                        all,
                        Some(stage.qubits),
                    );
                    let below = format!("{below}{further}");
                    within(out, &below, &blocks(stage), all, planes);
                }
            }
            None => {
                for (n, stage) in stages.iter().enumerate() {
                    let (branch, below) = branches(last && n + 1 == stages.len());
                    row(
                        out,
                        branch,
                        &stage.name.to_string(),
                        stage.cost,
                        all,
                        Some(stage.qubits),
                    );
                    within(out, below, &blocks(stage), all, planes);
                }
            }
        }
    }
    part(out, CallPart::Flip);
    part(out, CallPart::Uncompute);
    let total = inspection.total();
    row(out, "", "O_f", total, all, Some(inspection.qubits));
}

/// Returns the branch to a row, and the line past the rows below it.
fn branches(last: bool) -> (&'static str, &'static str) {
    if last {
        ("\u{2514} ", "  ")
    } else {
        ("\u{251c} ", "\u{2502} ")
    }
}

/// Returns the block of a stage, followed by the blocks within it. If other `stages` are parts of the same
/// block, only the blocks that have a part in this stage, with the costs of these parts.
fn blocks_of(
    inspection: &Inspection,
    blocks: &[BlockFigures],
    stages: &[CallStage],
    stage: &CallStage,
) -> Vec<BlockFigures> {
    let mut blocks = blocks.iter();
    let Some(own) = blocks.find(|block| Some(block.block) == stage.block) else {
        return Vec::new();
    };
    let inner = blocks.take_while(|block| block.level > own.level);
    let mut blocks: Vec<BlockFigures> = [own].into_iter().chain(inner).cloned().collect();
    if stages.iter().filter(|one| one.block == stage.block).count() > 1 {
        let parts = inspection.blocks_in(stage.instructions.clone());
        blocks.retain_mut(|block| {
            let part = parts.get(&block.block);
            block.compute = part.copied().unwrap_or_default();
            part.is_some()
        });
    }
    blocks
}

/// Writes the blocks within a stage, the first of `blocks`: those of one kind (`plane 0`, `plane 1`) added up,
/// or with `each`, one by one.
fn within(out: &mut String, below: &str, blocks: &[BlockFigures], all: u64, each: bool) {
    let Some((own, inner)) = blocks.split_first() else {
        return;
    };
    let level = own.level;
    let inner: Vec<&BlockFigures> = inner.iter().collect();
    // Each chunk is a block with the blocks within it.
    let own = inner.chunk_by(|_, next| next.level > level + 1);
    let mut kinds: BTreeMap<&str, Vec<&[&BlockFigures]>> = BTreeMap::new();
    for blocks in own {
        let kind = blocks[0].label.stage.kind();
        kinds.entry(kind).or_default().push(blocks);
    }
    let rows: Vec<(String, Cost)> = kinds
        .iter()
        .flat_map(|(kind, blocks)| {
            let total = blocks.iter().map(|block| block[0].compute).sum();
            let count = grouped(blocks.len() as u64);
            let name = match (*kind, blocks.len()) {
                (kind, 1) => kind.to_owned(),
                ("body", _) => "bodies".to_owned(),
                (kind, _) => format!("{kind}s"),
            };
            let mut rows = vec![(format!("{count} {name}"), total)];
            if each {
                rows.extend(blocks.iter().copied().flatten().map(|block| {
                    let indent = 2 * (block.level - level) as usize;
                    let name = format!("{:indent$}{}", "", block.label.stage);
                    (name, block.compute)
                }));
            }
            rows
        })
        .collect();
    for (place, (name, cost)) in rows.iter().enumerate() {
        let branch = format!("{below}{}", branches(place + 1 == rows.len()).0);
        row(out, &branch, name, *cost, all, None);
    }
}

fn passes(out: &mut String, shown: &InspectFigures<'_>) {
    if shown.passes.is_empty() {
        let most = grouped(MOST_OPS as u64);
        let _ = writeln!(out, "passes are not compared: more than {most} operations");
        return;
    }
    let _ = writeln!(
        out,
        "{:<NAME$}{:>14}{:>6}{:>14}{:>15}{:>20}",
        "passes, one after another", "Toffoli", "%", "operations", "qubits", "Toffoli removed"
    );
    let all = shown.passes.first().map_or(0, |first| first.toffoli);
    let mut before = all;
    for pass in &shown.passes {
        let percent = match all {
            0 => String::new(),
            _ => format!("{:.1}", 100.0 * pass.toffoli as f64 / all as f64),
        };
        let change = match (pass.name, pass.toffoli <= before) {
            ("none", _) => String::new(),
            (_, true) => grouped(before - pass.toffoli),
            (_, false) => format!("-{}", grouped(pass.toffoli - before)),
        };
        let _ = writeln!(
            out,
            "{:<NAME$}{:>14}{percent:>6}{:>14}{:>15}{change:>20}",
            format!("  {}", pass.name),
            grouped(pass.toffoli),
            grouped(pass.ops),
            grouped(u64::from(pass.qubits)),
        );
        before = pass.toffoli;
    }
}

fn registers(out: &mut String, inspection: &Inspection) {
    let mut count = [(0_u64, 0_u64); Role::ALL.len()];
    for (place, register) in inspection.whole.registers.iter().enumerate() {
        let used = inspection
            .layout
            .offset(qrt_circuit::RegisterId(place as u32));
        if let (Some(_), Some(role)) = (
            used,
            Role::ALL
                .iter()
                .position(|&role| role == Role::from_register(register)),
        ) {
            count[role].0 += 1;
            count[role].1 += u64::from(register.width);
        }
    }
    let (peak, ancillas) = inspection.peak_by_role();
    let _ = writeln!(
        out,
        "{:<NAME$}{:>14}{:>6}{:>14}{:>15}",
        "registers by role", "registers", "", "qubits", "at the peak"
    );
    for ((role, (registers, qubits)), peak) in Role::ALL.iter().zip(count).zip(peak) {
        let _ = writeln!(
            out,
            "{:<NAME$}{:>14}{:>6}{:>14}{:>15}",
            format!("  {role}"),
            grouped(registers),
            "",
            grouped(qubits),
            grouped(u64::from(peak)),
        );
    }
    let ancillas = grouped(u64::from(ancillas));
    let _ = writeln!(
        out,
        "{:<NAME$}{:>49}",
        "  ancillas of an operation", ancillas
    );
}
