//! Calls of the figure `picture`.

use super::{NOT_LOADED, answer, text};
use crate::picture::Picture;
use qrt_lab::playground::Answer;
use std::cell::RefCell;
use std::error::Error;

thread_local! {
    static PICTURE: RefCell<Option<Picture>> = RefCell::default();
}

fn with<E: From<&'static str>>(
    work: impl FnOnce(&mut Picture) -> Result<Answer, E>,
) -> Result<Answer, E> {
    PICTURE.with_borrow_mut(|picture| work(picture.as_mut().ok_or(NOT_LOADED)?))
}

/// Calls [`Picture::new`], and answers with its description.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_picture() {
    answer(Picture::new().map(|picture| {
        let description = picture.description();
        PICTURE.set(Some(picture));
        description
    }));
}

/// Calls [`Picture::trace`].
#[unsafe(no_mangle)]
pub extern "C" fn qrt_picture_trace(count: usize) {
    answer(with(|picture| Ok::<_, &str>(picture.trace(count))));
}

/// Calls [`Picture::estimate`] with the estimator that the input names.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_picture_estimate(phase_bits: u32, seed: u32, first: usize, count: usize) {
    let pixels = first..first.saturating_add(count);
    answer(with(|picture| {
        picture.estimate(&text(), phase_bits, seed, pixels)
    }));
}

/// Calls [`Picture::summary`].
#[unsafe(no_mangle)]
pub extern "C" fn qrt_picture_summary() {
    answer(with(|picture| Ok::<_, Box<dyn Error>>(picture.summary())));
}

#[cfg(test)]
mod tests {
    use super::super::last;
    use super::*;

    #[test]
    fn what_is_not_loaded_says_so() {
        for call in [
            || qrt_picture_trace(1),
            || qrt_picture_estimate(3, 0, 0, 1),
            || qrt_picture_summary(),
        ] {
            call();
            assert_eq!(last().text_of("error"), Some(NOT_LOADED));
        }
    }
}
