//! Metadata of a picture: a record of how it was made.

use super::Rendered;
use super::own::PREFIX;
use crate::image::{self, Encoding, ImageError, Metadata, PicturePath};
use qrt_scene::Estimator;

impl Rendered {
    /// Writes the picture with its metadata to a file whose name ends in `.png` or `.exr`, all or
    /// nothing. Returns the number of pixels that PNG clips; [`image::save`] also takes an
    /// exposure.
    ///
    /// ```
    /// use qrt_scene::front::parse;
    /// use qrt_runtime::render::{RenderOptions, render};
    ///
    /// # let text = "
    /// # name: sky
    /// # camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
    /// # film: { width: 4, height: 2 }
    /// # materials: { sky: { emitter: { radiance: [0.25, 0.5, 1] } } }
    /// # geometry:
    /// #   - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: sky }
    /// # ";
    /// let scene = parse(text, "sky.yaml", &[], "".as_ref())?.valid;
    /// let path = std::env::temp_dir().join(format!("qrt-sky-{}.png", std::process::id()));
    /// render(&scene, &RenderOptions::default())?.save(&path)?;
    /// # std::fs::remove_file(path)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// See [`ImageError`].
    #[cfg_attr(
        not(any(feature = "png", feature = "exr")),
        allow(
            clippy::needless_pass_by_value,
            reason = "no type is a path of a picture then"
        )
    )]
    pub fn save(&self, path: impl PicturePath) -> Result<u64, ImageError> {
        let path = path.as_ref();
        let encoding = Encoding::for_name(path, None)?;
        image::save(path, &self.image, &self.metadata()?, encoding)
    }

    /// Creates the metadata of the picture. It is the same on every run.
    ///
    /// # Errors
    /// If the scene's name contains a NUL, which no picture file can hold.
    pub fn metadata(&self) -> Result<Metadata, ImageError> {
        let [columns, rows] = self.film;
        let sampling = &self.parameters.sampling;
        let [x, y, width, height] = self.crop;
        let mut metadata = Metadata::new();
        metadata.set("version", env!("CARGO_PKG_VERSION"))?;
        metadata.set("scene", self.scene_name.as_str())?;
        metadata.set("scene_hash", self.scene_hash.as_str())?;
        metadata.set("model", self.model.name())?;
        for (key, value) in self.primary_hits.entries() {
            metadata.set(&key, value)?;
        }
        match &self.own_estimator {
            Some(own) => metadata.set("estimator", format!("{PREFIX}{own}"))?,
            None => metadata.set("estimator", self.estimator.name())?,
        }
        metadata.set("seed", self.seed.to_string())?;
        metadata.set("sequence", sampling.sequence.name())?;
        metadata.set("path_bits", sampling.path_bits.to_string())?;
        metadata.set("depths", sampling.depths.len().to_string())?;
        metadata.set("film", format!("{columns}x{rows}"))?;
        metadata.set("crop", format!("{x},{y},{width},{height}"))?;
        if self.estimator != Estimator::Exact {
            let (comparator, counting) = (&self.parameters.comparator, &self.parameters.counting);
            metadata.set("comparator_bits", comparator.bits.to_string())?;
            metadata.set("comparator_at", comparator.at.name())?;
            metadata.set("phase_bits", counting.phase_bits.to_string())?;
            metadata.set("repetitions", counting.repetitions.to_string())?;
            for (key, value) in self.counted.entries(self.estimator, counting) {
                metadata.set(key, value)?;
            }
            if let Some(error) = counting.error.filter(|_| self.estimator.stops_itself()) {
                metadata.set("counting_error", error.to_string())?;
            }
            metadata.set("colour", self.colour.name())?;
            metadata.set("noise", self.noise.to_string())?;
        }
        if let Some(plan) = &self.plan {
            metadata.set("accuracy_error", plan.accuracy.error.to_string())?;
            metadata.set("accuracy_confidence", plan.accuracy.confidence.to_string())?;
            metadata.set("accuracy_within", plan.within.to_string())?;
            if let Some(fraction) = plan.fraction {
                metadata.set("fraction", fraction.to_string())?;
            }
        }
        metadata.set("queries", self.total_queries().to_string())?;
        Ok(metadata)
    }
}
