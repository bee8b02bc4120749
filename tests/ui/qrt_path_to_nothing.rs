use qrt::prelude::*;

qrt! {
    pub scene Room from "tests/ui/no-such-scene.yaml"
}

fn main() {
    Room::scene();
}
