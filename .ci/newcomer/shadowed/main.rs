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
mod run {}
mod run_paths {}
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
    Box Option Result String Vec Bit BlockDeclaration BlockId Bool BoundProgram
    Caller Channel CompiledError Computed CompiledOracle Declaration Encoding Estimator Field Fixed Frame Host
    Image ImageError Int InvalidScene Item List Loaded Machine Map Marks Metadata Model Multiples NamedPlace
    Number Operand Options Oracle Outline OwnEstimator
    PathScene PixelWord Place Predicate Program Progress Quantity Recorder Reg RegisterId RenderError
    RenderOptions Rendered Report Scene SceneBuilder State
    Style Tag Text Type UFixed UInt ValidScene Vector
    When Word Workers M H T R
}

traits! {
    AmplitudeEstimator AsRef AsMut AsyncFn AsyncFnMut AsyncFnOnce Clone Copy Debug Default DoubleEndedIterator
    Drop Eq ExactSizeIterator Extend
    Fn FnMut FnOnce Format From FromIterator Future Into IntoFuture IntoIterator Iterator
    Ord PartialEq PartialOrd PathState Send Sized Sync ToOwned ToString TryFrom
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

macro_rules! functions {
    ($($name:ident)*) => { $(fn $name() {})* };
}

functions! {
    align_of align_of_val count_where drop load parse render render_compiled render_where save size_of
    size_of_val swap trace_path unconditional validate write_counts write_counts_to write_to
}

macro_rules! macros {
    ($($name:ident)*) => { $(macro_rules! $name { () => {}; })* };
}

macros! {
    assert assert_eq assert_ne cfg column compile_error concat dbg debug_assert debug_assert_eq
    debug_assert_ne env eprint eprintln file format format_args include include_bytes include_str
    line matches module_path option_env panic print println stringify thread_local todo
    unimplemented unreachable vec write writeln
}

::core::include!("../../both_macros.rs");

fn main() {
    check();
    ::std::println!("shadowed: both macros beside items of all names");
}
