//! Arguments that several commands have.

use super::failure::Failure;
use super::memory;
use super::progress::Bar;
use super::terminal;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use qrt_runtime::memory::Memory;
use qrt_scene::Film;
use qrt_scene::front::{self, Loaded};
use qrt_scene::meshes::MOST_FACES;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// A scene, with some of its keys overridden.
#[derive(Clone, Debug, Args)]
pub(crate) struct SceneArgs {
    /// The scene, a YAML file
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// Override a key of the scene; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// Let the scene read files below this folder, too, not only below its own; may be repeated
    #[arg(long, value_name = "DIR")]
    allow_files: Vec<PathBuf>,
    /// The memory that the work may take, such as 500M or 4G: what would take more is refused before it
    /// begins [default: three quarters of what the machine has]
    #[arg(long, value_name = "SIZE", value_parser = memory::size)]
    max_memory: Option<u64>,
}

impl SceneArgs {
    /// Returns the memory budget.
    pub(crate) fn memory(&self) -> Memory {
        Memory::new(self.max_memory)
    }

    /// Reads the scene and checks it.
    pub(crate) fn load(&self) -> Result<Loaded, Failure> {
        load(&self.scene, &self.sets, &self.allow_files, self.memory())
    }

    /// Reads the scene and checks it. If it is refused, reads it again with `estimator` in the place of its own: keys
    /// such as `counting.error` may suit that one alone.
    pub(crate) fn load_with(&self, estimator: Option<&str>) -> Result<Loaded, Failure> {
        let loaded = self.load();
        let Some(name) = estimator.filter(|_| loaded.is_err()) else {
            return loaded;
        };
        // `exact` goes with all keys of `counting`, as `auto` does.
        let name = if name == "exact" { "auto" } else { name };
        let mut sets = self.sets.clone();
        sets.push(format!("counting.estimator={name}"));
        load(&self.scene, &sets, &self.allow_files, self.memory()).or(loaded)
    }
}

/// Reads `scene` with the keys `sets` overridden and checks it; it may read files below `allow_files`.
pub(crate) fn load(
    scene: &Path,
    sets: &[String],
    allow_files: &[PathBuf],
    memory: Memory,
) -> Result<Loaded, Failure> {
    let bar = Bar::setting_up();
    let loaded = front::load_with(scene, sets, |files| {
        let most = memory.faces().min(MOST_FACES);
        files.allowing(allow_files).most_faces(most)
    });
    bar.clear();
    let loaded = loaded?;
    #[cfg(test)]
    super::tests::LOADED.set(Some(loaded.valid.clone()));
    if let Some(warnings) = loaded.warnings() {
        terminal::warn(&warnings);
    }
    Ok(loaded)
}

/// Threads.
#[derive(Clone, Debug, Args)]
pub(crate) struct ThreadsArgs {
    // 4,096 are more than any machine profits from.
    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=4096))]
    threads: Option<u64>,
}

impl ThreadsArgs {
    /// Returns the number of threads: the given one, or one for each core.
    pub(crate) fn or_cores(&self) -> usize {
        let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        self.count().map_or_else(cores, NonZeroUsize::get)
    }

    pub(crate) fn count(&self) -> Option<NonZeroUsize> {
        self.threads.and_then(|n| NonZeroUsize::new(n as usize))
    }
}

/// Returns a parser of the names of `values`, each with its line of help.
pub(crate) fn choice<T: Copy + Send + Sync + 'static, const N: usize>(
    values: [(T, &'static str); N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let words = values.map(|(value, help)| PossibleValue::new(name(value)).help(help));
    PossibleValuesParser::new(words).try_map(move |given| {
        let found = values.iter().find(|(value, _)| name(*value) == given);
        found
            .map(|(value, _)| *value)
            .ok_or("there is no such value")
    })
}

/// Parses a pixel on the command line, for example `10,20`.
pub(crate) fn pixel(text: &str) -> Result<[u32; 2], String> {
    numbers(text, "two whole numbers, such as 10,20")
}

/// Returns the pixel if the film has it.
///
/// # Errors
/// A pixel beyond the film's last column or row.
pub(crate) fn on_film([x, y]: [u32; 2], film: Film) -> Result<[u32; 2], Failure> {
    let Film { width, height, .. } = film;
    if x < width && y < height {
        return Ok([x, y]);
    }
    Err(Failure::Usage(format!(
        "there is no pixel {x},{y} on a film of {width} x {height}: x is in 0..={}, y in 0..={}",
        width - 1,
        height - 1
    )))
}

/// Parses `N` whole numbers with commas between them; `such_as` is the error message.
pub(crate) fn numbers<const N: usize>(text: &str, such_as: &str) -> Result<[u32; N], String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    let numbers = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    numbers.ok_or_else(|| such_as.to_owned())
}

/// Parses the slope of a table of phases.
pub(crate) fn slope(text: &str) -> Result<f64, String> {
    let slope = text.trim().parse().ok();
    let slope = slope.filter(|slope: &f64| *slope > 0.0 && slope.is_finite());
    slope.ok_or_else(|| "a slope is a positive, finite number, such as 2.5".to_owned())
}

/// Parses the reference of a table of phases.
pub(crate) fn reference(text: &str) -> Result<f64, String> {
    let reference = text.trim().parse().ok();
    let reference = reference.filter(|colour: &f64| (0.0..=1.0).contains(colour));
    // Not -0.
    let reference = reference.map(f64::abs);
    reference.ok_or_else(|| {
        "a reference is a colour over the scale, from 0 to 1, such as 0.1".to_owned()
    })
}
