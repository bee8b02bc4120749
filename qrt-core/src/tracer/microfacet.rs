//! GGX with Fresnel 1 and separable Smith masking.
//!
//! ```text
//! f = D(h) G1(i) G1(o) / (4 cos_i cos_o)
//! D(h) = a^2 / (pi (cos_h^2 (a^2 - 1) + 1)^2)
//! G1(w) = 2 cos / (cos + sqrt(cos^2 + a^2 sin^2))
//! ```
//!
//! (Walter et al. 2007.) Its own map samples the distribution of visible normals by spherical caps
//! (Dupuy & Benyoub 2023). The map's Jacobian cancels all but the masking of the sampled
//! direction: `W = f cos_i J = G1(i)`, never above 1.

use super::Arith;
use super::vector::{self, Vector};

/// `sqrt(cos^2 + alpha^2 (1 - cos^2))`, the root in Smith's `G1`.
#[inline(always)]
fn smith_root<A: Arith>(cx: &mut A, cos: A::Real, alpha_squared: A::Real) -> A::Real {
    let one = cx.real(1.0);
    let square = cx.mul(cos, cos);
    let sin_squared = cx.sub(one, square);
    let zero = cx.real(0.0);
    let sin_squared = cx.max(sin_squared, zero);
    let rough = cx.mul(alpha_squared, sin_squared);
    let sum = cx.add(square, rough);
    cx.sqrt(sum)
}

/// `f` without its reflectance; `outgoing` and `incoming` are unit, local, with z > 0. No `alpha` is
/// below `least_alpha`.
#[inline(always)]
pub(crate) fn value<A: Arith>(
    cx: &mut A,
    alpha: A::Real,
    outgoing: &Vector<A>,
    incoming: &Vector<A>,
    least_alpha: f64,
) -> A::Real {
    let half = vector::add(cx, outgoing, incoming);
    let xx = cx.mul(half[0], half[0]);
    let yy = cx.mul(half[1], half[1]);
    let zz = cx.mul(half[2], half[2]);
    let across = cx.add(xx, yy);
    let square = cx.add(across, zz);
    let sin_squared = cx.div(across, square, 1.0);
    // cos^2 (a^2 - 1) + 1, without the cancellation that small alphas would suffer.
    let one = cx.real(1.0);
    let alpha_squared = cx.mul(alpha, alpha);
    let smooth = cx.sub(one, alpha_squared);
    let term = cx.mul(sin_squared, smooth);
    let denominator = cx.add(alpha_squared, term);
    let denominator = cx.mul(denominator, denominator);
    let distribution = cx.div(alpha_squared, denominator, least_alpha.powi(-2));
    let distribution = cx.scale(distribution, std::f64::consts::FRAC_1_PI);
    let root_i = smith_root(cx, incoming[2], alpha_squared);
    let root_o = smith_root(cx, outgoing[2], alpha_squared);
    let left = cx.add(incoming[2], root_i);
    let right = cx.add(outgoing[2], root_o);
    let masking = cx.mul(left, right);
    cx.div(distribution, masking, least_alpha.powi(-4))
}

/// The sampled direction and `W = G1` of it, 0 where the direction lies below the surface.
///
/// `u` chooses the height on the cap; `cos`, `sin` are of the azimuth `2 pi v`.
#[inline(always)]
pub(crate) fn sample<A: Arith>(
    cx: &mut A,
    alpha: A::Real,
    outgoing: &Vector<A>,
    u: A::Real,
    [cos, sin]: [A::Real; 2],
    least_alpha: f64,
) -> (Vector<A>, A::Real) {
    let (zero, one) = (cx.real(0.0), cx.real(1.0));
    let x = cx.mul(alpha, outgoing[0]);
    let y = cx.mul(alpha, outgoing[1]);
    let longest = least_alpha.recip();
    let warped = vector::normalize(cx, &[x, y, outgoing[2]], longest);
    let left = cx.sub(one, u);
    let reach = cx.add(one, warped[2]);
    let height = cx.mul(left, reach);
    let z = cx.sub(height, warped[2]);
    let square = cx.mul(z, z);
    let sin_squared = cx.sub(one, square);
    let sin_squared = cx.max(sin_squared, zero);
    let radius = cx.sqrt(sin_squared);
    let x = cx.mul(radius, cos);
    let y = cx.mul(radius, sin);
    let half = vector::add(cx, &[x, y, z], &warped);
    let x = cx.mul(alpha, half[0]);
    let y = cx.mul(alpha, half[1]);
    // Where the cap's point is opposite to the viewer the half vector vanishes; that near to it, a
    // coarse machine may leave it shorter than 1.
    let normal = vector::normalize(cx, &[x, y, half[2]], 16.0 * longest);
    let incoming = vector::mirror(cx, outgoing, &normal);
    let alpha_squared = cx.mul(alpha, alpha);
    let root = smith_root(cx, incoming[2], alpha_squared);
    let sum = cx.add(incoming[2], root);
    let twice = cx.add(incoming[2], incoming[2]);
    let masking = cx.div(twice, sum, 2.0);
    let above = cx.less(zero, incoming[2]);
    let weight = cx.select(above, masking, zero);
    (incoming, weight)
}
