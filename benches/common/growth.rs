//! Growth of costs: scenes of any number of quads, and fitted exponents.

use qrt::drawing::Fit;
use std::fmt::Write;

/// Returns a generator of pseudorandom numbers in [-1, 1), the same in every run.
pub(crate) fn chance(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        let next = state.wrapping_mul(6_364_136_223_846_793_005);
        state = next.wrapping_add(1_442_695_040_888_963_407);
        (state >> 43) as f64 / f64::from(1 << 20) - 1.0
    }
}

/// Returns a scene of `quads` parallelograms, one of them a lamp and one the floor, seen along paths of
/// three rays. A smaller scene is a prefix of a larger one.
pub(crate) fn quads(quads: u32) -> String {
    let mut text = String::from(
        "name: quads\n\
         camera: { perspective: { eye: [0, 1, -4], target: [0, 1, 0], vfov: 40 } }\n\
         film: { width: 16, height: 16 }\n\
         materials:\n  \
           grey: { lambertian: { albedo: [0.7, 0.6, 0.5] } }\n  \
           lamp: { emitter: { radiance: [4, 4, 4] } }\n\
         geometry:\n",
    );
    let mut draw = chance(1);
    for quad in 0..quads {
        let (corner, along, up, material) = match quad {
            0 => ([-1.0, 2.5, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0], "lamp"),
            1 => ([-2.0, 0.0, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0], "grey"),
            _ => {
                let corner = [1.5 * draw(), 1.0 + 0.7 * draw(), 1.5 * draw()];
                let along = [0.3 + 0.1 * draw(), 0.2 * draw(), 0.2 * draw()];
                let up = [0.2 * draw(), 0.3 + 0.1 * draw(), 0.2 * draw()];
                (corner, along, up, "grey")
            }
        };
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[s, t]| {
            let [x, y, z] = [0, 1, 2].map(|i| corner[i] + s * along[i] + t * up[i]);
            format!("[{x:.5}, {y:.5}, {z:.5}]")
        });
        let corners = corners.join(", ");
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "  - quad: {{ vertices: [{corners}], material: {material} }}"
        );
    }
    let depths = ["{ bits: [8, 8] }"; 3].join(", ");
    let _ = writeln!(
        text,
        "sampling: {{ path_bits: 14, depths: [{depths}], lights: none }}\ncomparator: {{ bits: 12 }}"
    );
    text
}

/// Fits a power of x to points (x, y); the residual is a fraction of y.
pub(crate) fn fit(points: impl Iterator<Item = [f64; 2]>) -> Fit {
    Fit::from_points(points.map(|[x, y]| (x.ln(), y.ln()))).expect("points of several x")
}
