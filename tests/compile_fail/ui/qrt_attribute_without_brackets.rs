//! An attribute of a scene stands in brackets.

use qrt::qrt;

qrt! {
    #pub scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 2 x 2,
    }
}

fn main() {}
