//! The register map: time runs to the right, qubits upwards.

use qrt_core::compile::{Role, StageName};
use qrt_core::inspect::{CallPart, CallStage, Inspection, Lifetime, grouped};
use qrt_drawing::{Canvas, SMALL, number, text_width};
use std::collections::BTreeMap;
use std::fmt::Write as _;

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 760.0;
/// The rectangle in which the registers are drawn: left, top, right, bottom.
const PLOT: [f64; 4] = [76.0, 92.0, 1180.0, 660.0];
/// The largest number of registers drawn as single rectangles with their names.
const MOST: usize = 6000;
/// Side of a square. With more than [`MOST`] registers, squares stand for the small ones.
const CELL: f64 = 2.0;

/// Draws the register map of an inspected call of the scene called `scene`.
///
/// Each register is a rectangle from the instruction that computes it to the one that uncomputes
/// it, and its height is its number of qubits. Time is the number of Toffolis so far. In a drawing
/// of very many registers, those below two pixels are combined into squares. The colour of a square
/// is that of the role with the largest area in it.
pub fn registers(inspection: &Inspection, scene: &str) -> Canvas {
    let map = Map::new(inspection);
    let total = inspection.total();
    let title = format!(
        "{scene}: registers of one oracle call, {}",
        inspection.which_briefly()
    );
    let figures = format!(
        "{} qubits at the most, {} Toffoli, Toffoli depth {}; {} registers in a layout of {} qubits",
        grouped(u64::from(inspection.qubits)),
        grouped(total.toffoli),
        grouped(inspection.toffoli_depth),
        grouped(inspection.layout.registers()),
        grouped(u64::from(inspection.layout.height)),
    );
    let mut canvas = Canvas::large(&title, WIDTH, HEIGHT, &figures);
    legend(&mut canvas);
    map.axes(&mut canvas);
    let labels = map.lifetimes(&mut canvas);
    map.in_use(&mut canvas);
    map.stages(&mut canvas);
    for (place, label) in labels {
        canvas.text("small", place, &label);
    }
    canvas
}

fn legend(canvas: &mut Canvas) {
    let mut x = PLOT[0];
    for role in Role::ALL {
        let name = role.to_string();
        canvas.rectangle(class(role), [x, 64.0, 12.0, 12.0]);
        canvas.text("", [x + 17.0, 74.0], &name);
        x += 17.0 + text_width(&name) + 18.0;
    }
    canvas.line("in-use", [x, 70.0], [x + 20.0, 70.0]);
    canvas.text(
        "",
        [x + 26.0, 74.0],
        "qubits in use, with the ancillas of operations",
    );
}

struct Map<'a> {
    inspection: &'a Inspection,
    /// Number of Toffolis before each instruction, and at the end the number of all.
    times: Vec<u64>,
    height: f64,
}

impl<'a> Map<'a> {
    fn new(inspection: &'a Inspection) -> Self {
        let mut times = vec![0];
        for cost in &inspection.costs {
            times.push(times.last().copied().unwrap_or(0) + cost.toffoli);
        }
        if times.last() == Some(&0) {
            // Without Toffolis, the unit of time is the instruction.
            times = (0..times.len() as u64).collect();
        }
        let highest = inspection.layout.height.max(inspection.qubits).max(1);
        Self {
            inspection,
            times,
            height: f64::from(highest) * 1.02,
        }
    }

    fn x(&self, instruction: usize) -> f64 {
        let all = self.times.last().copied().unwrap_or(1).max(1) as f64;
        PLOT[0] + (PLOT[2] - PLOT[0]) * self.times[instruction] as f64 / all
    }

    fn y(&self, qubit: f64) -> f64 {
        PLOT[3] - (PLOT[3] - PLOT[1]) * qubit / self.height
    }

    fn axes(&self, canvas: &mut Canvas) {
        let step = round_step(self.height / 6.0);
        let mut qubit = 0.0;
        while qubit <= self.height {
            let y = self.y(qubit);
            canvas.line("grid", [PLOT[0], y], [PLOT[2], y]);
            canvas.text(
                "small end",
                [PLOT[0] - 6.0, y + 4.0],
                &grouped(qubit as u64),
            );
            qubit += step;
        }
        canvas.upright("", [16.0, f64::midpoint(PLOT[1], PLOT[3])], "qubits");
        let all = self.times.last().copied().unwrap_or(1).max(1) as f64;
        let step = round_step(all / 8.0);
        let mut time = 0.0;
        while time <= all {
            let x = PLOT[0] + (PLOT[2] - PLOT[0]) * time / all;
            canvas.line("wire", [x, PLOT[3]], [x, PLOT[3] + 4.0]);
            canvas.text("small mid", [x, PLOT[3] + 15.0], &grouped(time as u64));
            time += step;
        }
        let unit = if self.inspection.total().toffoli > 0 {
            "Toffolis so far"
        } else {
            "instructions so far"
        };
        canvas.text("end", [PLOT[2], PLOT[3] + 32.0], unit);
    }

    fn place(&self, lifetime: &Lifetime) -> [f64; 4] {
        let width = self.inspection.whole.width(lifetime.register);
        let (left, right) = (
            self.x(lifetime.instructions.start),
            self.x(lifetime.instructions.end),
        );
        let (low, high) = (
            f64::from(lifetime.offset),
            f64::from(lifetime.offset + width),
        );
        [
            left,
            self.y(high),
            (right - left).max(0.5),
            self.y(low) - self.y(high),
        ]
    }

    /// Draws the registers, and returns the labels that fit on them.
    fn lifetimes(&self, canvas: &mut Canvas) -> Vec<([f64; 2], String)> {
        let lifetimes = &self.inspection.layout.lifetimes;
        let all = lifetimes.len() <= MOST;
        let mut cells = Cells::default();
        let mut large: Vec<&Lifetime> = Vec::new();
        for lifetime in lifetimes {
            let place = self.place(lifetime);
            if all || place[3] >= CELL && place[2] >= CELL {
                large.push(lifetime);
            } else {
                cells.add(place, self.role(lifetime));
            }
        }
        if large.len() > MOST {
            // Draw the largest as rectangles, and the others as squares, too.
            let area = |lifetime: &&Lifetime| {
                let [_, _, width, height] = self.place(lifetime);
                -(width * height)
            };
            large.sort_by(|a, b| area(a).total_cmp(&area(b)));
            for lifetime in large.split_off(MOST) {
                cells.add(self.place(lifetime), self.role(lifetime));
            }
        }
        cells.draw(canvas);
        let mut labels = Vec::new();
        for lifetime in large {
            let place = self.place(lifetime);
            let register = &self.inspection.whole.registers[lifetime.register.index()];
            let ty = register.ty.name(register.width);
            let block = &self.inspection.whole.blocks[register.block.index()].name;
            let hint = format!("{}: {ty}, {block}", register.name);
            // On a rectangle below three pixels high, an edge would hide the fill.
            let edge = if place[3] >= 3.0 { " edge" } else { "" };
            let class = format!("{}{edge}", class(Role::from_register(register)));
            canvas.hinted(&class, place, &hint);
            let label = format!("{}: {ty}", register.name);
            if place[3] >= 13.0 && place[2] >= text_width(&label) {
                let [x, y, _, height] = place;
                labels.push(([x + 4.0, y + height / 2.0 + 4.0], label));
            }
        }
        labels
    }

    fn role(&self, lifetime: &Lifetime) -> Role {
        Role::from_register(&self.inspection.whole.registers[lifetime.register.index()])
    }

    /// Draws the qubits in use. An instruction that is at least one column of pixels wide has a
    /// step of its own; of the instructions within one column, the largest number is drawn.
    fn in_use(&self, canvas: &mut Canvas) {
        let mut points: Vec<(u32, u32)> = Vec::new();
        // True if the last point is the maximum within one column.
        let mut within = false;
        for (at, &in_use) in self.inspection.in_use.iter().enumerate() {
            let [start, end] = [at, at + 1].map(|at| self.x(at).floor() as u32);
            match points.last_mut() {
                Some((column, most)) if start == end && within && *column == start => {
                    *most = in_use.max(*most);
                }
                _ => {
                    points.push((start, in_use));
                    within = start == end;
                    if !within {
                        points.push((end, in_use));
                    }
                }
            }
        }
        let mut d = String::new();
        for (column, in_use) in points {
            let y = number(self.y(f64::from(in_use)));
            let _ = write!(d, "{}{column} {y}", if d.is_empty() { 'M' } else { 'L' });
        }
        if !d.is_empty() {
            canvas.path("in-use", &d);
        }
    }

    /// Draws bars below the time axis: one row for the boxes, one for the parts of the call.
    fn stages(&self, canvas: &mut Canvas) {
        let stages = self.inspection.stages();
        let (y, height) = (PLOT[3] + 42.0, 18.0);
        for (place, stage) in stages.iter().enumerate() {
            let (left, right) = (
                self.x(stage.instructions.start),
                self.x(stage.instructions.end),
            );
            let class = if place % 2 == 0 { "stage" } else { "stage2" };
            let hint = format!(
                "{}{stage}: {} Toffoli",
                if stage.inverse { "inverse of " } else { "" },
                grouped(stage.cost.toffoli)
            );
            canvas.hinted(class, [left, y, right - left, height], &hint);
            let label = [stage.to_string(), brief(stage)]
                .into_iter()
                .find(|label| text_width(label) * SMALL <= right - left - 4.0);
            if let Some(label) = label {
                canvas.text("small mid", [f64::midpoint(left, right), y + 13.0], &label);
            }
            if place > 0 && right - left > 8.0 {
                canvas.line("grid", [left, PLOT[1]], [left, PLOT[3]]);
            }
        }
        for part in CallPart::ALL {
            let instructions = self.inspection.instructions(part);
            let (left, right) = (self.x(instructions.start), self.x(instructions.end));
            canvas.hinted("stage", [left, y + 22.0, right - left, height], part.name());
            if right - left >= text_width(part.name()) {
                canvas.text(
                    "small mid",
                    [f64::midpoint(left, right), y + 35.0],
                    part.name(),
                );
            }
        }
    }
}

/// Shortens `find_intersection 1` to `find 1`.
fn brief(stage: &CallStage) -> String {
    let word = match stage.name {
        StageName::GenerateRay => "generate",
        StageName::FindIntersection => "find",
        other => other.kind(),
    };
    stage
        .depth
        .map_or_else(|| word.to_owned(), |depth| format!("{word} {depth}"))
}

/// The smallest of 1, 2 or 5 times a power of ten that is at least `least` and at least 1.
fn round_step(least: f64) -> f64 {
    let mut step = 1.0;
    loop {
        for factor in [1.0, 2.0, 5.0] {
            if step * factor >= least {
                return step * factor;
            }
        }
        step *= 10.0;
    }
}

/// Squares, each in the colour of the role with the largest area in it.
#[derive(Debug, Default)]
struct Cells {
    area: BTreeMap<(u32, u32), [f32; Role::ALL.len()]>,
}

impl Cells {
    fn add(&mut self, [x, y, width, height]: [f64; 4], role: Role) {
        let role = Role::ALL
            .iter()
            .position(|&known| known == role)
            .unwrap_or(0);
        let span = |start: f64, length: f64| {
            let first = (start / CELL).floor();
            let last = ((start + length) / CELL).ceil();
            (first as u32..last as u32).map(move |cell| {
                let from = start.max(f64::from(cell) * CELL);
                let to = (start + length).min(f64::from(cell + 1) * CELL);
                (cell, (to - from).max(0.0))
            })
        };
        for (row, high) in span(y, height) {
            for (column, wide) in span(x, width) {
                self.area.entry((row, column)).or_default()[role] += (wide * high) as f32;
            }
        }
    }

    fn draw(&self, canvas: &mut Canvas) {
        let mut paths: [String; Role::ALL.len()] = Default::default();
        // The current run of squares: its role, row, first column and length.
        let mut run: Option<(usize, u32, u32, u32)> = None;
        let mut write = |run: Option<(usize, u32, u32, u32)>| {
            if let Some((role, row, column, length)) = run {
                let [x, y, width] = [column, row, length].map(|n| f64::from(n) * CELL);
                let _ = write!(paths[role], "M{x} {y}h{width}v{CELL}h-{width}z");
            }
        };
        for (&(row, column), areas) in &self.area {
            // A square stays empty if registers cover less than a third of it.
            if areas.iter().sum::<f32>() < (CELL * CELL / 3.0) as f32 {
                continue;
            }
            let most = (0..Role::ALL.len()).max_by(|&a, &b| areas[a].total_cmp(&areas[b]));
            let most = most.unwrap_or(0);
            match &mut run {
                Some((role, at, first, length))
                    if *role == most && *at == row && *first + *length == column =>
                {
                    *length += 1;
                }
                _ => write(run.replace((most, row, column, 1))),
            }
        }
        write(run);
        for (role, d) in Role::ALL.into_iter().zip(paths) {
            if !d.is_empty() {
                canvas.path(class(role), &d);
            }
        }
    }
}

/// The style class for the colour of a role.
fn class(role: Role) -> &'static str {
    match role {
        Role::Id => "id",
        Role::Comparator => "comparator",
        Role::Work => "work",
        Role::Scratch => "scratch",
        Role::Colour => "colour",
        Role::Flag => "flag",
    }
}
