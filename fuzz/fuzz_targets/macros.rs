//! Fuzz target of the macros. A fuzzer cannot call a proc-macro crate, so this target includes its files.
#![no_main]
#![allow(
    dead_code,
    unused_imports,
    reason = "what only the macros' entries use"
)]

extern crate proc_macro;

use libfuzzer_sys::fuzz_target;

#[path = "../../qrt-macros/src/dependency.rs"]
mod dependency;
#[path = "../../qrt-macros/src/expand.rs"]
mod expand;
#[path = "../../qrt-macros/src/generate/mod.rs"]
mod generate;
#[path = "../../qrt-macros/src/reversible/mod.rs"]
mod reversible;
#[path = "../../qrt-macros/src/scene/mod.rs"]
mod scene;
#[path = "../macro_targets.rs"]
mod targets;

fuzz_target!(|data: &[u8]| targets::tokens(data));
