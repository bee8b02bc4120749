//! Tests of user-defined predicates: a count equals that of a loop over all paths, on every machine; a render
//! shows the light of these paths; and the numbers that predicates read are the scene's.

use qrt::circuit::Op;
use qrt::core::oracle::PredicateError;
use qrt::core::oracle::paths::{PathFormats, PathNumber, RayNumber};
use qrt::counting::PhaseDistribution;
use qrt::machines::statevector::counting_of;
use qrt::prelude::*;
use qrt::runtime::predicates::{PredicateCount, PredicateRefusal};
use qrt::runtime::render::{Colour, Visibility};
use qrt::runtime::traced_path::TracedPath;
use qrt::scene::Window;

qrt! {
    /// A red wall, a mirror, a floor and a lamp, from within; three rays.
    scene Corner<Fixed<2, 12>> {
        camera: perspective { eye: (1.6, 1.1, 2.4), target: (0.2, 0.8, 0), vfov: 55 },
        film: 4 x 3,
        material red: lambertian { albedo: (0.8, 0.15, 0.1) },
        material grey: lambertian { albedo: (0.7, 0.7, 0.7) },
        material silver: mirror { reflectance: (0.9, 0.9, 0.9) },
        material lamp: emitter { radiance: (8, 8, 7) },
        quad floor: grey { (-1, 0, 2), (2, 0, 2), (2, 0, -1), (-1, 0, -1) },
        quad wall: red { (-1, 0, 2), (-1, 0, -1), (-1, 2, -1), (-1, 2, 2) },
        quad glass: silver { (-0.8, 0.2, -1), (1.8, 0.2, -1), (1.8, 1.8, -1), (-0.8, 1.8, -1) },
        quad light: lamp { (0, 2, 0), (1, 2, 0), (1, 2, 1), (0, 2, 1) },
        sampling { path_bits: 5, lights: none },
        depth primary { bits: (4, 4) },
        depth secondary { bits: (4, 4) },
        depth tertiary { bits: (4, 4) },
        comparator { bits: 4 },
    }

    /// A wall that no other test traces: its recordings are counted.
    scene Alone<Fixed<2, 8>> {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
        film: 2 x 2,
        material lamp: emitter { radiance: (1, 0.5, 0) },
        quad sky: lamp { (0, -9, 0), (9, -9, 0), (9, 9, 0), (0, 9, 0) },
        sampling { path_bits: 2 },
        depth primary { bits: (2, 2) },
        comparator { bits: 2 },
    }

    /// The same in millimetres and far from the origin, uncomputed early.
    scene Far<Fixed<2, 14>> {
        const X: f64 = 1e6;
        camera: perspective { eye: (X + 2200, 1200, 3400), target: (X + 200, 800, 0), vfov: 45 },
        film: 3 x 2,
        material "warm red": lambertian { albedo: (0.8, 0.15, 0.1) },
        material type: lambertian { albedo: (0.7, 0.7, 0.7) },
        material lamp: emitter { radiance: (0.0003, 0.0002, 0.0001) },
        quad floor: type { (X - 1000, 0, 2000), (X + 2000, 0, 2000), (X + 2000, 0, -1000), (X - 1000, 0, -1000) },
        for i in 0..2 {
            triangle wall: "warm red" {
                (X - 1000, i * 1000, 2000), (X - 1000, i * 1000, -1000), (X - 1000, i * 1000 + 1000, -1000),
            },
        }
        quad light: lamp { (X, 2000, 0), (X + 1000, 2000, 0), (X + 1000, 2000, 1000), (X, 2000, 1000) },
        sampling { path_bits: 4, lights: none },
        depth primary { bits: (4, 4) },
        depth secondary { bits: (4, 4) },
        comparator { bits: 4 },
        circuit { uncompute: scoped },
    }

    /// A scene on few qubits, whose amplitudes can be simulated.
    scene Tiny<Fixed<2, 4>> {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 2 },
        film: 2 x 2,
        material lamp: emitter { radiance: (4, 2, 1) },
        triangle front: lamp { (-1, -1, 0), (1, -1, 0), (1, 1, 0) },
        sampling { path_bits: 3 },
        depth primary { bits: (2, 2) },
        comparator { bits: 1 },
    }

    /// A scene whose last rays go to the lamp, and are not traced.
    scene Lit<Fixed<2, 10>> {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 2 x 2,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        material lamp: emitter { radiance: rgb(3, 2, 1) },
        quad floor: white { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        sampling { path_bits: 4, lights: next_event },
        depth primary { bits: (4, 4) },
        depth secondary { bits: (4, 4), light: (4, 4) },
        comparator { bits: 4 },
    }
}

const RED: u32 = Corner::MATERIALS.red;
const SILVER: u32 = Corner::MATERIALS.silver;

struct Material<const A: u32>;

#[reversible]
impl<const A: u32> Material<A> {
    fn is_met(material: &UInt<3>, good: &mut Bool) {
        good ^= material == A;
    }
}

#[reversible]
fn red_in_the_mirror(first: &UInt<3>, second: &UInt<3>, good: &mut Bool) {
    good ^= first == SILVER && second == RED;
}

/// Flips `good` if the way to the first two faces is shorter than five units and leaves the first upwards.
#[reversible]
fn short_and_up(
    first: &UFixed<4, 11>,
    second: &UFixed<4, 11>,
    up: &Fixed<2, 12>,
    found: &Bool,
    good: &mut Bool,
) {
    let mut way: UFixed<5, 11> = 0;
    within! {
        way += first;
        way += second;
    }
    apply! {
        good ^= (found & (way < 5)) && up > 0;
    }
}

/// Flips `good` if the last ray meets the front of the lamp or the wall, beyond x = -0.5, and is reddish.
#[reversible]
fn ends_well(
    material: &UInt<3>,
    front: &Bool,
    x: &Fixed<4, 11>,
    red: &UFixed<5, 8>,
    blue: &UFixed<5, 8>,
    good: &mut Bool,
) {
    good ^= (material != 0 && front) && (x > -0.5 || red > blue);
}

fn at(model: Model, crop: Option<[u32; 4]>) -> RenderOptions<'static> {
    RenderOptions {
        model: Some(model),
        crop,
        estimator: Some(Estimator::Exact),
        seed: 3,
        ..RenderOptions::default()
    }
}

type Path = <Corner as PathScene>::Path;
type Code = fn(&mut Recorder, &Path, &mut Reg<qrt::circuit::Recorded, Bool>);

type Plain = fn(&TracedPath<'static>) -> bool;

/// A predicate in a circuit, and the same predicate of a path in floating point.
const PREDICATES: [(Code, Plain); 4] = [
    (
        |m, path, good| Material::<RED>::is_met(m, &path.ray1.material, good),
        |path| meets(path, 1) == Some("red"),
    ),
    (
        |m, path, good| {
            red_in_the_mirror(m, &path.ray0.material, &path.ray1.material, good);
        },
        |path| meets(path, 0) == Some("silver") && meets(path, 1) == Some("red"),
    ),
    (
        |m, path, good| {
            let [first, second] = [&path.ray0.distance, &path.ray1.distance];
            short_and_up(
                m,
                first,
                second,
                &path.ray1.direction.y,
                &path.ray1.found,
                good,
            );
        },
        |path| {
            let distance = |ray: usize| Some(path.rays.get(ray)?.hit?.distance);
            let way = distance(0).zip(distance(1)).map(|(a, b)| a + b);
            way.is_some_and(|way| way < 5.0 && path.rays[1].direction[1] > 0.0)
        },
    ),
    (
        |m, path, good| {
            let (last, colour) = (&path.ray2, &path.colour);
            ends_well(
                m,
                &last.material,
                &last.front,
                &last.origin.x,
                &colour.r,
                &colour.b,
                good,
            );
        },
        |path| {
            let Some(hit) = path.rays.get(2).and_then(|ray| ray.hit) else {
                return false;
            };
            hit.front && (path.rays[2].origin[0] > -0.5 || path.colour[0] > path.colour[2])
        },
    ),
];

fn meets(path: &TracedPath<'static>, ray: usize) -> Option<&'static str> {
    Some(path.rays.get(ray)?.hit?.name)
}

#[test]
fn a_counted_predicate_is_that_of_a_loop_over_all_paths_on_every_machine() {
    let mut found = [0; PREDICATES.len()];
    for pixel in [[0, 0], [1, 1], [2, 1], [3, 2]] {
        let crop = Some([pixel[0], pixel[1], 1, 1]);
        for model in [Model::Real, Model::Fixed, Model::Gates] {
            let paths: Vec<TracedPath> = (0..32)
                .map(|id| trace_path::<Corner>(model, 3, pixel, id).unwrap())
                .collect();
            for (place, (code, plain)) in PREDICATES.into_iter().enumerate() {
                let counted = count_where::<Corner>(&at(model, crop), code).unwrap();
                let expected = paths.iter().filter(|path| plain(path)).count() as u64;
                assert_eq!(
                    counted.pixels[0].good, expected,
                    "{place} {model:?} {pixel:?}"
                );
                assert_eq!(counted.fraction(), expected as f64 / 32.0);
                assert_eq!(counted.cost.is_none(), model == Model::Real);
                found[place] += expected;
            }
        }
    }
    // Neither no path nor all paths satisfy any of them.
    assert!(
        found.iter().all(|&found| 20 < found && found < 340),
        "{found:?}"
    );
}

/// Checks the numbers of a path against the scene: points in its units, unit vectors, radiance.
fn numbers_are_the_scenes<S: PathScene>(tolerance: f64, units: f64) {
    let scene = S::scene();
    let mut hits = 0;
    for id in 0..16 {
        let pixel = [1, 1];
        let [real, fixed, gates] = [Model::Real, Model::Fixed, Model::Gates]
            .map(|model| trace_path::<S>(model, 3, pixel, id).unwrap());
        assert_eq!(fixed, gates);
        // A bounce within rounding of an edge may go elsewhere, so the test compares the first ray.
        let (a, b) = (&real.rays[0], &fixed.rays[0]);
        for k in 0..3 {
            assert!((a.origin[k] - b.origin[k]).abs() < tolerance * units);
            assert!((a.direction[k] - b.direction[k]).abs() < tolerance);
        }
        let (Some(hit), Some(other)) = (a.hit, b.hit) else {
            continue;
        };
        hits += 1;
        assert!((hit.distance - other.distance).abs() < 8.0 * tolerance * units);
        assert_eq!(
            (hit.face, hit.material, hit.front),
            (other.face, other.material, other.front)
        );
        let polygon = &scene.polygons()[hit.face as usize - 1];
        assert_eq!(polygon.surface, hit.material - 1);
        for path in [&real, &fixed] {
            for pair in path.rays.windows(2) {
                let hit = pair[0].hit.unwrap();
                let length = pair[0].direction.iter().map(|d| d * d).sum::<f64>().sqrt();
                assert!((length - 1.0).abs() < tolerance, "{length}");
                for k in 0..3 {
                    let point = pair[0].origin[k] + pair[0].direction[k] * hit.distance;
                    let away = (point - pair[1].origin[k]).abs();
                    assert!(away < 16.0 * tolerance * units, "{away}");
                }
            }
        }
    }
    assert!(hits > 8, "{hits}");
}

#[test]
fn numbers_of_paths_are_in_the_units_of_the_scene() {
    numbers_are_the_scenes::<Corner>(2e-3, 1.0);
    numbers_are_the_scenes::<Far>(2e-3, 1000.0);
}

#[test]
fn formats_follow_the_scenes_extent() {
    let of = |formats: &PathFormats, number| {
        let format = formats.format(PathNumber::Ray(0, number));
        format.ty.name(format.width)
    };
    let near = PathFormats::new(Corner::scene()).unwrap();
    assert_eq!(near.rays, 3);
    assert_eq!(of(&near, RayNumber::Origin(0)), "Fixed<4, 11>");
    assert_eq!(of(&near, RayNumber::Direction(2)), "Fixed<2, 12>");
    assert_eq!(of(&near, RayNumber::Face), "UInt<3>");
    let far = PathFormats::new(Far::scene()).unwrap();
    assert_eq!(of(&far, RayNumber::Origin(0)), "Fixed<21, 3>");
    let lit = PathFormats::new(Lit::scene()).unwrap();
    assert_eq!(lit.rays, 1, "the last rays go to the lamp");
}

/// Names of materials and labels of faces are numbers.
#[test]
fn names_are_numbers() {
    let materials = Corner::MATERIALS;
    let all = [
        materials.red,
        materials.grey,
        materials.silver,
        materials.lamp,
    ];
    assert_eq!(all, [1, 2, 3, 4]);
    let faces = Corner::FACES;
    assert_eq!(
        [faces.floor, faces.wall, faces.glass, faces.light],
        [1, 2, 3, 4]
    );
    assert_eq!(Far::FACES.wall, [2, 3]);
    assert_eq!([Far::MATERIALS.warm_red, Far::MATERIALS.r#type], [1, 2]);
}

/// Scopes are covered too, whose registers are uncomputed early, and coarse units far away.
#[test]
fn machines_agree_on_predicates_of_scoped_circuits() {
    #[reversible]
    fn beyond(x: &Fixed<21, 3>, material: &UInt<2>, good: &mut Bool) {
        good ^= x > 1000500 && material == 2;
    }
    let count = |model| -> Vec<u64> {
        let counted = count_where::<Far>(&at(model, None), |m, path, good| {
            beyond(m, &path.ray1.origin.x, &path.ray0.material, good);
        });
        counted
            .unwrap()
            .pixels
            .iter()
            .map(|pixel| pixel.good)
            .collect()
    };
    let [real, fixed, gates] = [Model::Real, Model::Fixed, Model::Gates].map(count);
    assert_eq!(fixed, gates);
    assert_eq!(real, fixed);
    let all: u64 = real.iter().sum();
    assert!(10 < all && all < 86, "{real:?}");
}

/// The whole counting circuit around a predicate's oracle, with every gate on amplitudes and every ancilla
/// checked after every query, has the distribution from which counts are drawn.
#[test]
fn a_predicates_oracle_is_counted_by_the_whole_circuit() {
    #[reversible]
    fn right(x: &Fixed<4, 3>, found: &Bool, good: &mut Bool) {
        good ^= found & (x > 0.25);
    }
    let predicate = Predicate::record::<Tiny>(|m, path, good| {
        right(m, &path.ray0.origin.x, &path.ray0.found, good);
    })
    .unwrap();
    let oracle = predicate.oracle(Marks::Paths, qrt::core::oracle::OracleOptions::default());
    let oracle = oracle.unwrap();
    for pixel in [[0, 0], [1, 0], [1, 1]] {
        let options = RenderOptions {
            seed: 1,
            ..at(Model::Gates, Some([pixel[0], pixel[1], 1, 1]))
        };
        let counted = count_where::<Tiny>(&options, |m, path, good| {
            right(m, &path.ray0.origin.x, &path.ray0.found, good);
        });
        let good = counted.unwrap().pixels[0].good;
        let simulated = counting_of(&oracle.phase(0, 1, pixel).unwrap(), 4, Window::Sine).unwrap();
        assert_eq!(simulated.report.superposed, 3 + 4);
        assert!(simulated.report.checks > 0);
        let exact = PhaseDistribution::new(good, 8, 4, Window::Sine).unwrap();
        for (y, probability) in simulated.distribution.iter().enumerate() {
            let known = exact.probability(y as u64);
            assert!((probability - known).abs() < 1e-9, "{pixel:?} {y}");
        }
    }
}

fn pictures(model: Model) -> [Rendered; 3] {
    let options = at(model, None);
    let all = render_where::<Corner>(&options, |m, _, good| {
        m.xor_into(good.register_mut(), Operand::Constant(1), None);
    });
    let by_mirror = render_where::<Corner>(&options, |m, path, good| {
        Material::<SILVER>::is_met(m, &path.ray0.material, good);
    });
    let otherwise = render_where::<Corner>(&options, |m, path, good| {
        m.xor_into(good.register_mut(), Operand::Constant(1), None);
        Material::<SILVER>::is_met(m, &path.ray0.material, good);
    });
    [all, by_mirror, otherwise].map(Result::unwrap)
}

#[test]
fn the_light_of_all_paths_is_the_picture_and_its_parts_add_up() {
    for model in [Model::Real, Model::Fixed, Model::Gates] {
        let [all, by_mirror, otherwise] = pictures(model);
        let whole = render(Corner::scene(), &at(model, None)).unwrap();
        assert_eq!(all.image.pixels, whole.image.pixels);
        assert_eq!(all.good(), whole.good());
        let parts = by_mirror.image.pixels.iter().zip(&otherwise.image.pixels);
        let mut mirrored = 0.0;
        for ((a, b), whole) in parts.zip(&whole.image.pixels) {
            for channel in 0..3 {
                let sum = a[channel] + b[channel];
                assert!(
                    (sum - whole[channel]).abs() < 1e-12 * (1.0 + sum),
                    "{model:?}"
                );
                mirrored += a[channel];
            }
        }
        let light: f64 = whole.image.pixels.iter().flatten().sum();
        assert!(
            0.01 * light < mirrored && mirrored < 0.9 * light,
            "{mirrored} of {light}"
        );
    }
}

#[test]
fn estimators_tell_a_fraction_an_interval_and_their_queries() {
    let options = |estimator, crop| RenderOptions {
        estimator: Some(estimator),
        ..at(Model::Fixed, crop)
    };
    let count = |options: &RenderOptions<'_>| -> PredicateCount {
        count_where::<Corner>(options, |m, path, good| {
            Material::<RED>::is_met(m, &path.ray1.material, good);
        })
        .unwrap()
    };
    let film = count(&options(Estimator::Exact, None));
    assert_eq!((film.pixels.len(), film.paths), (12, 32));
    assert_eq!(film.queries(), 12 * 32);
    assert_eq!(film.good() as f64 / (12.0 * 32.0), film.fraction());
    assert_eq!(film.interval(), (film.fraction(), film.fraction()));
    assert_eq!(film.at([2, 1]).unwrap().pixel, [2, 1]);
    assert_eq!(film.at([4, 0]), None);
    let image = film.image();
    assert_eq!((image.width, image.height), (4, 3));
    assert_eq!(
        image.pixels[6][0],
        film.at([2, 1]).unwrap().estimate.amplitude
    );
    let mut inside = 0;
    for estimator in [Estimator::AdaptiveBayes, Estimator::Sine, Estimator::Iqae] {
        for pixel in &film.pixels {
            let [x, y] = pixel.pixel;
            let counted = count(&options(estimator, Some([x, y, 1, 1])));
            assert_eq!(counted.pixels[0].good, pixel.good);
            assert!(counted.queries() > 0);
            let (low, high) = counted.interval();
            inside += i32::from(
                low <= film.at([x, y]).unwrap().estimate.amplitude
                    && film.at([x, y]).unwrap().estimate.amplitude <= high,
            );
        }
    }
    // 36 intervals of 95 %: 29 or fewer of them hold less often than once in 1,000 times.
    assert!(inside >= 30, "{inside} of 36");
}

#[test]
fn a_predicate_costs_what_it_reads_and_no_more() {
    let cost = |code: Code| {
        let predicate = Predicate::record::<Corner>(code).unwrap();
        let options = qrt::core::oracle::OracleOptions::default();
        let oracle = predicate.oracle(Marks::Paths, options).unwrap();
        let (cost, qubits) = oracle.cost(0);
        (cost.toffoli, qubits)
    };
    // The first ray's material alone needs no second ray, no throughput and no comparator.
    let first = cost(|m, path, good| Material::<RED>::is_met(m, &path.ray0.material, good));
    let second = cost(|m, path, good| Material::<RED>::is_met(m, &path.ray1.material, good));
    assert!(10 * first.0 < 4 * Corner::TOFFOLI, "{first:?}");
    assert!(
        first.0 < second.0 && first.1 < second.1,
        "{first:?} {second:?}"
    );
    assert!(
        second.0 < Corner::TOFFOLI,
        "{second:?} of {}",
        Corner::TOFFOLI
    );
}

#[test]
fn code_that_is_no_predicate_is_refused() {
    let of = |code: Code| Predicate::record::<Corner>(code).unwrap_err();
    let left = of(|m, path, _| {
        let mut t: Reg<_, UInt<3>> = Reg::zero(m, "t");
        m.xor_into(t.register_mut(), path.ray0.face.word().into(), None);
    });
    assert_eq!(
        left,
        PredicateError::Kept {
            register: "t".to_owned()
        }
    );
    assert!(
        left.to_string()
            .starts_with("the predicate leaves something in `t`")
    );
    let flips = of(|m, path, _| {
        let bit = Bit::at(path.ray0.found.register(), 0);
        m.call(qrt::circuit::Call::Compute(Op::Phase { bit }));
    });
    assert_eq!(flips, PredicateError::Flips);
}

#[test]
fn options_that_no_predicate_is_asked_with_are_refused() {
    let ask = |options: RenderOptions<'_>| {
        let counted = count_where::<Corner>(&options, |_, _, _| {});
        let rendered = render_where::<Corner>(&options, |_, _, _| {});
        let [a, b] = [counted.unwrap_err(), rendered.unwrap_err()].map(|error| match error {
            RenderError::PredicateRefusal(refusal) => refusal,
            other => panic!("{other}"),
        });
        assert_eq!(a, b);
        a
    };
    let plain = || at(Model::Fixed, None);
    let one_run = RenderOptions {
        colour: Colour::OneRun,
        ..plain()
    };
    assert_eq!(ask(one_run), PredicateRefusal::OneRun);
    let searched = RenderOptions {
        visibility: Visibility::Exhaustive,
        ..plain()
    };
    assert_eq!(ask(searched), PredicateRefusal::Visibility);
    let kept = RenderOptions {
        checkpoint: Some("kept.qrt".into()),
        ..plain()
    };
    assert_eq!(ask(kept), PredicateRefusal::Checkpoint);
    let outside = count_where::<Corner>(&at(Model::Fixed, Some([4, 0, 1, 1])), |_, _, _| {});
    assert!(matches!(outside, Err(RenderError::Crop { .. })));
    let beyond = trace_path::<Corner>(Model::Fixed, 0, [0, 0], 32).unwrap_err();
    assert_eq!(
        beyond.to_string(),
        "there is no path 32: a pixel has 2^5 paths, from 0 on"
    );
}

#[reversible]
fn meets_something(found: &Bool, good: &mut Bool) {
    good ^= found;
}

#[test]
fn a_predicate_is_compiled_once() {
    let mut expected = 0;
    for (model, programs) in [(Model::Real, 0), (Model::Fixed, 1), (Model::Gates, 1)] {
        let options = RenderOptions {
            model: Some(model),
            ..RenderOptions::default()
        };
        count_where::<Alone>(&options, |m, path, good| {
            meets_something(m, &path.ray0.found, good);
        })
        .unwrap();
        expected += programs;
        assert_eq!(Alone::scene().recordings(), expected, "{model:?}");
        render_where::<Alone>(&options, |m, path, good| {
            meets_something(m, &path.ray0.found, good);
        })
        .unwrap();
        expected += programs;
        assert_eq!(Alone::scene().recordings(), expected, "{model:?}");
    }
}
