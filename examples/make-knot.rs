//! Prints the mesh of a torus knot: `cargo run --example make-knot 8 96 > knot.obj`.

#[path = "../benches/common/knot.rs"]
mod knot;

use std::process::ExitCode;

fn main() -> ExitCode {
    let counts: Vec<Option<u32>> = std::env::args()
        .skip(1)
        .map(|word| {
            word.parse()
                .ok()
                .filter(|count| (3..=65_536).contains(count))
        })
        .collect();
    match counts[..] {
        [Some(around), Some(along)] if u64::from(around) * u64::from(along) <= 1 << 24 => {
            print!("{}", knot::torus_knot(around, along));
            ExitCode::SUCCESS
        }
        _ => {
            eprintln!("usage: make-knot AROUND ALONG");
            eprintln!("corners of the tube's section and sections along it, 3 or more of both,");
            eprintln!("at most 16777216 together");
            ExitCode::from(2)
        }
    }
}
