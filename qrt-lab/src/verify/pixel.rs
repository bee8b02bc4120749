//! A pixel's oracle against real numbers: S of all its paths.

use super::VerifyError;
use qrt_core::compile::Strategy;
use qrt_core::inspect::OraclePixel;
use qrt_core::oracle::{Oracle, OracleError, OracleOptions};
use qrt_counting::Comparators;
use qrt_runtime::path_machines::{OracleMachine, Real};
use qrt_scene::valid::ValidScene;
use std::sync::Arc;

/// Most path bits of a pixel whose paths are compared.
const MOST_PATH_BITS: u32 = 16;

/// Most operations, times paths, that one comparison runs.
const MOST_WORK: u64 = 1 << 34;

/// Most operations of a program that is compiled again with more fraction bits.
const MOST_REPEATED: usize = 1 << 12;

/// Number of fraction bits beyond the scene's that are tried.
const MORE_FRACTION: u32 = 8;

/// S of a pixel's oracle, and S of the same paths in real numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelCounts {
    /// S by the oracle's program.
    pub good: u64,
    /// S by the real machine: of the same paths and the same thresholds.
    pub good_in_real: u64,
    /// N, the number of indices.
    pub total: u64,
    /// Number of paths whose counts differ.
    pub differing: u64,
    /// R, the number of paths.
    pub paths: u64,
    /// Number of fraction bits of the program.
    pub fraction: u32,
    /// The fewest fraction bits, more than those of the program, with which no path differs. None if no
    /// path differs already, if none of those tried is enough, and if the program is too large to be
    /// compiled again.
    pub agrees_at: Option<u32>,
}

impl PixelCounts {
    /// One or two sentences for people: both values, the number of paths that differ, and the setting that
    /// mends it.
    pub fn in_words(&self) -> String {
        let Self {
            good,
            good_in_real,
            total,
            differing,
            paths,
            fraction,
            agrees_at,
        } = *self;
        let share = |good: u64| good as f64 / total as f64;
        if differing == 0 {
            return format!(
                "S/N = {good}/{total} = {:.6}: each path counts as in real numbers",
                share(good)
            );
        }
        let advice = match agrees_at {
            Some(bits) => format!("with precision.fraction={bits} none does"),
            None => format!("{fraction} fraction bits round them"),
        };
        format!(
            "S/N = {good}/{total} = {:.6} by the circuit, {:.6} in real numbers: {differing} of {paths} \
             paths count differently; {advice}",
            share(good),
            share(good_in_real)
        )
    }
}

/// Counts the paths of a pixel by `oracle`, whose only or first channel is counted, and in real numbers.
/// None if the pixel has more than 2^16 paths, if the paths would take too long, or if the channel is
/// not a colour's: the real machine has no luminance.
///
/// # Errors
/// The scene has no circuit with more fraction bits, or no sample sequence; a defect of the program.
pub fn pixel_counts(
    scene: &ValidScene,
    oracle: &Oracle,
    pixel: OraclePixel,
) -> Result<Option<PixelCounts>, VerifyError> {
    let path_bits = oracle.points.path_bits();
    let work = (oracle.program.ops.len() as u64).saturating_mul(1 << path_bits.min(40));
    if path_bits > MOST_PATH_BITS || work > MOST_WORK {
        return Ok(None);
    }
    let channel = &oracle.channels[0];
    if channel.number > 2 {
        return Ok(None);
    }
    let real = Real::of_pixel(scene, pixel.seed, pixel.place)?;
    let comparators = Comparators::new(channel.scale, scene.scene().comparator)?;
    let mut in_real = Vec::new();
    real.trace(&[pixel.place], |block| {
        let colours = block.colours[channel.number].iter();
        in_real.extend(colours.map(|&colour| u64::from(comparators.good(colour))));
    });
    let counts = |oracle: &Oracle| -> Result<Vec<u64>, VerifyError> {
        let machine = OracleMachine::fixed(Arc::new(oracle.clone()), pixel.seed, false);
        let mut counts = Vec::new();
        machine.trace(&[pixel.place], 0..machine.paths(), |run| {
            counts.extend(run.good[0].iter().map(|n| n.cast_unsigned()));
        })?;
        Ok(counts)
    };
    let differing = |counts: &[u64]| {
        let pairs = counts.iter().zip(&in_real);
        pairs.filter(|(a, b)| a != b).count() as u64
    };
    let own = counts(oracle)?;
    let differ = differing(&own);
    let mut agrees_at = None;
    if differ > 0 && oracle.program.ops.len() <= MOST_REPEATED {
        for more in 1..=MORE_FRACTION {
            let bits = oracle.fraction + more;
            let mut parameters = scene.parameters();
            parameters.precision.fraction = Some(bits);
            let Ok(finer) = scene.with_parameters(parameters) else {
                break;
            };
            // Counts do not depend on the strategy.
            let options = OracleOptions {
                strategy: Some(Strategy::KEEP),
                ..OracleOptions::of_pixel(&finer, pixel.place)
            };
            match Oracle::new(&finer, channel.number, options) {
                Ok(finer) if differing(&counts(&finer)?) == 0 => {
                    agrees_at = Some(bits);
                    break;
                }
                Ok(_) => {}
                // More bits do not fit.
                Err(OracleError::Build(_)) => break,
                Err(error) => return Err(error.into()),
            }
        }
    }
    Ok(Some(PixelCounts {
        good: own.iter().sum(),
        good_in_real: in_real.iter().sum(),
        total: (own.len() as u64) << oracle.comparator_bits(),
        differing: differ,
        paths: own.len() as u64,
        fraction: oracle.fraction,
        agrees_at,
    }))
}
