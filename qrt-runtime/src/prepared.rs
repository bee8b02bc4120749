//! A scene that is ready for work: its parameters are chosen, its circuit is compiled once and fits.

use crate::memory::{CircuitSize, CircuitWork, Memory, MemoryError};
use crate::models::{MachineError, MachineOptions, Machines, path_machines};
use crate::plan::{self, Plan, PlanError, PlanFigures, plan};
use qrt_core::oracle::{OracleError, Oracles, check_budget};
use qrt_scene::valid::ValidScene;
use qrt_syntax::Problem;
use qrt_tracer::ByClass;
use std::borrow::Cow;
use std::sync::OnceLock;

/// A scene that is ready for work. It is the only way from a scene to a picture, a check, a figure or
/// a file:
///
/// ```text
/// scene --plan--> parameters --record, assemble--> oracles --make--> path machines
/// ```
///
/// Every part is made when it is first asked for, and once. Nothing is compiled for the model `real`.
///
/// ```
/// use qrt_runtime::Prepared;
/// use qrt_runtime::memory::{CircuitWork, Memory};
/// use qrt_runtime::render::{Model, RenderOptions};
/// # let text = "
/// # name: sky
/// # camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
/// # film: { width: 4, height: 2 }
/// # materials: { sky: { emitter: { radiance: [0.25, 0.5, 1] } } }
/// # geometry:
/// #   - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: sky }
/// # ";
/// let scene = qrt_scene::front::parse(text, "sky.yaml", &[], "".as_ref())?.valid;
/// let options = RenderOptions { model: Some(Model::Fixed), ..RenderOptions::default() };
/// let prepared = Prepared::new(&scene, &options.planning(), Memory::default())?;
///
/// // The circuit fits into memory and into the scene's budget.
/// prepared.check_circuit(CircuitWork::Program)?;
/// // The figures of the circuit, and a picture that it traces.
/// let qubits = prepared.oracles().most_expensive()?.call.qubits;
/// let (picture, _) = prepared.render(&options)?;
/// assert!(qubits > 0 && picture.image.pixels.len() == 8);
/// // The scene was compiled once for both.
/// assert_eq!(scene.recordings(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Prepared<'a> {
    oracles: Oracles<'a>,
    plan: Option<PlanFigures>,
    /// The hash of the scene as it is written.
    scene_hash: String,
    memory: Memory,
    sizes: ByClass<OnceLock<CircuitSize>>,
}

/// An error that a scene cannot be prepared for work.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// No parameters keep the scene's accuracy.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The work would exceed the memory budget, by an estimate.
    #[error(transparent)]
    WouldNotFit(#[from] MemoryError),
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// The scene's circuit costs more than its `budget` allows. [`qrt_scene::front::Loaded::report`]
    /// shows the problems at their places.
    #[error("the circuit is beyond the scene's budget: {}", first(.0))]
    Budget(Vec<Problem>),
}

impl PrepareError {
    /// Returns true if the request can't be met, so that another attempt will fail alike; false if
    /// the job failed.
    pub fn is_refusal(&self) -> bool {
        match self {
            Self::Plan(error) => error.is_refusal(),
            Self::WouldNotFit(_) | Self::Oracle(_) | Self::Budget(_) => true,
        }
    }
}

pub(crate) fn first(problems: &[Problem]) -> String {
    let first = problems.first();
    first.map_or_else(String::new, |problem| problem.description().message)
}

impl<'a> Prepared<'a> {
    /// Prepares a scene. The parameters of a scene that asks for an accuracy are chosen here.
    ///
    /// # Errors
    /// No parameters keep the accuracy, or the circuits that the search for them compiles do not fit
    /// into `memory`.
    pub fn new(
        scene: &'a ValidScene,
        planning: &plan::PlanOptions<'_>,
        memory: Memory,
    ) -> Result<Self, PrepareError> {
        if scene.scene().accuracy.is_some() {
            memory.keep_compiling(scene)?;
        }
        let planned = plan(scene, planning)?;
        Ok(Self::with_plan(scene, planned, memory))
    }

    /// Prepares a scene with the parameters that `plan` chose for it; `None` for the scene's own.
    pub fn with_plan(scene: &'a ValidScene, plan: Option<Plan>, memory: Memory) -> Self {
        let (traced, figures) = match plan {
            Some(plan) => (Cow::Owned(plan.scene), Some(plan.figures)),
            None => (Cow::Borrowed(scene), None),
        };
        let oracles = Oracles::of_scene(traced);
        Self {
            sizes: ByClass::defaults(oracles.classes()),
            oracles,
            plan: figures,
            scene_hash: scene.fingerprint().to_string(),
            memory,
        }
    }

    /// The same scene, whose circuit also computes the luminance of a path.
    #[must_use]
    pub fn with_luminance(self) -> Self {
        Self {
            sizes: ByClass::defaults(self.oracles.classes()),
            oracles: self.oracles.with_luminance(),
            ..self
        }
    }

    /// The oracles of the pixel (column, row) alone: see [`Oracles::of_pixel`]. The circuit of all three
    /// channels is compiled, and work on it fits into the memory budget.
    ///
    /// # Errors
    /// [`PrepareError::WouldNotFit`], or an error that the scene has no circuit.
    pub fn pixel_oracles(
        &self,
        pixel: [u32; 2],
        work: CircuitWork,
    ) -> Result<Oracles<'_>, PrepareError> {
        self.memory.keep_compiling(self.scene())?;
        let oracles = self.oracles.of_pixel(pixel);
        let class = oracles.classes().class(pixel);
        let size = CircuitSize::new(&*oracles.all_channels(class)?);
        self.memory.keep_circuit(self.scene(), &size, work)?;
        Ok(oracles)
    }

    /// A copy whose circuit also computes the luminance; None if the circuit does already.
    pub(crate) fn made_luminant(&self) -> Option<Prepared<'_>> {
        (!self.oracles.has_luminance()).then(|| Prepared {
            oracles: Oracles::new(self.scene()).with_luminance(),
            plan: self.plan,
            scene_hash: self.scene_hash.clone(),
            memory: self.memory,
            sizes: ByClass::defaults(self.oracles.classes()),
        })
    }

    /// The scene with the chosen parameters.
    pub fn scene(&self) -> &ValidScene {
        self.oracles.scene()
    }

    /// The figures of the plan that chose the parameters, if there was one.
    pub fn plan(&self) -> Option<&PlanFigures> {
        self.plan.as_ref()
    }

    /// The hash of the scene as it is written, as 32 hexadecimal digits.
    pub(crate) fn scene_hash(&self) -> &str {
        &self.scene_hash
    }

    /// The memory budget.
    pub fn memory(&self) -> Memory {
        self.memory
    }

    /// The oracles of the scene.
    pub fn oracles(&self) -> &Oracles<'a> {
        &self.oracles
    }

    /// The size of the circuit that machines run for the pixels of the class of `pixel` (column, row).
    /// The circuit is compiled unless it is already.
    ///
    /// # Errors
    /// If the scene has no circuit, or compiling it does not fit into the memory budget.
    pub fn circuit_size(&self, pixel: [u32; 2]) -> Result<CircuitSize, PrepareError> {
        let size = self.sizes.at(pixel);
        if let Some(size) = size.get() {
            return Ok(*size);
        }
        let scene = self.scene();
        self.memory.keep_compiling(scene)?;
        let class = self.oracles.classes().class(pixel);
        let oracle = if scene.scene().budget.is_some() {
            // The budget needs the costs, too, and both are assembled together.
            self.oracles.with_costs(class)?.0
        } else {
            self.oracles.all_channels(class)?
        };
        Ok(*size.get_or_init(|| CircuitSize::new(&oracle)))
    }

    /// Checks that work on the circuit of the class of `pixel` fits into the memory budget.
    ///
    /// # Errors
    /// [`PrepareError::WouldNotFit`], or an error that the scene has no circuit.
    pub fn check_memory(&self, pixel: [u32; 2], work: CircuitWork) -> Result<(), PrepareError> {
        let size = self.circuit_size(pixel)?;
        Ok(self.memory.keep_circuit(self.scene(), &size, work)?)
    }

    /// Checks that work on the scene's circuit fits into the memory budget, and that a call of each of
    /// the scene's oracles is within the scene's `budget`. The circuits of the classes of pixels are
    /// equally large, so only that of the first pixel is measured.
    ///
    /// # Errors
    /// [`PrepareError::WouldNotFit`], [`PrepareError::Budget`], or an error that the scene has no
    /// circuit.
    pub fn check_circuit(&self, work: CircuitWork) -> Result<(), PrepareError> {
        self.check_memory([0, 0], work)?;
        self.check_budget()
    }

    /// Checks that a call of each of the scene's oracles is within the scene's `budget`. Without a
    /// budget, nothing is compiled.
    ///
    /// # Errors
    /// [`PrepareError::Budget`], or an error that the scene has no circuit.
    pub fn check_budget(&self) -> Result<(), PrepareError> {
        if self.scene().scene().budget.is_none() {
            return Ok(());
        }
        check_budget(self.scene(), &self.oracles.costs()?).map_err(PrepareError::Budget)
    }

    /// True if the scene's circuit is so small that it is compiled without an estimate before.
    pub(crate) fn compiles_at_once(&self) -> bool {
        Memory::compiles_at_once(self.scene())
    }

    /// Makes the machine of each class of the scene's pixels: see [`path_machines`]. The recordings of
    /// the scene are dropped before, because the machines' programs take as much memory.
    ///
    /// # Errors
    /// See [`MachineError`].
    pub fn machines(&self, options: &MachineOptions<'_>) -> Result<Machines, MachineError> {
        if options.runs_all_channels() {
            self.oracles.assemble_all_channels()?;
        } else {
            self.oracles.release();
        }
        path_machines(&self.oracles, options)
    }
}
