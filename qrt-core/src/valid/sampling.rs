//! Ids must fit into words, the net must have its dimensions, and knobs must not contradict.

use crate::codes;
use crate::report::{Path, Problem};
use crate::sampling::{MAX_DIMENSIONS, MAX_PATH_BITS};
use crate::scene::{Comparator, Counting, Map, Precision, Sampling, Scene, Sequence, settle};

/// Bits of path id and comparator together: counts of their ids stay within 64-bit words.
pub const MAX_ID_BITS: u32 = 62;
/// Rays of a path under the digital net, which has two dimensions for each.
pub const MAX_NET_DEPTHS: usize = MAX_DIMENSIONS / 2;

pub(super) fn check(scene: &Scene, problems: &mut Vec<Problem>) {
    let sampling = &scene.sampling;
    let path = Path::root().key("sampling");
    let path_bits = path.key("path_bits");
    if let Some(first) = sampling.depths.first()
        && first.map != Map::Auto
    {
        let what = "the primary ray has no map: it samples the pixel square";
        let problem = Problem::new(
            codes::PRIMARY_MAP,
            path.key("depths").item(0).key("map"),
            what,
        )
        .help("remove it; the maps of reflected rays start with the second entry");
        problems.push(problem);
    }
    match sampling.sequence {
        Sequence::DigitalNet if sampling.depths.len() > MAX_NET_DEPTHS => {
            let count = sampling.depths.len();
            let needed = 2 * count;
            let what =
                format!("{count} depths need {needed} dimensions: the net has {MAX_DIMENSIONS}");
            let problem = Problem::new(codes::TOO_MANY_DIMENSIONS, path.key("depths"), what).help(
                format!("use at most {MAX_NET_DEPTHS} depths, or `product-lattice`"),
            );
            problems.push(problem);
        }
        Sequence::ProductLattice => lattice(sampling, &path, problems),
        Sequence::DigitalNet => {}
    }
    let ids = sampling.path_bits.saturating_add(scene.comparator.bits);
    if ids > MAX_ID_BITS && sampling.path_bits <= MAX_PATH_BITS {
        let what = format!(
            "{} path bits and {} comparator bits make 2^{ids} ids: at most 2^{MAX_ID_BITS} fit",
            sampling.path_bits, scene.comparator.bits
        );
        let comparator = Path::root().key("comparator").key("bits");
        let problem = Problem::new(codes::TOO_MANY_IDS, path_bits.clone(), what)
            .also(comparator, "with these")
            .help("use fewer of either");
        problems.push(problem);
    }
    if scene.accuracy.is_some() {
        let knobs = [
            ("precision", scene.precision != Precision::default()),
            ("comparator", scene.comparator != Comparator::default()),
            ("counting", scene.counting != Counting::default()),
        ];
        for (knob, _) in knobs.into_iter().filter(|(_, changed)| *changed) {
            problems.push(settle::conflict(Path::root().name(knob), knob, "accuracy"));
        }
        let default = match sampling.sequence {
            Sequence::DigitalNet => Sampling::default().path_bits,
            Sequence::ProductLattice => sampling.lattice_bits(),
        };
        if sampling.path_bits != default {
            let name = path.name("path_bits");
            problems.push(settle::conflict(name, "path_bits", "accuracy"));
        }
    }
}

fn lattice(sampling: &Sampling, path: &Path, problems: &mut Vec<Problem>) {
    let sum = sampling.lattice_bits();
    if sum > MAX_PATH_BITS {
        let what =
            format!("the bits add up to {sum}: a lattice of at most 2^{MAX_PATH_BITS} paths");
        let problem = Problem::new(codes::TOO_MANY_IDS, path.key("depths"), what)
            .help("use fewer bits; a bit more in each of six coordinates is 64 times the paths");
        problems.push(problem);
    } else if sampling.path_bits != sum {
        let what = format!(
            "path_bits is {}, but the bits add up to {sum}",
            sampling.path_bits
        );
        let problem = Problem::new(codes::PATH_BITS_SUM, path.key("path_bits"), what)
            .also(path.key("depths"), "these bits")
            .help("under `product-lattice` leave `path_bits` out, or change the bits");
        problems.push(problem);
    }
}
