#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../targets.rs"]
#[allow(dead_code, reason = "the other targets")]
mod targets;

fuzz_target!(|data: &[u8]| targets::other_mesh(data));
