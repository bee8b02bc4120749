//! Sample points of paths, in the square and on the hemisphere.

use super::{Figure, style};
use qrt::counting::random::Stream;
use qrt::drawing::{Canvas, polyline};
use qrt::scene::sampling::{Coordinate, PathPoints, cell_centre, maps};
use qrt::scene::{DepthSampling, Map, Sampling, Sequence};
use qrt::syntax::expr::Variables;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Bits of u and v.
const LATTICE: [u32; 2] = [3, 4];

/// The lattice's points, each with the number of its band of u.
struct Bands(Vec<(usize, Variables)>);

impl Bands {
    const COUNT: usize = 4;

    fn new() -> Self {
        let sampling = Sampling {
            sequence: Sequence::ProductLattice,
            path_bits: LATTICE[0] + LATTICE[1],
            depths: vec![DepthSampling::of_bits(LATTICE)],
            ..Sampling::default()
        };
        let points = PathPoints::new(&sampling).expect("a lattice");
        let ids = 0..1_u64 << points.path_bits();
        let all = ids.map(|id| {
            let [row, column] =
                [Coordinate::u(0), Coordinate::v(0)].map(|c| points.index(c, id, 0));
            let at = Variables {
                u: cell_centre(row, LATTICE[0]),
                v: cell_centre(column, LATTICE[1]),
                ..Variables::default()
            };
            (row as usize / 2, at)
        });
        Self(all.collect())
    }

    /// Returns the points of each band, with the class of the band's colour.
    fn each(&self) -> impl Iterator<Item = (String, Vec<&Variables>)> {
        (0..Self::COUNT).map(|wanted| {
            let of = self.0.iter().filter(|(band, _)| *band == wanted);
            (format!("s{wanted}"), of.map(|(_, at)| at).collect())
        })
    }
}

/// Draws the lattice in the square and on the hemisphere.
pub(super) fn hemispheres() -> Figure {
    let title = "One lattice of 8 × 16 cells, and where two maps send it";
    let mut canvas = Canvas::new(title, 580.0, 350.0);
    let bands = Bands::new();
    let top = 92.0;
    square(&mut canvas, &bands, top);
    let both = [
        (Map::UniformHemisphere, "uniform hemisphere", 290.0),
        (Map::CosineHemisphere, "cosine hemisphere", 480.0),
    ];
    let low = both.map(|(map, name, middle)| {
        canvas.text("mid", [middle, 52.0], name);
        hemisphere(&mut canvas, &bands, map, [middle, top])
    });
    for (y, label) in [(top + 70.0, "from above"), (top + 215.0, "from the side")] {
        canvas.upright("soft small", [385.0, y], label);
    }
    let says = format!(
        "128 cell centres of a lattice in the unit square, in four colours by u, and their \
         directions on the hemisphere under two maps. The uniform map gives equal solid angles to \
         cells, J = 2 pi: {} of 128 directions lie lower than 30 degrees above the surface. The \
         cosine map gives equal projected areas, J = pi / cos: {} do.",
        low[0], low[1]
    );
    Figure::drawn(canvas, says)
}

/// Draws the lattice itself.
fn square(canvas: &mut Canvas, bands: &Bands, top: f64) {
    let (left, side) = (44.0, 140.0);
    canvas.text("mid", [left + 70.0, 52.0], "the square");
    canvas.rectangle("thin axis", [left, top, side, side]);
    for (class, points) in bands.each() {
        let places = points.iter();
        let places = places.map(|at| [left + side * at.v, top + side * (1.0 - at.u)]);
        canvas.dots(&class, places);
    }
    canvas.text("soft mid", [left + 70.0, top + side + 20.0], "v");
    canvas.text("soft mid", [left - 14.0, top + 74.0], "u");
}

/// Draws the image of the lattice under a map, from above and from the side; returns the number of
/// directions lower than 30 degrees.
fn hemisphere(canvas: &mut Canvas, bands: &Bands, map: Map, [middle, top]: [f64; 2]) -> usize {
    let phi = maps::builtin(map);
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
    let mut low = 0;
    for (class, points) in bands.each() {
        let directions = points.iter();
        let directions = directions.map(|at| [0, 1, 2].map(|i: usize| phi[i].eval(at)));
        let directions: Vec<[f64; 3]> = directions.collect();
        let from_above = directions.iter().map(|[x, y, _]| seen([*x, *y]));
        canvas.dots(&class, from_above);
        let from_aside = directions.iter().map(|[x, _, z]| aside([*x, *z]));
        canvas.dots(&class, from_aside);
        low += directions.iter().filter(|[.., z]| *z < 0.5).count();
    }
    low
}

/// Log2 of the number of paths in the projections.
const PATH_BITS: u32 = 8;

/// Paths of three rays, by the six coordinates of each.
type Paths = Vec<[f64; 6]>;

/// Returns the paths of a sequence, with `bits` bits for each ray's u and v.
fn paths(sequence: Sequence, bits: [[u32; 2]; 3]) -> Paths {
    let sampling = Sampling {
        sequence,
        path_bits: PATH_BITS,
        depths: bits.map(DepthSampling::of_bits).to_vec(),
        ..Sampling::default()
    };
    let points = PathPoints::new(&sampling).expect("a sequence");
    let coordinate = |id: u64, dimension: usize| {
        let of_ray = [Coordinate::u, Coordinate::v][dimension % 2];
        let coordinate = of_ray(dimension / 2);
        let shift = points.shift(0, 0, 0, coordinate);
        let index = points.index(coordinate, id, shift);
        cell_centre(index, points.bits(coordinate))
    };
    let ids = 0..1_u64 << PATH_BITS;
    ids.map(|id| [0, 1, 2, 3, 4, 5].map(|d| coordinate(id, d)))
        .collect()
}

/// Draws two-dimensional projections of three sets of paths.
pub(super) fn projections() -> Figure {
    let title = "256 paths of three rays: six coordinates, two at a time";
    let mut canvas = Canvas::new(title, 580.0, 590.0);
    let lattice = paths(Sequence::ProductLattice, [[2, 2], [1, 1], [1, 1]]);
    let net = paths(Sequence::DigitalNet, [[16, 16]; 3]);
    let mut stream = Stream::new(0, 0, 0, 0);
    let random = (0..1 << PATH_BITS).map(|_| [(); 6].map(|()| stream.uniform()));
    let sets = [
        ("product lattice", lattice),
        ("random paths", random.collect()),
        ("digital net", net),
    ];
    let pairs = [
        ([0, 1], "v₀ over u₀ (pixel)"),
        ([4, 5], "v₂ over u₂ (last ray)"),
        ([0, 4], "u₂ over u₀"),
    ];
    let side = 160.0;
    let mut different = Vec::new();
    for (column, (name, paths)) in sets.iter().enumerate() {
        let left = 46.0 + 178.0 * column as f64;
        canvas.text("mid", [left + side / 2.0, 48.0], name);
        for (row, (axes, label)) in pairs.iter().enumerate() {
            let top = 60.0 + 176.0 * row as f64;
            canvas.rectangle("thin axis", [left, top, side, side]);
            let class = format!("s{}", style(name));
            let to = [left, top, side];
            if column == 0 {
                canvas.upright("soft", [28.0, top + side / 2.0], label);
                different.push(projection(&mut canvas, &class, paths, *axes, to, true));
            } else {
                projection(&mut canvas, &class, paths, *axes, to, false);
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
    Figure::drawn(canvas, says)
}

/// Draws two coordinates of paths into a square. With `by_number`, a point's size grows with the number
/// of paths on it. Returns the number of different points.
fn projection(
    canvas: &mut Canvas,
    class: &str,
    paths: &[[f64; 6]],
    [x, y]: [usize; 2],
    [left, top, side]: [f64; 3],
    by_number: bool,
) -> usize {
    let mut places: BTreeMap<[u64; 2], u32> = BTreeMap::new();
    for path in paths {
        let key = [path[x], path[y]].map(f64::to_bits);
        *places.entry(key).or_default() += 1;
    }
    let at = |key: &[u64; 2]| {
        let [x, y] = key.map(f64::from_bits);
        [left + side * x, top + side * (1.0 - y)]
    };
    if by_number {
        for (key, count) in &places {
            let radius = 1.7 * f64::from(*count).sqrt();
            canvas.circle(&format!("solid {class}"), at(key), radius);
        }
    } else {
        canvas.dots(class, places.keys().map(at));
    }
    places.len()
}
