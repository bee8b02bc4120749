//! From a BSDF as its author wrote it to one that can be traced, or all that is wrong with it.
//!
//! The map `phi(u, v)` gives i, the direction towards the light, in the local frame whose z is the
//! normal on the viewer's side (`z < 0`: the path goes through). The value is `f(i, o)` with o
//! towards the viewer, and a path's weight is
//!
//! `W = f |phi_z| J`, `J = |dphi/du x dphi/dv|`,
//!
//! see [`crate::sampling::maps`]. The checks sample a fixed set of points of the open square, the
//! bound of the weight is a proof by interval arithmetic.

use super::CustomBsdf;
use crate::expr::{Expr, Variable};
use crate::report::{Path, Problem};
use crate::sampling::maps;
use crate::scene::{Bsdf, Jacobian, Rgb};

mod checks;
#[cfg(test)]
mod tests;

/// Reads and checks a BSDF. Paths of problems are relative to it: `map[0]`, `jacobian`, `value[2]`.
///
/// Codes: those of [`Expr::parse`] for each formula, and `QRT0410` not one or three values,
/// `QRT0411` a map that leaves the unit sphere, `QRT0412` a map or slope without a finite value,
/// `QRT0413` a map of whole areas to points or lines, `QRT0414` a Jacobian that is not the map's,
/// `QRT0415` a negative value, `QRT0416` a value that is not finite, `QRT0417` a BSDF that gains
/// energy, `QRT0418` a weight without a bound.
pub fn compile(bsdf: &Bsdf) -> Result<CustomBsdf, Vec<Problem>> {
    let mut problems = Vec::new();
    let root = Path::root();
    let mut read = |text: &str, path: &Path, allowed: &[Variable]| {
        Expr::parse(text, allowed)
            .map_err(|found| {
                problems.extend(found.into_iter().map(|p| Problem {
                    path: path.clone(),
                    ..p
                }));
            })
            .ok()
    };
    let [x, y, z] =
        [0, 1, 2].map(|i| read(&bsdf.map[i], &root.key("map").item(i), &Variable::SQUARE));
    let stated = match &bsdf.jacobian {
        Jacobian::Auto => None,
        Jacobian::Stated(text) => Some(read(text, &root.key("jacobian"), &Variable::SQUARE)),
    };
    let values: Vec<Option<Expr>> = bsdf
        .value
        .iter()
        .enumerate()
        .map(|(i, text)| read(text, &root.key("value").item(i), &Variable::ALL))
        .collect();
    if !matches!(values.len(), 1 | 3) {
        let message = format!(
            "a BSDF has one value (grey) or three (RGB), not {}",
            values.len()
        );
        problems.push(Problem::new("QRT0410", root.key("value"), message));
    }
    let (Some(x), Some(y), Some(z)) = (x, y, z) else {
        return Err(problems);
    };
    let map = [x, y, z];
    problems.extend(checks::map(&map));
    if !problems.is_empty() {
        return Err(problems);
    }
    let projected_jacobian = match stated {
        None => maps::projected_jacobian(&map),
        Some(None) => return Err(problems),
        Some(Some(jacobian)) => {
            problems.extend(checks::jacobian(&map, &jacobian));
            (&jacobian * &map[2].abs()).simplify()
        }
    };
    let mut values: Vec<Expr> = values.into_iter().flatten().collect();
    let own: Vec<Expr> = values.clone();
    if values.len() == 1 {
        values = vec![values[0].clone(); 3];
    }
    let value: [Expr; 3] = match values.try_into() {
        Ok(value) => value,
        Err(_) => return Err(problems),
    };
    let before = problems.len();
    for (i, f) in own.iter().enumerate() {
        let path = root.key("value").item(i);
        let wrong = checks::value(&map, f, &path)
            .or_else(|| checks::energy(&map, &projected_jacobian, f, &path));
        problems.extend(wrong);
    }
    if problems.len() > before {
        return Err(problems);
    }
    let weight_bound = weight_bound(&map, &projected_jacobian, &value);
    for (i, bound) in weight_bound.iter().enumerate().take(own.len()) {
        if !bound.is_finite() {
            let message = "no bound of the weight value * |phi_z| * J can be shown";
            problems.push(
                Problem::new("QRT0418", root.key("value").item(i), message).help(
                    "choose a map that sends more points where the value is large, so that their \
                     product stays finite up to the border of the unit square",
                ),
            );
        }
    }
    if problems.is_empty() {
        let value = value.map(|f| f.simplify());
        Ok(CustomBsdf {
            map,
            projected_jacobian,
            value,
            weight_bound,
        })
    } else {
        Err(problems)
    }
}

/// An upper bound, per channel, of `value * projected_jacobian` over u and v in (0, 1), cos_o in
/// [0, 1] and cos_a in [-1, 1], with cos_i = |phi_z|: infinite if none can be shown.
///
/// It is a proof up to rounding of the weight itself, for which 1e-9 is added. Use it also where a
/// scene replaces a BSDF's own map.
pub fn weight_bound(map: &[Expr; 3], projected_jacobian: &Expr, value: &[Expr; 3]) -> Rgb {
    let cos_i = map[2].abs();
    let mut bounds: Rgb = [0.0; 3];
    for i in 0..3 {
        bounds[i] = if let Some(same) = (0..i).find(|j| value[*j] == value[i]) {
            bounds[same]
        } else {
            let f = value[i].substitute(Variable::CosI, &cos_i);
            checks::supremum(&(&f * projected_jacobian).simplify())
        };
    }
    bounds
}
