//! The playground of the book of qrt: the functions that a worker's script calls.
//!
//! The script writes a text and numbers into the module's memory, at the addresses from [`qrt_input`]
//! and [`qrt_arguments`]. [`qrt_call`] runs the call, and the script reads the [`Answer`] at the
//! addresses from [`qrt_index`] and [`qrt_numbers`], until the next call. See
//! [`qrt_lab::playground`] for the calls.
#![warn(
    missing_docs,
    clippy::pedantic,
    clippy::unwrap_used,
    clippy::expect_used
)]
// The same lint settings as in the workspace of qrt.
#![allow(clippy::must_use_candidate)]

#[path = "../../../../scenes-yaml/examples.rs"]
mod examples;

use examples::{EXAMPLES, FILES};
use qrt_lab::playground::{Answer, Playground};
use qrt_scene::front::Files;
use std::cell::RefCell;

struct State {
    input: Vec<u8>,
    arguments: Vec<f64>,
    index: String,
    answer: Answer,
    playground: Playground<'static>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::new(State {
        input: Vec::new(),
        arguments: Vec::new(),
        index: String::new(),
        answer: Answer::default(),
        playground: Playground::new(EXAMPLES, Files::held(FILES)),
    });
}

fn with<T>(work: impl FnOnce(&mut State) -> T) -> T {
    STATE.with_borrow_mut(work)
}

/// Allocates `bytes` bytes for a text in UTF-8, which the next call reads: its first line is the
/// call's name.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_input(bytes: usize) -> *mut u8 {
    with(|state| {
        state.input.clear();
        state.input.resize(bytes, 0);
        state.input.as_mut_ptr()
    })
}

/// Allocates memory for `count` numbers, which the next call reads.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_arguments(count: usize) -> *mut f64 {
    with(|state| {
        state.arguments.clear();
        state.arguments.resize(count, 0.0);
        state.arguments.as_mut_ptr()
    })
}

/// Runs a call.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_call() {
    with(|state| {
        let input = String::from_utf8_lossy(&state.input);
        let (name, text) = input.split_once('\n').unwrap_or((&input, ""));
        state.answer = state.playground.call(name, &state.arguments, text);
        state.index = state.answer.index();
    });
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

#[cfg(test)]
mod tests {
    use super::*;

    fn call(text: &str, numbers: &[f64]) -> Answer {
        qrt_input(text.len());
        qrt_arguments(numbers.len());
        with(|state| {
            state.input.copy_from_slice(text.as_bytes());
            state.arguments.copy_from_slice(numbers);
        });
        qrt_call();
        with(|state| state.answer.clone())
    }

    /// Checks that every scene of the folder is there, with its files, and opens.
    #[test]
    fn all_example_scenes_are_there_and_open() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../scenes-yaml");
        let names = call("examples", &[]);
        let names: Vec<&str> = names.text_of("names").unwrap().lines().collect();
        let mut count = 0;
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|kind| kind == "yaml") {
                let name = path.file_stem().unwrap().to_str().unwrap();
                assert!(names.contains(&name), "{name}");
                count += 1;
            }
        }
        assert_eq!(names.len(), count);
        for name in names {
            let example = call(&format!("example\n{name}"), &[]);
            let text = example.text_of("text").unwrap();
            let checked = call(&format!("check\n{text}"), &[]);
            assert_eq!(checked.number_of("valid"), Some(1.0), "{name}");
            let opened = call(&format!("open\n{text}"), &[0.0, 0.0, 0.0, 1.0]);
            assert_eq!(opened.text_of("error"), None, "{name}");
            assert_eq!(qrt_index_length(), opened.index().len());
            assert_eq!(qrt_numbers_length(), opened.numbers().len());
        }
    }
}
