//! Calls of the figure `circuit`.

use super::{NOT_LOADED, answer};
use crate::circuit::{Stepper, description};
use std::cell::RefCell;

thread_local! {
    static STEPPER: RefCell<Option<Stepper>> = RefCell::default();
}

/// Calls [`Stepper::new`], and answers with [`description`].
#[unsafe(no_mangle)]
pub extern "C" fn qrt_circuit() {
    answer(Stepper::new().map(|stepper| {
        STEPPER.set(Some(stepper));
        description()
    }));
}

/// Calls [`Stepper::step`].
#[unsafe(no_mangle)]
pub extern "C" fn qrt_circuit_step(id: u32, comparator: u32, position: usize) {
    answer(STEPPER.with_borrow_mut(|stepper| {
        let stepper = stepper.as_mut().ok_or(NOT_LOADED)?;
        Ok::<_, &str>(stepper.step(id.into(), comparator.into(), position))
    }));
}

#[cfg(test)]
mod tests {
    use super::super::last;
    use super::*;

    #[test]
    fn what_is_not_loaded_says_so() {
        qrt_circuit_step(0, 0, 0);
        assert_eq!(last().text_of("error"), Some(NOT_LOADED));
        qrt_circuit();
        qrt_circuit_step(0, 0, 1);
        assert_eq!(last().number_of("position"), Some(1.0));
    }
}
