//! Faces of one plane: every model and every search sees the first in the list, in all orders of the list.

use crate::common::numbers::Numbers;
use crate::common::scene::written;
use qrt::prelude::*;
use qrt::runtime::path_machines::{PixelSum, Real};
use qrt::scene::valid::ValidScene;
use std::fmt::Write as _;

/// A rectangle of cells on the plane z = `plane`.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    plane: i32,
    low: [i32; 2],
    high: [i32; 2],
    /// Radiance of the front, a power of two, so that comparators count it exactly; 0 for a surface that
    /// only reflects.
    radiance: u32,
    /// True if the front looks towards the camera, at positive z.
    front: bool,
}

const CELLS: i32 = 4;

fn rectangle(numbers: &mut Numbers) -> Rectangle {
    let mut side = || {
        let low = numbers.below(CELLS as usize) as i32;
        (low, low + 1 + numbers.below((CELLS - low) as usize) as i32)
    };
    let (x, y) = (side(), side());
    Rectangle {
        plane: -(numbers.below(2) as i32),
        low: [x.0, y.0],
        high: [x.1, y.1],
        radiance: [0, 1, 2, 4][numbers.below(4)],
        front: numbers.below(4) > 0,
    }
}

/// Returns a scene with a camera that looks along -z at `CELLS` by `CELLS` cells, one per pixel.
fn scene(list: &[Rectangle], rest: &str) -> String {
    let middle = f64::from(CELLS) / 2.0;
    let mut text = format!(
        "name: stack\nfilm: {{ width: {CELLS}, height: {CELLS} }}\ncamera: {{ orthographic: {{ eye: \
         [{middle}, {middle}, 3], target: [{middle}, {middle}, 0], height: {CELLS} }} }}\nmaterials:\n"
    );
    text += "  m0: { lambertian: { albedo: [0.5, 0.5, 0.5] } }\n";
    for radiance in [1, 2, 4] {
        let rgb = [radiance; 3];
        let _ = writeln!(
            text,
            "  m{radiance}: {{ emitter: {{ radiance: {rgb:?} }} }}"
        );
    }
    text += "geometry:\n";
    for face in list {
        let ([a, b], [c, d], z) = (face.low, face.high, face.plane);
        let mut corners = [[a, b, z], [c, b, z], [c, d, z], [a, d, z]];
        if !face.front {
            corners.reverse();
        }
        let _ = writeln!(
            text,
            "  - quad: {{ vertices: {corners:?}, material: m{} }}",
            face.radiance
        );
    }
    text + rest
}

/// Returns the radiance of each cell, from the top left: that of the first face in the list on the nearest plane.
fn seen(list: &[Rectangle]) -> Vec<f64> {
    let cells = (0..CELLS * CELLS).map(|n| [n % CELLS, CELLS - 1 - n / CELLS]);
    let radiance = |cell: [i32; 2]| {
        let over =
            |face: &&Rectangle| (0..2).all(|k| face.low[k] <= cell[k] && cell[k] < face.high[k]);
        let nearest = list.iter().filter(over).map(|face| face.plane).max()?;
        let first = list
            .iter()
            .filter(over)
            .find(|face| face.plane == nearest)?;
        Some(if first.front {
            f64::from(first.radiance)
        } else {
            0.0
        })
    };
    cells.map(|cell| radiance(cell).unwrap_or(0.0)).collect()
}

fn orders(list: &[Rectangle]) -> Vec<Vec<Rectangle>> {
    if list.len() <= 1 {
        return vec![list.to_vec()];
    }
    (0..list.len())
        .flat_map(|first| {
            let mut rest = list.to_vec();
            let one = rest.remove(first);
            orders(&rest).into_iter().map(move |mut order| {
                order.insert(0, one);
                order
            })
        })
        .collect()
}

fn red(rendered: &Rendered) -> Vec<f64> {
    rendered.image.pixels.iter().map(|pixel| pixel[0]).collect()
}

fn exact(model: Model) -> RenderOptions<'static> {
    RenderOptions {
        model: Some(model),
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    }
}

/// Asserts that boxes change no sum of any of 4 x 4 pixels; returns the sums.
fn sums_with_boxes(scene: &ValidScene, text: &str) -> Vec<PixelSum> {
    let pixels: Vec<[u32; 2]> = (0..16).map(|n| [n % 4, n / 4]).collect();
    let [plain, boxed] = [false, true].map(|boxes| {
        let real = Real::new(scene, 0).unwrap().with_boxes(boxes);
        real.sums(&pixels)
    });
    assert_eq!(plain, boxed, "{text}");
    boxed
}

#[test]
fn the_first_that_is_listed_is_seen_in_all_orders_and_models() {
    // The last ray tests emitters only, the first of two rays tests all faces; samples lie within a cell.
    let one = "sampling: { path_bits: 2, depths: [{ bits: [1, 1] }] }\n";
    let two =
        "sampling: { path_bits: 4, lights: none, depths: [{ bits: [1, 1] }, { bits: [1, 1] }] }\n";
    let mut checked = 0;
    for seed in 0..6 {
        let mut numbers = Numbers(seed);
        let list: Vec<Rectangle> = (0..4).map(|_| rectangle(&mut numbers)).collect();
        for (number, order) in orders(&list).into_iter().enumerate() {
            let expected = seen(&order);
            let text = scene(&order, one);
            let scene = written(&text, &[]);
            let mut models = vec![Model::Real];
            // Circuits take a while to lower.
            if number % 4 == 0 {
                models.extend([Model::Fixed, Model::Gates]);
            }
            for model in models {
                let rendered = render(&scene, &exact(model)).unwrap();
                assert_eq!(red(&rendered), expected, "{model:?}\n{text}");
            }
            let sums = sums_with_boxes(&scene, &text);
            let boxed: Vec<f64> = sums.iter().map(|sum| sum.colour[0] / 4.0).collect();
            assert_eq!(boxed, expected, "{text}");
            checked += 1;
        }
        // Faces that are seen directly, where others emit towards them.
        for order in orders(&list).into_iter().step_by(7) {
            let flat = order.iter().all(|face| face.plane == order[0].plane);
            let text = self::scene(&order, two);
            let scene = written(&text, &[]);
            sums_with_boxes(&scene, &text);
            if flat {
                let rendered = render(&scene, &exact(Model::Real)).unwrap();
                assert_eq!(red(&rendered), seen(&order), "{text}");
            }
        }
    }
    assert_eq!(checked, 6 * 24);
}

/// A lamp in a plane with a face that covers a part of it, above a floor: the sampled point of a lamp is
/// dark where a face earlier in the list covers it, and lit where a later one does.
#[test]
fn a_shadow_ray_sees_the_face_that_is_listed_first() {
    let lamp =
        "  - quad: { vertices: [[0, 2, 0], [2, 2, 0], [2, 2, 2], [0, 2, 2]], material: lamp }\n";
    let cover =
        "  - quad: { vertices: [[1, 2, -1], [3, 2, -1], [3, 2, 3], [1, 2, 3]], material: white }\n";
    let half =
        "  - quad: { vertices: [[0, 2, 0], [1, 2, 0], [1, 2, 2], [0, 2, 2]], material: lamp }\n";
    let other = "  - quad: { vertices: [[-2, 2, 4], [-1, 2, 4], [-1, 2, 5], [-2, 2, 5]], material: lamp }\n";
    let text = |list: &[&str], path_bits: u32| {
        format!(
            "name: covered\ncamera: {{ perspective: {{ eye: [0, 1, 6], target: [0, 0, 0], vfov: 40 }} }}\n\
             film: {{ width: 4, height: 4 }}\nmaterials:\n  lamp: {{ emitter: {{ radiance: [2, 2, 2] }} }}\n  \
             white: {{ lambertian: {{ albedo: [0.5, 0.5, 0.5] }} }}\ngeometry:\n{}  - quad: {{ vertices: \
             [[-4, 0, 8], [4, 0, 8], [4, 0, -4], [-4, 0, -4]], material: white }}\nsampling: {{ path_bits: \
             {path_bits}, lights: next-event, depths: [{{ bits: [6, 6] }}, {{ bits: [6, 6], light: [8, 8] }}] }}\n",
            list.concat()
        )
    };
    let picture = |text: &str, model: Model| {
        let rendered = render(&written(text, &[]), &exact(model)).unwrap();
        red(&rendered)
    };
    let mean = |list: &[&str], model: Model| {
        let red = picture(&text(list, 10), model);
        red.iter().sum::<f64>() / red.len() as f64
    };
    let lists: [&[&str]; 4] = [
        &[lamp, other],
        &[half, other],
        &[cover, lamp, other],
        &[lamp, cover, other],
    ];
    for list in lists {
        let many = text(list, 10);
        sums_with_boxes(&written(&many, &[]), &many);
        // Circuits take a while to run.
        let few = text(list, 4);
        let [fixed, gates] = [Model::Fixed, Model::Gates].map(|model| picture(&few, model));
        assert!(fixed.iter().any(|&red| red > 0.0), "{few}");
        assert_eq!(fixed, gates, "{few}");
    }
    for model in [Model::Real, Model::Fixed] {
        let [whole, cut] = [&[lamp, other], &[half, other]].map(|list| mean(list, model));
        assert!(cut < 0.7 * whole);
        // Ceiling first: half the lamp. Lamp first, and another behind the ceiling: all of it.
        let covered = mean(&[cover, lamp, other], model);
        let uncovered = mean(&[lamp, cover, other], model);
        assert!((covered / cut - 1.0).abs() < 0.01, "{covered} {cut}");
        assert!(
            (uncovered / whole - 1.0).abs() < 0.01,
            "{uncovered} {whole}"
        );
    }
}

/// The normals of the two lamps are (1, -1, 0) up to rounding, which alone decides the largest component.
#[test]
fn the_first_that_is_listed_is_seen_at_45_degrees() {
    let lamp = |left: f64, radiance: u32| {
        let corners = [[left, 0.0], [-0.5, 0.0], [-0.5, 1.0], [left, 1.0]];
        let corners = corners.map(|[x, z]| [x, x + 0.1, z]);
        format!("  - quad: {{ vertices: {corners:?}, material: m{radiance} }}\n")
    };
    let (one, two) = (lamp(-0.9, 1), lamp(-0.8, 2));
    for (list, radiance) in [(one.clone() + &two, 1.0), (two + &one, 2.0)] {
        let text = format!(
            "name: slanted\nfilm: {{ width: 2, height: 2 }}\ncamera: {{ orthographic: {{ eye: [0.35, -1.55, 0.5], \
             target: [-0.65, -0.55, 0.5], up: [0, 0, 1], height: 0.2 }} }}\nmaterials:\n  m0: {{ lambertian: {{ \
             albedo: [0.5, 0.5, 0.5] }} }}\n  m1: {{ emitter: {{ radiance: [1, 1, 1] }} }}\n  m2: {{ emitter: {{ \
             radiance: [2, 2, 2] }} }}\ngeometry:\n{list}  - quad: {{ vertices: [[-1, -1, -1], [1, -1, -1], [1, 1, \
             -1], [-1, 1, -1]], material: m0 }}\nsampling: {{ path_bits: 4, depths: [{{ bits: [4, 4] }}] }}\n"
        );
        let scene = written(&text, &[]);
        for model in [Model::Real, Model::Fixed, Model::Gates] {
            let found = red(&render(&scene, &exact(model)).unwrap());
            assert!(
                found.iter().all(|colour| (colour - radiance).abs() < 0.01),
                "{model:?} {found:?}\n{text}"
            );
        }
    }
}
