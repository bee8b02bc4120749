//! The expression language of maps and BSDFs.

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr;
