//! Bayesian estimators.

mod adaptive;
mod depth;
mod posterior;
mod support;

pub use adaptive::AdaptiveBayes;
