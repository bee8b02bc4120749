//! Warnings about useless parts of a scene: pictures that must be black, lamps that hide each
//! other, materials that nothing uses.
//!
//! A warning is proven: if no proof is found within the effort limits, there is no warning.

mod view;

use super::lights::MOST_PAIRS;
use super::{Ball, Polygon, Scatter, ValidScene};
use crate::polygons::{bounds, overlap};
use crate::scene::{DEFAULT_FRACTION, Geometry};
use glam::DVec3;
use qrt_syntax::{Material, Path, Problem, Sky, Unlit};
use std::collections::HashSet;
use view::View;

/// Maximum distance that counts as rounding, as a fraction of the largest coordinate.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Maximum number of warnings about unused materials; the last of them counts the others.
const MOST_UNUSED: usize = 8;

/// Maximum number of comparisons of a polygon with a lamp, in all.
const MOST_COMPARED: usize = 1 << 24;

/// Warnings of a scene without errors.
pub(super) fn find(valid: &ValidScene) -> Vec<Problem> {
    let mut found: Vec<Problem> = unused_materials(valid).collect();
    found.extend(unlit(valid));
    found.extend(opposite_lamps(valid));
    found.extend(faint_sunlight(valid));
    found
}

/// Fewest levels that a sunlit surface should have.
const LEAST_LEVELS: f64 = 16.0;

/// Warns if a sunlit surface has few levels of colours, because some surface may show the sun, whose radiance is then
/// the scale of colours.
fn faint_sunlight(valid: &ValidScene) -> Option<Problem> {
    let (cone, _) = valid.sun()?;
    let scene = &valid.scene;
    let fraction = scene.precision.fraction.unwrap_or(DEFAULT_FRACTION);
    let levels = 1_u64 << scene.comparator.bits.min(fraction);
    let lit = cone.sin.powi(2) * levels as f64;
    let may_show = |surface: u32| match &valid.materials[surface as usize].scatter {
        Scatter::Black | Scatter::Lambertian(_) | Scatter::Custom(_) => false,
        Scatter::Phong(phong) => phong.specular != [0.0; 3],
        Scatter::Mirror(_) | Scatter::Dielectric(_) | Scatter::Ggx(_) | Scatter::Metal(_) => true,
    };
    // The first ray comes from the eye.
    let is_shown = scene.sampling.depths.len() > 1 && valid.surface_of_faces().any(may_show);
    if lit >= LEAST_LEVELS || !is_shown {
        return None;
    }
    let square = 2.0 * LEAST_LEVELS / levels as f64;
    let angle = (2.0 * libm::asin(square.sqrt()).to_degrees()).ceil();
    // Not a number, or half of all directions, if no sun has that many levels.
    let larger = (angle < 180.0).then(|| {
        let sin = libm::sin((angle / 2.0).to_radians());
        [angle, two_digits((cone.sin / sin).powi(2))]
    });
    let what = Sky::FaintSunlight {
        lit: two_digits(lit),
        levels,
        larger,
    };
    Some(Problem::new(Path::root().name("sun"), what))
}

/// Rounds a number above 0 to two significant digits.
fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

/// Materials of the scene that no primitive names and no mesh uses.
fn unused_materials(valid: &ValidScene) -> impl Iterator<Item = Problem> {
    let named = valid.scene.geometry.iter().filter_map(|p| match p {
        Geometry::Quad(quad) => Some(quad.material.as_str()),
        Geometry::Triangle(triangle) => Some(triangle.material.as_str()),
        Geometry::Sphere(sphere) => Some(sphere.material.as_str()),
        Geometry::Disc(disc) => Some(disc.material.as_str()),
        Geometry::Cuboid(cuboid) => Some(cuboid.material.as_str()),
        Geometry::Mesh(mesh) => mesh.material.as_deref(),
    });
    let used: HashSet<&str> = named.collect();
    // A material of the scene may replace that of a mesh's file.
    let mut has_faces = vec![false; valid.materials.len()];
    for polygon in &valid.polygons {
        has_faces[polygon.surface as usize] = true;
    }
    let names = valid.scene.materials.iter().zip(has_faces);
    let unused = names.filter(|((name, _), has_faces)| !has_faces && !used.contains(name.as_str()));
    let unused = unused.map(|((name, _), _)| name);
    let unused: Vec<&String> = unused.collect();
    let told = unused.len().min(MOST_UNUSED);
    let warning = |(number, name): (usize, &&String)| {
        let last = number + 1 == told;
        let what = Material::Unused {
            name: (*name).clone(),
            more: if last { unused.len() - told } else { 0 },
        };
        Problem::new(Path::root().key("materials").name(name.as_str()), what)
    };
    let warnings: Vec<Problem> = unused[..told].iter().enumerate().map(warning).collect();
    warnings.into_iter()
}

/// A warning if every picture of the scene is black.
fn unlit(valid: &ValidScene) -> Option<Problem> {
    let shines = |ball: &Ball| valid.materials[ball.surface as usize].emits();
    let is_sunny = valid.scene.sky.is_some_and(|sky| sky.shines()) || valid.sun().is_some();
    if is_sunny || valid.balls.iter().any(shines) {
        return None;
    }
    let lamps = || {
        valid
            .polygons
            .iter()
            .enumerate()
            .filter(|(_, p)| emits(valid, p))
    };
    let Some((first, _)) = lamps().next() else {
        return Some(Problem::new(Path::root().name("geometry"), Unlit::NoLamp));
    };
    if !valid.balls.is_empty() || valid.scene.lens().is_some() {
        // Spheres are not compared with lamps, and a lens sees more than the pinhole.
        return None;
    }
    let view = View::new(&valid.scene.camera, valid.scene.film);
    let receivers = receivers(valid, &view);
    let around = corners_around(&receivers);
    let mut left = MOST_COMPARED;
    for (_, lamp) in lamps() {
        let plane = Plane::from_polygon(lamp);
        if view.may_see_front(lamp.outline(), plane.normal) {
            return None;
        }
        if !plane.is_before(&around) {
            continue;
        }
        left = left.checked_sub(receivers.len())?;
        if receivers.iter().any(|p| plane.is_before(p.outline())) {
            return None;
        }
    }
    let is_disc = valid.polygons[first].disc;
    Some(Problem::new(
        valid.place_of(first),
        Unlit::LampsAway { is_disc },
    ))
}

/// Returns the polygons at which the last but one ray of a path may end: those that scatter and
/// that the number of rays and the camera do not exclude.
fn receivers<'a>(valid: &'a ValidScene, view: &View) -> Vec<&'a Polygon> {
    let rays = valid.scene.sampling.depths.len();
    let scatters = |p: &&Polygon| {
        let surface = &valid.materials[p.surface as usize];
        !matches!(surface.scatter, Scatter::Black)
    };
    let reached = |p: &&Polygon| rays > 2 || rays == 2 && view.may_see(p.outline());
    valid
        .polygons
        .iter()
        .filter(scatters)
        .filter(reached)
        .collect()
}

/// Returns the corners of the box around all polygons; empty if there is no polygon.
fn corners_around(polygons: &[&Polygon]) -> Vec<DVec3> {
    if polygons.is_empty() {
        return Vec::new();
    }
    let (low, high) = bounds(polygons.iter().flat_map(|p| p.outline()));
    let corner = |bits: usize| DVec3::from_array([0, 1, 2].map(|k| [low, high][bits >> k & 1][k]));
    (0..8).map(corner).collect()
}

/// Returns a warning for each lamp that lies on an earlier lamp which faces the opposite way.
fn opposite_lamps(valid: &ValidScene) -> Vec<Problem> {
    let lamps = valid.polygons.iter().enumerate();
    let lamps = lamps.filter(|(_, p)| emits(valid, p));
    let lamps: Vec<(usize, &Polygon, Plane)> = lamps
        .map(|(number, p)| (number, p, Plane::from_polygon(p)))
        .collect();
    let mut found: Vec<Problem> = Vec::new();
    let mut pairs_left = MOST_PAIRS;
    for (number, lamp, plane) in &lamps {
        let before = lamps.iter().take_while(|(other, ..)| other < number);
        let mut before = before.take(pairs_left);
        let hidden_by = before.find(|(_, other, facing)| {
            pairs_left -= 1;
            plane.is_opposite(facing)
                && overlap(
                    &lamp.inner_outline(),
                    &other.inner_outline(),
                    plane.rounding,
                )
        });
        if let Some((first, ..)) = hidden_by {
            let (place, first) = (valid.place_of(*number), valid.place_of(*first));
            let mut problem = Problem::new(place.clone(), Unlit::OppositeLamp);
            if place != first {
                problem = problem.also(first);
            }
            // Polygons of one primitive follow each other, and get one warning.
            if found.last().is_none_or(|known| known.at != problem.at) {
                found.push(problem);
            }
        }
    }
    found
}

fn emits(valid: &ValidScene, polygon: &Polygon) -> bool {
    valid.materials[polygon.surface as usize].emits()
}

/// The plane of a polygon, with the side that its front faces.
struct Plane {
    corner: DVec3,
    /// Of length 1.
    normal: DVec3,
    rounding: f64,
}

impl Plane {
    fn from_polygon(polygon: &Polygon) -> Self {
        let [a, b, c, _] = polygon.vertices;
        Self {
            corner: a,
            normal: (b - a).normalize().cross((c - a).normalize()).normalize(),
            rounding: rounding(&polygon.vertices),
        }
    }

    /// True if some of `points` may lie before the front.
    fn is_before(&self, points: &[DVec3]) -> bool {
        let allowed = self.rounding.max(rounding(points));
        let behind = |v: &DVec3| self.normal.dot(*v - self.corner) <= allowed;
        !points.iter().all(behind)
    }

    /// True if the other plane is the same, facing the other way.
    fn is_opposite(&self, other: &Self) -> bool {
        let allowed = self.rounding.max(other.rounding);
        self.normal.dot(other.normal) < ROUNDING - 1.0
            && self.normal.dot(other.corner - self.corner).abs() <= allowed
    }
}

/// Returns the maximum distance that counts as rounding for coordinates like those of `points`.
fn rounding(points: &[DVec3]) -> f64 {
    let largest = points.iter().map(|v| v.abs().max_element());
    ROUNDING * largest.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
