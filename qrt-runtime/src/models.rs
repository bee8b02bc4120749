//! Models: the one place where the machine that traces a scene's paths is chosen and made.
//!
//! | model | the paths | a predicate | primary hits by search |
//! |---|---|---|---|
//! | `real` | the tracer in `f64` | its program, on integers | - |
//! | `fixed` | the oracle's program, on integers | as a part of the program | yes |
//! | `gates` | the oracle's circuit, gate by gate | as a part of the circuit | yes |
//!
//! Whoever uses a machine sees only [`PathMachine`].

mod visibility;

pub use visibility::{DEFAULT_FAILURE, PrimaryHitsFound, Searched, Visibility};

use crate::named::named;
use crate::path_machines::{Defect, OracleMachine, PathMachine, Real, Simd};
use crate::search::RoundsError;
use qrt_core::oracle::{Marks, Oracle, OracleError, OracleOptions, Oracles, Predicate};
use qrt_scene::sampling::SamplingError;
use qrt_tracer::ByClass;
use std::sync::Arc;

named! {
    /// The machine that traces the paths.
    #[derive(Default)]
    #[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
    pub enum Model {
        /// The tracer in 64-bit floating point.
        #[default]
        Real = "real",
        /// The oracle's program, operation by operation, on integers.
        Fixed = "fixed",
        /// The oracle's circuit, gate by gate: compute, flip, uncompute.
        Gates = "gates",
    }
}

/// The machine to make, and what it is to report.
#[derive(Clone, Copy, Default)]
pub struct MachineOptions<'a> {
    /// The model.
    pub model: Model,
    /// The key of the shifts of the digital net, and of the draws of searches.
    pub seed: u64,
    /// SIMD lanes for tracing under [`Model::Real`].
    pub simd: Simd,
    /// The method that finds primary hits.
    pub visibility: Visibility,
    /// The predicate of the paths that count, and the values that are counted; `None` for all paths.
    pub predicate: Option<(&'a Predicate, Marks)>,
    /// True if a circuit's machine reports colours beside counts.
    pub colours: bool,
}

impl MachineOptions<'_> {
    /// True if the machines run the scene's own oracle, of all channels.
    pub(crate) fn runs_all_channels(&self) -> bool {
        self.model != Model::Real
            && self.visibility == Visibility::Classical
            && self.predicate.is_none()
    }
}

/// A machine for each class of a scene's pixels.
pub struct Machines {
    /// The machines.
    pub by_class: ByClass<Box<dyn PathMachine>>,
    /// The size and cost of the search for primary hits, if there is one.
    pub searched: Option<Searched>,
}

/// An error of making a machine.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MachineError {
    /// The sequence of paths cannot be created.
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    /// The scene has no circuit.
    #[error(transparent)]
    Oracle(#[from] OracleError),
    /// The circuit is not a valid oracle: a defect of qrt.
    #[error("{0}: a defect of qrt; the picture would prove nothing, so there is none")]
    Defect(#[from] Defect),
    /// The search for primary hits cannot be set up.
    #[error(transparent)]
    Search(#[from] RoundsError),
    /// A search for primary hits is requested with the real model, which has no oracle.
    #[error(
        "primary hits are searched for by a circuit, which the model `real` does not have: use \
         `fixed` or `gates`"
    )]
    SearchModel,
}

/// Makes the machine of each class of a scene's pixels. This is the only choice between models.
///
/// # Errors
/// See [`MachineError`].
///
/// ```
/// use qrt_core::oracle::Oracles;
/// use qrt_runtime::models::{MachineOptions, Model, path_machines};
/// # let text = "
/// # name: sky
/// # camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
/// # film: { width: 4, height: 2 }
/// # materials: { sky: { emitter: { radiance: [0.25, 0.5, 1] } } }
/// # geometry:
/// #   - quad: { vertices: [[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], material: sky }
/// # ";
/// let scene = qrt_scene::front::parse(text, "sky.yaml", &[], "".as_ref())?.valid;
/// let oracles = Oracles::new(&scene);
/// for model in Model::ALL {
///     let options = MachineOptions { model, ..MachineOptions::default() };
///     let machines = path_machines(&oracles, &options)?;
///     assert_eq!(machines.by_class.at([3, 1]).bounds(), [0.25, 0.5, 1.0]);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn path_machines(
    oracles: &Oracles<'_>,
    options: &MachineOptions<'_>,
) -> Result<Machines, MachineError> {
    let search = visibility::search(oracles.scene(), options)?;
    let machine = |class| -> Result<Box<dyn PathMachine>, MachineError> {
        let MachineOptions { model, seed, .. } = *options;
        if model == Model::Real {
            let real = Real::of_class(oracles.scene(), seed, class)?;
            let real = match options.predicate {
                Some((predicate, marks)) => real.with_predicate(predicate, marks),
                None => real,
            };
            return Ok(Box::new(real.with_simd(options.simd)));
        }
        if options.visibility != Visibility::Classical {
            let oracle = Arc::new(Oracle::given_primary_hit(oracles.scene(), class)?);
            let machine = oracle_machine(model, oracle, seed, options.colours)?;
            return Ok(match &search {
                Some(search) => Box::new(machine.with_primary_hits(search.primary_hits(seed))),
                None => Box::new(machine),
            });
        }
        let oracle = match options.predicate {
            Some((predicate, marks)) => {
                Arc::new(predicate.oracle(marks, OracleOptions::of_class(class))?)
            }
            None => oracles.all_channels(class)?,
        };
        Ok(Box::new(oracle_machine(
            model,
            oracle,
            seed,
            options.colours,
        )?))
    };
    let by_class = match options.predicate {
        // A mark has no scale, so one machine serves all pixels.
        Some((_, Marks::Paths)) => ByClass::try_one(machine)?,
        _ => ByClass::try_new(oracles.classes(), machine)?,
    };
    Ok(Machines {
        by_class,
        searched: search.as_ref().map(|search| search.searched),
    })
}

/// Makes the machine that runs `oracle` under a model with a circuit: gate by gate under
/// [`Model::Gates`], and else on integers.
///
/// # Errors
/// The circuit is not a valid oracle: a defect of qrt.
pub(crate) fn oracle_machine(
    model: Model,
    oracle: Arc<Oracle>,
    seed: u64,
    colours: bool,
) -> Result<OracleMachine, Defect> {
    match model {
        Model::Gates => OracleMachine::gates(oracle, seed, colours),
        Model::Real | Model::Fixed => Ok(OracleMachine::fixed(oracle, seed, colours)),
    }
}
