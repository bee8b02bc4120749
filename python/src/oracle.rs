//! A pixel's oracle: its costs, its counts, its circuit.

use crate::device::Device;
use crate::errors;
use crate::records;
use crate::scene::Scene;
use crate::work;
use numpy::PyArray1;
use numpy::ndarray::ArrayView1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use qrt_circuit::export::{Export, ExportFormat};
use qrt_circuit::lower::Cost;
use qrt_circuit::quantum::{CircuitPart, Conjunction, CountingCircuit, LogicalCounts};
use qrt_core::inspect::{Inspection, OraclePixel};
use qrt_core::oracle::{Oracle as PathOracle, OracleName, Oracles, check_budget};
use qrt_counting::estimators::{CountingProblem, Noise, NoiseError};
use qrt_lab::json;
use qrt_lab::physical::{PhysicalError, PictureCounts};
use qrt_lab::verify::pixel_counts;
use qrt_runtime::memory::CircuitWork;
use qrt_runtime::path_machines::{Defect, OracleMachine};
use qrt_runtime::prepared::PrepareError;
use qrt_scene::valid::ValidScene;
use std::sync::{Arc, OnceLock};

/// Most paths whose thresholds are returned: 8 bytes each.
const MOST_PATHS: u64 = 1 << 28;

/// The oracle of a channel of a pixel.
#[pyclass(frozen, module = "qrt")]
pub(crate) struct Oracle {
    scene: Py<Scene>,
    traced: ValidScene,
    /// Planned queries of a pixel, by channel, if the scene asks for an accuracy.
    planned: Option<[f64; 3]>,
    name: OracleName,
    which: String,
    call: String,
    pixel: [u32; 2],
    seed: u64,
    compiled: Arc<PathOracle>,
    cost: Cost,
    qubits: u32,
    toffoli_depth: u64,
    /// Number of thresholds that a path's colour exceeds, by path index.
    thresholds: OnceLock<Vec<i64>>,
    /// Its counts beside those of real numbers, as JSON; none if the paths are too many.
    counts: OnceLock<Option<String>>,
}

impl Oracle {
    pub(crate) fn new(
        py: Python<'_>,
        scene: &Scene,
        this: Py<Scene>,
        channel: Option<&str>,
        pixel: Option<[u32; 2]>,
        seed: u64,
    ) -> PyResult<Self> {
        let pixel = scene.pixel(py, pixel)?;
        let number = records::channel(py, channel)?;
        let prepared = scene.prepared(py)?;
        let place = OraclePixel { place: pixel, seed };
        let report = |problems| errors::scene(py, &scene.loaded.report(problems));
        let inspection = work::run(py, None, None, |_| {
            let alone = prepared.pixel_oracles(pixel, CircuitWork::Program)?;
            Ok::<_, PrepareError>(Inspection::of_pixel(&alone, number, place)?)
        })?;
        let inspection = inspection.map_err(|error| scene.unprepared(py, error))?;
        check_budget(prepared.scene(), &[inspection.oracle_cost()]).map_err(report)?;
        Ok(Self {
            scene: this,
            name: inspection.name,
            which: inspection.which(),
            call: inspection.call_in_words(),
            pixel,
            seed,
            cost: inspection.total(),
            qubits: inspection.qubits,
            toffoli_depth: inspection.toffoli_depth,
            compiled: Arc::new(inspection.oracle),
            planned: prepared.plan().map(|plan| plan.channel_queries),
            traced: prepared.scene().clone(),
            thresholds: OnceLock::new(),
            counts: OnceLock::new(),
        })
    }

    fn paths(&self) -> u64 {
        1 << self.compiled.points.path_bits()
    }

    fn counted(&self, py: Python<'_>) -> PyResult<&[i64]> {
        if let Some(found) = self.thresholds.get() {
            return Ok(found);
        }
        let paths = self.paths();
        if paths > MOST_PATHS {
            let message = format!("{paths} paths are more than {MOST_PATHS}: lower path_bits");
            return Err(errors::request(py, message));
        }
        let found = work::run(py, None, None, |workers| {
            let machine = OracleMachine::fixed(Arc::clone(&self.compiled), self.seed, false);
            let mut found = Vec::with_capacity(paths as usize);
            for ids in work::runs(workers, paths) {
                machine.trace(&[self.pixel], ids, |run| found.extend(run.good[0]))?;
            }
            Ok::<_, Defect>(found)
        })?;
        let found = found.map_err(|error| errors::job(py, error))?;
        Ok(self.thresholds.get_or_init(|| found))
    }

    fn problem(&self, py: Python<'_>) -> PyResult<CountingProblem> {
        Ok(CountingProblem {
            good: self.counted(py)?.iter().sum::<i64>().cast_unsigned(),
            total: self.total(),
        })
    }
}

fn of_qsharp(py: Python<'_>, counts: LogicalCounts) -> PyResult<Bound<'_, PyDict>> {
    let told = PyDict::new(py);
    for (name, value) in [
        ("numQubits", counts.qubits),
        ("cczCount", counts.toffoli),
        ("ccixCount", counts.and),
        ("tCount", counts.t),
        ("rotationCount", counts.rotations),
        ("rotationDepth", counts.rotation_depth),
        ("measurementCount", counts.measurements),
    ] {
        told.set_item(name, value)?;
    }
    Ok(told)
}

#[pymethods]
impl Oracle {
    /// "r", "g" or "b".
    #[getter]
    fn channel(&self) -> &'static str {
        self.name.channel_name()
    }

    /// The class of its pixel: "may-see-lamp" or "sees-no-lamp", or "all" where the scene has one oracle
    /// for all pixels of a channel.
    #[getter]
    fn pixel_class(&self) -> &'static str {
        self.name.class_name()
    }

    /// Column and row, from 0 at the top left.
    #[getter]
    fn pixel(&self) -> (u32, u32) {
        self.pixel.into()
    }

    /// The key of its paths' shifts.
    #[getter]
    fn seed(&self) -> u64 {
        self.seed
    }

    /// The scene that it is of.
    #[getter]
    fn scene(&self, py: Python<'_>) -> Py<Scene> {
        self.scene.clone_ref(py)
    }

    /// Qubits of a call (compute, compare and flip, uncompute): the most in use at any time. These figures
    /// are those of `qrt inspect --pixel X,Y --channel C`, and of what `qasm` writes.
    #[getter]
    fn qubits(&self) -> u32 {
        self.qubits
    }

    /// Toffoli gates of a call, where everything is undone by gates.
    #[getter]
    fn toffoli(&self) -> u64 {
        self.cost.toffoli
    }

    /// ANDs of a call, where those into clean qubits are undone by measurement.
    #[getter]
    fn and_measured(&self) -> u64 {
        self.cost.and_measured
    }

    /// CNOT gates of a call.
    #[getter]
    fn cnot(&self) -> u64 {
        self.cost.cnot
    }

    /// X gates of a call, the pixel's parameters built in.
    #[getter]
    fn x(&self) -> u64 {
        self.cost.x
    }

    /// Toffolis one after another, at the longest.
    #[getter]
    fn toffoli_depth(&self) -> u64 {
        self.toffoli_depth
    }

    /// Qubits of the path index: R = 2**path_bits paths.
    #[getter]
    fn path_bits(&self) -> u32 {
        self.compiled.points.path_bits()
    }

    /// Qubits of the comparator: C = 2**comparator_bits thresholds.
    #[getter]
    fn comparator_bits(&self) -> u32 {
        self.compiled.comparator_bits()
    }

    /// t, the qubits of the phase register, as the scene has them; T = 2**phase_bits.
    #[getter]
    fn phase_bits(&self) -> u32 {
        self.traced.scene().counting.phase_bits
    }

    /// The window on the phase register, "rect" or "sine", as the scene has it.
    #[getter]
    fn window(&self) -> &'static str {
        self.traced.scene().counting.register_window().name()
    }

    /// The radiance of S = N, the proven bound on a path's colour.
    #[getter]
    fn scale(&self) -> f64 {
        self.compiled
            .channels
            .first()
            .map_or(0.0, |channel| channel.scale)
    }

    /// N, the indices: paths times thresholds.
    #[getter]
    fn total(&self) -> u64 {
        self.paths() << self.comparator_bits()
    }

    /// S, the good indices, counted path by path by the oracle's program.
    #[getter]
    fn good(&self, py: Python<'_>) -> PyResult<u64> {
        Ok(self.problem(py)?.good)
    }

    /// S/N. The pixel is `scale` times as bright.
    #[getter]
    fn amplitude(&self, py: Python<'_>) -> PyResult<f64> {
        let CountingProblem { good, total } = self.problem(py)?;
        Ok(good as f64 / total as f64)
    }

    /// The number of thresholds that the colour of each path exceeds: an array of (2**path_bits,), int64, in the
    /// order of path indices, that shares the oracle's memory and can't be written to. Index path + (y <<
    /// path_bits) is good if y is below it.
    #[getter]
    fn thresholds<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<i64>>> {
        let view = ArrayView1::from(this.get().counted(this.py())?);
        // SAFETY: the memory belongs to the oracle, which is frozen and counts once: it neither changes nor
        // moves, and the array holds a reference to the oracle.
        let array = unsafe { PyArray1::borrow_from_array(&view, this.clone().into_any()) };
        array.call_method1("setflags", (false,))?;
        Ok(array)
    }

    /// S by the oracle's program beside S of the same paths in real numbers, as JSON; none if the paths are
    /// too many to compare.
    fn _counts(&self, py: Python<'_>) -> PyResult<Option<&str>> {
        if let Some(found) = self.counts.get() {
            return Ok(found.as_deref());
        }
        let pixel = OraclePixel {
            place: self.pixel,
            seed: self.seed,
        };
        let counts = work::run(py, None, None, |_| {
            pixel_counts(&self.traced, &self.compiled, pixel)
        })?;
        let counts = counts.map_err(|error| errors::job(py, error))?;
        let counts = counts.map(|counts| json::pixel_counts(counts).to_string());
        Ok(self.counts.get_or_init(|| counts).as_deref())
    }

    /// A device that runs the iterate on this oracle's indices: what it measures is drawn from the exact
    /// probabilities of S and N. `noise` is such as "depolarising=0.001,readout=0.01".
    #[pyo3(signature = (seed=0, *, noise=None))]
    fn device(&self, py: Python<'_>, seed: u64, noise: Option<&str>) -> PyResult<Device> {
        let noise = noise.map(str::parse::<Noise>).transpose();
        let noise = noise.map_err(|error: NoiseError| errors::request(py, error))?;
        let problem = self.problem(py)?;
        Ok(Device::new(
            problem,
            noise.unwrap_or_default(),
            seed,
            self.pixel,
            self.name.channel as u8,
        ))
    }

    /// The circuit as OpenQASM 2 or 3; `part` is "oracle", "grover" (one iterate) or "counting" (all of
    /// quantum counting, by the scene's phase bits).
    ///
    /// Raises RequestError for more than max_gates gates, of which each takes some 28 bytes.
    #[pyo3(signature = (version=3, part="oracle", *, max_gates=50_000_000))]
    fn qasm(&self, py: Python<'_>, version: u32, part: &str, max_gates: u64) -> PyResult<String> {
        let format = match version {
            2 => ExportFormat::OpenQasm2,
            3 => ExportFormat::OpenQasm3,
            other => {
                let message = format!("there is no OpenQASM {other} here: versions are 2 and 3");
                return Err(errors::request(py, message));
            }
        };
        let part = match part {
            "oracle" => CircuitPart::Oracle,
            "grover" => CircuitPart::Grover,
            "counting" => CircuitPart::Counting,
            other => {
                let message = format!("part={other:?} is none of: oracle, grover, counting");
                return Err(errors::request(py, message));
            }
        };
        let counting = self.traced.scene().counting;
        let (phase_bits, window) = (counting.phase_bits, counting.register_window());
        let comments = [
            format!(
                "qrt {}: {}, {}, seed {}",
                env!("CARGO_PKG_VERSION"),
                self.traced.scene().name,
                self.which,
                self.seed
            ),
            format!("One call of the oracle has {}.", self.call),
        ];
        let written = work::run(py, None, None, |workers| {
            let failed = |error: &dyn std::error::Error| error.to_string();
            let oracle = self
                .compiled
                .phase(0, self.seed, self.pixel)
                .map_err(|e| failed(&e))?;
            let conjunction = Conjunction::Toffolis;
            let counting = CountingCircuit::with(&oracle, phase_bits, window, conjunction);
            let counting = counting.map_err(|e| failed(&e))?;
            let export = Export::new(&counting, part, &self.compiled.index_parts());
            let export = export.map_err(|e| failed(&e))?;
            if export.gates() > max_gates {
                let gates = export.gates();
                return Err(format!("{gates} gates are more than max_gates={max_gates}"));
            }
            let export = match workers.cancel {
                Some(cancel) => export.with_cancel(cancel),
                None => export,
            };
            let mut bytes = Vec::new();
            let written = export.write(format, &comments, &mut bytes);
            written.map_err(|e| failed(&e))?;
            String::from_utf8(bytes).map_err(|e| failed(&e))
        })?;
        written.map_err(|message| errors::request(py, message))
    }

    /// The input of estimators of physical resources, by the names of Q#'s `LogicalCounts`: for
    /// `qdk.estimator.LogicalCounts(...)`. `of` is "oracle" (a call), "channel", "pixel" or "film" (all that the scene's
    /// counting may use); `measured` says whether ANDs are undone by measurement.
    #[pyo3(signature = (of="oracle", *, measured=true))]
    fn logical_counts<'py>(
        &self,
        py: Python<'py>,
        of: &str,
        measured: bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let counts = work::run(py, None, None, |_| {
            PictureCounts::for_scene(&Oracles::new(&self.traced), self.name, self.planned)
        })?;
        let picture = counts.map_err(|error| match error {
            PhysicalError::Oracle(error) => {
                let scene = self.scene.get();
                errors::scene(py, &scene.loaded.report(vec![error.problem()]))
            }
            error => errors::request(py, error),
        })?;
        let one = picture.channels[self.name.channel];
        let counts = match of {
            "oracle" => one.oracle,
            "channel" => one.pixel,
            "pixel" => picture.pixel,
            "film" => picture.film,
            other => {
                let message = format!("of={other:?} is none of: oracle, channel, pixel, film");
                return Err(errors::request(py, message));
            }
        };
        of_qsharp(
            py,
            if measured {
                counts.measured
            } else {
                counts.unitary
            },
        )
    }

    fn __repr__(&self) -> String {
        let [x, y] = self.pixel;
        let (name, channel) = (&self.traced.scene().name, self.channel());
        let (toffoli, qubits) = (self.cost.toffoli, self.qubits);
        format!(
            "<qrt.Oracle of {name:?}, channel {channel}, pixel ({x}, {y}): {toffoli} Toffolis on {qubits} \
             qubits>"
        )
    }
}
