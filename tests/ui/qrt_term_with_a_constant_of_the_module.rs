use qrt::prelude::*;

const HALF: u32 = 1;

#[reversible]
fn glow(cos_i: &UFixed<1, 14>, out: &mut UFixed<4, 14>) {
    out += cos_i + HALF;
}

qrt! {
    pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material cloth: bsdf {
            map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u)),
            jacobian: auto,
            value: fn glow,
        },
    }
}

fn main() {
    Room::scene();
}
