#![deny(warnings)]
use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material cloth: bsdf {
            map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u)),
            jacobian: auto,
            value: 0.5 / pi * (1 + 0.3 * cos_i),
        },
        material lamp: emitter { radiance: rgb(1, 1, 1) },
        quad floor: cloth { (-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1) },
        quad light: lamp { (-1, 3, -1), (1, 3, -1), (1, 3, 1), (-1, 3, 1) },
    }
}

fn main() {
    Room::scene();
}
