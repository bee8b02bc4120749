//! The built-in maps phi from the unit square to the hemisphere, and the Jacobian of any map.
//!
//! The paper samples directions by a change of variables, `omega = phi(u, v)`. An integral over
//! directions then turns into one over the square by *multiplying* with
//!
//! `J = |dphi/du x dphi/dv|`,
//!
//! the solid angle that a unit of the square covers (the paper divides; the integral of the cosine
//! over the hemisphere tells which is right: pi, not 0.0796). What a path needs is `|phi_z| J`.
//! On the unit sphere both partial derivatives are tangent, so their cross product is parallel to
//! phi and its z component is `phi_z J`, up to sign. Hence
//!
//! `|phi_z| J = |x_u y_v - x_v y_u|`,
//!
//! which has no root to take and in which the cosine of the cosine map cancels to pi.

use crate::expr::{Expr, Function, Variable};
use crate::scene::Map;

/// The components x, y, z of a built-in map. [`Map::Auto`], on a surface that has no map of its own,
/// is the cosine map.
///
/// - cosine: `sqrt(u) cos(2 pi v), sqrt(u) sin(2 pi v), sqrt(1 - u)`; `|phi_z| J = pi`;
/// - uniform: `sqrt(u (2 - u)) cos(2 pi v), sqrt(u (2 - u)) sin(2 pi v), 1 - u`; `|phi_z| J = 2 pi z`.
///
/// ```
/// use qrt_core::{sampling::maps, scene::Map};
/// let map = maps::builtin(Map::CosineHemisphere);
/// assert_eq!(maps::projected_jacobian(&map).to_string(), "pi");
/// ```
pub fn builtin(map: Map) -> [Expr; 3] {
    let (u, v) = (Expr::variable(Variable::U), Expr::variable(Variable::V));
    let angle = &(&Expr::from(2) * &Expr::pi()) * &v;
    let (radius, z) = match map {
        Map::Auto | Map::CosineHemisphere => (u.sqrt(), (&Expr::from(1) - &u).sqrt()),
        Map::UniformHemisphere => ((&u * &(&Expr::from(2) - &u)).sqrt(), &Expr::from(1) - &u),
    };
    [
        &radius * &angle.apply(Function::Cos),
        &radius * &angle.apply(Function::Sin),
        z,
    ]
}

/// `|phi_z| J = |x_u y_v - x_v y_u|` of a map onto the unit sphere, simplified.
pub fn projected_jacobian(map: &[Expr; 3]) -> Expr {
    let [x, y, _] = map;
    let (x_u, x_v) = (x.diff(Variable::U), x.diff(Variable::V));
    let (y_u, y_v) = (y.diff(Variable::U), y.diff(Variable::V));
    (&(&x_u * &y_v) - &(&x_v * &y_u)).abs().simplify()
}

/// `J = |dphi/du x dphi/dv|` of a map onto the unit sphere, simplified: the solid angle per unit of
/// the square, 1 over the pdf. It is the [`projected_jacobian`] over `|phi_z|`.
pub fn jacobian(map: &[Expr; 3]) -> Expr {
    (&projected_jacobian(map) / &map[2].abs()).simplify()
}
