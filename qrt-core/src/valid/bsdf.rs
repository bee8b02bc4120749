//! Placeholder of the branch: the BSDF compiler replaces it.
use crate::expr::Expr;
use crate::report::Problem;
use crate::scene::Bsdf;
use crate::valid::CustomBsdf;

/// Compiles nothing.
pub fn compile(_: &Bsdf) -> Result<CustomBsdf, Vec<Problem>> {
    Ok(CustomBsdf {
        map: [Expr, Expr, Expr],
        projected_jacobian: Expr,
        value: [Expr, Expr, Expr],
        weight_bound: [1.0; 3],
    })
}
