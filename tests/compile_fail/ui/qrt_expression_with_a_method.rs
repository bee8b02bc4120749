use qrt::prelude::*;

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material cloth: bsdf {
            map: |u, v| (u.sqrt() * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), (1 - u).sqrt()),
            jacobian: auto,
            value: (1 - cos_i).powi(2) / pi,
        },
    }
}

fn main() {
    Room::scene();
}
