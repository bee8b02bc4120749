use qrt::prelude::*;

qrt! {
    scene Room from "../room.yaml"
}

fn main() {
    Room::scene();
}
