//! What scripts call.
//!
//! Numbers are arguments; a text is written into the module's memory, where [`qrt_input`] says.
//! Every call leaves an [`Answer`], whose index and numbers a script finds where [`qrt_index`] and
//! [`qrt_numbers`] say, until the next call. What goes wrong is an answer, too: the text `error`.
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

use qrt_runtime::playground::Answer;
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

/// Leaves what a call found.
fn answer<E: Display>(found: Result<Answer, E>) {
    with(|state| {
        state.answer =
            found.unwrap_or_else(|error| Answer::default().text("error", error.to_string()));
        state.index = state.answer.index();
    });
}

/// The text that a script wrote.
#[cfg(any(feature = "map", feature = "picture"))]
fn text() -> String {
    with(|state| String::from_utf8_lossy(&state.input).into_owned())
}

/// What a figure without its first call says.
#[cfg(any(feature = "circuit", feature = "picture"))]
const NOT_LOADED: &str = "the figure is not loaded";

/// Room for a text of so many bytes, in UTF-8, which the next call reads.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_input(bytes: usize) -> *mut u8 {
    with(|state| {
        state.input.clear();
        state.input.resize(bytes, 0);
        state.input.as_mut_ptr()
    })
}

/// The index of the last answer: JSON.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_index() -> *const u8 {
    with(|state| state.index.as_ptr())
}

/// Its bytes.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_index_length() -> usize {
    with(|state| state.index.len())
}

/// The numbers of the last answer.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_numbers() -> *const f64 {
    with(|state| state.answer.numbers().as_ptr())
}

/// How many.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_numbers_length() -> usize {
    with(|state| state.answer.numbers().len())
}

/// The last answer.
#[cfg(test)]
fn last() -> Answer {
    with(|state| state.answer.clone())
}
