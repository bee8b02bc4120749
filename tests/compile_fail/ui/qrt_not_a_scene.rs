use qrt::prelude::*;

qrt! {
    pub struct Room {
        film: 8 x 8,
    }
}

fn main() {
}
