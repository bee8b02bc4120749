//! Errors as exceptions, of the classes in `qrt/_errors.py`.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use qrt_runtime::memory::MemoryError;
use qrt_runtime::render::RenderError;
use qrt_syntax::Report;

/// Returns an exception of the class `class` of `qrt`.
fn exception<'py, A>(py: Python<'py>, class: &str, arguments: A) -> PyErr
where
    A: pyo3::call::PyCallArgs<'py>,
{
    let made = py
        .import("qrt._errors")
        .and_then(|module| module.getattr(class))
        .and_then(|class| class.call1(arguments));
    match made {
        Ok(made) => PyErr::from_value(made),
        Err(error) => error,
    }
}

/// Returns the exception for a request that names what does not exist, or combines what does not go together.
pub(crate) fn request(py: Python<'_>, message: impl ToString) -> PyErr {
    exception(py, "RequestError", (message.to_string(),))
}

/// Returns the exception for a request that exceeds the memory budget.
pub(crate) fn memory(py: Python<'_>, error: &MemoryError) -> PyErr {
    request(py, format!("{error}, or allow more with max_memory"))
}

/// Returns the exception for work that failed.
pub(crate) fn job(py: Python<'_>, message: impl ToString) -> PyErr {
    exception(py, "JobError", (message.to_string(),))
}

/// Returns the exception for parts that make no picture.
pub(crate) fn merging(py: Python<'_>, message: impl ToString) -> PyErr {
    exception(py, "MergeError", (message.to_string(),))
}

/// Returns the exception with all errors of a scene, as the command shows them.
pub(crate) fn scene(py: Python<'_>, report: &Report) -> PyErr {
    match problems(py, report) {
        Ok(problems) => exception(py, "SceneError", (report.to_string().trim_end(), problems)),
        Err(error) => error,
    }
}

/// Warns about valid input that is surely not meant.
pub(crate) fn warn(py: Python<'_>, report: &Report) -> PyResult<()> {
    let class = py.import("qrt._errors")?.getattr("SceneWarning")?;
    let text = report.to_string();
    py.import("warnings")?
        .call_method1("warn", (text.trim_end(), class, 2))?;
    Ok(())
}

fn problems<'py>(py: Python<'py>, report: &Report) -> PyResult<Bound<'py, PyTuple>> {
    let class = py.import("qrt._errors")?.getattr("Problem")?;
    let problems = report.problems().map(|problem| {
        let place = problem.place.as_ref();
        let (line, column) = place.map(|place| (place.line, place.column)).unzip();
        let (code, message, help) = (problem.code, problem.message, problem.help);
        class.call1((code, message, problem.file, line, column, help))
    });
    PyTuple::new(py, problems.collect::<PyResult<Vec<_>>>()?)
}

/// Returns the exception for a render that failed.
pub(crate) fn render(
    py: Python<'_>,
    error: RenderError,
    report: impl FnOnce(Vec<qrt_syntax::Problem>) -> Report,
) -> PyErr {
    match error {
        RenderError::Oracle(error) => scene(py, &report(vec![error.problem()])),
        RenderError::Budget(problems) => scene(py, &report(problems)),
        RenderError::WouldNotFit(error) => memory(py, &error),
        error if error.is_refusal() => request(py, error),
        error => job(py, error),
    }
}
