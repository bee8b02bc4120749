use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material cloth: bsdf {
            map: |u, v| (sqrt(u) * cos(pi * v), sqrt(u) * sin(pi * v), sqrt(1 - u)),
            jacobian: auto,
            value: 0.9 / pi,
        },
    }
}

fn main() {
    Room::scene();
}
