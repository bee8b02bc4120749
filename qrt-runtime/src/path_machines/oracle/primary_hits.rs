//! Search for primary hits that are inputs of an oracle.

use super::Defect;

/// Consecutive paths of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathRun {
    /// Column and row of the paths' pixel.
    pub pixel: [u32; 2],
    /// The path index of the first path.
    pub first: u64,
    /// Number of paths.
    pub count: usize,
}

/// A search for the primary hits of paths, for an oracle that has them as inputs
/// ([`qrt_core::oracle::Oracle::given_primary_hit`]).
pub trait PrimaryHits: Send + Sync {
    /// Sets `hits`, path after path and run after run, to the number of the face that a path's
    /// first ray meets first, or to the number of all faces if the ray meets none. Adds the queries
    /// of the search to `queries`, by run.
    ///
    /// # Errors
    /// The first defect found.
    fn find(&self, runs: &[PathRun], hits: &mut [u64], queries: &mut [u64]) -> Result<(), Defect>;
}
