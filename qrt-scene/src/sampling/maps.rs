//! The built-in maps phi from the unit square to the hemisphere, and the Jacobian of any map.
//!
//! The paper samples directions by a change of variables, `omega = phi(u, v)`. An integral over
//! directions then turns into one over the square by *multiplying* with
//!
//! `J = |dphi/du x dphi/dv|`,
//!
//! the solid angle that a unit of the square covers (the paper divides; the integral of the cosine
//! over the hemisphere shows that multiplying is right: pi, not 0.0796). A path needs `|phi_z| J`.
//! On the unit sphere both partial derivatives are tangent, so their cross product is parallel to
//! phi and its z component is `phi_z J`, up to sign. Hence
//!
//! `|phi_z| J = |x_u y_v - x_v y_u|`,
//!
//! which has no root to take and in which the cosine of the cosine map cancels to pi.

use crate::scene::Map;
use qrt_syntax::expr::{Expr, Function, Variable};

/// The components x, y, z of a built-in map. [`Map::Auto`], on a surface that has no map of its own,
/// is the cosine map.
///
/// - cosine: `sqrt(u) cos(2 pi v), sqrt(u) sin(2 pi v), sqrt(1 - u)`; `|phi_z| J = pi`;
/// - uniform: `sqrt(u (2 - u)) cos(2 pi v), sqrt(u (2 - u)) sin(2 pi v), 1 - u`; `|phi_z| J = 2 pi z`.
///
/// ```
/// use qrt_scene::{Map, sampling::maps};
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

/// Returns the projected Jacobian by the square of the distance to the normal, `q = x^2 + y^2`, and
/// the azimuth, whose tangent `y / x` is `Y / X` without common factors:
///
/// `|phi_z| J = |q_u a_v - q_v a_u| / 2`, `a_u = (X Y_u - Y X_u) / (X^2 + Y^2)`.
///
/// The radius, whose derivative has a pole at the normal of most maps, is in none of the
/// factors. So a bound can be proven even if the shape of the map depends on the azimuth, as for an
/// anisotropic lobe.
pub(crate) fn projected_jacobian_by_azimuth(map: &[Expr; 3]) -> Expr {
    let [x, y, _] = map;
    let square = (&x.powi(2) + &y.powi(2)).simplify();
    let [sine, cosine] = (y / x).simplify().fraction();
    let turn = |axis| {
        let both = &(&cosine * &sine.diff(axis)) - &(&sine * &cosine.diff(axis));
        both.simplify()
    };
    let area = &(&square.diff(Variable::U).simplify() * &turn(Variable::V))
        - &(&square.diff(Variable::V).simplify() * &turn(Variable::U));
    let length = &Expr::from(2) * &(&sine.powi(2) + &cosine.powi(2));
    (&area.abs() / &length).simplify()
}

/// `J = |dphi/du x dphi/dv|` of a map onto the unit sphere, simplified: the solid angle per unit of
/// the square, 1 over the pdf. It is the [`projected_jacobian`] over `|phi_z|`.
pub fn jacobian(map: &[Expr; 3]) -> Expr {
    (&projected_jacobian(map) / &map[2].abs()).simplify()
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_syntax::expr::Variables;
    use std::f64::consts::PI;

    const MAPS: [Map; 2] = [Map::CosineHemisphere, Map::UniformHemisphere];

    /// The integral over the open unit square, by the midpoint rule.
    fn integral(f: impl Fn(&Variables) -> f64) -> f64 {
        const N: u32 = 1000;
        let centre = |i: u32| (f64::from(i) + 0.5) / f64::from(N);
        let mut total = 0.0;
        for i in 0..N {
            for j in 0..8 {
                let at = Variables {
                    u: centre(i),
                    v: f64::from(j) / 8.0,
                    ..Variables::default()
                };
                total += f(&at) / f64::from(8 * N);
            }
        }
        total
    }

    #[test]
    fn maps_are_what_their_documentation_writes() {
        let written = |map: [&str; 3]| map.map(|c| Expr::parse(c, &Variable::SQUARE).unwrap());
        let cosine = ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"];
        let uniform = [
            "sqrt(u*(2-u))*cos(2*pi*v)",
            "sqrt(u*(2-u))*sin(2*pi*v)",
            "1-u",
        ];
        assert_eq!(builtin(Map::CosineHemisphere), written(cosine));
        assert_eq!(builtin(Map::Auto), written(cosine));
        assert_eq!(builtin(Map::UniformHemisphere), written(uniform));
    }

    #[test]
    fn projected_jacobians_cancel() {
        let [cosine, uniform] = MAPS.map(|map| projected_jacobian(&builtin(map)));
        assert_eq!(cosine.constant(), Some(PI));
        assert_eq!(uniform.to_string(), "6.283185307179586*(1 - u)");
    }

    #[test]
    fn a_change_of_variables_multiplies() {
        for map in MAPS {
            let phi = builtin(map);
            let (j, projected) = (jacobian(&phi), projected_jacobian(&phi));
            // The projected hemisphere has the area pi, the hemisphere 2 pi.
            let cosine = integral(|at| phi[2].eval(at) * j.eval(at));
            assert!((cosine - PI).abs() < 1e-3, "{map:?}: {cosine}");
            assert!((integral(|at| projected.eval(at)) - PI).abs() < 1e-9);
            let area = integral(|at| j.eval(at));
            // The cosine map's Jacobian has a pole at u = 1, where the rule loses 0.6/sqrt(N).
            assert!((area - 2.0 * PI).abs() < 0.07, "{map:?}: {area}");
        }
        // The second moment of the cosine is 2 pi / 3.
        for map in MAPS {
            let phi = builtin(map);
            let projected = projected_jacobian(&phi);
            let moment = integral(|at| phi[2].eval(at) * projected.eval(at));
            assert!((moment - 2.0 * PI / 3.0).abs() < 1e-4, "{map:?}: {moment}");
        }
        // Dividing by J, as the paper writes, gives 1/(4 pi) for the integral of the cosine.
        let uniform = builtin(Map::UniformHemisphere);
        let j = jacobian(&uniform);
        assert_eq!(j.constant(), Some(2.0 * PI));
        let divided = integral(|at| uniform[2].eval(at) / j.eval(at));
        assert!((divided - 0.0796).abs() < 1e-4, "{divided}");
    }

    #[test]
    fn directions_are_units_around_the_normal() {
        for map in MAPS {
            let phi = builtin(map);
            let length = |at: &Variables| phi.iter().map(|c| c.eval(at) * c.eval(at)).sum::<f64>();
            assert!(integral(|at| (length(at) - 1.0).abs()) < 1e-15);
            // Their mean points along z: every azimuth occurs as often as its opposite.
            for component in &phi[..2] {
                assert!(integral(|at| component.eval(at)).abs() < 1e-15);
            }
        }
    }
    /// Checks that both forms are the same number, for lobes of any shape.
    #[test]
    fn the_azimuth_leads_to_the_same_jacobian() {
        for [a, b] in [[0.5, 0.5], [0.5, 0.2], [0.3, 0.02], [1.0, 0.7]] {
            let square = format!("(1-u+u*({a}^2*cos(2*pi*v)^2+{b}^2*sin(2*pi*v)^2))");
            let map = [
                format!("{a}*cos(2*pi*v)*sqrt(u/{square})"),
                format!("{b}*sin(2*pi*v)*sqrt(u/{square})"),
                format!("sqrt((1-u)/{square})"),
            ];
            let map = map.map(|text| Expr::parse(&text, &Variable::SQUARE).unwrap());
            let (plain, other) = (
                projected_jacobian(&map),
                projected_jacobian_by_azimuth(&map),
            );
            for k in 0..100 {
                let at = Variables {
                    u: (f64::from(k) + 0.5) / 100.0,
                    v: (f64::from(k) * 0.618).fract(),
                    ..Variables::default()
                };
                let (plain, other) = (plain.eval(&at), other.eval(&at));
                assert!(
                    (plain / other - 1.0).abs() < 1e-9,
                    "{a} {b}: {plain} {other}"
                );
            }
        }
    }
}
