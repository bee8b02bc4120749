//! Both macros in a library without `std` of its own.

#![no_std]
#![allow(dead_code, reason = "it is built, not run")]

include!("../../both_macros.rs");
