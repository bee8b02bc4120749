//! Last steps of reading that concern several keys at once, or what was written at all.

use super::shape::{Expression, Shape, is_auto};
use super::{Data, Jacobian, Sampling, Scene, Sequence};
use crate::codes;
use crate::front::tree::Node;
use crate::report::Problem;
use crate::scene::decode::{Decoder, Place};

/// Under the product lattice, `path_bits` is the sum of all bits if it is not written. A sum
/// beyond the range is reported for the bits, not for what nobody wrote.
pub(super) fn path_bits(
    mut sampling: Sampling,
    node: &Node,
    _: &Place<'_>,
    _: &mut Decoder,
) -> Sampling {
    if sampling.sequence == Sequence::ProductLattice && node.entry("path_bits").is_none() {
        sampling.path_bits = sampling.lattice_bits().min(crate::sampling::MAX_PATH_BITS);
    }
    sampling
}

impl Sampling {
    /// The sum of the bits of all coordinates: the path bits of the product lattice.
    pub fn lattice_bits(&self) -> u32 {
        self.depths
            .iter()
            .flat_map(|depth| depth.bits)
            .fold(0, u32::saturating_add)
    }
}

/// `accuracy` replaces knobs: none of them may be written beside it.
pub(super) fn scene(scene: Scene, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Scene {
    if let Some(accuracy) = node.entry("accuracy") {
        for key in ["precision", "comparator", "counting"] {
            if node.entry(key).is_some() {
                decoder
                    .problems
                    .push(conflict(at.path().name(key), key, &accuracy.key));
            }
        }
        let sampling = at.key("sampling");
        let written = node
            .entry("sampling")
            .and_then(|entry| entry.value.entry("path_bits"));
        if written.is_some() {
            let path = sampling.path().name("path_bits");
            decoder
                .problems
                .push(conflict(path, "path_bits", &accuracy.key));
        }
    }
    scene
}

/// The problem of `knob` beside `accuracy`.
pub(crate) fn conflict(path: crate::report::Path, knob: &str, accuracy: &str) -> Problem {
    let message = format!("`{accuracy}` chooses `{knob}`, so that both cannot be given");
    Problem::new(codes::ACCURACY_CONFLICT, path, message)
        .also(
            crate::report::Path::root().name(accuracy),
            "the accuracy asked for",
        )
        .help("keep one of the two")
}

/// `auto`, or an expression.
pub(super) struct JacobianShape;

impl Shape for JacobianShape {
    type Value = Jacobian;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Jacobian {
        if is_auto(node) {
            return Jacobian::Auto;
        }
        Jacobian::Stated(Expression.decode(node, at, decoder))
    }
    fn fallback(&self) -> Jacobian {
        Jacobian::Auto
    }
    fn check(&self, value: &Jacobian, at: &Place<'_>, problems: &mut Vec<Problem>) {
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
