//! The methods that find a path's primary hit.
//!
//! Under [`Visibility::Grover`], every path has a search of its own with an oracle of nearest hits
//! (Lanzagorta & Uhlmann 2005; Alves 2019; Santos 2024). The integration is then classical: paths
//! are taken one by one, and the pixel is their mean. The rest of the path is traced by the same
//! program as always, except that its first intersection is an input: see
//! [`qrt_core::oracle::Oracle::given_primary_hit`].

use super::{MachineError, MachineOptions, Model};
use crate::path_machines::{NearestMachine, PrimaryHits};
use crate::search::{FoundHits, Guess, Method, Rounds};
use qrt_core::oracle::NearestOracle;
use qrt_scene::valid::ValidScene;
use std::sync::Arc;

/// The default probability that a ray's search misses the nearest face.
pub const DEFAULT_FAILURE: f64 = 1e-3;

/// The method that finds a path's primary hit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
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
#[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
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

/// The method that found the primary hits of a picture, and its cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
pub struct PrimaryHitsFound {
    /// The method.
    pub method: Visibility,
    /// The size and cost of the search, if there was one; `None` for a scene without faces, where all
    /// paths meet nothing.
    pub searched: Option<Searched>,
}

impl PrimaryHitsFound {
    /// Entries of a picture's metadata, or of a checkpoint's header: none if the tracer finds primary
    /// hits.
    pub(crate) fn entries(&self) -> Vec<(String, String)> {
        let mut entries = Vec::new();
        let mut say = |key: &str, value: String| entries.push((key.to_owned(), value));
        if self.method != Visibility::Classical {
            say("visibility", self.method.name().to_owned());
        }
        if let Visibility::Grover { failure, guess } = self.method {
            say("search_failure", failure.to_string());
            say("first_guess", guess.name().to_owned());
        }
        entries
    }
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
}

/// A search for the primary hits of a scene's paths.
pub(super) struct HitSearch {
    /// The size of the search, and the cost of a query.
    pub(super) searched: Searched,
    nearest: Arc<NearestMachine>,
    method: Method,
}

/// Returns the search for primary hits: `None` if the tracer finds them, or if there are no faces to
/// find.
pub(super) fn search(
    scene: &ValidScene,
    options: &MachineOptions<'_>,
) -> Result<Option<HitSearch>, MachineError> {
    if options.visibility == Visibility::Classical {
        return Ok(None);
    }
    if options.model == Model::Real {
        return Err(MachineError::SearchModel);
    }
    let Some(nearest) = NearestOracle::new(scene)? else {
        return Ok(None);
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
    let nearest = match options.model {
        Model::Gates => NearestMachine::gates(nearest, options.seed)?,
        Model::Real | Model::Fixed => NearestMachine::fixed(nearest, options.seed),
    };
    Ok(Some(HitSearch {
        searched,
        nearest: Arc::new(nearest),
        method,
    }))
}

impl HitSearch {
    /// The search of the machine of a class of pixels.
    pub(super) fn primary_hits(&self, seed: u64) -> Box<dyn PrimaryHits> {
        let nearest = Arc::clone(&self.nearest);
        Box::new(FoundHits::new(nearest, self.method.clone(), seed))
    }
}
