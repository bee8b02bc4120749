//! Numbers and places, in words.

use crate::expr::Variables;

/// A number for a person.
pub(super) fn short(x: f64) -> String {
    let exponent = x.abs().log10();
    if x == 0.0 || (-4.0..6.0).contains(&exponent) {
        let text = format!("{x:.6}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        if text.is_empty() || text == "-" {
            "0".to_owned()
        } else {
            text.to_owned()
        }
    } else {
        format!("{x:.3e}")
    }
}

pub(super) fn place(at: &Variables) -> String {
    format!("u = {}, v = {}", short(at.u), short(at.v))
}
