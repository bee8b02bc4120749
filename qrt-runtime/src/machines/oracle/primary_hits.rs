//! What finds primary hits that are inputs of an oracle.

use super::Defect;

/// Paths of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathRun {
    /// Column and row of the paths' pixel.
    pub pixel: [u32; 2],
    /// The path index of the first path.
    pub first: u64,
    /// How many paths follow one another, the first included.
    pub count: usize,
}

/// What finds the primary hits of paths, for an oracle that is given them
/// ([`qrt_core::oracle::Oracle::given_primary_hit`]).
pub trait PrimaryHits: Send + Sync {
    /// Sets `hits`, path after path and run after run, to the numbers of the faces that are met
    /// first, or the number of all faces where none is; and adds to `queries`, by run, what it
    /// took.
    ///
    /// # Errors
    /// The first defect that shows.
    fn find(&self, runs: &[PathRun], hits: &mut [u64], queries: &mut [u64]) -> Result<(), Defect>;
}
