use qrt::prelude::*;

qrt! {
    pub scene Room from "scenes/faulty.yaml"
}

fn main() {
    Room::scene();
}
