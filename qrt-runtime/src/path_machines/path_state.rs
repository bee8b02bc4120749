//! A basis state at the start of one path.

use qrt_circuit::Recorded;
use qrt_core::oracle::compiled::CompiledOracle;
use qrt_machines::State;
use qrt_scene::sampling::SamplingError;

/// Starts a [`State`] at one path of a compiled oracle.
pub trait PathState: Sized {
    /// A state for path number `path` of `pixel` (column, row) of the compiled oracle `C`, and the register of
    /// the path's index, which holds the lowest bits of `path`.
    ///
    /// # Errors
    /// A sequence that cannot be made; a checked scene's can.
    fn path<C: CompiledOracle>(
        seed: u64,
        pixel: [u32; 2],
        path: u64,
    ) -> Result<(Self, Recorded), SamplingError>;
}

impl PathState for State {
    fn path<C: CompiledOracle>(
        seed: u64,
        pixel: [u32; 2],
        path: u64,
    ) -> Result<(Self, Recorded), SamplingError> {
        let outline = C::OUTLINE;
        let points = C::points()?;
        let parameters = outline.parameters.iter();
        let words: Vec<u64> = parameters
            .map(|parameter| parameter.value(&points, seed, pixel))
            .collect();
        let mut recorder = outline.recorder();
        let id = outline.inputs(&mut recorder);
        let state = Self::with_inputs(recorder, &[(&id, path)], &words);
        Ok((state, id))
    }
}
