//! The call in the paper's frame: wires and boxes, found in the program.
//!
//! A wire is a bundle of qubits. The path index, the comparator, the colour and the flag have wires
//! of their own. The values that a box computes *and another box reads* are one wire. All other
//! qubits, with the ancillas that operations borrow, are the wire `work`.

use super::{CallPart, CallStage, Inspection};
use crate::compile::{Role, StageName};
use qrt_circuit::lower::Cost;
use qrt_circuit::{Op, RegisterId};
use std::collections::BTreeSet;

/// A bundle of qubits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wire {
    /// The wire's name: `id`, `ray_0`, `nearest_0`, `colour`.
    pub name: String,
    /// The bounce that the wire belongs to, 0 for the primary ray; none for a wire of no ray.
    pub depth: Option<u32>,
    /// Number of qubits of the wire.
    pub qubits: u64,
    /// True if the wire holds a value before the first box.
    pub input: bool,
}

/// A box of the paper's figure: a stage of the call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DiagramBox {
    /// The title of the box: `Find Intersection 0`.
    pub name: String,
    /// The stage of the oracle.
    pub stage: StageName,
    /// The part of the call.
    pub part: CallPart,
    /// True if the box is the inverse of another.
    pub inverse: bool,
    /// The cost of the box in gates.
    pub cost: Cost,
    /// The wires that it reads and does not change, from the top.
    pub reads: Vec<usize>,
    /// The wires that it computes, or uncomputes if it is an inverse, from the top.
    pub writes: Vec<usize>,
}

/// The call as boxes on wires.
///
/// The path index, the comparator, the colour and the flag have wires of their own. The values that
/// a box computes and another box reads are one wire. All other qubits, with the ancillas that
/// operations borrow, are the wire `work`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CallDiagram {
    /// The wires from the top; the last is `work`.
    pub wires: Vec<Wire>,
    /// The boxes from the left, in the order in which they run.
    pub boxes: Vec<DiagramBox>,
}

/// The wire that a register is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Bundle {
    Id,
    Comparator,
    /// Registers that a stage computes, by the stage's index.
    Of(usize),
    Colour,
    Flag,
    Work,
}

impl CallDiagram {
    /// The diagram of an inspected call.
    pub fn new(inspection: &Inspection) -> Self {
        let stages = inspection.stages();
        let bundles = bundles(inspection, &stages);
        let place = |register: RegisterId| bundles[register.index()];
        let mut used: BTreeSet<Bundle> = BTreeSet::from([Bundle::Work]);
        let mut qubits = std::collections::BTreeMap::<Bundle, u64>::new();
        for (n, register) in inspection.whole.registers.iter().enumerate() {
            let id = RegisterId(n as u32);
            if inspection.layout.offset(id).is_some() {
                used.insert(place(id));
                *qubits.entry(place(id)).or_default() += u64::from(register.width);
            }
        }
        let work = work(inspection, &bundles);
        let order: Vec<Bundle> = used.into_iter().collect();
        let wires = order.iter().map(|&bundle| {
            let (name, depth) = match bundle {
                Bundle::Id => ("id".to_owned(), None),
                Bundle::Comparator => ("comparator".to_owned(), None),
                Bundle::Of(stage) => wire_of(&stages[stage]),
                Bundle::Colour => ("colour".to_owned(), None),
                Bundle::Flag => ("flag".to_owned(), None),
                Bundle::Work => ("work".to_owned(), None),
            };
            Wire {
                name,
                depth,
                qubits: match bundle {
                    Bundle::Work => work,
                    _ => qubits.get(&bundle).copied().unwrap_or(0),
                },
                input: matches!(bundle, Bundle::Id | Bundle::Comparator),
            }
        });
        let wires: Vec<Wire> = wires.collect();
        let boxes = stages.iter().map(|stage| {
            let mut reads = BTreeSet::new();
            let mut writes = BTreeSet::new();
            for instruction in &inspection.whole.instructions[stage.instructions.clone()] {
                let op = &inspection.whole.ops[instruction.op as usize];
                reads.extend(op.reads().into_iter().map(place));
                writes.extend(op.fresh().into_iter().map(place));
                if let Op::AddInto { target, .. } = op {
                    writes.insert(place(*target));
                }
            }
            // A phase flip computes no register: its box writes no wire.
            let wire = |bundle: &Bundle| order.iter().position(|known| known == bundle);
            DiagramBox {
                name: title(stage),
                stage: stage.name,
                part: stage.part,
                inverse: stage.inverse,
                cost: stage.cost,
                reads: reads.difference(&writes).filter_map(wire).collect(),
                writes: writes.iter().filter_map(wire).collect(),
            }
        });
        Self {
            boxes: boxes.collect(),
            wires,
        }
    }

    /// The boxes before which a wire holds a value: those after the first box that computes it, up
    /// to the last box that uncomputes it. For an input, all boxes and the end.
    pub fn held(&self, wire: usize) -> std::ops::Range<usize> {
        if self.wires[wire].input {
            return 0..self.boxes.len() + 1;
        }
        let writes = |b: &DiagramBox| b.writes.contains(&wire);
        let first = self.boxes.iter().position(writes).unwrap_or(0);
        let last = self.boxes.iter().rposition(writes).unwrap_or(first);
        first + 1..last + 1
    }
}

/// By register: its bundle. A register that only its own stage reads is work.
fn bundles(inspection: &Inspection, stages: &[CallStage]) -> Vec<Bundle> {
    let registers = &inspection.whole.registers;
    let mut made = vec![None; registers.len()];
    let mut shared = vec![false; registers.len()];
    for (place, stage) in stages.iter().enumerate() {
        if stage.part == CallPart::Uncompute {
            break;
        }
        for instruction in &inspection.whole.instructions[stage.instructions.clone()] {
            let op = &inspection.whole.ops[instruction.op as usize];
            for register in op.fresh() {
                made[register.index()].get_or_insert(place);
            }
            for register in op.reads() {
                if made[register.index()].is_some_and(|maker| maker != place) {
                    shared[register.index()] = true;
                }
            }
        }
    }
    let bundle =
        |(n, register): (usize, &qrt_circuit::Register)| match Role::from_register(register) {
            Role::Id => Bundle::Id,
            Role::Comparator => Bundle::Comparator,
            Role::Colour => Bundle::Colour,
            Role::Flag => Bundle::Flag,
            Role::Work | Role::Scratch => match made[n] {
                Some(stage) if shared[n] => Bundle::Of(stage),
                _ => Bundle::Work,
            },
        };
    registers.iter().enumerate().map(bundle).collect()
}

/// Number of qubits of `work`: the most in use besides those of the other wires.
fn work(inspection: &Inspection, bundles: &[Bundle]) -> u64 {
    let instructions = inspection.whole.instructions.len();
    let mut change = vec![0_i64; instructions + 1];
    for lifetime in &inspection.layout.lifetimes {
        if bundles[lifetime.register.index()] != Bundle::Work {
            let width = i64::from(inspection.whole.width(lifetime.register));
            change[lifetime.instructions.start] += width;
            change[lifetime.instructions.end] -= width;
        }
    }
    let mut named = 0;
    let mut most = 0;
    for (at, &in_use) in inspection.in_use.iter().enumerate() {
        named += change[at];
        most = most.max(i64::from(in_use) - named);
    }
    most.unsigned_abs()
}

/// The wire that leaves a stage: a ray leaves Generate Ray, the nearest hit leaves Find
/// Intersection.
fn wire_of(stage: &CallStage) -> (String, Option<u32>) {
    let name = match stage.name {
        StageName::GenerateRay => "ray".to_owned(),
        StageName::FindIntersection => "nearest".to_owned(),
        StageName::Shade => "light".to_owned(),
        StageName::SampleLight => "lamp".to_owned(),
        other => other.to_string(),
    };
    match stage.depth {
        Some(depth) => (format!("{name}_{depth}"), stage.depth),
        None => (name, None),
    }
}

/// The title of a stage's box: `Find Intersection 0` for `find_intersection 0`.
fn title(stage: &CallStage) -> String {
    if stage.name == StageName::Flip {
        return "Z".to_owned();
    }
    let name = stage.name.to_string();
    let words = name.split('_').map(|word| {
        let mut letters = word.chars();
        let first = letters.next().map(|c| c.to_ascii_uppercase());
        first.into_iter().chain(letters).collect::<String>()
    });
    let name = words.collect::<Vec<_>>().join(" ");
    match stage.depth {
        Some(depth) => format!("{name} {depth}"),
        None => name,
    }
}
