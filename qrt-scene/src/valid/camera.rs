//! Checks that a camera has a view direction, and an `up` direction that is not along it, and that its
//! eye is inside or outside each sphere.

use super::Ball;
use crate::polygons::normalized;
use crate::scene::Camera;
use glam::DVec3;
use qrt_syntax::{Camera as Fault, Path, Problem, Problems};

/// Minimum sine of the angle between view and `up`: below it, rounding decides the direction to the
/// right.
const LEAST_SINE: f64 = 1e-9;
/// Minimum distance of an eye from the surface of a sphere, relative to its radius: nearer than this,
/// rounding in the circuit's numbers decides if the eye is inside.
const LEAST_DISTANCE: f64 = 1e-4;
/// Minimum diameter of a lens whose points are at many distances, relative to the radius.
const LEAST_LENS: f64 = 100.0 * LEAST_DISTANCE;

pub(super) fn check(camera: &Camera, problems: &mut Problems) {
    let path = Path::root().key("camera").key(camera.kind());
    let (eye, target, up) = match camera {
        Camera::Perspective(part) => (part.eye, part.target, part.up),
        Camera::Orthographic(part) => (part.eye, part.target, part.up),
    };
    if ["eye", "target", "up"]
        .iter()
        .any(|key| problems.touches(&path.key(*key)))
    {
        return;
    }
    if up == DVec3::ZERO {
        problems.add(path.key("up"), Fault::NoUp);
    }
    let view = target - eye;
    // An eye whose squared distance from the target vanishes stands there.
    if view.length() == 0.0 {
        let problem = Problem::new(path.key("target"), Fault::NoView);
        problems.push(problem.also(path.key("eye")));
    } else if up != DVec3::ZERO {
        let sine = normalized(view).cross(normalized(up)).length();
        if sine < LEAST_SINE {
            problems.add(path.key("up"), Fault::UpAlongView);
        }
    }
}

/// Refuses an eye on the surface of a sphere. Rays of an orthographic camera, and of a lens that is not
/// tiny, start at many points, of which hardly any is on it.
pub(super) fn check_spheres(camera: &Camera, balls: &[Ball], problems: &mut Problems) {
    let Camera::Perspective(part) = camera else {
        return;
    };
    let eye = Path::root().key("camera").key(camera.kind()).key("eye");
    if problems.touches(&eye) {
        return;
    }
    let aperture = part.lens.map_or(0.0, |lens| lens.aperture);
    let on = |ball: &&Ball| {
        let height = (part.eye - ball.centre).length() - ball.radius;
        height.abs() < LEAST_DISTANCE * ball.radius && aperture < LEAST_LENS * ball.radius
    };
    if let Some(ball) = balls.iter().find(on) {
        let problem = Problem::new(eye, Fault::OnSphere);
        problems.push(problem.also(ball.place()));
    }
}
