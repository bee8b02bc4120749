use qrt::prelude::*;

qrt! {
    scene Room from "scenes/lti.yaml"
}

fn main() {
    Room::scene();
}
