//! A camera must look somewhere, and know which way is up.

use crate::codes;
use crate::report::{Path, Problem};
use crate::scene::Camera;

/// Below this sine of the angle between view and `up`, rounding decides where right is.
const LEAST_SINE: f64 = 1e-9;

pub(super) fn check(camera: &Camera, problems: &mut Vec<Problem>) {
    let path = Path::root().key("camera").key(camera.kind());
    let (eye, target, up) = match camera {
        Camera::Perspective(part) => (part.eye, part.target, part.up),
        Camera::Orthographic(part) => (part.eye, part.target, part.up),
    };
    if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
        return;
    }
    if up.length() == 0.0 {
        let what = "`up` is zero: it has no direction";
        problems.push(Problem::new(codes::CAMERA_UP, path.key("up"), what));
    }
    let view = target - eye;
    if view.length() == 0.0 {
        let what = "the camera looks at the point it stands on";
        let problem = Problem::new(codes::CAMERA_TARGET, path.key("target"), what)
            .label("same as `eye`")
            .also(path.key("eye"), "the camera stands here");
        problems.push(problem);
    } else if up.length() > 0.0 {
        let sine = view.normalize().cross(up.normalize()).length();
        // A length below 1e-154 squares to 0, so that its direction is NaN.
        if sine.is_nan() || sine < LEAST_SINE {
            let what = "`up` points along the view";
            let problem = Problem::new(codes::CAMERA_UP, path.key("up"), what)
                .help("choose an `up` across the view, such as [0, 0, 1]");
            problems.push(problem);
        }
    }
}
