//! Functions that scripts call.
//!
//! Numbers are arguments. A script writes a text into the module's memory, at the address from
//! [`qrt_input`]. Every call stores an [`Answer`], whose index and numbers a script finds at the
//! addresses from [`qrt_index`] and [`qrt_numbers`], until the next call. An error is an answer, too:
//! the text `error`.
//!
//! A module has the calls of the figures that it is compiled for, and one circuit and one picture:
//! a page makes an instance of it for each figure.

#[cfg(feature = "circuit")]
mod circuit;
#[cfg(feature = "counting")]
mod counting;
#[cfg(feature = "map")]
mod map;
#[cfg(feature = "picture")]
mod picture;

use qrt_lab::playground::Answer;
use std::cell::RefCell;
use std::fmt::Display;

#[derive(Default)]
struct State {
    input: Vec<u8>,
    index: String,
    answer: Answer,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

fn with<T>(work: impl FnOnce(&mut State) -> T) -> T {
    STATE.with_borrow_mut(work)
}

/// Stores the result of a call.
fn answer<E: Display>(found: Result<Answer, E>) {
    with(|state| {
        state.answer =
            found.unwrap_or_else(|error| Answer::default().text("error", error.to_string()));
        state.index = state.answer.index();
    });
}

/// Returns the text that a script wrote.
#[cfg(any(feature = "map", feature = "picture"))]
fn text() -> String {
    with(|state| String::from_utf8_lossy(&state.input).into_owned())
}

/// Error of a figure whose first call is missing.
#[cfg(any(feature = "circuit", feature = "picture"))]
const NOT_LOADED: &str = "the figure is not loaded";

/// Allocates `bytes` bytes for a text in UTF-8, which the next call reads.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_input(bytes: usize) -> *mut u8 {
    with(|state| {
        state.input.clear();
        state.input.resize(bytes, 0);
        state.input.as_mut_ptr()
    })
}

/// Address of the index of the last answer: JSON.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_index() -> *const u8 {
    with(|state| state.index.as_ptr())
}

/// Length of the index in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_index_length() -> usize {
    with(|state| state.index.len())
}

/// Address of the numbers of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_numbers() -> *const f64 {
    with(|state| state.answer.numbers().as_ptr())
}

/// Number of these numbers.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_numbers_length() -> usize {
    with(|state| state.answer.numbers().len())
}

/// Returns the last answer.
#[cfg(test)]
fn last() -> Answer {
    with(|state| state.answer.clone())
}
