//! A device whose outcomes are drawn from their exact probabilities.

use crate::errors;
use pyo3::prelude::*;
use qrt_circuit::quantum::Window;
use qrt_counting::estimators::{CountingProblem, Device as RuntimeDevice, EstimatorError, Noise};
use qrt_counting::random::Stream;
use std::sync::{Mutex, PoisonError};

/// Runs Grover's iterate on an oracle's indices and measures.
#[pyclass(frozen, module = "qrt")]
pub(crate) struct Device {
    problem: CountingProblem,
    noise: Noise,
    state: Mutex<State>,
}

struct State {
    stream: Stream,
    queries: u64,
    shots: u64,
}

impl Device {
    /// Creates a device with the random draws of the pixel and the channel (0 red, 1 green, 2 blue) under `seed`.
    pub(crate) fn new(
        problem: CountingProblem,
        noise: Noise,
        seed: u64,
        [x, y]: [u32; 2],
        channel: u8,
    ) -> Self {
        let state = State {
            stream: Stream::new(seed, x, y, channel),
            queries: 0,
            shots: 0,
        };
        Self {
            problem,
            noise,
            state: Mutex::new(state),
        }
    }

    fn measure<T>(
        &self,
        py: Python<'_>,
        run: impl FnOnce(&mut RuntimeDevice<'_>) -> Result<T, EstimatorError> + Send,
    ) -> PyResult<T>
    where
        T: Send,
    {
        // The thread releases the interpreter while it waits for the lock, because the lock's holder may need it.
        let measured = py.detach(|| {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            let State {
                stream,
                queries,
                shots,
            } = &mut *state;
            let mut device = RuntimeDevice::new(self.problem, self.noise, stream)?;
            let found = run(&mut device)?;
            let usage = device.usage();
            *queries += usage.queries;
            *shots += usage.shots;
            Ok::<T, EstimatorError>(found)
        });
        measured.map_err(|error| errors::request(py, error))
    }

    fn used(&self, py: Python<'_>) -> (u64, u64) {
        py.detach(|| {
            let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            (state.queries, state.shots)
        })
    }
}

#[pymethods]
impl Device {
    /// One measurement of the index after k iterates: whether it is good. Its probability is
    /// sin((2k + 1) theta)**2 with sin(theta)**2 = S/N. It takes k queries, and one for k = 0.
    #[pyo3(signature = (k=0))]
    fn shot(&self, py: Python<'_>, k: u64) -> PyResult<bool> {
        Ok(self.shots(py, k, 1)? == 1)
    }

    /// Number of good outcomes among `shots` measurements after k iterates each.
    fn shots(&self, py: Python<'_>, k: u64, shots: u64) -> PyResult<u64> {
        self.measure(py, |device| device.iterated(k, shots))
    }

    /// Outcomes y of the counting circuit with 2**phase_bits = T, folded onto 0 to T/2: y/T is about theta in
    /// turns. T - 1 queries each. `window` is "rect" or "sine".
    #[pyo3(signature = (phase_bits, shots=1, *, window="rect"))]
    fn phases(
        &self,
        py: Python<'_>,
        phase_bits: u32,
        shots: u32,
        window: &str,
    ) -> PyResult<Vec<u64>> {
        let found = match window {
            "rect" => Window::Rect,
            "sine" => Window::Sine,
            other => {
                let message = format!("window={other:?} is none of: rect, sine");
                return Err(errors::request(py, message));
            }
        };
        self.measure(py, |device| device.phases(phase_bits, found, shots))
    }

    /// N, the indices.
    #[getter]
    fn total(&self) -> u64 {
        self.problem.total
    }

    /// Queries of the oracle up to now.
    #[getter]
    fn queries(&self, py: Python<'_>) -> u64 {
        self.used(py).0
    }

    /// Measurements up to now.
    #[getter]
    fn measured(&self, py: Python<'_>) -> u64 {
        self.used(py).1
    }
}
