//! A scene's figures as JSON: the records that `qrt ... --json` prints and that Python's methods return.
//!
//! Every record of a command has a `version`, which grows with a change of a key's meaning; new keys do
//! not change it. The book's chapter on the command describes the keys.

mod count;
mod inspect;
mod pareto;
mod plan;
mod simulate;
mod trade;
mod verify;

pub use count::count;
pub(crate) use inspect::oracle_cost;
pub use inspect::{cost, inspect, pixel_counts};
pub use pareto::pareto;
pub use plan::plan;
pub use simulate::{simulate, simulate_mean_phase};
pub use trade::trade;
pub use verify::{VerifyFigures, defect, verify};
