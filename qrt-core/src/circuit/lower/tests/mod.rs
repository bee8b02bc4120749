//! Gates against integers.
mod published;
mod simulate;
mod small;
