//! Helpers for tests of several groups; each group uses some of them.
#![allow(dead_code, reason = "each test program uses some of it")]

pub(crate) mod command;
pub(crate) mod cuboid;
pub(crate) mod numbers;
pub(crate) mod scene;
