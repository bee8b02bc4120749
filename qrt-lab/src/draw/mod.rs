//! Drawings of an inspected oracle (the call in the paper's frame, and the map of registers to
//! qubits), of small circuits, gate by gate, and of the outcomes of a simulated circuit.

mod frame;
mod outcomes;
mod registers;
mod terminal;
#[cfg(test)]
mod tests;
mod wires;

pub use frame::frame;
pub use outcomes::outcomes;
pub use registers::registers;
pub use terminal::frame_text;
pub use wires::Wires;
