//! Pictures, enlarged so that their pixels are visible.

use super::{Body, Figure, cornell, root, scene};
use qrt::runtime::image::Image;
use qrt::runtime::path_machines::Real;
use qrt::runtime::render::{Model, RenderOptions, render};
use qrt::runtime::sample::tallies;
use qrt::runtime::workers::Workers;
use qrt::scene::Estimator;
use qrt::scene::front;
use qrt::scene::valid::ValidScene;
use std::f64::consts::{PI, TAU};

/// Width of the gap between pictures of a strip, in their pixels.
const GAP: u32 = 2;
/// Colour of the gap: a grey that differs from the background of the light and the dark page.
const BETWEEN: [f64; 3] = [0.1; 3];
/// Pixels along each side of a picture of a strip.
const SIDE: u32 = 48;
/// Exposure of strips and of the gates machine's picture, in stops.
const EXPOSURE: f64 = 1.0;

/// Returns the picture with each pixel as `times` x `times`.
fn enlarged(image: &Image, times: u32) -> Image {
    let (width, height) = (times * image.width, times * image.height);
    let pixel = |k: u32| {
        let (x, y) = (k % width / times, k / width / times);
        image.pixels[(y * image.width + x) as usize]
    };
    Image {
        width,
        height,
        pixels: (0..width * height).map(pixel).collect(),
        window: None,
    }
}

/// Joins pictures of one size side by side.
fn strip(images: &[Image]) -> Image {
    let (side, height) = (images[0].width, images[0].height);
    let count = images.len() as u32;
    let width = count * side + (count - 1) * GAP;
    let pixel = |k: u32| {
        let (x, y) = (k % width, k / width);
        let (image, within) = (x / (side + GAP), x % (side + GAP));
        if within < side {
            images[image as usize].pixels[(y * side + within) as usize]
        } else {
            BETWEEN
        }
    };
    Image {
        width,
        height,
        pixels: (0..width * height).map(pixel).collect(),
        window: None,
    }
}

/// Returns the root of the mean square difference over the mean of `truth`.
fn error(image: &Image, truth: &Image) -> f64 {
    let pairs = image.pixels.as_flattened().iter();
    let pairs = pairs.zip(truth.pixels.as_flattened());
    let squares: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
    let all = truth.pixels.as_flattened();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    (squares / all.len() as f64).sqrt() / mean
}

fn rendered(scene: &ValidScene, options: &RenderOptions<'_>) -> (Image, f64) {
    let rendered = render(scene, options).expect("a picture");
    let channels = 3.0 * rendered.image.pixels.len() as f64;
    let queries = rendered.total_queries() as f64 / channels;
    (rendered.image, queries)
}

/// Renders the Cornell box with its lamp sampled, half as large as the plain command renders it.
pub(super) fn first() -> Figure {
    let file = root().join("scenes-yaml/lit-box.yaml");
    let film = ["film={ width: 128, height: 128 }".to_owned()];
    let loaded = front::load(&file, &film).unwrap_or_else(|report| panic!("{report}"));
    let (image, queries) = rendered(&loaded.valid, &RenderOptions::default());
    let says = format!(
        "128 x 128 pixels, each shown as 2 x 2; 2^10 paths a pixel, sine window, {queries:.0} \
         queries a channel, exposure 1, as `qrt render scenes-yaml/lit-box.yaml --exposure 1` \
         renders it at twice that size."
    );
    let body = Body::Picture(enlarged(&image, 2), 1.0);
    Figure { body, says }
}

/// Returns the picture of the mean colours of the paths.
fn mean_of(real: &Real) -> Image {
    let pixels: Vec<[u32; 2]> = (0..SIDE * SIDE).map(|k| [k % SIDE, k / SIDE]).collect();
    let paths = real.paths();
    let sums = tallies(real, &pixels, 0..paths, &[], &Workers::default()).expect("nobody cancels");
    let pixel = |sum: qrt::runtime::sample::Tally| sum.colour.map(|c| c / paths as f64);
    Image {
        width: SIDE,
        height: SIDE,
        pixels: sums.into_iter().map(pixel).collect(),
        window: None,
    }
}

/// Shows the same number of paths by three ways of choosing them.
pub(super) fn noise() -> Figure {
    let film = format!("film={{ width: {SIDE}, height: {SIDE} }}");
    let net = |bits: u32, seed: u64| {
        let scene = cornell(&[&film, &format!("sampling.path_bits={bits}")]);
        Real::new(&scene, seed).expect("a machine")
    };
    let lattice = cornell(&[
        &film,
        "sampling.sequence=product-lattice",
        "sampling.depths=[{bits: [2, 2]}, {bits: [2, 2]}, {bits: [1, 1]}]",
        "sampling.path_bits=10",
    ]);
    let lattice = Real::new(&lattice, 0).expect("a machine");
    let images = [lattice, net(10, 0).monte_carlo(1 << 10), net(10, 0)].map(|real| mean_of(&real));
    let truth = mean_of(&net(13, 1));
    let errors = images.each_ref().map(|image| 100.0 * error(image, &truth));
    let says = format!(
        "Cornell box, 48 x 48 pixels, each shown as 4 x 4, exact mean of 2^10 paths a pixel, exposure \
         1: product lattice (bits 2 2, 2 2, 1 1), random paths, digital net. RMSE over the mean, to \
         the net with 2^13 paths and another seed: {:.0} %, {:.0} %, {:.0} %.",
        errors[0], errors[1], errors[2]
    );
    let body = Body::Picture(enlarged(&strip(&images), 4), EXPOSURE);
    Figure { body, says }
}

/// Shows the same number of queries by five estimators.
pub(super) fn counted() -> Figure {
    let scene = cornell(&[
        &format!("film={{ width: {SIDE}, height: {SIDE} }}"),
        "sampling.path_bits=12",
        "counting.phase_bits=8",
    ]);
    let estimators = [
        Estimator::Exact,
        Estimator::MonteCarlo,
        Estimator::Paper,
        Estimator::Sine,
        Estimator::AdaptiveBayes,
    ];
    let all = estimators.map(|estimator| {
        let options = RenderOptions {
            estimator: Some(estimator),
            ..RenderOptions::default()
        };
        rendered(&scene, &options)
    });
    let listed: Vec<String> = (estimators.iter().zip(&all).skip(1))
        .map(|(estimator, (image, queries))| {
            let error = 100.0 * error(image, &all[0].0);
            format!("{estimator} {error:.0} % ({queries:.0} queries a channel)")
        })
        .collect();
    let says = format!(
        "Cornell box, 48 x 48 pixels, each shown as 3 x 3, 2^12 paths a pixel, 2^12 comparators, T = \
         2^8, exposure 1: exact, then by estimators. RMSE to the exact picture over its mean: {}.",
        listed.join(", ")
    );
    let body = Body::Picture(enlarged(&strip(&all.map(|(image, _)| image)), 3), EXPOSURE);
    Figure { body, says }
}

/// Materials of a ball, in the order of the grid.
const MATERIALS: [&str; 6] = [
    "lambertian: { albedo: [0.75, 0.3, 0.2] }",
    "mirror: { reflectance: [0.9, 0.9, 0.9] }",
    "dielectric: { ior: 1.5 }",
    "ggx: { alpha: 0.25, reflectance: [0.95, 0.75, 0.4] }",
    "phong: { diffuse: [0.2, 0.35, 0.5], specular: [0.3, 0.3, 0.3], exponent: 40 }",
    "bsdf: { map: ['sqrt(1-u^2)*cos(2*pi*v)', 'sqrt(1-u^2)*sin(2*pi*v)', 'u'], jacobian: auto, \
     value: '0.1/pi + 2.2*(1-cos_i)^3*(1-cos_o)^3', pdf: '1/(2*pi)' }",
];

/// Returns a ball of triangles around (0, 1, 0), as lines of a scene.
fn ball(rings: u32, sectors: u32) -> String {
    let corner = |ring: u32, sector: u32| {
        let polar = PI * f64::from(ring) / f64::from(rings);
        let around = TAU * f64::from(sector % sectors) / f64::from(sectors);
        let [x, y, z] = [
            libm::sin(polar) * libm::cos(around),
            1.02 + libm::cos(polar),
            libm::sin(polar) * libm::sin(around),
        ];
        format!("[{x:.6}, {y:.6}, {z:.6}]")
    };
    let cells = (0..rings).flat_map(|ring| (0..sectors).map(move |sector| (ring, sector)));
    let triangles = cells.flat_map(|(ring, sector)| {
        let at = |[r, s]: [u32; 2]| corner(ring + r, sector + s);
        let [a, b, c, d] = [[0, 0], [0, 1], [1, 1], [1, 0]].map(at);
        // At the poles one of the two triangles has no area. The front faces outward.
        let lower = (ring + 1 < rings).then(|| format!("{a}, {c}, {d}"));
        let upper = (ring > 0).then(|| format!("{a}, {b}, {c}"));
        lower.into_iter().chain(upper)
    });
    let lines = triangles
        .map(|corners| format!("  - triangle: {{ vertices: [{corners}], material: shown }}\n"));
    lines.collect::<Vec<_>>().concat()
}

/// Shows a ball of each material.
pub(super) fn materials() -> Figure {
    let ball = ball(14, 28);
    let images = MATERIALS.map(|material| {
        let text = format!(
            "name: ball
camera: {{ perspective: {{ eye: [0, 2.2, 5], target: [0, 0.95, 0], vfov: 30 }} }}
film: {{ width: {SIDE}, height: {SIDE} }}
materials:
  floor: {{ lambertian: {{ albedo: [0.6, 0.6, 0.6] }} }}
  back: {{ lambertian: {{ albedo: [0.25, 0.45, 0.3] }} }}
  lamp: {{ emitter: {{ radiance: [9, 8.5, 8] }} }}
  shown: {{ {material} }}
geometry:
  - quad: {{ vertices: [[-9, 0, 9], [9, 0, 9], [9, 0, -3], [-9, 0, -3]], material: floor }}
  - quad: {{ vertices: [[-9, 0, -3], [9, 0, -3], [9, 9, -3], [-9, 9, -3]], material: back }}
  - quad: {{ vertices: [[-2, 5, 0], [1, 5, 0], [1, 5, 3], [-2, 5, 3]], material: lamp }}
{ball}sampling:
  path_bits: 8
  depths:
    - {{ bits: [10, 10] }}
    - {{ bits: [10, 10], light: [10, 10] }}
    - {{ bits: [10, 10], light: [10, 10] }}
    - {{ bits: [10, 10], light: [10, 10] }}
    - {{ bits: [10, 10], light: [10, 10] }}
"
        );
        mean_of(&Real::new(&scene(&text, "ball.yaml"), 0).expect("a machine"))
    });
    let [first, second] = [&images[..3], &images[3..]].map(strip);
    let between = vec![BETWEEN; (GAP * first.width) as usize];
    let image = Image {
        width: first.width,
        height: 2 * first.height + GAP,
        pixels: [first.pixels, between, second.pixels].concat(),
        window: None,
    };
    let says = "A ball of 728 triangles, 48 x 48 pixels, each shown as 3 x 3, 2^8 paths of five \
                rays with sampled lamps: lambertian, mirror, dielectric; ggx, phong, a bsdf of \
                one's own."
        .to_owned();
    let body = Body::Picture(enlarged(&image, 3), 0.0);
    Figure { body, says }
}

/// Shows the knot with flat faces and with interpolated normals.
pub(super) fn smooth() -> Figure {
    let exact = RenderOptions {
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    };
    let images = ["auto", "180"].map(|smooth| {
        let sets = [
            "film={ width: 128, height: 96 }".to_owned(),
            "camera.perspective.vfov=26".to_owned(),
            "camera.perspective.target=[0, 0.45, 0]".to_owned(),
            "sampling={ path_bits: 6, depths: 3 }".to_owned(),
            format!("geometry[2].mesh.smooth={smooth}"),
        ];
        let loaded = front::load(&root().join("scenes-yaml/knot.yaml"), &sets);
        let scene = loaded.unwrap_or_else(|report| panic!("{report}")).valid;
        rendered(&scene, &exact).0
    });
    let says =
        "The knot of 1,536 triangles, 128 x 96 pixels, each shown as 2 x 2, the exact mean of \
                2^6 paths of three rays with sampled lamps: flat, and with `smooth: 180`."
            .to_owned();
    let body = Body::Picture(enlarged(&strip(&images), 2), 0.5);
    Figure { body, says }
}

/// Shows the same 64 paths with lamps found by chance, and with lamps sampled.
pub(super) fn lights() -> Figure {
    let images = ["none", "mis", "auto"].map(|lights| {
        let sets = [
            format!("film={{ width: {SIDE}, height: {SIDE} }}"),
            "sampling.path_bits=6".to_owned(),
            format!("sampling.lights={lights}"),
        ];
        let loaded = front::load(&root().join("scenes-yaml/lit-box.yaml"), &sets);
        let scene = loaded.unwrap_or_else(|report| panic!("{report}")).valid;
        mean_of(&Real::new(&scene, 0).expect("a machine"))
    });
    let says = "The lit box, 48 x 48 pixels, each shown as 4 x 4, the exact mean of 2^6 paths a \
                pixel, exposure 1: `lights: none`, `mis`, `auto`."
        .to_owned();
    let body = Body::Picture(enlarged(&strip(&images), 4), EXPOSURE);
    Figure { body, says }
}

/// Pixels along each side of the gates machine's picture.
const GATES: u32 = 32;
/// Factor by which it is enlarged.
const TIMES: u32 = 8;

fn small_box() -> ValidScene {
    cornell(&[
        &format!("film={{ width: {GATES}, height: {GATES} }}"),
        "sampling.path_bits=12",
    ])
}

/// Renders the Cornell box by gates.
pub(super) fn gates() -> Figure {
    by_gates(Model::Gates)
}

/// Same as [`gates`], by a model that makes the same picture.
pub(crate) fn by_gates(model: Model) -> Figure {
    let options = RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    };
    let (image, _) = rendered(&small_box(), &options);
    let says =
        "32 x 32 pixels, each shown as 8 x 8, 2^12 paths a pixel, exposure 1: every gate of \
                compute, flip and uncompute executed for every path, no counting noise (`--model \
                gates --estimator exact`)."
            .to_owned();
    let body = Body::Picture(enlarged(&image, TIMES), EXPOSURE);
    Figure { body, says }
}

/// Renders a part of the same picture by gates, and returns it with the same part of `whole`.
#[allow(dead_code, reason = "the test's")]
pub(crate) fn gates_crop(whole: &Image) -> [Vec<[f64; 3]>; 2] {
    const CROP: [u32; 4] = [13, 11, 4, 4];
    let options = RenderOptions {
        model: Some(Model::Gates),
        estimator: Some(Estimator::Exact),
        crop: Some(CROP),
        ..RenderOptions::default()
    };
    let (part, _) = rendered(&small_box(), &options);
    let [left, top, width, height] = CROP;
    let pixel = |k: u32| {
        let (x, y) = (left + k % width, top + k / width);
        whole.pixels[(y * TIMES * whole.width + x * TIMES) as usize]
    };
    [part.pixels, (0..width * height).map(pixel).collect()]
}
