//! What the tests of several groups begin with; each uses some of it.
#![allow(dead_code, reason = "each test program uses some of it")]

pub(crate) mod command;
pub(crate) mod cuboid;
pub(crate) mod numbers;
pub(crate) mod scene;
