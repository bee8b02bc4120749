use qrt::prelude::*;

qrt! {
    pub scene Room<Fixed<2, 14>> from "scenes/lit.yaml"
}

fn main() {}
