//! The properties of a picture other than its pixels, as the file of a part of the picture has
//! them.
//!
//! serde and postcard turn them into bytes. The version of the checkpoint's format covers these bytes:
//! any change of a type here needs another version.

#[cfg(test)]
mod tests;

use super::own::PREFIX;
use super::{Colour, CountedPixels, Model, PrimaryHitsFound, Rendered, Scales};
use crate::checkpoint::Header;
use crate::image::Image;
use crate::plan::PlanFigures;
use crate::serialized::{self, NoiseFields};
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
    primary_hits: PrimaryHitsFound,
    plan: Option<PlanFigures>,
    scales: Scales,
    ids: u64,
    paths: u64,
    resumed_paths: u64,
    seconds: f64,
    threads: usize,
}

impl Properties {
    /// Returns the properties of a picture; `scene` is its scene without geometry and materials, as
    /// YAML.
    pub(super) fn new(rendered: &Rendered, scene: &str) -> Self {
        Self {
            scene_hash: rendered.scene_hash.clone(),
            scene: scene.to_owned(),
            model: rendered.model,
            colour: rendered.colour,
            estimator: rendered.estimator,
            noise: rendered.noise,
            primary_hits: rendered.primary_hits,
            plan: rendered.plan,
            scales: rendered.scales.clone(),
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
        if [scene.film.width, scene.film.height] != film {
            return None;
        }
        let own = header.options.get("estimator");
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
            counted: CountedPixels::default(),
            model: self.model,
            primary_hits: self.primary_hits,
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
            scales: self.scales,
            ids: self.ids,
            paths: self.paths,
            resumed_paths: self.resumed_paths,
            seconds: self.seconds,
            threads: self.threads,
        })
    }
}
