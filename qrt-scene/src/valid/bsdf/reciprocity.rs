//! Checks that a value is reciprocal: `f(i, o) = f(o, i)`, as physics requires.

use qrt_syntax::expr::{Expr, Variable, Variables};
use qrt_syntax::{Bsdf, Path, Problem};

/// Maximum relative difference of the two values.
const OFF: f64 = 1e-6;

/// Returns the problem of a value that is not reciprocal. A value that depends on u or v is not
/// checked.
pub(super) fn check(f: &Expr, path: &Path) -> Option<Problem> {
    let asked = f.variables(f.root());
    if Variable::SQUARE.iter().any(|&axis| asked.contains(axis)) {
        return None;
    }
    let cosines = || (1..=8).map(|i| f64::from(i) / 8.0);
    let pairs = cosines().flat_map(|a| cosines().take_while(move |b| *b < a).map(move |b| [a, b]));
    for [cos_i, cos_o] in pairs {
        let sines = ((1.0 - cos_i * cos_i) * (1.0 - cos_o * cos_o)).sqrt();
        for turn in [-1.0, 0.0, 0.9] {
            let at = Variables {
                cos_i,
                cos_o,
                cos_a: cos_i * cos_o + turn * sines,
                ..Variables::default()
            };
            let back = Variables {
                cos_i: cos_o,
                cos_o: cos_i,
                ..at
            };
            let [there, back] = [at, back].map(|at| f.eval(&at));
            if (there - back).abs() > OFF * there.abs().max(back.abs()) {
                let what = Bsdf::NotReciprocal {
                    there,
                    back,
                    at: [cos_i, cos_o],
                };
                return Some(Problem::new(path.clone(), what));
            }
        }
    }
    None
}
