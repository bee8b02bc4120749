//! The macro front end of qrt.

#[allow(dead_code)]
mod generate;
