#![no_main]
//! The macros' own modules, for a crate of macros hands none of them over.

use libfuzzer_sys::fuzz_target;

#[path = "../../qrt-macros/src/expand.rs"]
mod expand;
#[path = "../../qrt-macros/src/generate/mod.rs"]
mod generate;
#[path = "../../qrt-macros/src/reversible/mod.rs"]
mod reversible;
#[path = "../../qrt-macros/src/scene/mod.rs"]
mod scene;
#[path = "../tokens.rs"]
mod targets;

fuzz_target!(|data: &[u8]| {
    targets::tokens(data);
    // What it remembers of texts would grow without end.
    proc_macro2::extra::invalidate_current_thread_spans();
});
