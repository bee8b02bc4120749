//! Studies of a scene, returned as the JSON that the command prints.

use crate::scene::Scene;
use crate::{errors, work};
use pyo3::prelude::*;
use qrt_core::inspect::{CHANNELS, OraclePixel};
use qrt_core::oracle::Oracles;
use qrt_counting::MAX_REPETITIONS;
use qrt_counting::estimators::EstimatorError;
use qrt_lab::count::{CountFigures, CountOptions};
use qrt_lab::inspect::InspectFigures;
use qrt_lab::json::{self, VerifyFigures};
use qrt_lab::layouts::{LayoutsError, front_of_most_expensive};
use qrt_lab::simulate::{SimulateError, SimulateOptions, simulate};
use qrt_lab::trade::{TradeError, TradeOptions, trade};
use qrt_lab::verify::{VerifyError, VerifyOptions, verify_prepared};
use qrt_runtime::Prepared;
use qrt_runtime::memory::{CircuitWork, Memory};
use qrt_runtime::prepared::PrepareError;
use qrt_runtime::workers::Workers;
use qrt_scene::Window;
use serde_json::Value;
use std::path::PathBuf;
use std::time::Instant;

/// Returns the number of the channel with the name `asked`.
pub(crate) fn channel(py: Python<'_>, asked: Option<&str>) -> PyResult<Option<usize>> {
    let Some(name) = asked else {
        return Ok(None);
    };
    let found = CHANNELS.iter().position(|other| *other == name);
    let refused = || errors::request(py, format!("channel={name:?} is none of: r, g, b"));
    found.map(Some).ok_or_else(refused)
}

/// Returns the window with the name `asked`.
fn window(py: Python<'_>, asked: &str) -> PyResult<Window> {
    let all = [Window::Rect, Window::Sine];
    let found = all.into_iter().find(|window| window.name() == asked);
    let refused = || errors::request(py, format!("window={asked:?} is none of: rect, sine"));
    found.ok_or_else(refused)
}

/// Checks that a number is in `range`.
fn in_range(
    py: Python<'_>,
    name: &str,
    value: Option<u32>,
    range: std::ops::RangeInclusive<u32>,
) -> PyResult<()> {
    match value.filter(|value| !range.contains(value)) {
        None => Ok(()),
        Some(value) => {
            let message = format!(
                "{name}={value} is not in {}..={}",
                range.start(),
                range.end()
            );
            Err(errors::request(py, message))
        }
    }
}

/// The reason why a study has no result.
enum StudyError {
    Prepare(PrepareError),
    /// The request cannot be met.
    Refused(String),
    Failed(String),
}

impl StudyError {
    fn new(error: &impl std::error::Error, is_refusal: bool) -> Self {
        if is_refusal {
            Self::Refused(error.to_string())
        } else {
            Self::Failed(error.to_string())
        }
    }
}

impl From<PrepareError> for StudyError {
    fn from(error: PrepareError) -> Self {
        Self::Prepare(error)
    }
}

impl From<VerifyError> for StudyError {
    fn from(error: VerifyError) -> Self {
        match error {
            VerifyError::Prepare(error) => error.into(),
            VerifyError::Oracle(error) => Self::Prepare(error.into()),
            error => Self::new(&error, error.is_refusal()),
        }
    }
}

impl From<LayoutsError> for StudyError {
    fn from(error: LayoutsError) -> Self {
        match error {
            LayoutsError::Oracle(error) => Self::Prepare(error.into()),
            error => Self::new(&error, false),
        }
    }
}

impl From<TradeError> for StudyError {
    fn from(error: TradeError) -> Self {
        match error {
            TradeError::Oracle(error) => Self::Prepare(error.into()),
            error => Self::new(&error, error.is_refusal()),
        }
    }
}

impl From<SimulateError> for StudyError {
    fn from(error: SimulateError) -> Self {
        match error {
            SimulateError::Oracle(error) => Self::Prepare(error.into()),
            error => Self::new(&error, error.is_refusal()),
        }
    }
}

impl Scene {
    /// Runs `study` on a thread of its own, with the scene prepared: the planner has chosen its parameters if
    /// it asks for an accuracy.
    fn study(
        &self,
        py: Python<'_>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
        study: impl FnOnce(&Prepared<'_>, Workers<'_>) -> Result<Value, StudyError> + Send,
    ) -> PyResult<String> {
        let threads = work::threads(py, threads)?;
        let prepared = self.prepared(py)?;
        let study = |workers: Workers<'_>| study(&prepared, workers).map(|value| value.to_string());
        work::listened(py, threads, progress, study, |error| match error {
            StudyError::Prepare(error) => self.unprepared(py, error),
            StudyError::Refused(message) => errors::request(py, message),
            StudyError::Failed(message) => errors::job(py, message),
        })
    }
}

/// Returns the figures of `qrt inspect`.
#[pyfunction]
pub(crate) fn inspect(
    py: Python<'_>,
    scene: &Scene,
    channel: Option<&str>,
    pixel: Option<[u32; 2]>,
    seed: u64,
) -> PyResult<String> {
    let channel = self::channel(py, channel)?;
    let pixel = match pixel {
        None => None,
        Some(pixel) => Some(OraclePixel {
            place: scene.pixel(py, Some(pixel))?,
            seed,
        }),
    };
    scene.study(py, None, Some(no_progress(py)), |prepared, _| {
        let shown = pixel.map_or([0, 0], |pixel| pixel.place);
        prepared.check_memory(shown, CircuitWork::Program)?;
        let figures = InspectFigures::new(prepared, channel, pixel)?;
        Ok(json::inspect(&figures))
    })
}

/// Returns the front of `qrt inspect --pareto`.
#[pyfunction]
pub(crate) fn pareto(
    py: Python<'_>,
    scene: &Scene,
    channel: Option<&str>,
    pixel: Option<[u32; 2]>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let channel = self::channel(py, channel)?;
    let place = match pixel {
        None => None,
        Some(_) => Some(scene.pixel(py, pixel)?),
    };
    scene.study(py, threads, progress, |prepared, workers| {
        prepared.check_memory(place.unwrap_or([0, 0]), CircuitWork::Program)?;
        let whole = prepared.oracles();
        let alone: Option<Oracles<'_>> = place.map(|place| whole.of_pixel(place));
        let oracles = alone.as_ref().unwrap_or(whole);
        let (name, front) = front_of_most_expensive(oracles, channel, &workers)?;
        let scene = &prepared.scene().scene().name;
        let pixel = place.map(|place| OraclePixel { place, seed: 0 });
        Ok(json::pareto(scene, name, pixel, &front))
    })
}

/// Returns the answer of `qrt verify`.
#[pyfunction]
pub(crate) fn verify(
    py: Python<'_>,
    scene: &Scene,
    pixels: u64,
    seed: u64,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    if pixels == 0 {
        return Err(errors::request(py, "pixels=0 checks nothing"));
    }
    scene.study(py, threads, progress, |prepared, workers| {
        prepared.check_memory([0, 0], CircuitWork::gates(workers.threads))?;
        prepared.check_budget()?;
        let start = Instant::now();
        let options = VerifyOptions {
            pixels,
            seed,
            workers,
            ..VerifyOptions::default()
        };
        let report = verify_prepared(prepared, &options)?;
        let defect = report.defect.as_ref();
        let defect = defect.map(|defect| json::defect(defect, report.defect_model));
        let figures = VerifyFigures {
            scene: prepared.scene(),
            seed,
            portion: None,
            report: &report,
            defect: defect.as_ref(),
            seconds: start.elapsed().as_secs_f64(),
        };
        Ok(json::verify(&figures))
    })
}

/// Returns the plan of a scene that asks for an accuracy.
#[pyfunction]
pub(crate) fn plan(py: Python<'_>, scene: &Scene) -> PyResult<String> {
    let prepared = scene.prepared(py)?;
    let planned = prepared.plan().map(json::plan);
    let planned = planned.map(|plan| plan.to_string());
    planned.ok_or_else(|| {
        let message = "the scene asks for no accuracy, so nothing is planned: write `accuracy: { error: \
                       0.05, confidence: 0.95 }` in place of `sampling.path_bits` and `counting`";
        errors::request(py, message)
    })
}

/// Measures as `qrt trade` does, and writes its files to `folder`.
#[pyfunction]
pub(crate) fn trade_in(
    py: Python<'_>,
    scene: &Scene,
    folder: PathBuf,
    quick: bool,
    pixels: Option<u64>,
    seed: u64,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    if pixels == Some(0) {
        return Err(errors::request(py, "pixels=0 measures nothing"));
    }
    scene.study(py, threads, progress, |prepared, workers| {
        let options = TradeOptions {
            pixels,
            seed,
            quick,
            workers,
            memory: Memory::default(),
            ..TradeOptions::default()
        };
        let measured = trade(prepared.scene(), &folder, &options)?;
        Ok(json::trade(&measured))
    })
}

/// Returns the distribution of `qrt count`.
#[pyfunction]
pub(crate) fn count(
    py: Python<'_>,
    good: u64,
    total: u64,
    phase_bits: u32,
    window: &str,
    outcomes: Vec<u64>,
    shots: Option<u32>,
    seed: u64,
) -> PyResult<String> {
    in_range(py, "phase_bits", Some(phase_bits), 1..=40)?;
    in_range(py, "shots", shots, 1..=MAX_REPETITIONS)?;
    let options = CountOptions {
        good,
        total,
        phase_bits,
        window: self::window(py, window)?,
        outcomes,
        shots,
        seed,
    };
    let counted = work::run(py, None, None, |_| {
        CountFigures::new(options).map(|count| json::count(&count).to_string())
    })?;
    counted.map_err(|error: EstimatorError| errors::request(py, error))
}

/// Returns the outcomes of `qrt simulate`.
#[pyfunction]
pub(crate) fn simulate_pixel(
    py: Python<'_>,
    scene: &Scene,
    channel: Option<&str>,
    pixel: Option<[u32; 2]>,
    phase_bits: Option<u32>,
    window: Option<&str>,
    shots: Option<u32>,
    seed: u64,
) -> PyResult<String> {
    in_range(py, "phase_bits", phase_bits, 1..=23)?;
    in_range(py, "shots", shots, 1..=MAX_REPETITIONS)?;
    let channel = self::channel(py, channel)?;
    let window = window.map(|window| self::window(py, window)).transpose()?;
    let pixel = OraclePixel {
        place: scene.pixel(py, pixel)?,
        seed,
    };
    scene.study(py, None, Some(no_progress(py)), |prepared, workers| {
        let options = SimulateOptions {
            channel,
            phase_bits,
            window,
            shots,
            workers,
            ..SimulateOptions::default()
        };
        let simulated = simulate(prepared.oracles(), pixel, &options)?;
        Ok(json::simulate(prepared.scene(), &simulated))
    })
}

/// Returns the value of `progress` that shows none.
fn no_progress(py: Python<'_>) -> Py<PyAny> {
    pyo3::types::PyBool::new(py, false)
        .to_owned()
        .into_any()
        .unbind()
}
