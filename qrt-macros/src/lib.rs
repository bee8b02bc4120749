//! The macro front end of qrt.
