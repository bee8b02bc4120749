//! Checks that path indices fit into words, that the net has enough dimensions, and that parameters
//! do not contradict each other.

use crate::sampling::{MAX_DIMENSIONS, MAX_PATH_BITS};
use crate::scene::{
    Comparator, Counting, LightPoint, Map, Precision, Sampling, Scene, Sequence, finalize,
};
use qrt_syntax::{Path, Problem, Problems, Sampling as Fault};

/// Maximum number of bits of path index and comparator together: counts of their basis states stay
/// within 64-bit words.
pub const MAX_ID_BITS: u32 = 62;
/// Maximum number of rays of a path under the digital net, which needs two dimensions for each, and
/// two for each point on a lamp.
pub const MAX_NET_DEPTHS: usize = MAX_DIMENSIONS / 2;
/// Maximum number of rays of a path under the product lattice. At the maximum most rays have no
/// bits, but each takes memory.
const MAX_LATTICE_DEPTHS: usize = 1024;

pub(super) fn check(scene: &Scene, problems: &mut Problems) {
    let sampling = &scene.sampling;
    let path = Path::root().key("sampling");
    let path_bits = path.key("path_bits");
    if let Some(first) = sampling.depths.first()
        && first.map != Map::Auto
    {
        let map = path.key("depths").item(0).key("map");
        problems.add(map, Fault::PrimaryMap);
    }
    let first = sampling.depths.first();
    if first.is_some_and(|primary| matches!(primary.light, LightPoint::Bits(_))) {
        let light = path.key("depths").item(0).key("light");
        problems.add(light, Fault::PrimaryLight);
    }
    for (depth, sampled) in sampling.depths.iter().enumerate() {
        let what = match depth {
            0 if scene.lens().is_some() => continue,
            0 => Fault::NoLens,
            _ => Fault::ReflectedLens,
        };
        if sampled.lens.is_some() {
            problems.add(path.key("depths").item(depth).key("lens"), what);
        }
    }
    match sampling.sequence {
        Sequence::DigitalNet => {
            let dimensions = 2 * sampling.squares().count();
            let most = MAX_DIMENSIONS;
            if dimensions > most {
                let lit = (0..sampling.depths.len()).any(|depth| sampling.light(depth).is_some());
                let what = Fault::TooManyDepths {
                    dimensions,
                    most,
                    lit,
                };
                problems.add(path.key("depths"), what);
            }
        }
        Sequence::ProductLattice => lattice(sampling, &path, problems),
    }
    let (bits, comparator) = (sampling.path_bits, scene.comparator.bits);
    if bits.saturating_add(comparator) > MAX_ID_BITS && bits <= MAX_PATH_BITS {
        let what = Fault::TooManyIds {
            path: bits,
            comparator,
            most: MAX_ID_BITS,
        };
        let problem = Problem::new(path_bits, what);
        problems.push(problem.also(Path::root().key("comparator").key("bits")));
    }
    if scene.accuracy.is_some() {
        let parameters = [
            ("precision", scene.precision != Precision::default()),
            ("comparator", scene.comparator != Comparator::default()),
            ("counting", scene.counting != Counting::default()),
        ];
        for (parameter, _) in parameters.into_iter().filter(|(_, changed)| *changed) {
            problems.push(finalize::conflict(&Path::root(), parameter));
        }
        let default = match sampling.sequence {
            Sequence::DigitalNet => Sampling::default().path_bits,
            Sequence::ProductLattice => sampling.lattice_bits(),
        };
        if sampling.path_bits != default {
            problems.push(finalize::conflict(&path, "path_bits"));
        }
    }
}

fn lattice(sampling: &Sampling, path: &Path, problems: &mut Problems) {
    let sum = sampling.lattice_bits();
    let depths = path.key("depths");
    let (rays, most) = (sampling.depths.len(), MAX_LATTICE_DEPTHS);
    if rays > most {
        problems.add(depths.clone(), Fault::TooManyRays { rays, most });
    }
    if sum > MAX_PATH_BITS {
        let most = MAX_PATH_BITS;
        problems.add(depths, Fault::TooManyPaths { sum, most });
    } else if sampling.path_bits != sum {
        let what = Fault::NotTheSum {
            path: sampling.path_bits,
            sum,
        };
        problems.push(Problem::new(path.key("path_bits"), what).also(depths));
    }
}
