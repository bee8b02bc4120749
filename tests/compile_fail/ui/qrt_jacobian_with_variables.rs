use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material cloth: bsdf {
            map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u)),
            jacobian: |u, v| pi / sqrt(1 - u),
            value: 0.5 / pi,
        },
    }
}

fn main() {
    Room::scene();
}
