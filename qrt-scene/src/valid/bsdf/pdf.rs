//! Checks a stated density of directions against the map that samples them.

use super::shape::{points, solid_angle};
use super::undefined::undefined_part;
use qrt_syntax::expr::{Expr, Variable, Variables};
use qrt_syntax::{Bsdf, Mistake, Path, Problem};
use std::f64::consts::TAU;

/// Maximum relative deviation of a stated density from the map's.
const OFF_DENSITY: f64 = 1e-6;
/// Maximum excess over 1 of its integral over the hemisphere: the quadrature's error for a density
/// with a peak.
const OFF_WHOLE: f64 = 1e-2;
/// Number of points of the quadrature, one per ring of directions.
const RINGS: u32 = 4096;
/// Cosines of viewers at which the density is tested: the map's density depends on no viewer.
const VIEWERS: [f64; 3] = [1.0, 0.7, 0.2];

/// Checks that `pdf` is one over the map's Jacobian, and that the map reaches all directions in
/// which `pdf` has weight.
pub(super) fn check(map: &[Expr; 3], values: &[Expr], pdf: &Expr) -> Option<Problem> {
    let path = Path::root().key("pdf");
    let squares = |value: &Expr| {
        let asked = value.variables(value.root());
        Variable::SQUARE.iter().any(|&axis| asked.contains(axis))
    };
    if values.iter().any(squares) {
        return Some(Problem::new(path, Bsdf::PdfOfTheSquare));
    }
    let jacobian = solid_angle(map);
    let mut room = Vec::new();
    let mut inverse = true;
    let mut wrong = None;
    for at in points() {
        let [x, _, z] = map.each_ref().map(|c| c.eval_in(&at, &mut room));
        if z < -1e-12 {
            return Some(Problem::new(path, Bsdf::PdfBelow));
        }
        let right = 1.0 / jacobian(&at);
        for cos_o in VIEWERS {
            let sin_o = (1.0 - cos_o * cos_o).sqrt();
            let angles = Variables {
                cos_i: z.abs(),
                cos_o,
                // The mirror direction of a viewer at azimuth 0.
                cos_a: z * cos_o - x * sin_o,
                ..at
            };
            let stated = pdf.eval_in(&angles, &mut room);
            if let (true, Some(what)) = (stated.is_finite(), undefined_part(pdf, &angles, &room)) {
                return Some(Problem::new(path, what));
            }
            let off = |right: f64| {
                let error = (stated - right).abs();
                error.is_nan() || error > OFF_DENSITY * right.abs().max(f64::MIN_POSITIVE)
            };
            inverse &= !off(1.0 / right);
            if off(right) && wrong.is_none() {
                wrong = Some((stated, right, [at.u, at.v]));
            }
        }
    }
    if let Some((stated, right, at)) = wrong {
        let mistake = if inverse {
            Mistake::NotInverse
        } else {
            Mistake::Density
        };
        let what = Bsdf::WrongPdf {
            stated,
            right,
            at,
            mistake,
        };
        return Some(Problem::new(path, what));
    }
    // The density depends on no azimuth and no viewer, so one point per height stands for its ring.
    let ring = |k: u32| {
        let cos_i = (f64::from(k) + 0.5) / f64::from(RINGS);
        let at = Variables {
            cos_i,
            cos_o: 1.0,
            cos_a: cos_i,
            ..Variables::default()
        };
        pdf.eval(&at) * TAU / f64::from(RINGS)
    };
    let whole: f64 = (0..RINGS).map(ring).sum();
    let beyond = whole.is_nan() || whole > 1.0 + OFF_WHOLE;
    beyond.then(|| Problem::new(path, Bsdf::PdfBeyondMap { whole }))
}
