//! Final steps of decoding that concern several keys at once, or depend on which keys are written.

use super::shape::{Array, List, PartShape, Shape, Whole, part, whole};
use super::{
    Data, DepthSampling, LightPoint, Lights, Mesh, MeshFormat, Sampling, Scene, Sequence, Sky,
    Square,
};
use crate::scene::decode;
use qrt_syntax::tree::{Kind, Node, Value};
use qrt_syntax::{Path, Place, Problem, Problems, Sky as Light, Structure, nearest};

/// Sets `path_bits`, if it is not written, to the sum of all bits under the product lattice. The sum is
/// clamped to the range, so that too large a sum is reported for the bits, not for a key that is not
/// written.
pub(super) fn sampling(
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
    pub(crate) fn lattice_bits(&self) -> u32 {
        let squares = self.squares();
        let bits = squares.flat_map(|(_, _, bits)| bits);
        bits.fold(0, u32::saturating_add)
    }

    /// The bits of the point on the camera's lens, if one is sampled.
    pub fn lens(&self) -> Option<[u32; 2]> {
        self.depths.first()?.lens
    }

    /// Returns the bits of the point on a lamp that is connected to the start of the ray of
    /// `depth`; `None` if no lamp is sampled there, or if that is not decided yet, as in a scene that
    /// is not validated and has [`LightPoint::Auto`].
    pub fn light(&self, depth: usize) -> Option<[u32; 2]> {
        match self.depths.get(depth)?.light {
            LightPoint::Bits(bits) if self.lights != Lights::None && depth > 0 => Some(bits),
            _ => None,
        }
    }

    /// Iterates over the squares that a path samples, each with its depth and bits, in the order of
    /// a sequence's dimensions: all rays, then the points on lamps, then the point on the lens. So
    /// rays have the same dimensions with and without lamps and a lens, and light that only rays
    /// find is sampled no worse because of lamps.
    pub fn squares(&self) -> impl Iterator<Item = (usize, Square, [u32; 2])> + '_ {
        let rays = self.depths.iter().enumerate();
        let rays = rays.map(|(depth, sampling)| (depth, Square::Ray, sampling.bits));
        let lights = (0..self.depths.len())
            .filter_map(|depth| Some((depth, Square::Light, self.light(depth)?)));
        let lens = self.lens().map(|bits| (0, Square::Light, bits));
        rays.chain(lights).chain(lens)
    }
}

/// Reports a mesh with no file or with several.
pub(super) fn mesh(mesh: Mesh, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Mesh {
    let names = MeshFormat::NAMES;
    let written: Vec<&str> = names
        .into_iter()
        .filter(|key| node.entry(key).is_some())
        .collect();
    match written[..] {
        [_] => {}
        [first, second, ..] => {
            let path = at.path();
            problems.push(second_file(&path, first, second));
            problems.mark(path);
        }
        [] => {
            // A misspelt key is reported as such.
            let keys = [
                "material",
                "smooth",
                "colors",
                "scale",
                "rotate",
                "translate",
            ];
            let all = names.into_iter().chain(keys);
            let is_meant =
                |key: &str| nearest(key, all.clone()).is_some_and(|near| names.contains(&near));
            let entries = match &node.value {
                Value::Map(entries) => &entries[..],
                _ => &[],
            };
            if !entries.iter().any(|entry| is_meant(&entry.key)) {
                problems.add(at.name(), Structure::NoFile);
            }
            problems.mark(at.path());
        }
    }
    mesh
}

/// Reports a sky with both one radiance and a gradient, or with a part of a gradient.
pub(super) fn sky(sky: Sky, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Sky {
    let [radiance, horizon, zenith] =
        ["radiance", "horizon", "zenith"].map(|key| node.entry(key).is_some());
    if let Some(problem) = sky_fault(&at.path(), [radiance, horizon, zenith]) {
        problems.push(problem);
        problems.mark(at.path());
    }
    sky
}

/// Returns the problem of a sky with these keys: `radiance`, `horizon`, `zenith`.
pub(crate) fn sky_fault(path: &Path, written: [bool; 3]) -> Option<Problem> {
    let missing = |key: &'static str| Some(Problem::new(path.clone(), Light::NoEnd { key }));
    match written {
        [true, false, false] | [false, true, true] => None,
        [true, horizon, _] => {
            let key = if horizon { "horizon" } else { "zenith" };
            let problem = Problem::new(path.name(key), Light::TwoSkies { key });
            Some(problem.also(path.name("radiance")))
        }
        [false, true, false] => missing("zenith"),
        [false, false, true] => missing("horizon"),
        [false, false, false] => Some(Problem::new(path.clone(), Light::NoSky)),
    }
}

/// Returns the problem of the files `first` and `second` of the mesh at `path`.
pub(crate) fn second_file(path: &Path, first: &'static str, second: &'static str) -> Problem {
    let problem = Problem::new(path.name(second), Structure::SecondFile { first, second });
    problem.also(path.name(first))
}

/// Reports parameters that are written beside `accuracy`, which replaces them.
pub(super) fn scene(
    mut scene: Scene,
    node: &Node,
    at: &Place<'_>,
    problems: &mut Problems,
) -> Scene {
    sample_lens(&mut scene);
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

fn is_number(node: &Node) -> bool {
    matches!(&node.value, Value::Scalar(scalar) if matches!(scalar.kind(), Kind::Number(_)))
}

/// Gives the point on a lens the bits of the primary ray, if it has none.
pub(crate) fn sample_lens(scene: &mut Scene) {
    let has_lens = scene.lens().is_some();
    let sampling = &mut scene.sampling;
    let bits = sampling.lattice_bits();
    if let Some(primary) = sampling.depths.first_mut()
        && has_lens
        && primary.lens.is_none()
    {
        primary.lens = Some(primary.bits);
        if sampling.sequence == Sequence::ProductLattice && sampling.path_bits == bits {
            sampling.path_bits = sampling.lattice_bits();
        }
    }
}

/// Returns the problem of `key`, in the record at `path`, beside `accuracy`.
pub(crate) fn conflict(path: &Path, key: &'static str) -> Problem {
    let problem = Problem::new(path.name(key), qrt_syntax::Sampling::BesideAccuracy { key });
    problem.also(Path::root().name("accuracy"))
}

/// The shape of a point on a lamp: `auto`, `none`, or its bits.
pub(super) struct LightPointShape;

impl LightPointShape {
    const BITS: Array<Whole<u32>, 2> = Array(whole::<u32>(0, 16));
    const WORDS: &[&str] = &["auto", "none"];
}

impl Shape for LightPointShape {
    type Value = LightPoint;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> LightPoint {
        if !matches!(node.value, Value::Scalar(_)) {
            return LightPoint::Bits(Self::BITS.decode(node, at, problems));
        }
        match decode::word(problems, node, at, "a point on a lamp", Self::WORDS) {
            Some(1) => LightPoint::None,
            _ => LightPoint::Auto,
        }
    }
    fn fallback(&self) -> LightPoint {
        LightPoint::Auto
    }
    fn check(&self, value: &LightPoint, at: &Place<'_>, problems: &mut Problems) {
        if let LightPoint::Bits(bits) = value {
            Self::BITS.check(bits, at, problems);
        }
    }
    fn encode(&self, value: &LightPoint) -> Option<Data> {
        match value {
            LightPoint::Bits(bits) => Self::BITS.encode(bits),
            // It is the default, and would fill the text of every scene.
            LightPoint::Auto => None,
            LightPoint::None => Some(Data::text("none")),
        }
    }
    fn schema(&self) -> Data {
        let words = Self::WORDS.iter();
        let words = words.map(|word| Data::map([("const", Data::text(*word))]));
        let shapes = words.chain([Self::BITS.schema()]);
        Data::map([("anyOf", Data::List(shapes.collect()))])
    }
}

/// The shape of a path's rays: a list, or their number.
pub(super) struct Depths;

impl Depths {
    const LIST: List<PartShape<DepthSampling>> = List {
        item: part::<DepthSampling>(),
        least: 1,
    };
    const NUMBER: Whole<u32> = whole::<u32>(1, 64);
}

impl Shape for Depths {
    type Value = Vec<DepthSampling>;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self::Value {
        if is_number(node) {
            let rays = Self::NUMBER.decode(node, at, problems);
            return vec![DepthSampling::default(); rays as usize];
        }
        Self::LIST.decode(node, at, problems)
    }
    fn fallback(&self) -> Self::Value {
        Self::LIST.fallback()
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Problems) {
        Self::LIST.check(value, at, problems);
    }
    fn encode(&self, value: &Self::Value) -> Option<Data> {
        Self::LIST.encode(value)
    }
    fn schema(&self) -> Data {
        let shapes = vec![Self::LIST.schema(), Self::NUMBER.schema()];
        Data::map([("anyOf", Data::List(shapes))])
    }
}

#[cfg(test)]
mod tests {
    /// Returns the points on lamps of the rays of a scene with this material, beside a wall, and with
    /// these keys of `sampling`.
    fn points(material: &str, sampling: &str) -> Vec<Option<[u32; 2]>> {
        let text = format!(
            "name: n
camera: {{ perspective: {{ eye: [0, 0, 3], target: [0, 0, 0], vfov: 40 }} }}
film: {{ width: 1, height: 1 }}
sky: {{ radiance: 1 }}
materials: {{ m: {material}, wall: {{ lambertian: {{ albedo: 0.5 }} }} }}
geometry:
- sphere: {{ center: [0, 0, 0], radius: 1, material: m }}
- sphere: {{ center: [3, 0, 0], radius: 1, material: wall }}
sampling: {{ {sampling} }}"
        );
        let parsed = crate::front::parse(&text, "n.yaml", &[], "".as_ref());
        let parsed = parsed.unwrap_or_else(|report| panic!("{report}"));
        let warnings = parsed.valid.warnings();
        assert!(warnings.is_empty(), "{sampling}: {warnings:?}");
        let sampling = &parsed.valid.scene().sampling;
        let depths = 0..sampling.depths.len();
        depths.map(|depth| sampling.light(depth)).collect()
    }

    const LAMP: &str = "{ emitter: { radiance: 1 } }";

    #[test]
    fn rays_sample_lamps_where_there_are_any() {
        let lit = Some([8, 8]);
        for sampling in [
            "depths: 3",
            "path_bits: 4",
            "depths: [{ bits: [4, 4] }, { bits: [0, 0] }, { bits: [9, 9], light: auto }]",
        ] {
            assert_eq!(points(LAMP, sampling), [None, lit, lit], "{sampling}");
            let grey = "{ lambertian: { albedo: 0.5 } }";
            assert_eq!(points(grey, sampling), [None; 3], "{sampling}");
        }
        let one = "depths: [{ bits: [4, 4] }, { bits: [4, 4], light: none }, { bits: [4, 4], light: [3, 2] }, \
                    { bits: [4, 4] }]";
        assert_eq!(points(LAMP, one), [None, None, Some([3, 2]), lit]);
    }

    #[test]
    fn rays_sample_no_lamps_where_the_scene_says_so() {
        assert_eq!(points(LAMP, "depths: 2, lights: none"), [None; 2]);
        let lattice = "sequence: product-lattice, depths: [{ bits: [4, 4] }, { bits: [4, 4] }]";
        assert_eq!(points(LAMP, lattice), [None; 2]);
    }

    /// The net has dimensions for 64 squares, of which the rays come first.
    #[test]
    fn the_first_rays_sample_lamps_where_the_net_has_too_few_dimensions() {
        let count = |rays: usize| {
            let points = points(LAMP, &format!("depths: {rays}"));
            points.iter().flatten().count()
        };
        assert_eq!([32, 33, 40, 63, 64].map(count), [31, 31, 24, 1, 0]);
    }
}
