//! Estimates of the memory that work takes. Work that would exceed the memory budget is refused
//! before it begins, with an error that says how much it would take and what to lower.

use super::allowed_bytes;
use qrt_circuit::Cores;
use qrt_circuit::lower::{self, Cost};
use qrt_core::oracle::{MOST_BITS, Oracle};
use qrt_scene::Uncompute;
use qrt_scene::valid::{Scatter, ValidScene};
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

/// Bytes of the rows that the same gates run on, one row after another, if gates are generated for
/// each run instead of held: for one thread, and for all threads together.
///
/// Generating a gate takes as long as running it on about 20,000 states.
const MOST_BYTES_OF_ROWS: [usize; 2] = [128 << 20, 512 << 20];
/// With more qubits than this, gates that are not held run on one thread at a time. That thread may
/// use the bytes of all rows.
pub(crate) const QUBITS_OF_ONE_TURN: u32 = 1 << 20;
/// Bytes of one qubit in the shortest rows, those of 256 states.
const OF_QUBIT: usize = 32;

/// Bytes that each of `threads` threads has for rows of `qubits` qubits, if gates are generated for
/// each run. The shortest rows may need more.
pub(crate) fn bytes_of_rows(threads: usize, qubits: u32) -> usize {
    let [of_thread, of_all] = MOST_BYTES_OF_ROWS;
    if qubits > QUBITS_OF_ONE_TURN {
        of_all
    } else {
        of_thread.min(of_all / threads.max(1))
    }
}

/// Bytes of templates of operations that each of `threads` threads keeps for a circuit of `qubits`
/// qubits, if gates are generated for each run.
///
/// On the scoped knot, of 596 million gates, 32 MB for each thread save a third of the time, and
/// 128 MB nearly half of it. On the knot under `keep`, where like operations are far apart, 32 MB
/// save a fourth, and more memory saves no more.
pub(crate) fn bytes_of_templates(threads: usize, qubits: u32) -> usize {
    if qubits > QUBITS_OF_ONE_TURN {
        32 << 20
    } else {
        (128 << 20).min((256 << 20) / threads.max(1))
    }
}

/// Bytes of a face while it is read and traced. Measured: 730, with a flat grid of 720,000
/// triangles.
const OF_FACE: u64 = 1000;
/// Bytes of a pixel in tiles, picture and files; 83 of them are in a tile.
const OF_PIXEL: u64 = 104;
/// Bytes of a basis state of the sparse state vector while states are mixed, without its bits.
const OF_STATE: f64 = 92.0;
/// Bytes of a pixel in a comparison of two pictures: both pictures, their difference, and FLIP's
/// filtered planes.
const OF_COMPARED_PIXEL: u64 = 120;
/// The largest number of operations, by [`expected_operations`], of a circuit that is compiled
/// without an estimate before it: compiling takes a second, and less than a gigabyte.
const FEW_OPERATIONS: f64 = 40_000.0;
/// Operations of a face for each ray, as in the knot; and operations of a node of a user-defined
/// BSDF, which takes one or two.
const OF_RAY_AND_FACE: f64 = 31.0;
const OF_NODE: f64 = 2.0;
/// The least fraction of the expected size that a circuit has: faces along the axes take fewer
/// operations than those of the knot.
const LEAST: f64 = 0.2;
/// Qubits of an operation if all qubits are kept until the end, as in the knot, whose 138,445
/// operations need 9.1 million qubits; and if a stage frees its qubits (56,080 in the knot).
const KEPT_QUBITS: f64 = 66.0;
const FREED_QUBITS: f64 = 0.4;
/// Operations that are compiled in a second: a round figure, for an estimate of minutes or hours.
const COMPILED: f64 = 5e4;

/// The memory budget of work; unless set, three quarters of the memory that the process may use.
///
/// ```
/// use qrt_runtime::memory::Memory;
/// let little = Memory::new(Some(1 << 20));
/// assert!(little.keep_picture([64, 64]).is_ok());
/// let refused = little.keep_picture([4096, 4096]).unwrap_err();
/// assert!(refused.to_string().contains("4096 x 4096 pixels would take about 1.7 GB"));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Memory {
    bytes: u64,
}

/// An error that work would exceed the memory budget.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{what} would take about {} of memory, and {} are allowed: {lower}",
    bytes_text(*.bytes), bytes_text(*.allowed as f64)
)]
pub struct MemoryError {
    /// The work that would exceed the budget.
    pub what: String,
    /// The estimated memory of the work, in bytes.
    pub bytes: f64,
    /// The memory budget, in bytes.
    pub allowed: u64,
    /// A change that would lower the memory.
    pub lower: &'static str,
}

/// The use that is made of a circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CircuitWork {
    /// The circuit is compiled, and its operations are counted or run.
    Program,
    /// The circuit's gates run on this number of threads.
    Gates(usize),
    /// The circuit's gates are exported.
    Export,
}

impl CircuitWork {
    /// Runs gates on this number of threads; one for each core if `None`.
    pub fn gates(threads: Option<NonZeroUsize>) -> Self {
        let cores = || available_parallelism().map_or(1, NonZeroUsize::get);
        Self::Gates(threads.map_or_else(cores, NonZeroUsize::get))
    }
}

/// Formats bytes, in the largest unit of which there is at least one.
fn bytes_text(bytes: f64) -> String {
    let (value, unit) = match bytes {
        bytes if bytes < 1e3 => return format!("{bytes:.0} bytes"),
        bytes if bytes < 1e6 => (bytes / 1e3, "kB"),
        bytes if bytes < 1e9 => (bytes / 1e6, "MB"),
        bytes if bytes < 1e12 => (bytes / 1e9, "GB"),
        bytes => (bytes / 1e12, "TB"),
    };
    let places = usize::from(value < 100.0);
    format!("{value:.places$} {unit}")
}

impl Default for Memory {
    fn default() -> Self {
        Self::new(None)
    }
}

impl Memory {
    /// A budget of `bytes`; if `None`, three quarters of the memory that the process may use, or no
    /// limit if the system does not report that.
    pub fn new(bytes: Option<u64>) -> Self {
        let usual = || allowed_bytes().map_or(u64::MAX, |bytes| bytes / 4 * 3);
        Self {
            bytes: bytes.unwrap_or_else(usual),
        }
    }

    /// The largest number of faces that a scene may have.
    pub fn faces(self) -> usize {
        usize::try_from(self.bytes / OF_FACE).unwrap_or(usize::MAX)
    }

    fn check(self, what: &str, bytes: f64, lower: &'static str) -> Result<(), MemoryError> {
        if bytes <= self.bytes as f64 {
            return Ok(());
        }
        Err(MemoryError {
            what: what.to_owned(),
            bytes,
            allowed: self.bytes,
            lower,
        })
    }

    /// Checks that the comparison of two pictures of this width and height in pixels fits into the
    /// budget.
    ///
    /// # Errors
    /// If it does not fit.
    pub fn keep_compared(self, [width, height]: [u64; 2]) -> Result<(), MemoryError> {
        let pixels = width as f64 * height as f64;
        let what = format!("comparing pictures of {width} x {height} pixels");
        self.check(
            &what,
            pixels * OF_COMPARED_PIXEL as f64,
            "compare crops of them",
        )
    }

    /// Checks that a picture of this width and height in pixels fits into the budget.
    ///
    /// # Errors
    /// If it does not fit.
    pub fn keep_picture(self, [width, height]: [u32; 2]) -> Result<(), MemoryError> {
        let pixels = f64::from(width) * f64::from(height);
        let what = format!("a picture of {width} x {height} pixels");
        let lower = "render part of it with a crop, or a smaller film";
        self.check(&what, pixels * OF_PIXEL as f64, lower)
    }

    /// Checks that parts of `bytes` bytes fit into the budget, together with the picture that is
    /// merged from them, which has about the same size.
    ///
    /// # Errors
    /// If they do not fit.
    pub fn keep_parts(self, bytes: u64) -> Result<(), MemoryError> {
        let lower = "merge on another machine";
        self.check("merging these parts", 2.0 * bytes as f64, lower)
    }

    /// Checks that `machines` sparse state vectors fit into the budget at a time, each of a circuit of `qubits`
    /// qubits of which `superposed` are in superposition.
    ///
    /// # Errors
    /// If they do not fit.
    pub fn keep_states(
        self,
        qubits: u32,
        superposed: u32,
        machines: usize,
    ) -> Result<(), MemoryError> {
        let words = f64::from(qubits.div_ceil(64));
        let state = OF_STATE + 2.0 * 8.0 * words;
        let what = format!("the amplitudes of {superposed} qubits in superposition, of {qubits}");
        let lower =
            "lower `sampling.path_bits`, `comparator.bits` or the phase bits, or use fewer threads";
        self.check(
            &what,
            machines as f64 * state * f64::from(superposed).exp2(),
            lower,
        )
    }

    /// Checks, before a scene's circuit is compiled, that the least size that it may have fits into
    /// the budget. The size of a circuit grows with the number of the scene's faces and rays. The
    /// compiled circuit is checked by [`Memory::keep_circuit`].
    ///
    /// # Errors
    /// If it does not fit.
    pub fn keep_compiling(self, scene: &ValidScene) -> Result<(), MemoryError> {
        if Self::compiles_at_once(scene) {
            return Ok(());
        }
        let least = CircuitSize::expected(scene).scaled(LEAST);
        self.keep_circuit(scene, &least, CircuitWork::Program)
    }

    /// True if a scene's circuit is compiled without an estimate before it.
    pub(crate) fn compiles_at_once(scene: &ValidScene) -> bool {
        expected_operations(scene) <= FEW_OPERATIONS
    }

    /// Checks that work on a scene's circuit fits into the budget.
    ///
    /// # Errors
    /// If it does not fit.
    pub fn keep_circuit(
        self,
        scene: &ValidScene,
        size: &CircuitSize,
        work: CircuitWork,
    ) -> Result<(), MemoryError> {
        let (faces, rays) = (
            scene.surface_of_faces().len(),
            scene.scene().sampling.depths.len(),
        );
        let what = format!("the circuit of a scene of {faces} faces and paths of {rays} rays");
        let lower = "use a coarser mesh, or fewer rays";
        self.check(&what, size.bytes(work), lower)
    }
}

/// Returns the expected time of compiling a scene's circuit and counting its gates, in seconds.
pub fn compiling_seconds(scene: &ValidScene) -> f64 {
    expected_operations(scene) / COMPILED
}

/// The expected number of operations of a scene's program.
fn expected_operations(scene: &ValidScene) -> f64 {
    let nodes = |scatter: &Scatter| match scatter {
        Scatter::Custom(bsdf) => {
            let all = bsdf.map.iter().chain(&bsdf.value).chain(&bsdf.pdf);
            let all = all.chain([&bsdf.projected_jacobian]);
            all.map(|value| value.nodes().len() as f64).sum()
        }
        _ => 0.0,
    };
    let mut used = vec![false; scene.surfaces().len()];
    for surface in scene.surface_of_faces() {
        used[surface as usize] = true;
    }
    let surfaces = scene.surfaces().iter().zip(used).filter(|(_, used)| *used);
    let nodes: f64 = surfaces.map(|(surface, _)| nodes(&surface.scatter)).sum();
    let rays = scene.scene().sampling.depths.len() as f64;
    rays * (OF_RAY_AND_FACE * scene.surface_of_faces().len() as f64 + OF_NODE * nodes)
}

/// The size of a circuit.
#[derive(Clone, Copy, Debug)]
pub struct CircuitSize {
    /// Operations of the program.
    pub operations: f64,
    /// The largest number of qubits in use at a time.
    pub qubits: f64,
    /// Bits of all registers.
    pub bits: f64,
    /// Gates of compute and uncompute.
    pub gates: f64,
}

impl CircuitSize {
    /// The size of an oracle's circuit, without the comparisons of its channels.
    pub fn new(oracle: &Oracle) -> Self {
        let program = &oracle.program;
        let ops: Vec<_> = program.ops.iter().collect();
        let width = |register| program.width(register);
        let figures = lower::KnownFigures::default().all(&ops, width, Cores::All);
        let steps = program.instructions.iter();
        let costs = steps.map(|step| {
            let costs = figures[step.op as usize].costs;
            costs[usize::from(step.inverse)]
        });
        let Cost {
            toffoli, cnot, x, ..
        } = costs.sum();
        let widths = program.registers.iter();
        Self {
            operations: program.ops.len() as f64,
            qubits: f64::from(lower::most_qubits_by(program, |op| figures[op].borrowed)),
            bits: widths.map(|register| f64::from(register.width)).sum(),
            gates: 2.0 * (toffoli + cnot + x) as f64,
        }
    }

    /// The expected size of a scene's circuit, by the numbers of its faces, its rays and the nodes of
    /// its user-defined BSDFs. Gates are not estimated: no work before compiling depends on them.
    fn expected(scene: &ValidScene) -> Self {
        let operations = expected_operations(scene);
        let qubits = match scene.scene().circuit.uncompute {
            // `auto` compiles under `keep` first.
            Uncompute::Keep | Uncompute::Auto => KEPT_QUBITS,
            _ => FREED_QUBITS,
        };
        Self {
            operations,
            qubits: qubits * operations,
            bits: KEPT_QUBITS * operations,
            gates: 0.0,
        }
    }

    fn scaled(self, factor: f64) -> Self {
        Self {
            operations: factor * self.operations,
            qubits: factor * self.qubits,
            bits: factor * self.bits,
            gates: factor * self.gates,
        }
    }

    /// Bytes that the work takes. Measured for the knot, whose 142,875 operations need 12.7 million
    /// qubits: 0.62 GB for compiling and 0.80 GB for running gates.
    fn bytes(&self, work: CircuitWork) -> f64 {
        let (qubits, operations) = (self.qubits, self.operations);
        let compiled = 40.0 * qubits + 700.0 * operations;
        match work {
            CircuitWork::Gates(threads) if self.bits <= MOST_BITS as f64 => {
                compiled + 40.0 * self.gates + 256.0 * qubits * threads as f64
            }
            // Rows, templates of operations, places of registers, and the program with its inverse.
            CircuitWork::Gates(threads) => {
                let shortest = OF_QUBIT as f64 * qubits;
                let all = MOST_BYTES_OF_ROWS[1] as f64;
                let rows = if qubits > f64::from(QUBITS_OF_ONE_TURN) {
                    shortest * (all / shortest).floor().max(1.0)
                } else {
                    let of_thread = bytes_of_rows(threads, 0) as f64;
                    of_thread.max(shortest) * threads as f64
                };
                let templates = match threads {
                    _ if qubits > f64::from(QUBITS_OF_ONE_TURN) => bytes_of_templates(1, u32::MAX),
                    threads => threads * bytes_of_templates(threads, 0),
                };
                let run = rows + templates as f64;
                compiled.max(run + 32.0 * qubits + 500.0 * operations)
            }
            CircuitWork::Export if self.bits <= MOST_BITS as f64 => compiled + 48.0 * self.gates,
            CircuitWork::Program | CircuitWork::Export => compiled,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_core::oracle::OracleOptions;

    /// A tunnel of `quads` quads and `quads` triangles of one material and a lamp, with paths of
    /// `rays` rays.
    fn tunnel(material: &str, quads: usize, rays: usize) -> ValidScene {
        use std::fmt::Write;
        let mut text = format!(
            "name: tunnel
camera: {{ perspective: {{ eye: [0.1, 0.2, 3], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 4, height: 4 }}
materials: {{ lamp: {{ emitter: {{ radiance: [1, 1, 1] }} }}, m: {{ {material} }} }}
geometry:
  - quad: {{ vertices: [[-1, -1, 4], [-1, 1, 4], [1, 1, 4], [1, -1, 4]], material: lamp }}
"
        );
        for n in 0..quads {
            let (z, up) = (n as f64 / quads as f64, 0.1 * (n % 7) as f64);
            let _ = writeln!(
                text,
                "  - quad: {{ vertices: [[-1, -1, {z}], [1, -1, {z}], [1, 1, {z}], [-1, 1, {z}]], material: m }}
  - triangle: {{ vertices: [[-1, {up}, {z}], [1, 1, {}], [0.3, -1, 3.9]], material: m }}",
                z + 1.0
            );
        }
        let rays = vec!["{ bits: [6, 6] }"; rays].join(", ");
        let _ = writeln!(
            text,
            "sampling: {{ path_bits: 10, depths: [{rays}], lights: none }}"
        );
        let loaded = qrt_scene::front::parse(&text, "tunnel.yaml", &[], "".as_ref());
        loaded.unwrap_or_else(|report| panic!("{report}")).valid
    }

    fn compiled(scene: &ValidScene) -> CircuitSize {
        CircuitSize::new(&Oracle::rgb(scene, OracleOptions::default()).unwrap())
    }

    #[test]
    fn the_size_of_a_large_circuit_is_expected() {
        let grey = "lambertian: { albedo: [0.5, 0.4, 0.3] }";
        let own = r#"bsdf: { map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"], jacobian: auto,
            value: ["0.1*cos_a^2/(1 + cos_o*cos_o) + 0.05*sqrt(1 + cos_i*cos_o)"] }"#;
        for (material, quads, rays) in [(grey, 20, 40), (grey, 300, 3), (own, 20, 40)] {
            let scene = tunnel(material, quads, rays);
            let (expected, real) = (CircuitSize::expected(&scene), compiled(&scene));
            println!("{quads} quads, {rays} rays: {expected:?}, {real:?}");
            assert!(expected.operations > FEW_OPERATIONS);
            let bytes = [expected, real].map(|size| size.bytes(CircuitWork::Program));
            // Half of the faces lie along the axes.
            let ratio = bytes[0] / bytes[1];
            assert!((0.7..1.0 / LEAST).contains(&ratio), "{bytes:?}");
        }
    }

    /// The gates of a circuit are those that are generated.
    #[test]
    fn the_size_of_a_circuit_is_that_of_its_gates() {
        let scene = tunnel("lambertian: { albedo: [0.5, 0.4, 0.3] }", 2, 2);
        let oracle = Oracle::rgb(&scene, OracleOptions::default()).unwrap();
        let mut gates = 0.0;
        let each = |next: &[_], _| gates += 2.0 * next.len() as f64;
        let qubits = lower::each_instruction(&oracle.program, each);
        let size = CircuitSize::new(&oracle);
        assert_eq!([size.gates, size.qubits], [gates, f64::from(qubits)]);
    }

    /// Circuits that are compiled without an estimate are small.
    #[test]
    fn the_largest_circuit_that_is_not_estimated_is_small() {
        for (quads, rays) in [(200, 3), (60, 10), (10, 60)] {
            let scene = tunnel("lambertian: { albedo: [0.5, 0.4, 0.3] }", quads, rays);
            assert!(expected_operations(&scene) <= FEW_OPERATIONS);
            let size = compiled(&scene);
            for work in [CircuitWork::Gates(16), CircuitWork::Export] {
                let bytes = size.bytes(work);
                println!("{quads} quads, {rays} rays, {work:?}: {bytes:.2e} bytes");
                assert!(bytes < 1e9, "{bytes}");
            }
        }
    }

    #[test]
    fn bytes_are_told_in_words() {
        assert_eq!(bytes_text(7.2e9), "7.2 GB");
        assert_eq!(bytes_text(687e9), "687 GB");
        assert_eq!(bytes_text(3e6), "3.0 MB");
        assert_eq!(bytes_text(10_240.0), "10.2 kB");
        assert_eq!(bytes_text(999_999.0), "1000 kB");
        assert_eq!(bytes_text(512.0), "512 bytes");
        assert_eq!(bytes_text(0.0), "0 bytes");
    }
}
