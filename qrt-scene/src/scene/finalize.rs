//! Final steps of decoding that concern several keys at once, or depend on which keys are written.

use super::shape::{Expression, Shape, is_auto};
use super::{Data, Jacobian, Lights, Sampling, Scene, Sequence, Square};
use crate::syntax::tree::Node;
use crate::syntax::{Path, Place, Problem, Problems};

/// Sets `path_bits`, if it is not written, to the sum of all bits under the product lattice. The
/// sum is clamped to the range, so that too large a sum is reported for the bits, not for a key
/// that is not written.
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

    /// Returns the bits of the point on a lamp that is connected to the start of the ray of
    /// `depth`; `None` if no lamp is sampled there.
    pub fn light(&self, depth: usize) -> Option<[u32; 2]> {
        let light = self.depths.get(depth)?.light;
        light.filter(|_| self.lights != Lights::None && depth > 0)
    }

    /// Iterates over the squares that a path samples, each with its depth and bits, in the order of
    /// a sequence's dimensions: all rays, and then the points on lamps. So rays have the same
    /// dimensions with and without lamps, and light that only rays find is sampled no worse because
    /// of lamps.
    pub fn squares(&self) -> impl Iterator<Item = (usize, Square, [u32; 2])> + '_ {
        let rays = self.depths.iter().enumerate();
        let rays = rays.map(|(depth, sampling)| (depth, Square::Ray, sampling.bits));
        let lights = (0..self.depths.len())
            .filter_map(|depth| Some((depth, Square::Light, self.light(depth)?)));
        rays.chain(lights)
    }
}

/// Reports parameters that are written beside `accuracy`, which replaces them.
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

/// Returns the problem of `key`, in the record at `path`, beside `accuracy`.
pub(crate) fn conflict(path: &Path, key: &'static str) -> Problem {
    let problem = Problem::new(
        path.name(key),
        crate::syntax::Sampling::BesideAccuracy { key },
    );
    problem.also(Path::root().name("accuracy"))
}

/// The shape of a Jacobian: `auto`, or an expression.
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
