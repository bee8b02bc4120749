//! The `qrt` command.
fn main() {}
