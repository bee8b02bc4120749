//! Tests of gates against integers.
mod published;
mod random;
mod simulate;
mod small;
