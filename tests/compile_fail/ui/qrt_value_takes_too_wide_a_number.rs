use qrt::prelude::*;

qrt! {
    scene Steep {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 2 x 2,
        material steep: bsdf {
            map: |u, v| (sqrt(1 - u^2) * cos(2 * pi * v), sqrt(1 - u^2) * sin(2 * pi * v), u),
            jacobian: auto,
            value: 0.1 / pi * (1e6 * cos_i * cos_o)^8 / (1 + (1e6 * cos_i * cos_o)^8),
        },
        material lamp: emitter { radiance: rgb(3, 2, 1) },
        quad floor: steep { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        sampling { path_bits: 4, lights: none },
        depth primary { bits: (4, 4) },
        depth secondary { bits: (4, 4) },
    }
}

fn main() {
    Steep::scene();
}
