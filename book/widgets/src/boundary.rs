//! What scripts call.
//!
//! Numbers are arguments; a text is written into the module's memory, where [`qrt_input`] says.
//! Every call leaves an [`Answer`], whose index and numbers a script finds where [`qrt_index`] and
//! [`qrt_numbers`] say, until the next call. What goes wrong is an answer, too: the text `error`.
//!
//! A module has one circuit and one picture: a page makes an instance of it for each figure.

use crate::circuit::{self, Stepper};
use crate::counting::{self, Asked};
use crate::map::{self, Chosen};
use crate::picture::Picture;
use qrt_core::scene::{Map, Window};
use qrt_runtime::machines::InvalidGate;
use qrt_runtime::playground::Answer;
use std::cell::RefCell;
use std::fmt::Display;

#[derive(Default)]
struct State {
    input: Vec<u8>,
    index: String,
    answer: Answer,
    circuit: Option<Stepper>,
    picture: Option<Picture>,
}

impl State {
    fn text(&self) -> String {
        String::from_utf8_lossy(&self.input).into_owned()
    }
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

fn with<T>(work: impl FnOnce(&mut State) -> T) -> T {
    STATE.with_borrow_mut(work)
}

/// Leaves what `work` answers.
fn answer<E: Display>(work: impl FnOnce(&mut State) -> Result<Answer, E>) {
    with(|state| {
        let found = work(state);
        state.answer =
            found.unwrap_or_else(|error| Answer::default().text("error", error.to_string()));
        state.index = state.answer.index();
    });
}

/// What a figure without its first call says.
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

/// [`counting::angles`]
#[unsafe(no_mangle)]
pub extern "C" fn qrt_counting_angles() {
    answer(|_| counting::angles());
}

/// [`counting::answer`]; `sine` is 0 for the rectangular window.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_counting(theta: f64, phase_bits: u32, runs: u32, sine: u32, seed: u32) {
    answer(|_| {
        counting::answer(Asked {
            theta,
            phase_bits,
            runs,
            window: if sine == 0 {
                Window::Rect
            } else {
                Window::Sine
            },
            seed,
        })
    });
}

/// [`map::answer`]; `chosen` is 0 for the uniform map, 1 for the cosine map, and anything else for
/// the one of the input's three lines.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_map(chosen: u32, bits: u32) {
    answer(|state| {
        let chosen = match chosen {
            0 => Chosen::Builtin(Map::UniformHemisphere),
            1 => Chosen::Builtin(Map::CosineHemisphere),
            _ => Chosen::Own(state.text()),
        };
        map::answer(&chosen, bits)
    });
}

/// [`Stepper::new`], and [`circuit::description`].
#[unsafe(no_mangle)]
pub extern "C" fn qrt_circuit() {
    answer(|state| {
        let stepper = Stepper::new()?;
        state.circuit = Some(stepper);
        Ok::<_, InvalidGate>(circuit::description())
    });
}

/// [`Stepper::step`]
#[unsafe(no_mangle)]
pub extern "C" fn qrt_circuit_step(id: u32, comparator: u32, position: usize) {
    answer(|state| {
        let stepper = state.circuit.as_mut().ok_or(NOT_LOADED)?;
        Ok::<_, &str>(stepper.step(id.into(), comparator.into(), position))
    });
}

/// [`Picture::new`], and what it is.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_picture() {
    answer(|state| {
        let picture = Picture::new()?;
        Ok::<_, Box<dyn std::error::Error>>(state.picture.insert(picture).description())
    });
}

/// [`Picture::trace`]
#[unsafe(no_mangle)]
pub extern "C" fn qrt_picture_trace(count: usize) {
    answer(|state| {
        let picture = state.picture.as_mut().ok_or(NOT_LOADED)?;
        Ok::<_, &str>(picture.trace(count))
    });
}

/// [`Picture::estimate`], by the estimator that the input names.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_picture_estimate(phase_bits: u32, seed: u32, first: usize, count: usize) {
    answer(|state| {
        let name = state.text();
        let picture = state.picture.as_mut().ok_or(NOT_LOADED)?;
        picture.estimate(&name, phase_bits, seed, first..first.saturating_add(count))
    });
}

/// [`Picture::summary`]
#[unsafe(no_mangle)]
pub extern "C" fn qrt_picture_summary() {
    answer(|state| {
        let picture = state.picture.as_ref().ok_or(NOT_LOADED)?;
        Ok::<_, &str>(picture.summary())
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn last() -> Answer {
        with(|state| state.answer.clone())
    }

    #[test]
    fn a_text_goes_in_and_an_answer_comes_out() {
        let text = b"u\nv\nw";
        qrt_input(text.len());
        with(|state| state.input.copy_from_slice(text));
        qrt_map(2, 3);
        assert!(last().text_of("error").is_some_and(|e| e.contains("`w`")));
        qrt_map(0, 3);
        assert_eq!(last().number_of("points"), Some(64.0));
        assert_eq!(qrt_numbers_length(), 3 + 6 * 64);
        assert_eq!(qrt_index_length(), last().index().len());
    }

    #[test]
    fn what_is_not_loaded_says_so() {
        for call in [
            || qrt_circuit_step(0, 0, 0),
            || qrt_picture_trace(1),
            || qrt_picture_estimate(3, 0, 0, 1),
            || qrt_picture_summary(),
        ] {
            call();
            assert_eq!(last().text_of("error"), Some(NOT_LOADED));
        }
    }

    #[test]
    fn controls_out_of_range_are_errors() {
        qrt_counting(0.3, 41, 1, 0, 0);
        assert!(last().text_of("error").is_some());
        qrt_map(0, 40);
        assert!(last().text_of("error").is_some());
    }
}
