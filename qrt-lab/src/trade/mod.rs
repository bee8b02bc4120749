//! Measures speed against accuracy.
//!
//! [`trade`] varies the parameters of a scene one at a time, and estimators and queries together.
//! It renders a sample of the scene's pixels under each setting. It writes the cost of each setting
//! and its distance from the picture's limit: a table, plots and a page that shows both.
//!
//! # Errors
//!
//! Each part of a pixel's error is the difference between two pictures of the same pixels that
//! differ in one respect only. It is a root mean square over pixels and channels, relative to the
//! mean radiance:
//!
//! | | of | against |
//! |---|---|---|
//! | `E_R` | the exact mean over R paths | over far more paths, with other shifts |
//! | `E_C` | S of the same paths in real arithmetic | the exact mean of these paths |
//! | `E_W` | S of the circuit's numbers | S of the same paths and comparators in real arithmetic |
//! | `E_T` | the estimate | S/N |
//! | `E_D` | paths of D rays | paths so long that more rays add almost nothing, same path indices |
//! | total | the estimate | the exact mean over far more paths, of D rays |
//!
//! Far more paths sample lamps, even if the scene does not: their mean is the same, and they are
//! closer to it. The total is measured, too: it is not the sum of the others. It does not include
//! `E_D`, which depends on no other parameter than the length of paths. Intervals are a bootstrap's
//! over pixels.

//!
//! # Rivals
//!
//! `beside-rivals` is the scene's estimator on pixels that see no lamp. On the same pixels, the
//! sweeps `random-paths` and `classical-net` are pictures without a circuit: means over random
//! paths, and over all paths of a smaller net (quasi-Monte Carlo), in real arithmetic, with lamps
//! sampled. Their `queries` are paths of a pixel, each of which gives all channels. Their error is
//! against the same limit as that of all others.
//!
//! # The table
//!
//! `trade.csv` begins with a line that names the values that its rows depend on: version, build,
//! scene hash, seed, pixels, quick. Its columns:
//!
//! * the setting: see [`Setting::values`];
//! * its price: `queries` of a pixel, all channels together, on average; `toffoli` and `qubits` of
//!   one call of the most expensive channel's oracle, as `qrt inspect` counts them (a phase
//!   register's own qubits are not among them); `toffoli_x_queries`;
//! * `mean`: the mean radiance over the pixels and channels of the errors, which are relative to
//!   it;
//! * `e_r`, `e_c`, `e_w`, `e_t`, `e_d`, `e_total`, each followed by the ends of its 95 % interval
//!   (`e_r_low`, `e_r_high`, ...);
//! * `seconds`: wall time of tracing and counting a pixel. It alone differs from run to run;
//! * `crc32`: the checksum of the row before it, in hexadecimal.
//!
//! Each row is written as soon as it is finished. A later run does not measure it again if its
//! checksum is right.

mod advice;
mod band;
mod bench;
mod error;
mod figure;
mod figures;
mod fronts;
mod limits;
mod page;
mod pareto;
mod preview;
mod rivals;
mod setting;
mod styles;
mod summary;
mod sweep;
mod table;
#[cfg(test)]
mod tests;

pub use band::Band;
pub use error::TradeError;
pub use pareto::pareto;
pub use setting::{Setting, Sweep};
pub use styles::style;
pub use table::{ERRORS, Row};

use bench::{Bench, Effort};
use qrt_runtime::memory::Memory;
use qrt_runtime::render::Portion;
use qrt_runtime::replace_file::replace_file;
use qrt_runtime::sample::spread;
use qrt_runtime::workers::{Progress, Workers};
use qrt_scene::valid::ValidScene;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use table::Contents;

/// Options of a measurement.
#[derive(Clone, Copy, Debug, Default)]
pub struct TradeOptions<'a> {
    /// Number of pixels, spread over the film; all of them if it has no more. 256 unless set; if quick 32, or 16
    /// of a scene whose oracle has more than 2^20 Toffolis, and 8 of one with more than 2^23.
    pub pixels: Option<u64>,
    /// Key of the shifts of the digital net and of every draw.
    pub seed: u64,
    /// Measures fewer settings, pixels and reference paths, and runs no gates where that takes long.
    pub quick: bool,
    /// The portion of the settings that this process measures; the settings are dealt out one by
    /// one. With a portion there is a table, and neither plots nor a page. All settings unless set.
    pub portion: Portion,
    /// Folders whose tables have rows that need not be measured again. Two tables may have the same
    /// row, but not different rows of one setting. Settings that no table has are measured.
    pub parts: &'a [PathBuf],
    /// Number of threads, a cancel flag, and a callback for progress in rows.
    pub workers: Workers<'a>,
    /// The memory budget. A scene whose circuit would exceed it is refused.
    pub memory: Memory,
}

impl TradeOptions<'_> {
    /// Most pixels that are measured: [`TradeOptions::pixels`], or its default for any circuit.
    pub fn most_pixels(&self) -> u64 {
        self.pixels.unwrap_or(if self.quick { 32 } else { 256 })
    }
}

/// The result of measuring a scene's parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Trade {
    /// The scene's name.
    pub name: String,
    /// The scene as YAML.
    pub scene_text: String,
    /// Number of pixels that were rendered, and number of the film's pixels.
    pub pixels: [u64; 2],
    /// Key of shifts and draws.
    pub seed: u64,
    /// Paths of the reference: `2^reference_bits`.
    pub reference_bits: u32,
    /// All rows, in their order.
    pub rows: Vec<Row>,
    /// Number of rows that earlier runs had finished.
    pub resumed: usize,
    /// Number of rows that were damaged, and that were measured again.
    pub damaged: usize,
    /// Settings that were not measured, and the reason: they have no scene or no circuit, or their gates take too long
    /// for a quick measurement.
    pub left_out: Vec<(Setting, String)>,
}

impl Trade {
    /// The row of the scene as it is.
    pub fn scene(&self) -> Option<&Row> {
        self.rows.first()
    }

    /// The rows of `sweep`.
    pub(crate) fn rows_of(&self, sweep: Sweep) -> impl Iterator<Item = &Row> {
        self.rows
            .iter()
            .filter(move |row| row.setting.sweep == sweep)
    }

    /// A summary in a few lines.
    pub fn summary(&self) -> String {
        summary::text(self)
    }
}

/// Measures a scene's parameters and writes `trade.csv`, plots and `index.html` to `folder`.
///
/// Creates the folder if it does not exist, and continues the table of an interrupted run.
///
/// # Errors
/// See [`TradeError`].
pub fn trade(
    scene: &ValidScene,
    folder: &Path,
    options: &TradeOptions<'_>,
) -> Result<Trade, TradeError> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        |source: std::io::Error| TradeError::File { path, source }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    let measured = (options.workers).on_threads(|| measure(scene, folder, options))??;
    if options.portion != Portion::WHOLE {
        return Ok(measured);
    }
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        replace_file(&path, |out| out.write_all(text.as_bytes())).map_err(failed(&path))
    };
    let figures = figures::all(&measured);
    for figure in &figures {
        write(&format!("{}.svg", figure.name), &figure.plot.draw().svg())?;
    }
    let preview = || preview::Preview::render(scene, options);
    let preview = (options.workers).on_threads(preview)??;
    write(
        "index.html",
        &page::html(&measured, preview.as_ref(), &figures),
    )?;
    Ok(measured)
}

/// Toffolis of a call above which a quick measurement takes half of the pixels, and those above which it takes a
/// quarter.
const MANY_TOFFOLIS: [u64; 2] = [1 << 20, 1 << 23];

/// Most Toffolis of a row that a quick measurement runs gate by gate: below ten seconds of processor time on a circuit
/// of millions of gates, and below one on a small circuit.
const MOST_OF_A_ROW: u64 = 50_000_000_000;

/// Returns the name of this build: hashes of the sources that a row depends on, those of the renderer
/// and those of this module.
fn build() -> String {
    format!("{}-{}", qrt_runtime::BUILD, env!("QRT_TRADE_BUILD"))
}

fn measure(
    scene: &ValidScene,
    folder: &Path,
    options: &TradeOptions<'_>,
) -> Result<Trade, TradeError> {
    let written = scene.scene();
    let film = [written.film.width, written.film.height];
    let settings = sweep::settings(&scene.parameters(), options.quick);
    let counted = settings.iter().filter(|s| !s.sweep.is_rival());
    let longest = counted.map(|setting| setting.path_bits).max();
    let more = if options.quick { 3 } else { 4 };
    let effort = Effort {
        reference_bits: (longest.unwrap_or(0) + more).min(qrt_scene::sampling::MAX_PATH_BITS),
        depth_bits: written.sampling.path_bits.clamp(8, 12),
        draws: if options.quick { 2 } else { 4 },
        most_toffoli: options.quick.then_some(MOST_OF_A_ROW),
    };
    let mut bench = Bench::new(scene, options.seed, effort, options.workers);
    // Reports a scene that cannot be measured before it writes a file.
    let toffoli = bench.check(options.memory)?;
    let most = options.most_pixels();
    let asked = if options.pixels.is_none() && options.quick {
        let halvings = MANY_TOFFOLIS.into_iter().filter(|many| toffoli > *many);
        most >> halvings.count()
    } else {
        most
    };
    bench.pixels = spread(film, asked.max(1));
    let count = bench.pixels.len() as u64;
    let header = vec![
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("build", build()),
        ("scene_hash", scene.fingerprint().to_string()),
        ("seed", options.seed.to_string()),
        ("pixels", count.to_string()),
        ("quick", options.quick.to_string()),
    ];
    let own = folder.join("trade.csv");
    let parts = options.parts.iter().map(|part| part.join("trade.csv"));
    let parts: Vec<PathBuf> = parts.collect();
    let read = |path: &PathBuf| table::read(path, &header, &settings);
    let taken = parts.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let rows = taken.iter().map(|part| &*part.rows);
    let mut tables: Vec<_> = parts.iter().map(PathBuf::as_path).zip(rows).collect();
    table::agree(&tables, &settings)?;
    let mut table = table::Table::open(&own, &header, &settings)?;
    tables.push((&own, &table.found));
    table::agree(&tables, &settings)?;
    let found = std::mem::take(&mut table.found);
    table.damaged += taken.iter().map(|part| part.damaged).sum::<usize>();
    // For each setting: the first part that has its row.
    let taken: Vec<Option<&Contents>> = (0..settings.len())
        .map(|at| taken.iter().find(|part| part.rows[at].is_some()))
        .collect();
    let is_there = |at: usize| found[at].is_some() || taken[at].is_some();
    let resumed = (0..settings.len()).filter(|&at| is_there(at)).count();
    let mine = (0..settings.len()).filter(|&at| is_there(at) || options.portion.takes(at));
    options.workers.report(Progress::Started {
        total: mine.count() as u64,
        resumed: resumed as u64,
    });
    let mut measured = Trade {
        name: written.name.clone(),
        scene_text: written.to_yaml(),
        pixels: [count, u64::from(film[0]) * u64::from(film[1])],
        seed: options.seed,
        reference_bits: effort.reference_bits,
        rows: Vec::new(),
        resumed,
        damaged: table.damaged,
        left_out: Vec::new(),
    };
    for (at, (setting, found)) in settings.into_iter().zip(found).enumerate() {
        if let Some(row) = found {
            measured.rows.push(row);
            continue;
        }
        if let Some(part) = taken[at] {
            measured.rows.extend(table.take_over(at, part)?);
            continue;
        }
        if !options.portion.takes(at) {
            continue;
        }
        match bench.row(setting)? {
            Ok(row) => measured.rows.push(table.append(at, &row)?),
            Err(why) => measured.left_out.push((setting, why)),
        }
        options.workers.report(Progress::Finished(1));
    }
    table.finish()?;
    Ok(measured)
}
