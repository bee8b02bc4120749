//! The properties of a picture other than its pixels, as the file of a part of the picture has
//! them.
//!
//! serde and postcard turn them into bytes. The version of the checkpoint's format covers these bytes:
//! any change of a type here needs another version.

#[cfg(test)]
mod tests;

use super::own::PREFIX;
use super::{Colour, Model, Rendered, Scales, Searched, Visibility};
use crate::checkpoint::Header;
use crate::image::Image;
use crate::plan::PlanFigures;
use crate::serialized::{self, NoiseFields, PixelClassNames};
use qrt_core::tracer::{PixelClass, PixelClasses};
use qrt_counting::estimators::Noise;
use qrt_scene::valid::Parameters;
use qrt_scene::{Estimator, Scene};
use serde::{Deserialize, Serialize};

/// The properties of a picture other than its pixels and those of the file's [`Header`].
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Properties {
    scene_hash: String,
    /// The traced scene without its geometry and materials, as YAML.
    scene: String,
    model: Model,
    colour: Colour,
    #[serde(with = "serialized::word")]
    estimator: Estimator,
    #[serde(with = "NoiseFields")]
    noise: Noise,
    visibility: Visibility,
    searched: Option<Searched>,
    plan: Option<PlanFigures>,
    /// The lamps' outlines: see [`PixelClasses::outlines`].
    outlines: Option<Vec<Vec<[f64; 2]>>>,
    bounds: Vec<Bound>,
    ids: u64,
    paths: u64,
    resumed_paths: u64,
    seconds: f64,
    threads: usize,
}

/// The proven bound on a path's colour in the pixels of a class.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Bound {
    #[serde(with = "PixelClassNames")]
    class: PixelClass,
    bound: [f64; 3],
}

impl Properties {
    /// Returns the properties of a picture; `scene` is its scene without geometry and materials, as
    /// YAML.
    pub(super) fn new(rendered: &Rendered, scene: &str) -> Self {
        let Scales { of, bounds } = &rendered.scales;
        let bound = |&(class, bound): &(PixelClass, [f64; 3])| Bound { class, bound };
        Self {
            scene_hash: rendered.scene_hash.clone(),
            scene: scene.to_owned(),
            model: rendered.model,
            colour: rendered.colour,
            estimator: rendered.estimator,
            noise: rendered.noise,
            visibility: rendered.visibility,
            searched: rendered.searched,
            plan: rendered.plan,
            outlines: of.outlines(),
            bounds: bounds.iter().map(bound).collect(),
            ids: rendered.ids,
            paths: rendered.paths,
            resumed_paths: rendered.resumed_paths,
            seconds: rendered.seconds,
            threads: rendered.threads,
        }
    }

    /// Encodes the properties as bytes.
    pub(super) fn encode(&self) -> Vec<u8> {
        let bytes = postcard::to_extend(self, Vec::new());
        // postcard refuses sequences of unknown length alone, and there are none.
        bytes.unwrap_or_else(|error| unreachable!("{error}"))
    }

    /// Decodes properties from all of `bytes`; `None` if the bytes are not valid. A length beyond the
    /// end of `bytes` allocates nothing.
    pub(super) fn decode(bytes: &[u8]) -> Option<Self> {
        let (properties, rest) = postcard::take_from_bytes(bytes).ok()?;
        rest.is_empty().then_some(properties)
    }

    /// Returns the picture with these properties and those of `header`, without pixels. `None` if they
    /// contradict each other.
    pub(super) fn rendered(self, header: &Header) -> Option<Rendered> {
        let scene = Scene::from_yaml(&self.scene, "the part").ok()?;
        let film = [header.width, header.height];
        if [scene.film.width, scene.film.height] != film || self.bounds.is_empty() {
            return None;
        }
        let own = header.options.get("estimator");
        let bounds = self.bounds.into_iter();
        Some(Rendered {
            scene_name: scene.name,
            scene_hash: self.scene_hash,
            film,
            image: Image {
                width: 0,
                height: 0,
                pixels: Vec::new(),
                window: None,
            },
            queries: Vec::new(),
            widths: Vec::new(),
            strata: Vec::new(),
            good: None,
            model: self.model,
            visibility: self.visibility,
            searched: self.searched,
            crop: header.crop,
            estimator: self.estimator,
            own_estimator: own
                .and_then(|name| name.strip_prefix(PREFIX))
                .map(str::to_owned),
            colour: self.colour,
            noise: self.noise,
            seed: header.seed,
            parameters: Parameters {
                sampling: scene.sampling,
                precision: scene.precision,
                comparator: scene.comparator,
                counting: scene.counting,
                circuit: scene.circuit,
            },
            plan: self.plan,
            scales: Scales {
                of: PixelClasses::of_outlines(self.outlines),
                bounds: bounds
                    .map(|Bound { class, bound }| (class, bound))
                    .collect(),
            },
            ids: self.ids,
            paths: self.paths,
            resumed_paths: self.resumed_paths,
            seconds: self.seconds,
            threads: self.threads,
        })
    }
}
