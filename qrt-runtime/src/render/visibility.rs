//! The methods that find a path's primary hit.
//!
//! Under [`Visibility::Grover`], every path has a search of its own with an oracle of nearest hits
//! (Lanzagorta & Uhlmann 2005; Alves 2019; Santos 2024). The integration is then classical: paths
//! are taken one by one, and the pixel is their mean. The rest of the path is traced by the same
//! program as always, except that its first intersection is an input: see
//! [`qrt_core::oracle::Oracle::given_primary_hit`].

use super::{Model, Options, RenderError};
use crate::path_machines::{NearestMachine, OracleMachine, PrimaryHits};
use crate::search::{FoundHits, Guess, Method, Rounds};
use qrt_core::oracle::{NearestOracle, Oracle};
use qrt_core::tracer::PixelClass;
use qrt_scene::valid::ValidScene;
use qrt_scene::{Estimator, Scene};
use std::sync::Arc;

/// The default probability that a ray's search misses the nearest face.
pub const DEFAULT_FAILURE: f64 = 1e-3;

/// The method that finds a path's primary hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Visibility {
    /// The tracer tests all faces, as for all other hits.
    #[default]
    Classical,
    /// The oracle of nearest hits is queried about every face, and the nearest is taken. The
    /// picture is that of a search that never fails.
    Exhaustive,
    /// A search with the oracle of nearest hits.
    Grover {
        /// The probability that a ray's search may miss the nearest face: above 0 and below 1.
        failure: f64,
        /// The first guess of a search.
        guess: Guess,
    },
}

/// The size of a search for primary hits, and the cost of a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Searched {
    /// P, the number of faces.
    pub faces: u64,
    /// N, the number of basis states of a face's number: a power of two.
    pub states: u64,
    /// The bound on the probability that a ray's nearest face is missed; 0 if all faces are
    /// queried.
    pub failure: f64,
    /// Qubits of the oracle of nearest hits: the largest number in use at any time.
    pub qubits: u64,
    /// Number of Toffoli gates of a query.
    pub toffoli: u64,
}

impl Visibility {
    /// A search with the failure probability [`DEFAULT_FAILURE`] that begins with the hit of the
    /// path before it.
    pub const GROVER: Self = Self::Grover {
        failure: DEFAULT_FAILURE,
        guess: Guess::Coherent,
    };

    /// Returns the name of the method in text.
    pub fn name(self) -> &'static str {
        match self {
            Self::Classical => "classical",
            Self::Exhaustive => "exhaustive",
            Self::Grover { .. } => "grover",
        }
    }

    /// Returns the entries for a picture's metadata or a checkpoint: none if the tracer finds
    /// primary hits.
    pub(super) fn written(self) -> Vec<(String, String)> {
        let mut written = Vec::new();
        let mut say = |key: &str, value: String| written.push((key.to_owned(), value));
        if self != Self::Classical {
            say("visibility", self.name().to_owned());
        }
        if let Self::Grover { failure, guess } = self {
            say("search_failure", failure.to_string());
            say("first_guess", guess.name().to_owned());
        }
        written
    }

    /// Returns the estimator. Without a superposition of paths there is nothing to count, so
    /// [`Estimator::Exact`] replaces the scene's own.
    pub(super) fn estimator(
        self,
        options: &Options<'_>,
        scene: &Scene,
    ) -> Result<Estimator, RenderError> {
        if self != Self::Classical && options.own_estimator.is_some() {
            return Err(RenderError::OwnSearches);
        }
        match (self, options.estimator) {
            (Self::Classical, _) => options.counted_by(scene),
            (_, None | Some(Estimator::Exact)) => Ok(Estimator::Exact),
            (_, Some(other)) => Err(RenderError::SearchEstimator(other)),
        }
    }
}

/// Creates the machine that traces paths with a search for their primary hits, and describes the
/// search.
pub(super) fn machine(
    scene: &ValidScene,
    options: &Options<'_>,
    class: PixelClass,
) -> Result<(OracleMachine, Option<Searched>), RenderError> {
    let seed = options.seed;
    if options.model == Model::Real {
        return Err(RenderError::SearchModel);
    }
    let oracle = Arc::new(Oracle::given_primary_hit(scene, class)?);
    let gates = options.model == Model::Gates;
    let machine = if gates {
        OracleMachine::gates(oracle, seed, false)?
    } else {
        OracleMachine::fixed(oracle, seed, false)
    };
    let Some(nearest) = NearestOracle::new(scene)? else {
        return Ok((machine, None));
    };
    let (faces, states) = (nearest.faces(), nearest.states());
    let (failure, method) = match options.visibility {
        Visibility::Grover { failure, guess } => {
            let rounds = Rounds::new(states, faces, failure)?;
            (rounds.failure(), Method::Grover(rounds, guess))
        }
        Visibility::Classical | Visibility::Exhaustive => (0.0, Method::Exhaustive),
    };
    let (cost, qubits) = nearest.cost();
    let searched = Searched {
        faces: faces as u64,
        states: states as u64,
        failure,
        qubits: u64::from(qubits),
        toffoli: cost.toffoli,
    };
    let nearest = Arc::new(nearest);
    let nearest = if gates {
        NearestMachine::gates(nearest, seed)?
    } else {
        NearestMachine::fixed(nearest, seed)
    };
    let primary_hits: Box<dyn PrimaryHits> = Box::new(FoundHits::new(nearest, method, seed));
    Ok((machine.with_primary_hits(primary_hits), Some(searched)))
}
