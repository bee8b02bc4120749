//! Output files of a picture, whether it was rendered at once or in parts.

use super::failure::Failure;
use super::files::{Output, STDOUT, keep_apart};
use super::{stats, terminal};
use clap::Args;
use qrt_core::inspect::grouped;
use qrt_runtime::image::{self, Encoding, Layer};
use qrt_runtime::render::Rendered;
use qrt_runtime::replace_file::checkpoint_of;
use std::path::{Path, PathBuf};

/// Options for the files that are written beside a picture.
#[derive(Clone, Debug, Args)]
pub(crate) struct BesideArgs {
    /// Stops of exposure: the picture times 2^STOPS; for .png only
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true)]
    pub(crate) exposure: Option<f64>,
    /// Write time, queries, mean colour and more as JSON; `-` is standard output
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Write every channel of every pixel as CSV: x,y,channel,value,good,total,scale; `-` is standard
    /// output
    #[arg(long, value_name = "FILE.csv")]
    counts: Option<PathBuf>,
}

/// The output files.
pub(crate) struct Outputs {
    /// The picture, or a part of it.
    pub(crate) picture: Output,
    stats: Option<Output>,
    counts: Option<Output>,
    /// File that keeps finished tiles; `None` if the picture goes to a pipe or a device, which has no folder
    /// for it.
    pub(crate) checkpoint: Option<PathBuf>,
}

impl Outputs {
    /// Resolves the paths of the output files.
    ///
    /// # Errors
    /// An output is a folder, or its folder does not exist.
    pub(crate) fn new(picture: &Path, beside: &BesideArgs) -> Result<Self, Failure> {
        let output = |path: &PathBuf| Output::or_stdout(path);
        let asked = Output::new(picture)?;
        let partial = checkpoint_of(picture);
        let are_stdout = |path: &Option<PathBuf>| path.as_deref() == Some(Path::new(STDOUT));
        if are_stdout(&beside.stats) && are_stdout(&beside.counts) {
            let message =
                "`-` is used for two different things: name a file for --stats or --counts";
            return Err(Failure::Usage(message.to_owned()));
        }
        Ok(Self {
            stats: beside.stats.as_ref().map(output).transpose()?,
            counts: beside.counts.as_ref().map(output).transpose()?,
            checkpoint: (!asked.is_device()).then_some(partial),
            picture: asked,
        })
    }

    /// Returns the files that the user asked for.
    pub(crate) fn asked(&self) -> impl Iterator<Item = &Output> {
        let others = self.stats.iter().chain(&self.counts);
        std::iter::once(&self.picture).chain(others)
    }

    /// Prints the summary of the picture, on standard error if standard output is one of the files.
    ///
    /// # Errors
    /// The summary cannot be written.
    pub(crate) fn tell(&self, summary: &str) -> Result<(), Failure> {
        if self.asked().any(Output::is_stdout) {
            terminal::note(summary.trim_end());
            return Ok(());
        }
        terminal::print(summary)
    }

    /// Checks that no output is one of `inputs`, another output, or another picture's checkpoint.
    ///
    /// # Errors
    /// The first output that is.
    pub(crate) fn keep_off<'a>(
        &self,
        inputs: impl IntoIterator<Item = &'a Path>,
    ) -> Result<(), Failure> {
        let checkpoint = self.checkpoint.as_deref().map(Output::new).transpose()?;
        let all: Vec<&Output> = self.asked().chain(&checkpoint).collect();
        keep_apart(inputs, &all)?;
        self.asked().try_for_each(Output::keep_off_checkpoints)
    }
}

/// Checks that the picture's format keeps layers, if they were asked for.
///
/// # Errors
/// The format has no layers.
pub(crate) fn keeps_layers(asked: bool, picture: &Path, encoding: Encoding) -> Result<(), Failure> {
    if !asked || encoding == Encoding::Exr {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "`{}` cannot keep layers: name an .exr",
        picture.display()
    )))
}

/// Writes the picture with its layers and the files beside it; returns the number of clipped pixels.
///
/// # Errors
/// A file that cannot be written.
pub(crate) fn write(
    outputs: &Outputs,
    encoding: Encoding,
    rendered: &Rendered,
    layers: &[Layer],
) -> Result<u64, Failure> {
    let mut metadata = rendered.metadata()?;
    if let Encoding::Png { exposure } = encoding {
        metadata.set("exposure", exposure.to_string())?;
    }
    let picture = outputs.picture.path()?;
    let clipped = image::save_layers(picture, &rendered.image, layers, &metadata, encoding)?;
    match &outputs.counts {
        Some(output) if output.is_stdout() => {
            terminal::stream(|out| image::write_counts_to(out, rendered.counts()))?;
        }
        Some(output) => image::write_counts(output.path()?, rendered.counts())?,
        None => {}
    }
    match &outputs.stats {
        Some(output) if output.is_stdout() => terminal::print(&stats::text(rendered, clipped))?,
        Some(output) => stats::write(output.path()?, rendered, clipped)?,
        None => {}
    }
    Ok(clipped)
}

/// Returns the summary of a picture.
pub(crate) fn summary(output: &Path, rendered: &Rendered, clipped: u64) -> String {
    let Rendered { image, paths, .. } = rendered;
    let clipped = match clipped {
        0 => String::new(),
        _ => format!(
            "{clipped} of {} pixels are clipped: lower --exposure, or write .exr\n",
            image.pixels.len()
        ),
    };
    format!(
        "{}: {} x {} pixels, {paths} paths in {:.2} s ({:.2} Mpaths/s), model {}, estimator {}, {} \
         queries\n\
         {clipped}",
        output.display(),
        image.width,
        image.height,
        rendered.seconds,
        stats::paths_per_second(rendered) / 1e6,
        rendered.model.name(),
        rendered.estimator,
        rendered.total_queries(),
    ) + &search_summary(rendered)
}

/// Describes the cost of the search for primary hits; empty if there was none.
fn search_summary(rendered: &Rendered) -> String {
    let Some(searched) = rendered.primary_hits.searched else {
        return String::new();
    };
    let root = libm::sqrt(searched.faces as f64);
    let mean = rendered.total_queries() as f64 / rendered.paths as f64;
    let promise = match searched.failure {
        0.0 => String::new(),
        failure => format!(", a miss at most {failure:.1e} likely"),
    };
    format!(
        "primary hits by {}: P = {} faces, {mean:.2} queries a ray = {:.2} sqrt(P) = {:.3} P, each of \
         {} Toffolis on {} qubits{promise}\n",
        rendered.primary_hits.method.name(),
        searched.faces,
        mean / root,
        mean / searched.faces as f64,
        grouped(searched.toffoli),
        grouped(searched.qubits),
    )
}
