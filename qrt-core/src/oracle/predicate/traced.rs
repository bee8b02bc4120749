//! The oracle that computes the numbers of a path, each in a register of its format.

use super::Marks;
use crate::compile::{self, BoolValue, Builder, PixelWord, RealValue, Role, StageName};
use crate::oracle::paths::{PathFormats, PathNumber, RayNumber as Of};
use crate::oracle::recording::{PrimaryHit, record};
use crate::oracle::target::target;
use crate::oracle::{Channel, Oracle, OracleError, OracleOptions, register_of};
use qrt_circuit::{RegisterId, Type};
use qrt_scene::Nearest;
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::ValidScene;
use qrt_tracer::{Arith, Segment, Stage, dot};
use std::sync::Mutex;

/// The oracle of a path's numbers, and the registers that hold them.
pub(super) fn traced(
    scene: &ValidScene,
    formats: &PathFormats,
    numbers: &[PathNumber],
    marks: Marks,
    options: OracleOptions,
) -> Result<(Oracle, Vec<RegisterId>), OracleError> {
    let written = scene.scene();
    let stage = formats.stage(Stage::rgb(scene, options.class), numbers);
    let stage = stage.relative();
    let points = PathPoints::new(&written.sampling)?;
    let strategy = options.strategy(scene)?;
    let target = target(scene, &stage, &points, strategy, options)?;
    let (film, fraction) = (target.film, target.fraction);
    let mut builder = Builder::new(target).with_values(stage.values(scene));
    let bits = match marks {
        Marks::Paths => 0,
        Marks::Light => written.comparator.bits,
    };
    let comparator = builder.outside("comparator", Type::UInt, Role::Comparator, bits);
    let flag = builder.outside("flag", Type::Bool, Role::Flag, 1);
    let (colours, _) = match written.circuit.nearest {
        Nearest::Running => {
            let search = stage.search(1.0 / (1_u64 << fraction) as f64);
            record(scene, &mut builder, &stage, &search, PrimaryHit::Traced)?
        }
        Nearest::Paper => record(
            scene,
            &mut builder,
            &stage,
            &stage.recorded_search(1.0 / (1_u64 << fraction) as f64),
            PrimaryHit::Traced,
        )?,
    };
    let bounds = stage.bound();
    let mut channels = Vec::new();
    if marks == Marks::Light {
        for (number, colour) in colours.into_iter().enumerate() {
            let (colour, count) = builder.counted(colour, bits, written.comparator.at);
            channels.push(Channel {
                number,
                colour,
                count,
                scale: bounds[number],
            });
        }
    }
    builder.enter_stage(StageName::Predicate);
    let reader = Reader {
        formats,
        stage: &stage,
        face_numbers: (1..=scene.surface_of_faces().len() as u32).collect(),
        material_numbers: scene
            .surface_of_faces()
            .map(|surface| surface + 1)
            .collect(),
        colours,
    };
    let names: Vec<String> = numbers.iter().map(ToString::to_string).collect();
    let numbers = numbers.iter();
    let registers: Vec<RegisterId> = numbers
        .map(|&number| reader.register(&mut builder, number))
        .collect();
    builder.leave();
    let id = builder.id();
    let sharing = builder.sharing();
    scene.count_recording();
    let recorded = builder.finish()?;
    let parameters = recorded.parameters.clone();
    let counts = channels
        .iter()
        .flat_map(|channel| [channel.colour, channel.count]);
    let mut roots = registers.clone();
    roots.extend(counts.filter_map(register_of));
    let (mut program, renamed) = compile::assemble(
        recorded,
        roots.as_slice().into(),
        options.passes,
        strategy,
        &[id, comparator],
        &Mutex::default(),
    );
    let parameters = PixelWord::of_program(&parameters, &program);
    let rename = |register: RegisterId| *renamed.get(&register).unwrap_or(&register);
    for channel in &mut channels {
        channel.colour = channel.colour.map_register(rename);
        channel.count = channel.count.map_register(rename);
    }
    let registers: Vec<RegisterId> = registers.into_iter().map(rename).collect();
    for (number, register) in names.into_iter().zip(&registers) {
        program.registers[register.index()].name = number;
    }
    let oracle = Oracle {
        program,
        parameters,
        channels,
        id,
        comparator,
        nearest: None,
        flag,
        fraction,
        points,
        film,
        pixel: options.pixel,
        places: Vec::new(),
        sharing,
    };
    Ok((oracle, registers))
}

/// The values in the builder that the numbers of a path are computed from.
struct Reader<'a> {
    formats: &'a PathFormats,
    stage: &'a Stage<3>,
    /// By face: its number in registers.
    face_numbers: Vec<u32>,
    /// By face: the number of its material in registers.
    material_numbers: Vec<u32>,
    /// The colours by channel, in units of the channel's bound.
    colours: [RealValue; 3],
}

impl Reader<'_> {
    /// The register of a number, in its format.
    fn register(&self, cx: &mut Builder<'_>, number: PathNumber) -> RegisterId {
        let format = self.formats.format(number);
        let shape = (format.ty, format.width);
        let (depth, of) = match number {
            PathNumber::Ray(depth, of) => (depth, of),
            PathNumber::Colour(channel) => {
                let share = self.stage.bound()[channel] / self.formats.colour_unit;
                let colour = cx.scale(self.colours[channel], share);
                return cx.number_in(colour, shape, format.shift);
            }
        };
        let Some(segment) = cx.segment(depth) else {
            // No path has this ray.
            let zero = cx.real(0.0);
            return cx.number_in(zero, shape, 0);
        };
        match of {
            Of::Found => cx.truth_in(segment.found),
            Of::Front => {
                let front = self.front(cx, &segment);
                let front = cx.and(segment.found, front);
                cx.truth_in(front)
            }
            Of::Face => entry_in(cx, &segment, &self.face_numbers, format.width),
            Of::Material => entry_in(cx, &segment, &self.material_numbers, format.width),
            Of::Origin(axis) => {
                let centre = self.formats.centre[axis] * self.formats.scale;
                let centre = cx.real(centre);
                let point = cx.add(segment.origin[axis], centre);
                number_where(cx, segment.goes, point, shape, format.shift)
            }
            Of::Direction(axis) => {
                let direction = segment.direction[axis];
                number_where(cx, segment.goes, direction, shape, format.shift)
            }
            Of::Distance => number_where(cx, segment.found, segment.distance, shape, format.shift),
            Of::Normal(axis) => {
                let normal = cx.rows(self.stage.normals(), segment.face)[axis];
                number_where(cx, segment.found, normal, shape, format.shift)
            }
        }
    }

    /// True if the ray meets the front of its face; arbitrary if it meets none.
    fn front<'a>(&self, cx: &mut Builder<'a>, segment: &Segment<Builder<'a>>) -> BoolValue {
        if let Some(front) = segment.front {
            return front;
        }
        let normal = cx.rows(self.stage.normals(), segment.face);
        let cos_theta = dot(cx, &segment.direction, &normal);
        let zero = cx.real(0.0);
        cx.less(cos_theta, zero)
    }
}

/// The register of the entry of the face that the ray meets; 0 if it meets none.
fn entry_in<'a>(
    cx: &mut Builder<'a>,
    segment: &Segment<Builder<'a>>,
    entries: &[u32],
    width: u32,
) -> RegisterId {
    let entry = cx.entry(entries, segment.face);
    let none = cx.index(0);
    let entry = cx.select_index(segment.found, entry, none);
    cx.index_in(entry, width)
}

/// The register of a number that is `number` if `when` holds, and 0 otherwise.
fn number_where(
    cx: &mut Builder<'_>,
    when: BoolValue,
    number: RealValue,
    shape: (Type, u32),
    shift: i32,
) -> RegisterId {
    let zero = cx.real(0.0);
    let number = cx.select(when, number, zero);
    cx.number_in(number, shape, shift)
}
