//! Calls of the figure `map`.

use super::{answer, text};
use crate::map::{self, Chosen};
use qrt_scene::Map;

/// Calls [`map::answer`]; `chosen` is 0 for the uniform map, 1 for the cosine map, and anything else for
/// the map in the input's three lines.
#[unsafe(no_mangle)]
pub extern "C" fn qrt_map(chosen: u32, bits: u32) {
    let chosen = match chosen {
        0 => Chosen::Builtin(Map::UniformHemisphere),
        1 => Chosen::Builtin(Map::CosineHemisphere),
        _ => Chosen::Own(text()),
    };
    answer(map::answer(&chosen, bits));
}

#[cfg(test)]
mod tests {
    use super::super::{last, qrt_index_length, qrt_input, qrt_numbers_length, with};
    use super::*;

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
    fn controls_out_of_range_are_errors() {
        qrt_map(0, 40);
        assert!(last().text_of("error").is_some());
    }
}
