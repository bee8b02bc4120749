use qrt::prelude::*;

qrt! {}

fn main() {
}
