//! Arguments that several commands have.

use super::failure::Failure;
use super::terminal;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use qrt_core::front::{self, Loaded};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// A scene, with some of its keys overridden.
#[derive(Clone, Debug, Args)]
pub(crate) struct SceneArgs {
    /// The scene, a YAML file
    #[arg(value_name = "SCENE")]
    pub(crate) scene: PathBuf,
    /// Override a key of the scene; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
}

impl SceneArgs {
    /// Reads the scene and checks it.
    pub(crate) fn load(&self) -> Result<Loaded, Failure> {
        let loaded = front::load(&self.scene, &self.sets)?;
        if let Some(warnings) = loaded.warnings() {
            terminal::warn(&warnings);
        }
        Ok(loaded)
    }
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
    pub(crate) fn count(&self) -> Option<NonZeroUsize> {
        self.threads.and_then(|n| NonZeroUsize::new(n as usize))
    }
}

/// A parser of the names of these values, each with its line of help.
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

/// So many whole numbers, with commas between them; `such_as` these.
pub(crate) fn numbers<const N: usize>(text: &str, such_as: &str) -> Result<[u32; N], String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    let numbers = numbers.ok().and_then(|numbers| numbers.try_into().ok());
    numbers.ok_or_else(|| such_as.to_owned())
}
