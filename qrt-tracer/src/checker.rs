//! Checkers: which of a surface's two colours a hit has.
//!
//! A checker's cells are cubes along the axes of the scene. A hit at `p` lies in the cell
//! `floor(p / scale)`, and has the second colour if the sum of the cell's three coordinates is odd.
//! In a circuit, a cell's coordinate is even or odd by one bit of `p / scale`.
//!
//! A face that lies across an axis has one coordinate along it, which rounding may take to either
//! side of a cell's end. That coordinate is a constant of the face.

use super::vector::Vector;
use super::{Arith, StageGeometry};
use qrt_scene::Checker;
use qrt_scene::valid::Polygon;

/// The checkers of a scene's surfaces.
#[derive(Clone, Debug)]
pub(crate) struct Checkers {
    /// By face: the row of its second colour, or of its only one.
    second: Vec<u32>,
    lattices: Vec<Lattice>,
    /// The surface with the smallest cells, and their edge in stage units.
    smallest: (usize, f64),
}

/// The cells of all faces whose checkers have one scale.
#[derive(Clone, Debug)]
struct Lattice {
    /// Cells per stage unit.
    density: f64,
    /// The cell's coordinates at the stage's origin, less an even number.
    origin: [f64; 3],
    /// The faces that the lattice is for.
    members: Flags,
    /// By axis: the faces whose hits differ in their coordinate.
    varies: [Flags; 3],
    /// The faces whose constant coordinates have an odd sum.
    odd: Flags,
}

/// A property of faces.
#[derive(Clone, Debug, PartialEq)]
enum Flags {
    Never,
    Always,
    /// By face: 1 for those that have it.
    By(Vec<u32>),
}

impl Flags {
    /// The property of `number` faces that `pairs` lists; other faces may have it or not.
    fn new(number: usize, pairs: impl Iterator<Item = (usize, bool)> + Clone) -> Self {
        if pairs.clone().all(|(_, flag)| !flag) {
            return Self::Never;
        }
        if pairs.clone().all(|(_, flag)| flag) {
            return Self::Always;
        }
        let mut flags = vec![0; number];
        for (face, flag) in pairs {
            flags[face] = u32::from(flag);
        }
        Self::By(flags)
    }
}

impl Checkers {
    /// The checkers of `surfaces`, by their number; None if there are none. `surface_of` is by face,
    /// `polygons` come first among the faces. The rows of second colours follow those of the surfaces.
    pub(crate) fn new(
        geometry: &StageGeometry,
        polygons: &[Polygon],
        surface_of: &[u32],
        surfaces: &[Option<&Checker>],
    ) -> Option<Self> {
        let edge = |checker: &Checker| checker.scale * geometry.scale;
        let numbered = surfaces.iter().enumerate();
        let edges = numbered.filter_map(|(number, checker)| Some((number, edge((*checker)?))));
        let smallest = edges.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let mut scales: Vec<f64> = surfaces.iter().flatten().map(|c| c.scale).collect();
        scales.sort_by(f64::total_cmp);
        scales.dedup();
        let checker = |face: usize| surfaces[surface_of[face] as usize];
        let faces = 0..surface_of.len();
        let lattice = |scale: f64| {
            let density = 1.0 / (scale * geometry.scale);
            let origin = geometry.centre / scale;
            let is_mine = |face: usize| checker(face).is_some_and(|c| c.scale == scale);
            let mine = faces.clone().filter(|&face| is_mine(face));
            let layers: Vec<(usize, [Option<f64>; 3])> = mine
                .map(|face| match (polygons.get(face), checker(face)) {
                    (Some(polygon), Some(checker)) => (face, checker.layers(polygon.outline())),
                    _ => (face, [None; 3]),
                })
                .collect();
            let by_face = |property: &dyn Fn(&[Option<f64>; 3]) -> bool| {
                let pairs = layers
                    .iter()
                    .map(|(face, layers)| (*face, property(layers)));
                Flags::new(surface_of.len(), pairs)
            };
            let members = faces.clone().map(|face| (face, is_mine(face)));
            Lattice {
                density,
                origin: origin.to_array().map(|o| o - 2.0 * (o / 2.0).floor()),
                members: Flags::new(surface_of.len(), members),
                varies: std::array::from_fn(|axis| by_face(&|layers| layers[axis].is_none())),
                odd: by_face(&|layers| {
                    let odd = layers
                        .iter()
                        .flatten()
                        .filter(|&&layer| Checker::is_odd(layer));
                    odd.count() % 2 == 1
                }),
            }
        };
        Some(Self {
            second: surface_of
                .iter()
                .map(|&surface| match surfaces[surface as usize] {
                    Some(_) => surface + surfaces.len() as u32,
                    None => surface,
                })
                .collect(),
            lattices: scales.into_iter().map(lattice).collect(),
            smallest,
        })
    }

    /// The number of the surface with the smallest cells, and their edge in stage units.
    pub(crate) fn smallest(&self) -> (usize, f64) {
        self.smallest
    }

    /// The row of the colour of a hit at `point`, in stage units, on `face`, which has `surface`.
    #[inline(always)]
    pub(super) fn row<A: Arith>(
        &self,
        cx: &mut A,
        point: &Vector<A>,
        face: A::Index,
        surface: A::Index,
    ) -> A::Index {
        let mut odd = cx.truth(false);
        for lattice in &self.lattices {
            let mine = lattice.is_odd(cx, point, face);
            odd = match flag(cx, &lattice.members, face) {
                Flag::Always => mine,
                Flag::Never => odd,
                Flag::On(members) => cx.select_truth(members, mine, odd),
            };
        }
        let second = cx.entry(&self.second, face);
        cx.select_index(odd, second, surface)
    }
}

impl Lattice {
    #[inline(always)]
    fn is_odd<A: Arith>(&self, cx: &mut A, point: &Vector<A>, face: A::Index) -> A::Bool {
        let mut sum = match flag(cx, &self.odd, face) {
            Flag::Always => cx.truth(true),
            Flag::Never => cx.truth(false),
            Flag::On(odd) => odd,
        };
        for (axis, &along) in point.iter().enumerate() {
            let varies = flag(cx, &self.varies[axis], face);
            if let Flag::Never = varies {
                continue;
            }
            let cells = cx.scale(along, self.density);
            let cell = math!(cx, cells + real(self.origin[axis]));
            let mut odd = cx.odd(cell);
            if let Flag::On(varies) = varies {
                odd = cx.and(odd, varies);
            }
            let even = cx.not(sum);
            sum = cx.select_truth(odd, even, sum);
        }
        sum
    }
}

/// A property of the face of a hit.
enum Flag<A: Arith> {
    Never,
    Always,
    On(A::Bool),
}

#[inline(always)]
fn flag<A: Arith>(cx: &mut A, flags: &Flags, face: A::Index) -> Flag<A> {
    match flags {
        Flags::Never => Flag::Never,
        Flags::Always => Flag::Always,
        Flags::By(flags) => {
            let flag = cx.entry(flags, face);
            Flag::On(cx.is(flag, 1))
        }
    }
}
