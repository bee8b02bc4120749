//! Last steps of reading that concern several keys at once, or what was written at all.

use super::shape::{Expression, Shape, is_auto};
use super::{Data, Jacobian, Lights, Sampling, Scene, Sequence, Square};
use crate::syntax::tree::Node;
use crate::syntax::{Path, Place, Problem, Problems};

/// Under the product lattice, `path_bits` is the sum of all bits if it is not written. A sum
/// beyond the range is reported for the bits, not for what nobody wrote.
pub(super) fn path_bits(
    mut sampling: Sampling,
    node: &Node,
    _: &Place<'_>,
    _: &mut Problems,
) -> Sampling {
    if sampling.sequence == Sequence::ProductLattice && node.entry("path_bits").is_none() {
        sampling.path_bits = sampling.lattice_bits().min(super::MAX_PATH_BITS);
    }
    sampling
}

impl Sampling {
    /// The sum of the bits of all coordinates: the path bits of the product lattice.
    pub fn lattice_bits(&self) -> u32 {
        let squares = self.squares();
        let bits = squares.flat_map(|(_, _, bits)| bits);
        bits.fold(0, u32::saturating_add)
    }

    /// The bits of the point on a lamp that the surface is connected to which the ray of `depth`
    /// leaves; none where no lamp is sampled.
    pub fn light(&self, depth: usize) -> Option<[u32; 2]> {
        let light = self.depths.get(depth)?.light;
        light.filter(|_| self.lights != Lights::None && depth > 0)
    }

    /// The squares that a path samples, in the order of a sequence's dimensions, each with its depth
    /// and its bits: those of all rays, and then the points on lamps. So rays have the dimensions that
    /// they have without lamps: light that only they find is sampled no worse for being beside lamps.
    pub fn squares(&self) -> impl Iterator<Item = (usize, Square, [u32; 2])> + '_ {
        let rays = self.depths.iter().enumerate();
        let rays = rays.map(|(depth, sampling)| (depth, Square::Ray, sampling.bits));
        let lights = (0..self.depths.len())
            .filter_map(|depth| Some((depth, Square::Light, self.light(depth)?)));
        rays.chain(lights)
    }
}

/// `accuracy` replaces parameters: none of them may be written beside it.
pub(super) fn scene(scene: Scene, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Scene {
    if node.entry("accuracy").is_some() {
        for key in ["precision", "comparator", "counting"] {
            if node.entry(key).is_some() {
                problems.push(conflict(&at.path(), key));
            }
        }
        let sampling = node.entry("sampling");
        if sampling.is_some_and(|entry| entry.value.entry("path_bits").is_some()) {
            problems.push(conflict(&at.key("sampling").path(), "path_bits"));
        }
    }
    scene
}

/// The problem of `key`, in the record at `path`, beside `accuracy`.
pub(crate) fn conflict(path: &Path, key: &'static str) -> Problem {
    let problem = Problem::new(
        path.name(key),
        crate::syntax::Sampling::BesideAccuracy { key },
    );
    problem.also(Path::root().name("accuracy"))
}

/// `auto`, or an expression.
pub(super) struct JacobianShape;

impl Shape for JacobianShape {
    type Value = Jacobian;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Jacobian {
        if is_auto(node) {
            return Jacobian::Auto;
        }
        Jacobian::Stated(Expression.decode(node, at, problems))
    }
    fn fallback(&self) -> Jacobian {
        Jacobian::Auto
    }
    fn check(&self, value: &Jacobian, at: &Place<'_>, problems: &mut Problems) {
        if let Jacobian::Stated(text) = value {
            Expression.check(text, at, problems);
        }
    }
    fn encode(&self, value: &Jacobian) -> Option<Data> {
        match value {
            Jacobian::Auto => Some(Data::text("auto")),
            Jacobian::Stated(text) => Expression.encode(text),
        }
    }
    fn schema(&self) -> Data {
        Expression.schema()
    }
}
