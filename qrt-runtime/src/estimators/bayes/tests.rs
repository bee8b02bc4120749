//! What Bayesian estimators promise.
