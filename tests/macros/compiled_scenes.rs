//! Tests of the code that `qrt!` compiles: it is the circuit of the scene, with the same program, computed
//! and uncomputed, the same numbers on every machine, and the same picture.

#![allow(
    deprecated,
    reason = "the macro warns of a scene that is dark on purpose"
)]

use qrt::circuit::{Declaration, Type};
use qrt::core::inspect::Inspection;
use qrt::core::oracle::{Oracle, OracleOptions, Oracles};
use qrt::prelude::*;
use qrt::runtime::path_machines::{Finished, OracleMachine};
use qrt::runtime::render::{Colour, Visibility};
use qrt::tracer::PixelClass;
use std::sync::Arc;

qrt! {
    scene Box from "scenes-yaml/cornell-box.yaml"
    scene Mirror from "scenes-yaml/cornell-mirror.yaml"
    scene Copper from "scenes-yaml/cornell-ggx.yaml"
    scene Floor from "scenes-yaml/floor-and-light.yaml"
    scene Furnace from "scenes-yaml/furnace.yaml"
    scene Scoped from "tests/scenes/scoped.yaml"
    scene Lattice from "tests/scenes/lattice.yaml"
    scene Ring from "tests/scenes/ring.yaml"
    scene Lit from "tests/scenes/lit.yaml"
    /// A scene whose circuit computes a sum in place.
    scene Slanted from "scenes-yaml/small/slanted.yaml"

    /// The scene that `Lit` reads from its file.
    scene LitTwin {
        name: "lit",
        camera: perspective { eye: (0.3, 1.5, -0.2), target: (0.3, 0, -0.2), up: (0, 0, 1), vfov: 60 },
        film: 8 x 8,
        material floor: lambertian { albedo: rgb(0.8, 0.5, 0.2) },
        material wall: ggx { alpha: 0.3, reflectance: rgb(0.9, 0.8, 0.7) },
        material lamp: emitter { radiance: rgb(10, 8, 6), albedo: rgb(0.1, 0.2, 0.3) },
        quad floor: floor { (-4, 0, -4), (-4, 0, 4), (4, 0, 4), (4, 0, -4) },
        quad wall: wall { (-1, 0, 1), (1, 0, 1), (1, 2, 1), (-1, 2, 1) },
        quad lamp: lamp { (-0.5, 2, -0.5), (0.5, 2, -0.5), (0.5, 2, 0.5), (-0.5, 2, 0.5) },
        triangle second: lamp { (1, 0, 0), (1, 0.5, 0.5), (1, 0, 0.5) },
        sampling { path_bits: 8, lights: mis },
        depth primary { bits: (4, 4) },
        depth secondary { bits: (4, 4), light: (4, 4) },
        depth third { bits: (4, 4), light: (4, 4) },
        precision { fraction: 12 },
    }

    /// The scene that `Floor` reads from its file.
    scene Twin {
        name: "floor-and-light",
        camera: perspective { eye: (0.3, 1.5, -0.2), target: (0.3, 0, -0.2), up: (0, 0, 1), vfov: 60 },
        film: 64 x 64,
        material floor: lambertian { albedo: rgb(0.8, 0.5, 0.2) },
        material lamp: emitter { radiance: rgb(10, 8, 6) },
        quad floor: floor { (-4, 0, -4), (-4, 0, 4), (4, 0, 4), (4, 0, -4) },
        quad lamp: lamp { (-0.5, 2, -0.5), (0.5, 2, -0.5), (0.5, 2, 0.5), (-0.5, 2, 0.5) },
        sampling { path_bits: 14, lights: none },
        depth primary { bits: (10, 10) },
        depth secondary { bits: (10, 10) },
        comparator { bits: 12 },
        counting { phase_bits: 12 },
    }

    /// A scene on few qubits, where most uncomputed values are recomputed, over and over.
    scene Few {
        camera: perspective { eye: (0.3, 1.5, -0.2), target: (0.3, 0, -0.2), up: (0, 0, 1), vfov: 60 },
        film: 8 x 8,
        material floor: lambertian { albedo: rgb(0.8, 0.5, 0.2) },
        material lamp: emitter { radiance: rgb(10, 8, 6), albedo: rgb(0.1, 0.2, 0.3) },
        quad floor: floor { (-4, 0, -4), (-4, 0, 4), (4, 0, 4), (4, 0, -4) },
        quad lamp: lamp { (-0.5, 2, -0.5), (0.5, 2, -0.5), (0.5, 2, 0.5), (-0.5, 2, 0.5) },
        sampling { path_bits: 8, lights: none },
        depth primary { bits: (4, 4) },
        depth secondary { bits: (4, 4) },
        depth third { bits: (4, 4) },
        precision { fraction: 12 },
        circuit { uncompute: auto },
        budget { qubits: 330 },
    }
}

qrt! {
    /// A scene with names that generated code uses, too.
    #[cfg(all())]
    pub(crate) scene Field<Fixed<2, 30>> {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 4 x 4,
        material white: lambertian {
            albedo: { checker: { of: (rgb(0.7, 0.6, 0.5), rgb(0.2, 0.3, 0.4)), scale: 0.5 } },
        },
        material glass: dielectric { ior: 1.5 },
        material lamp: emitter { radiance: rgb(3, 2, 0) },
        quad floor: white { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        triangle pane: glass { (-1, 0, 1), (1, 0, 1), (0, 1.5, 1) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        sampling { path_bits: 40, lights: none },
        depth primary { bits: (20, 18) },
        depth secondary { bits: (9, 3) },
        depth third { bits: (9, 3) },
        comparator { bits: 20 },
    }
    #[cfg(any())]
    scene Gone {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
        film: 1 x 1,
    }
    /// An empty scene with one path.
    scene Dark {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
        film: 1 x 1,
        sampling { path_bits: 0 },
        depth primary { bits: (0, 0) },
    }
    /// A scene whose paths are all alike.
    #[allow(non_camel_case_types)]
    scene r#type {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
        film: 2 x 2,
        material lamp: emitter { radiance: rgb(1, 0, 0.5) },
        quad sky: lamp { (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0) },
        sampling { path_bits: 3 },
        depth primary { bits: (2, 2) },
    }
}

/// Records the whole program of the code, from the first operation to the last inverse.
fn whole<C: CompiledOracle>() -> Program {
    let mut recorder = C::OUTLINE.recorder();
    let id = C::OUTLINE.inputs(&mut recorder);
    C::within(&mut recorder, &id, |_, _| {});
    C::OUTLINE.ordered(recorder.finish())
}

fn is_the_scene<C: CompiledOracle>() {
    let oracle = Oracle::rgb(C::scene(), OracleOptions::default()).unwrap();
    assert!(C::program() == oracle.program, "another program");
    let compiled = C::oracle().unwrap();
    assert_eq!(compiled.channels, oracle.channels);
    assert_eq!(compiled.places, oracle.places);
    assert_eq!(
        (compiled.id, compiled.comparator, compiled.flag),
        (oracle.id, oracle.comparator, oracle.flag)
    );
    assert_eq!(
        (compiled.fraction, compiled.film, compiled.sharing),
        (oracle.fraction, oracle.film, oracle.sharing)
    );
    let mut both = oracle.program.instructions.clone();
    both.extend(oracle.program.inverse().instructions);
    assert!(whole::<C>().instructions == both, "not undone in reverse");
}

/// Most paths of a pixel that are compared, the last ones.
const MOST: u64 = 1 << 14;

/// Returns the count and the colour by channel, for each path of a pixel.
fn paths(machine: &OracleMachine, pixel: [u32; 2]) -> Vec<[[i64; 3]; 2]> {
    let mut paths = Vec::new();
    let finished = |run: Finished<'_>| {
        for place in 0..run.good[0].len() {
            let of = |values: [&[i64]; 3]| values.map(|values| values[place]);
            paths.push([of(run.good), of(run.colours)]);
        }
    };
    let all = machine.paths();
    let ids = all.saturating_sub(MOST)..all;
    machine.trace(&[pixel], ids, finished).unwrap();
    paths
}

/// Compares paths of a pixel, one basis state at a time, with the fixed machine.
fn computes_what_the_fixed_machine_does<C: CompiledOracle>(pixel: [u32; 2]) {
    let oracle: Arc<Oracle> = C::oracle().unwrap().into();
    let fixed = paths(&OracleMachine::fixed(oracle.clone(), 3, true), pixel);
    let most = 1 << oracle.comparator_bits();
    let first = (1_u64 << oracle.points.path_bits()).saturating_sub(MOST);
    for (path, expected) in (first..).zip(&fixed).step_by(fixed.len().div_ceil(24)) {
        let (mut state, id) = State::path::<C>(3, pixel, path).unwrap();
        C::within(&mut state, &id, |state, computed| {
            let counts = computed.counts().map(|count| state.operand(count));
            let counts = counts.map(|count| count.clamp(0, most));
            let colours = computed.colours().map(|colour| state.operand(colour));
            assert_eq!([counts, colours], *expected, "path {path}");
        });
        state.clean().unwrap();
    }
}

macro_rules! scenes {
    ($($test:ident: $scene:ident at $pixel:expr;)*) => {
        $(#[test]
        fn $test() {
            is_the_scene::<$scene>();
            computes_what_the_fixed_machine_does::<$scene>($pixel);
            let oracles = Oracles::new($scene::scene());
            let class = PixelClass::default();
            let inspection = Inspection::of_class(&oracles, None, class).unwrap();
            assert_eq!($scene::QUBITS, u64::from(inspection.qubits));
            assert_eq!($scene::TOFFOLI, inspection.total().toffoli);
        })*
    };
}

scenes! {
    of_the_cornell_box: Box at [20, 40];
    of_the_cornell_box_with_a_mirror: Mirror at [44, 40];
    of_the_cornell_box_with_copper: Copper at [20, 44];
    of_the_floor_under_a_light: Floor at [5, 5];
    of_the_furnace: Furnace at [7, 7];
    of_a_circuit_that_uncomputes_early: Scoped at [3, 4];
    of_a_ring_searched_by_its_edges: Ring at [3, 4];
    of_a_circuit_of_few_qubits: Few at [3, 4];
    of_the_product_lattice: Lattice at [3, 4];
    of_sampled_lamps: Lit at [3, 4];
    of_sums_in_place: Slanted at [1, 0];
    of_wide_numbers_and_long_ids: Field at [2, 1];
    of_nothing: Dark at [0, 0];
    of_a_lamp_alone: r#type at [1, 1];
}

#[test]
fn constants_are_those_of_the_oracle() {
    let oracle = Box::oracle().unwrap();
    assert_eq!(Box::PATH_BITS, 14);
    assert_eq!(Box::COMPARATOR_BITS, oracle.comparator_bits());
    assert_eq!(Box::FRACTION_BITS, oracle.fraction);
    assert_eq!(
        Box::SCALE,
        [0, 1, 2].map(|channel| oracle.channels[channel].scale)
    );
    assert_eq!(Box::DEPTH, 3);
    assert_eq!(Box::FILM, [64, 64]);
    assert_eq!(Box::OPERATIONS, oracle.program.ops.len());
}

/// Fields of the layout have the values of the real tracer's path.
#[test]
fn the_layout_reads_rays_of_unit_length_inside_the_box() {
    let ray = Box::LAYOUT.ray1;
    let mut hits = 0;
    for path in 0..64 {
        let pixel = [30, 20];
        let (mut state, id) = State::path::<Box>(1, pixel, path).unwrap();
        Box::within(&mut state, &id, |state, computed| {
            let found = computed.word(&Box::LAYOUT.ray0.found);
            let found = Box::LAYOUT
                .ray0
                .found
                .value(state.bits(found.register), pixel);
            assert!(found == 0.0 || found == 1.0);
            let of = |word: Word<&_>| state.bits(word.register);
            let x = ray
                .direction
                .x
                .value(of(computed.word(&ray.direction.x)), pixel);
            let y = ray
                .direction
                .y
                .value(of(computed.word(&ray.direction.y)), pixel);
            let z = ray
                .direction
                .z
                .value(of(computed.word(&ray.direction.z)), pixel);
            if found == 1.0 {
                hits += 1;
                let length = (x * x + y * y + z * z).sqrt();
                assert!((length - 1.0).abs() < 1e-3, "{length} on path {path}");
            }
        });
        state.clean().unwrap();
    }
    assert!(hits > 50, "{hits} hits");
}

/// Flips `near` if a ray meets a face within half a unit of the circuit's.
#[reversible]
fn is_near(found: &Bool, distance: &UFixed<2, 16>, near: &mut Bool) {
    near ^= found && distance < 0.5;
}

/// A reversible function takes a field as a register; the caller keeps its results.
#[test]
fn a_function_takes_fields_as_registers() {
    let (pixel, ray) = ([30, 20], Box::LAYOUT.ray0);
    let mut count = [0; 2];
    for path in 0..64 {
        let (mut state, id) = State::path::<Box>(1, pixel, path).unwrap();
        let mut near = Reg::zero(&mut state, "near");
        let expected = Box::within(&mut state, &id, |state, path| {
            path.with(state, &ray.found, |state, found| {
                path.with(state, &ray.distance, |state, distance| {
                    is_near(state, found, distance, &mut near);
                });
            });
            let bits = |state: &State, word: Word<&_>| state.bits(word.register);
            let found = ray.found.value(bits(state, path.word(&ray.found)), pixel);
            let distance = ray
                .distance
                .value(bits(state, path.word(&ray.distance)), pixel);
            found == 1.0 && distance < 0.5
        });
        assert_eq!(
            state.bits(near.register()),
            u64::from(expected),
            "path {path}"
        );
        count[usize::from(expected)] += 1;
        // A second call uncomputes the first: only the path's index is left.
        Box::within(&mut state, &id, |state, path| {
            path.with(state, &ray.found, |state, found| {
                path.with(state, &ray.distance, |state, distance| {
                    is_near(state, found, distance, &mut near);
                });
            });
        });
        near.free(&mut state);
        state.clean().unwrap();
    }
    assert!(count[0] > 0, "{count:?}");
}

/// A register that is computed among a path's registers and not uncomputed is found at the end.
#[test]
fn what_is_left_within_a_path_is_found() {
    let (mut state, id) = State::path::<Box>(1, [30, 20], 3).unwrap();
    Box::within(&mut state, &id, |state, computed| {
        let mut own = state.zero(&Declaration::work("own", Type::UInt, 8));
        let distance = computed.word(&Box::LAYOUT.ray0.distance).register;
        let held = Operand::unsigned(distance, 0, 8);
        assert_ne!(state.operand(Operand::unsigned(distance, 0, 8)), 0);
        state.xor_into(&mut own, held, None);
    });
    let told = state.clean().unwrap_err().to_string();
    assert!(told.contains("`own`"), "{told}");
}

/// The macro's tokens and the file's text give the same scene, program and picture.
#[test]
fn a_scene_and_its_twin_are_one() {
    assert_eq!(Twin::scene().scene(), Floor::scene().scene());
    assert!(Twin::program() == Floor::program());
    assert_eq!(LitTwin::scene().scene(), Lit::scene().scene());
    assert!(LitTwin::program() == Lit::program());
    let options = RenderOptions {
        model: Some(Model::Fixed),
        crop: Some([16, 30, 32, 2]),
        ..RenderOptions::default()
    };
    let [twin, floor] = [
        render_compiled::<Twin>(&options).unwrap(),
        render_compiled::<Floor>(&options).unwrap(),
    ];
    assert_eq!(twin.image.pixels, floor.image.pixels);
    assert_eq!(twin.good(), floor.good());
}

#[test]
fn pictures_are_those_of_the_scene() {
    for model in [Model::Fixed, Model::Gates] {
        let options = |crop| RenderOptions {
            model: Some(model),
            crop: Some(crop),
            ..RenderOptions::default()
        };
        let floor = options([30, 30, 3, 2]);
        let compiled = render_compiled::<Floor>(&floor).unwrap();
        let built = render(Floor::scene(), &floor).unwrap();
        assert_eq!(compiled.image.pixels, built.image.pixels);
        assert_eq!(compiled.good(), built.good());
        // For pixels with sampled lamps, only one class is compiled: colours are the same, at another scale.
        let lit = RenderOptions {
            estimator: Some(Estimator::Exact),
            ..options([0, 0, 8, 8])
        };
        let compiled = render_compiled::<Lit>(&lit).unwrap();
        let built = render(Lit::scene(), &lit).unwrap();
        let off = compiled.image.pixels.iter().zip(&built.image.pixels);
        let off = off.flat_map(|(a, b)| (0..3).map(move |c| (a[c] - b[c]).abs()));
        let (off, step) = (
            off.fold(0.0, f64::max),
            compiled.scales.greatest()[0] / 4096.0,
        );
        assert!(off <= step && built.mean()[0] > 10.0 * step, "{off} {step}");
    }
}

/// Options that name no model are those of the compiled circuit's model.
#[test]
fn a_compiled_circuit_runs_under_default_options() {
    let corner = RenderOptions {
        crop: Some([30, 30, 2, 1]),
        ..RenderOptions::default()
    };
    let compiled = render_compiled::<Floor>(&corner).unwrap();
    assert_eq!(compiled.model, Model::Fixed);
    assert_eq!(render(Floor::scene(), &corner).unwrap().model, Model::Real);
    assert_eq!(format!("{corner:?}").matches("crop: Some").count(), 1);
}

/// The types beside a scene's are not names of the author's module.
#[test]
fn names_beside_a_scene_are_free() {
    qrt! {
        scene Room {
            camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
            film: 2 x 2,
            material lamp: emitter { radiance: rgb(1, 0.5, 0) },
            quad sky: lamp { (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0) },
            sampling { path_bits: 2 },
            depth primary { bits: (2, 2) },
        }
        scene RoomPath {
            camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
            film: 1 x 1,
            material lamp: emitter { radiance: rgb(1, 0.5, 0) },
            quad sky: lamp { (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0) },
            sampling { path_bits: 2 },
            depth primary { bits: (2, 2) },
        }
    }
    struct RoomLayout;
    struct RoomMaterials;
    let _ = (RoomLayout, RoomMaterials);
    assert_eq!((Room::FILM, RoomPath::FILM), ([2; 2], [1; 2]));
    assert_eq!((Room::MATERIALS.lamp, RoomPath::FACES.sky), (1, 1));
}

/// A request that the compiled circuit cannot meet is refused, not replaced by another.
#[test]
fn what_a_compiled_circuit_does_not_do_is_refused() {
    qrt! {
        scene Accurate {
            camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
            film: 2 x 2,
            material lamp: emitter { radiance: rgb(0.5, 0.5, 0.5) },
            quad: lamp { (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0) },
            accuracy { error: 0.1, confidence: 0.9 },
        }
    }
    let fixed = RenderOptions {
        model: Some(Model::Fixed),
        ..RenderOptions::default()
    };
    let one_run = RenderOptions {
        colour: Colour::OneRun,
        ..fixed.clone()
    };
    let searched = RenderOptions {
        visibility: Visibility::Exhaustive,
        ..fixed.clone()
    };
    let refused = |rendered: Result<Rendered, RenderError>| match rendered.unwrap_err() {
        RenderError::Compiled(error) => error,
        other => panic!("{other}"),
    };
    let real = RenderOptions {
        model: Some(Model::Real),
        ..RenderOptions::default()
    };
    let real = refused(render_compiled::<Floor>(&real));
    assert_eq!(
        real.to_string(),
        "a compiled circuit is run by the models `fixed` and `gates`; `real` runs none: choose one \
         of the two, or use `render`"
    );
    assert_eq!(real, CompiledError::Model);
    assert_eq!(
        refused(render_compiled::<Floor>(&one_run)),
        CompiledError::OneRun
    );
    assert_eq!(
        refused(render_compiled::<Floor>(&searched)),
        CompiledError::Visibility
    );
    assert_eq!(
        refused(render_compiled::<Accurate>(&fixed)),
        CompiledError::Accuracy
    );
    // An estimator in the options replaces the scene's, as in `render`.
    let sine = RenderOptions {
        estimator: Some(Estimator::Sine),
        crop: Some([30, 30, 2, 1]),
        ..fixed
    };
    let [compiled, built] = [
        render_compiled::<Floor>(&sine).unwrap(),
        render(Floor::scene(), &sine).unwrap(),
    ];
    assert_eq!(compiled.estimator, Estimator::Sine);
    assert_eq!(compiled.image.pixels, built.image.pixels);
}

/// The scene stands in a function, and is private.
#[test]
fn a_scene_may_stand_in_a_function() {
    qrt! { scene Inner from "tests/scenes/lattice.yaml" }
    assert!(Inner::program() == Lattice::program());
}
