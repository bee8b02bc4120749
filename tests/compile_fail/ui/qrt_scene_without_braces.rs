use qrt::prelude::*;

qrt! {
    pub scene Room: Scene;
}

fn main() {
    Room::scene();
}
