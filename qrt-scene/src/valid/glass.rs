//! Checks that pieces of glass do not touch.

use super::{Ball, Scatter, ValidScene};
use crate::polygons::{Overlap, first_overlap, stage_units};
use crate::scene::Geometry;
use glam::DVec3;
use qrt_syntax::{Glass, Problem, Problems};

/// Minimum width of an overlap, relative to the size of the scene: narrower overlaps come from
/// meshes with rounded corners.
const SLIVER: f64 = 1e-6;

/// Refuses faces of glass that overlap on one plane: a ray crosses both as one, and is refracted
/// once.
pub(super) fn check(valid: &ValidScene, problems: &mut Problems) {
    let is_glass = |surface: u32| {
        let surface = valid.materials.get(surface as usize);
        surface.is_some_and(|surface| matches!(surface.scatter, Scatter::Dielectric(_)))
    };
    check_spheres(valid, is_glass, problems);
    let glass: Vec<usize> = (0..valid.polygons.len())
        .filter(|&polygon| is_glass(valid.polygons[polygon].surface))
        .collect();
    // With faulty primitives, the primitive of a polygon is not known.
    if glass.is_empty() || problems.count() > 0 {
        return;
    }
    let (centre, scale) = stage_units(valid.extent());
    let staged = |polygon: &usize| -> Vec<DVec3> {
        let outline = valid.polygons[*polygon].inner_outline();
        let staged = outline.iter().map(|corner| (*corner - centre) * scale);
        staged.collect()
    };
    let outlines: Vec<Vec<DVec3>> = glass.iter().map(staged).collect();
    let outlines: Vec<&[DVec3]> = outlines.iter().map(Vec::as_slice).collect();
    if let Overlap::Of([first, second]) = first_overlap(&outlines, SLIVER) {
        let place = |number: usize| {
            let primitive = &valid.scene.geometry[valid.primitive_of(glass[number])];
            let place = valid.place_of(glass[number]);
            match primitive {
                Geometry::Mesh(_) => place.key("obj"),
                Geometry::Cuboid(_) | Geometry::Disc(_) => place,
                _ => place.key("vertices"),
            }
        };
        let problem = Problem::new(place(second), Glass::Touches);
        problems.push(problem.also(place(first)));
    }
}

/// Refuses spheres of glass with one surface.
fn check_spheres(valid: &ValidScene, is_glass: impl Fn(u32) -> bool, problems: &mut Problems) {
    let mut glass: Vec<&Ball> = (valid.balls.iter())
        .filter(|ball| is_glass(ball.surface))
        .collect();
    glass.sort_by(|a, b| a.centre.x.total_cmp(&b.centre.x));
    for (number, ball) in glass.iter().enumerate() {
        let most = SLIVER * ball.radius;
        let near = (glass[number + 1..].iter())
            .take_while(|other| other.centre.x - ball.centre.x < most)
            .find(|other| {
                let apart = (other.centre - ball.centre).length();
                apart + (other.radius - ball.radius).abs() < most
            });
        if let Some(other) = near {
            let [first, second] = if ball.primitive < other.primitive {
                [ball, other]
            } else {
                [other, ball]
            };
            let problem = Problem::new(second.place(), Glass::Touches);
            problems.push(problem.also(first.place()));
            return;
        }
    }
}
