//! Checks the claims of the book.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;
// These tests parse the book with the modules of the book's tool.
#[allow(dead_code, reason = "the tool's own parts of it")]
#[path = "../book/tool/src/complaint.rs"]
mod complaint;
#[allow(dead_code, reason = "the tool's own parts of it")]
#[path = "../book/tool/src/equation.rs"]
mod equation;
#[allow(dead_code, reason = "the tool's own parts of it")]
#[path = "../book/tool/src/symbol.rs"]
mod symbol;

mod book {
    mod page;

    mod figures;
    mod listings;
    mod measured;
    mod pages;
    mod reference;
}
