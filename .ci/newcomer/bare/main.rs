//! Both macros without the prelude.

#![no_implicit_prelude]

::core::include!("../../both_macros.rs");

fn main() {
    check();
    ::std::println!("bare: both macros without a prelude");
}
