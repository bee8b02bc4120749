//! One pixel: its brightest paths, its counts, and the distribution that a phase register shows.

use super::{Answer, Refused};
use qrt_core::oracle::Oracles;
use qrt_counting::{Comparators, PhaseDistribution};
use qrt_runtime::models::{MachineError, MachineOptions, Model, path_machines};
use qrt_runtime::path_machines::Traced;
use qrt_runtime::traced_path::{TracedPath, trace_path_of};
use qrt_scene::Window;
use qrt_scene::valid::ValidScene;
use std::fmt::Write as _;

/// The largest number of paths that the answer lists.
const BRIGHTEST: usize = 6;
/// Bars of the histogram: one for each halving of brightness from the scale down; one more is for
/// black.
const HALVES: usize = 16;
/// The largest phase register of which every outcome can be drawn, in bits.
const MOST_PHASE: u32 = 10;

pub(super) fn pixel(
    scene: &ValidScene,
    pixel: [u32; 2],
    seed: u64,
    phase_bits: u32,
) -> Result<Answer, Refused> {
    let written = scene.scene();
    if pixel[0] >= written.film.width || pixel[1] >= written.film.height {
        return Err(Refused::Outside(pixel[0], pixel[1]));
    }
    let options = MachineOptions {
        seed,
        ..MachineOptions::default()
    };
    let machines = path_machines(&Oracles::new(scene), &options)?.by_class;
    let real = machines.at(pixel);
    let bound = real.bounds();
    let comparators = Comparators::rgb(bound, written.comparator)?;
    let mut mean = [0.0; 3];
    let mut good = [0_u64; 3];
    let mut histogram = [0_u64; HALVES + 1];
    let mut brightest: Vec<(f64, u64)> = Vec::new();
    let mut next = 0;
    let mut add = |traced: Traced<'_>| {
        let Traced::Colours(block) = traced else {
            return;
        };
        let paths = block.colours[0].len();
        for (channel, colours) in block.colours.into_iter().enumerate() {
            mean[channel] += colours.iter().sum::<f64>();
            good[channel] += comparators[channel].good_total(colours);
        }
        for place in 0..paths {
            let of_scale = |c: usize| match bound[c] {
                0.0 => 0.0,
                bound => block.colours[c][place] / bound,
            };
            let share = of_scale(0).max(of_scale(1)).max(of_scale(2));
            // The k-th bar holds the shares of the scale in (2^-(k+1), 2^-k].
            let bar = if share > 0.0 {
                (-libm::log2(share)).clamp(0.0, HALVES as f64 - 1.0) as usize
            } else {
                HALVES
            };
            histogram[bar] += 1;
            let light: f64 = (0..3).map(|c| block.colours[c][place]).sum();
            if light > 0.0
                && (brightest.len() < BRIGHTEST || brightest.last().is_some_and(|l| light > l.0))
            {
                brightest.push((light, next + place as u64));
                brightest.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
                brightest.truncate(BRIGHTEST);
            }
        }
        next += paths as u64;
    };
    let paths = real.paths();
    let traced = real.trace_paths(None, &[pixel], 0..paths, &mut add);
    traced.map_err(MachineError::from)?;
    let told: Vec<String> = brightest
        .iter()
        .map(|&(_, id)| {
            Ok(path_line(
                id,
                &trace_path_of(scene, Model::Real, seed, pixel, id)?,
            ))
        })
        .collect::<Result<_, Refused>>()?;
    let total = paths << written.comparator.bits;
    let dearest = (0..3).max_by_key(|&c| good[c]).unwrap_or(0);
    let phase_bits = phase_bits.clamp(1, MOST_PHASE);
    let distribution = PhaseDistribution::new(good[dearest], total, phase_bits, Window::Sine)?;
    Ok(Answer::default()
        .list("mean", mean.map(|sum| sum / paths as f64))
        .list("scale", bound)
        .list("good", good.map(|good| good as f64))
        .number("total", total as f64)
        .number("paths", paths as f64)
        .list("histogram", histogram.map(|paths| paths as f64))
        .lines("brightest", &told)
        .number("channel", dearest as f64)
        .number("phase_bits", phase_bits.into())
        .number("theta", distribution.theta())
        .list(
            "probability",
            (0..=distribution.largest_outcome()).map(|y| distribution.probability(y)),
        ))
}

/// Formats a path like `37: floor, wall, lamp: 0.42 0.4 0.31`.
fn path_line(id: u64, path: &TracedPath<'_>) -> String {
    let mut told = id.to_string() + ": ";
    for (place, ray) in path.rays.iter().enumerate() {
        if place > 0 {
            told.push_str(", ");
        }
        told.push_str(ray.hit.map_or("nothing", |hit| hit.name));
    }
    let [r, g, b] = path.colour;
    // Writing into a string cannot fail.
    let _ = write!(told, ": {r:.4} {g:.4} {b:.4}");
    told
}
