//! Drawings of an inspected oracle (the call in the paper's frame, and the map of registers to
//! qubits) and of small circuits, gate by gate.

mod frame;
mod registers;
mod terminal;
#[cfg(test)]
mod tests;
mod wires;

pub use frame::frame;
pub use registers::registers;
pub use terminal::frame_text;
pub use wires::Wires;
