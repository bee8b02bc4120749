//! The native part of the Python package `qrt`; the modules for users are in `python/qrt`.

mod device;
mod errors;
mod oracle;
mod picture;
mod records;
mod scene;
mod scene_methods;
mod work;

use pyo3::prelude::*;

/// The native part of `qrt`.
#[pymodule]
fn _qrt(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<picture::Picture>()?;
    module.add_class::<oracle::Oracle>()?;
    module.add_class::<device::Device>()?;
    module.add_function(wrap_pyfunction!(scene::load, module)?)?;
    module.add_function(wrap_pyfunction!(scene::parse, module)?)?;
    module.add_function(wrap_pyfunction!(scene::restore, module)?)?;
    module.add_function(wrap_pyfunction!(picture::merge, module)?)?;
    module.add_function(wrap_pyfunction!(records::count, module)?)?;
    module.add_function(wrap_pyfunction!(records::inspect, module)?)?;
    module.add_function(wrap_pyfunction!(records::pareto, module)?)?;
    module.add_function(wrap_pyfunction!(records::plan, module)?)?;
    module.add_function(wrap_pyfunction!(records::simulate_pixel, module)?)?;
    module.add_function(wrap_pyfunction!(records::trade_in, module)?)?;
    module.add_function(wrap_pyfunction!(records::verify, module)?)
}
