use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material cloth: bsdf {
            map: |a, b| (sqrt(a) * cos(2 * pi * b), sqrt(a) * sin(2 * pi * b), sqrt(1 - a)),
            jacobian: auto,
            value: 0.5 / pi,
        },
    }
}

fn main() {
    Room::scene();
}
