use qrt::prelude::*;

qrt! {
    pub scene Room from scenes_yaml
}

fn main() {
    Room::scene();
}
