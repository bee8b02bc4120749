//! The interactive figures of the book of qrt.
//!
//! Each figure is a function of its controls. qrt itself, compiled to WebAssembly, computes the
//! results: no script computes them a second time. Scripts call [`boundary`];
//! `book/interactive/figures.js` draws. Most pages have one figure, so each figure becomes a module
//! of its own, by a feature of its name, and readers do not load the code of other figures.
//!
//! * [`counting`]: the phase register's distribution, draws from it, and the posterior;
//! * [`map`]: a lattice in the unit square and on the sphere, and its Jacobian;
//! * [`circuit`]: the oracle of a tiny scene, operation by operation;
//! * [`picture`]: a picture that sharpens as queries are spent.
#![warn(
    missing_docs,
    clippy::pedantic,
    clippy::unwrap_used,
    clippy::expect_used
)]
// The same lint settings as in the workspace of qrt.
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    clippy::float_cmp,
    clippy::many_single_char_names,
    clippy::missing_errors_doc,
    clippy::must_use_candidate,
    clippy::return_self_not_must_use,
    clippy::similar_names,
    clippy::too_many_lines
)]

pub mod boundary;
#[cfg(feature = "circuit")]
pub mod circuit;
#[cfg(feature = "counting")]
pub mod counting;
#[cfg(feature = "map")]
pub mod map;
#[cfg(feature = "picture")]
pub mod picture;
