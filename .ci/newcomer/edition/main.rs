//! Both macros in edition 2021.

include!("../../both_macros.rs");

fn main() {
    check();
    println!("edition: both macros in edition 2021");
}
