use qrt::prelude::*;

qrt! {
    pub scene Room from
}

fn main() {
    Room::scene();
}
