//! Calls of the figure `counting`.

use super::answer;
use crate::counting::{self, CountingControls};
use qrt_scene::Window;

/// Calls [`counting::angles`].
#[unsafe(no_mangle)]
pub extern "C" fn qrt_counting_angles() {
    answer(counting::angles());
}

/// Calls [`counting::answer`]; `sine` is 0 for the rectangular window.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_counting(theta: f64, phase_bits: u32, runs: u32, sine: u32, seed: u32) {
    answer(counting::answer(CountingControls {
        theta,
        phase_bits,
        runs,
        window: if sine == 0 {
            Window::Rect
        } else {
            Window::Sine
        },
        seed,
    }));
}

#[cfg(test)]
mod tests {
    use super::super::last;
    use super::*;

    #[test]
    fn controls_out_of_range_are_errors() {
        qrt_counting(0.3, 41, 1, 0, 0);
        assert!(last().text_of("error").is_some());
    }
}
