//! Both macros in a crate whose items have every name of the preludes of std and of qrt, and the
//! names that the generated code uses.

#![allow(
    dead_code,
    non_camel_case_types,
    non_upper_case_globals,
    unused_imports,
    unused_macros
)]

mod alloc {}
mod core {}
mod glam {}
mod std {}

enum Light {
    Err,
    None,
    Ok,
    Some,
}

use Light::*;

macro_rules! types {
    ($($name:ident)*) => { $(struct $name;)* };
}

macro_rules! traits {
    ($($name:ident)*) => { $(trait $name {})* };
}

macro_rules! constants {
    ($($name:ident)*) => { $(const $name: () = ();)* };
}

types! {
    bool char f32 f64 i8 i16 i32 i64 i128 isize str u8 u16 u32 u64 u128 usize
    Box Option Result String Vec Bit BlockDeclaration BlockId Bool
    Caller Channel Computed CompiledOracle Declaration Field Fixed Frame Host
    Int Item List Machine Map Multiples NamedPlace Number Operand Options Outline
    PathScene PixelWord Place Program Quantity Recorder Reg RegisterId RenderOptions State
    Style Tag Text Type UFixed UInt ValidScene Vector
    When Word M H T R
}

traits! {
    AsRef AsMut Clone Copy Debug Default Drop Eq Extend
    Fn FnMut FnOnce Format From FromIterator Into IntoIterator Iterator
    Ord PartialEq PartialOrd Send Sized Sync ToOwned ToString TryFrom
    TryInto Unpin
}

constants! {
    applied apply channels fields host id m machine recorder register running style t0
}

/// Methods of everything, of the names of methods that machines have.
trait Everything {
    fn add_into(&mut self) {}
    fn into(&mut self) {}
    fn machine(&mut self) {}
    fn rev(&mut self) {}
    fn swap(&mut self) {}
    fn undo(&mut self) {}
    fn xor_into(&mut self) {}
}

impl<T> Everything for T {}

fn drop() {}
fn swap() {}
fn unconditional() {}

macro_rules! assert {
    () => {};
}
macro_rules! assert_eq {
    () => {};
}
macro_rules! cfg {
    () => {};
}
macro_rules! column {
    () => {};
}
macro_rules! compile_error {
    () => {};
}
macro_rules! concat {
    () => {};
}
macro_rules! env {
    () => {};
}
macro_rules! format {
    () => {};
}
macro_rules! include_bytes {
    () => {};
}
macro_rules! line {
    () => {};
}
macro_rules! matches {
    () => {};
}
macro_rules! module_path {
    () => {};
}
macro_rules! panic {
    () => {};
}
macro_rules! println {
    () => {};
}
macro_rules! stringify {
    () => {};
}
macro_rules! unreachable {
    () => {};
}
macro_rules! vec {
    () => {};
}
macro_rules! write {
    () => {};
}
macro_rules! writeln {
    () => {};
}

::core::include!("../../both_macros.rs");

fn main() {
    check();
    ::std::println!("shadowed: both macros beside items of all names");
}
