//! Where paths' sample points lie, in the square and on the hemisphere.

use super::Figure;
use super::drawing::{Anchor, Canvas, polyline};
use qrt::core::expr::Variables;
use qrt::core::sampling::{PathPoints, cell_centre, maps};
use qrt::core::scene::{DepthSampling, Map, Sampling, Sequence};
use qrt::runtime::random::Stream;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Bits of u and v.
const LATTICE: [u32; 2] = [3, 4];

/// The lattice in the square and on the hemisphere.
pub(super) fn hemispheres() -> Figure {
    let title = "One lattice of 8 × 16 cells, and where two maps send it";
    let mut canvas = Canvas::new(title, 580.0, 350.0);
    let sampling = Sampling {
        sequence: Sequence::ProductLattice,
        path_bits: LATTICE[0] + LATTICE[1],
        depths: vec![DepthSampling {
            bits: LATTICE,
            map: Map::Auto,
        }],
    };
    let points = PathPoints::new(&sampling).expect("a lattice");
    let square: Vec<(usize, Variables)> = (0..1_u64 << points.path_bits())
        .map(|id| {
            let [row, column] = [0, 1].map(|axis| points.index(0, axis, id, 0));
            let at = Variables {
                u: cell_centre(row, LATTICE[0]),
                v: cell_centre(column, LATTICE[1]),
                ..Variables::default()
            };
            (row as usize / 2, at)
        })
        .collect();
    let class = |band: usize| format!("s{band}");
    let of = |wanted: usize| square.iter().filter(move |(band, _)| *band == wanted);

    let (left, top, side) = (44.0, 92.0, 140.0);
    canvas.text("", [left + 70.0, 52.0], Anchor::Middle, "the square");
    canvas.rectangle("thin axis", [left, top, side, side]);
    for band in 0..4 {
        let places = of(band).map(|(_, at)| [left + side * at.v, top + side * (1.0 - at.u)]);
        canvas.dots(&class(band), places);
    }
    canvas.text(
        "soft",
        [left + 70.0, top + side + 20.0],
        Anchor::Middle,
        "v",
    );
    canvas.text("soft", [left - 14.0, top + 74.0], Anchor::Middle, "u");

    let mut rings = Vec::new();
    let both = [
        (Map::UniformHemisphere, "uniform hemisphere", 290.0),
        (Map::CosineHemisphere, "cosine hemisphere", 480.0),
    ];
    for (map, name, middle) in both {
        let phi = maps::builtin(map);
        let jacobian = maps::jacobian(&phi);
        canvas.text("", [middle, 52.0], Anchor::Middle, name);
        let (above, below, radius) = ([middle, top + 70.0], [middle, top + 240.0], 84.0);
        let circle = (0..=64).map(|k| {
            let angle = TAU * f64::from(k) / 64.0;
            [libm::cos(angle), libm::sin(angle)]
        });
        let circle: Vec<[f64; 2]> = circle.collect();
        let seen = |[x, y]: [f64; 2]| [above[0] + radius * x, above[1] - radius * y];
        let outline: Vec<[f64; 2]> = circle.iter().map(|at| seen(*at)).collect();
        canvas.path("axis", &polyline(&outline));
        let aside = |[x, z]: [f64; 2]| [below[0] + radius * x, below[1] - radius * z];
        let arc: Vec<[f64; 2]> = circle[..=32].iter().map(|at| aside(*at)).collect();
        canvas.path("axis", &format!("{}z", polyline(&arc)));
        let mut highest = [0.0_f64; 2];
        for band in 0..4 {
            let directions = of(band).map(|(_, at)| [0, 1, 2].map(|i: usize| phi[i].eval(at)));
            let directions: Vec<[f64; 3]> = directions.collect();
            let from_above = directions.iter().map(|[x, y, _]| seen([*x, *y]));
            canvas.dots(&class(band), from_above);
            let from_aside = directions.iter().map(|[x, _, z]| aside([*x, *z]));
            canvas.dots(&class(band), from_aside);
            let below_30 = directions.iter().filter(|[.., z]| *z < 0.5).count();
            highest[0] += below_30 as f64;
        }
        highest[1] = jacobian.eval(&square[0].1);
        rings.push(highest[0]);
    }
    for (y, label) in [(top + 70.0, "from above"), (top + 215.0, "from the side")] {
        canvas.upright("soft small", [385.0, y], label);
    }
    let says = format!(
        "128 cell centres of a lattice in the unit square, in four colours by u, and their \
         directions on the hemisphere under two maps. The uniform map gives equal solid angles to \
         cells, J = 2 pi: {} of 128 directions lie lower than 30 degrees above the surface. The \
         cosine map gives equal projected areas, J = pi / cos: {} do.",
        rings[0], rings[1]
    );
    Figure::svg(canvas.finish(&says), says)
}

/// Paths in the projections: 2^8.
const PATH_BITS: u32 = 8;

/// Two-dimensional projections of three sets of paths.
pub(super) fn projections() -> Figure {
    let title = "256 paths of three rays: six coordinates, two at a time";
    let mut canvas = Canvas::new(title, 580.0, 590.0);
    let depth = |bits| DepthSampling {
        bits,
        map: Map::Auto,
    };
    let made = |sequence, bits: [[u32; 2]; 3]| {
        let sampling = Sampling {
            sequence,
            path_bits: PATH_BITS,
            depths: bits.map(depth).to_vec(),
        };
        PathPoints::new(&sampling).expect("a sequence")
    };
    let lattice = made(Sequence::ProductLattice, [[2, 2], [1, 1], [1, 1]]);
    let net = made(Sequence::DigitalNet, [[16, 16]; 3]);
    let of = |points: &PathPoints| -> Vec<[f64; 6]> {
        let coordinate = |id: u64, dimension: usize| {
            let (ray, axis) = (dimension / 2, dimension % 2);
            let shift = points.shift(0, 0, 0, dimension);
            let index = points.index(ray, axis, id, shift);
            cell_centre(index, points.bits(ray, axis))
        };
        let ids = 0..1_u64 << PATH_BITS;
        ids.map(|id| [0, 1, 2, 3, 4, 5].map(|d| coordinate(id, d)))
            .collect()
    };
    let mut stream = Stream::new(0, 0, 0, 0);
    let random = (0..1 << PATH_BITS).map(|_| [(); 6].map(|()| stream.uniform()));
    let sets = [
        ("product lattice", of(&lattice)),
        ("random", random.collect()),
        ("digital net", of(&net)),
    ];
    let pairs = [
        ([0, 1], "v₀ over u₀ (pixel)"),
        ([4, 5], "v₂ over u₂ (last ray)"),
        ([0, 4], "u₂ over u₀"),
    ];
    let side = 160.0;
    let mut different = Vec::new();
    for (column, (name, points)) in sets.iter().enumerate() {
        let left = 46.0 + 178.0 * column as f64;
        canvas.text("", [left + side / 2.0, 48.0], Anchor::Middle, name);
        for (row, ([x, y], label)) in pairs.iter().enumerate() {
            let top = 60.0 + 176.0 * row as f64;
            canvas.rectangle("thin axis", [left, top, side, side]);
            if column == 0 {
                canvas.upright("soft", [28.0, top + side / 2.0], label);
            }
            let mut places: BTreeMap<[u64; 2], u32> = BTreeMap::new();
            for point in points {
                let key = [point[*x], point[*y]].map(f64::to_bits);
                *places.entry(key).or_default() += 1;
            }
            let at = |key: &[u64; 2]| {
                let [x, y] = key.map(f64::from_bits);
                [left + side * x, top + side * (1.0 - y)]
            };
            let class = format!("s{column}");
            if column == 0 {
                // As large as they are many.
                for (key, count) in &places {
                    let radius = 1.7 * f64::from(*count).sqrt();
                    canvas.circle(&format!("solid {class}"), at(key), radius);
                }
                different.push(places.len());
            } else {
                canvas.dots(&class, places.keys().map(at));
            }
        }
    }
    let says = format!(
        "Three projections of the same number of paths. The product lattice, whose 8 bits are \
         spread as 2, 2, 1, 1, 1, 1 over six coordinates, has {}, {} and {} different points there, \
         drawn as large as they are many. Random paths have 256 with gaps and clusters, the digital \
         net (shifted as in pixel (0, 0)) has 256: spread evenly in the first and the third, in \
         streaks between its last two coordinates.",
        different[0], different[1], different[2]
    );
    Figure::svg(canvas.finish(&says), says)
}
