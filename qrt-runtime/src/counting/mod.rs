//! Quantum counting: the distribution `P(theta~ | theta)`, draws from it, and estimators.
