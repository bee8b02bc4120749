//! Further layers of a picture's EXR file, beside its colours.

use super::{RenderError, Rendered, tiles};
use crate::image::Layer;
use crate::path_machines::{Real, SingleRay};
use glam::DVec3;
use qrt_scene::valid::{Polygon, ValidScene};
use qrt_tracer::Start;

/// Number of pixels whose primary hits are found at a time.
const PIXELS: usize = 1 << 12;

impl Rendered {
    /// Creates the layers of the picture of `scene`, pixel by pixel. A value is 0 if there is
    /// nothing to report.
    ///
    /// - `interval.R`, `.G`, `.B`: width of a channel's interval, in radiance
    ///   ([`super::CountedPixels::widths`]); with colour from one run, only `interval.Y`, of the luminance;
    /// - `queries.Y`: number of queries of the oracle, for all channels together;
    /// - `depth.Z`: distance from the camera to the first hit of the ray through the pixel's
    ///   centre, along the ray, in units of the scene;
    /// - `normal.X`, `.Y`, `.Z`: the unit normal at that hit, on the visible side;
    /// - `material.ID`: the number of the material at that hit, from 1 on, in the order of
    ///   [`ValidScene::surfaces`].
    ///
    /// Viewers group channels by the name before the dot.
    ///
    /// # Errors
    /// If `scene` is not the scene of the picture, or has no paths.
    pub fn layers(&self, scene: &ValidScene) -> Result<Vec<Layer>, RenderError> {
        if scene.fingerprint().to_string() != self.scene_hash {
            return Err(RenderError::OtherScene);
        }
        let mut layers = Vec::new();
        let layer = |name: &str, values: Vec<f64>| Layer {
            name: name.to_owned(),
            values,
        };
        let intervals: &[(&str, usize)] = match self.colour {
            super::Colour::ThreeRuns => &[("interval.R", 0), ("interval.G", 1), ("interval.B", 2)],
            super::Colour::OneRun => &[("interval.Y", 0)],
        };
        for &(name, channel) in intervals {
            layers.push(layer(
                name,
                (self.counted.widths.iter())
                    .map(|widths| widths[channel])
                    .collect(),
            ));
        }
        layers.push(layer(
            "queries.Y",
            self.counted.queries.iter().map(|&n| n as f64).collect(),
        ));
        let hits = first_hits(scene, self.crop)?;
        let of = |value: fn(&FirstHit) -> f64| -> Vec<f64> {
            hits.iter()
                .map(|hit| hit.as_ref().map_or(0.0, value))
                .collect()
        };
        layers.push(layer("depth.Z", of(|hit| hit.distance)));
        layers.push(layer("normal.X", of(|hit| hit.normal.x)));
        layers.push(layer("normal.Y", of(|hit| hit.normal.y)));
        layers.push(layer("normal.Z", of(|hit| hit.normal.z)));
        layers.push(layer("material.ID", of(|hit| f64::from(hit.material + 1))));
        Ok(layers)
    }
}

/// The first hit of the ray through the centre of a pixel.
struct FirstHit {
    /// Distance in units of the scene.
    distance: f64,
    /// Unit normal towards the viewer.
    normal: DVec3,
    /// Number of the material among the scene's surfaces, from 0.
    material: u32,
}

fn first_hits(scene: &ValidScene, crop: [u32; 4]) -> Result<Vec<Option<FirstHit>>, RenderError> {
    let real = Real::new(scene, 0)?;
    let camera = real.stage().camera();
    let geometry = real.stage().geometry();
    let unit = geometry.scale;
    let ray = |[x, y]: [u32; 2]| {
        let across = [f64::from(x) + 0.5, f64::from(y) + 0.5];
        let varying: [f64; 3] = std::array::from_fn(|axis| {
            camera.corner[axis] + across[0] * camera.column[axis] + across[1] * camera.row[axis]
        });
        let (origin, direction) = if camera.perspective {
            (camera.fixed, varying)
        } else {
            (varying, camera.fixed)
        };
        SingleRay {
            origin,
            direction,
            from: camera.from,
            start: Start::Camera,
        }
    };
    let pixels: Vec<[u32; 2]> = tiles::pixels(crop).collect();
    let mut hits = Vec::with_capacity(pixels.len());
    for pixels in pixels.chunks(PIXELS) {
        let rays: Vec<SingleRay> = pixels.iter().map(|&pixel| ray(pixel)).collect();
        for (ray, met) in rays.iter().zip(real.nearest(&rays)) {
            hits.push(met.and_then(|met| {
                let face = met.face as usize;
                let [start, direction] = [ray.origin, ray.direction].map(DVec3::from_array);
                let point = start + direction * met.distance;
                let normal = if let Some(Polygon { vertices, .. }) = scene.polygons().get(face) {
                    let [v0, v1, v2, _] = *vertices;
                    let own = (v1 - v0).cross(v2 - v0).normalize();
                    let smooth = scene.smooth_face(face).map(|smooth| {
                        let corners = &geometry.corners[face];
                        smooth.normal_at([corners[0], corners[1], corners[2]], point)
                    });
                    // As in the picture, a viewer behind the interpolated normal sees the face's own.
                    let seen = |normal: &DVec3| normal.dot(direction) * own.dot(direction) > 0.0;
                    smooth.filter(seen).unwrap_or(own)
                } else {
                    let ball = geometry.balls.get(face - scene.polygons().len())?;
                    (point - ball.centre).normalize()
                };
                Some(FirstHit {
                    distance: met.distance * direction.length() / unit,
                    normal: if normal.dot(direction) > 0.0 {
                        -normal
                    } else {
                        normal
                    },
                    material: scene.surface_of_face(face),
                })
            }));
        }
    }
    Ok(hits)
}
