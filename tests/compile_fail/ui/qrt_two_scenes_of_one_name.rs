use qrt::prelude::*;

qrt! {
    scene Room {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
        film: 1 x 1,
    }
    scene Hall from "scenes/lit.yaml"
    scene Room from "scenes/lit.yaml"
}

fn main() {
    Room::scene();
    Hall::scene();
}
