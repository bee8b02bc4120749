//! Valid requests for pictures.

use super::pixel::Pixels;
use super::tiles::Tiles;
use super::{RenderError, RenderOptions};
use crate::path_machines::PathMachine;
use qrt_scene::valid::ValidScene;
use qrt_scene::{Estimator, Scene};

/// A valid request for a picture: its parameters are chosen, and its crop is on the film.
pub(super) struct Request<'a> {
    pub(super) scene: &'a ValidScene,
    pub(super) options: &'a RenderOptions<'a>,
    /// x, y, width and height on the film, in pixels.
    pub(super) crop: [u32; 4],
    pub(super) estimator: Estimator,
    /// Number of pixels of the picture.
    pub(super) area: u64,
    /// R, the number of paths of a pixel.
    pub(super) paths: u64,
    /// The picture, cut into tiles.
    pub(super) tiles: Tiles,
    /// The entry of a checkpoint's header that names the part of the picture; `None` for all of it.
    pub(super) part: Option<(String, String)>,
}

impl<'a> Request<'a> {
    pub(super) fn new(
        scene: &'a ValidScene,
        options: &'a RenderOptions<'a>,
    ) -> Result<Self, RenderError> {
        let crop = crop_of(scene, options)?;
        let path_bits = scene.scene().sampling.path_bits;
        let paths = 1 << path_bits;
        let request = Self {
            scene,
            options,
            crop,
            estimator: estimator(scene.scene(), options)?,
            area: u64::from(crop[2]) * u64::from(crop[3]),
            paths,
            tiles: Tiles::whole(crop, options.tile, paths),
            part: None,
        };
        match request.area.checked_mul(request.paths) {
            Some(_) => Ok(request),
            None => Err(RenderError::TooManyPaths {
                pixels: request.area,
                path_bits,
            }),
        }
    }

    /// Creates the counter of the paths that `machine` traces.
    pub(super) fn pixels(&self, machine: Box<dyn PathMachine>) -> Result<Pixels, RenderError> {
        Pixels::new(machine, self.scene.scene(), self.estimator, self.options)
    }
}

/// Returns the part of the film to render: x, y, width and height.
pub(crate) fn crop_of(
    scene: &ValidScene,
    options: &RenderOptions<'_>,
) -> Result<[u32; 4], RenderError> {
    let film = [scene.scene().film.width, scene.scene().film.height];
    let crop = options.crop.unwrap_or([0, 0, film[0], film[1]]);
    let [x, y, width, height] = crop;
    let within = |first: u32, length: u32, whole: u32| {
        length > 0 && first.checked_add(length).is_some_and(|end| end <= whole)
    };
    if within(x, width, film[0]) && within(y, height, film[1]) {
        Ok(crop)
    } else {
        Err(RenderError::Crop { crop, film })
    }
}

/// Returns the estimator. With a search for primary hits there is no superposition of paths, and so
/// nothing to count, and [`Estimator::Exact`] replaces the scene's own.
pub(super) fn estimator(
    scene: &Scene,
    options: &RenderOptions<'_>,
) -> Result<Estimator, RenderError> {
    let classical = !options.searches();
    if !classical && options.own_estimator.is_some() {
        return Err(RenderError::OwnSearches);
    }
    match options.estimator {
        _ if classical => options.counted_by(scene),
        None | Some(Estimator::Exact) => Ok(Estimator::Exact),
        Some(other) => Err(RenderError::SearchEstimator(other)),
    }
}
