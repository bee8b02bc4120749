//! Why a checkpoint can't be used.

use super::format::VERSION;
use std::io;
use std::path::PathBuf;

/// In what a checkpoint differs from the render that asks for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// `scene`, `seed`, `film`, `crop`, or the name of an option.
    pub what: String,
    /// Its value in the checkpoint.
    pub found: Option<String>,
    /// Its value in the render that asks.
    pub asked: Option<String>,
}

/// Why a checkpoint can't be used.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum CheckpointError {
    /// The file system refused.
    #[error("`{}`: {source}", .path.display())]
    Io { path: PathBuf, source: io::Error },
    /// Another process is writing to it.
    #[error("`{}` is being written by another render", .path.display())]
    InUse { path: PathBuf },
    /// It is a link, a folder or a device.
    #[error(
        "`{}` is a link or no regular file, which a checkpoint never is: remove it, or name another \
         picture",
        .path.display()
    )]
    Irregular { path: PathBuf },
    /// The file is gone in which the finished tiles were.
    #[error(
        "`{}` was removed or replaced while it was written: the tiles that it had are lost",
        .path.display()
    )]
    Lost { path: PathBuf },
    /// The file is no checkpoint.
    #[error("`{}` is not a checkpoint of qrt", .path.display())]
    Foreign { path: PathBuf },
    /// Written by another version of this format.
    #[error("`{}` is a checkpoint of format {version}; this qrt reads {VERSION}", .path.display())]
    Version { path: PathBuf, version: u32 },
    /// The header fails its sum.
    #[error("`{}` is damaged: delete it and render anew", .path.display())]
    Damaged { path: PathBuf },
    /// It belongs to another render.
    #[error("`{}` belongs to another render{}", .path.display(), listed(.differences))]
    Differs {
        path: PathBuf,
        differences: Vec<Difference>,
    },
    /// A tile outside the crop, or whose pixels or queries don't fill it.
    #[error("a tile of {width} x {height} at ({x}, {y}) is not filled or not in the crop")]
    Tile {
        x: u32,
        y: u32,
        width: u32,
        height: u32,
    },
}

/// A line each.
fn listed(differences: &[Difference]) -> String {
    let of = |value: &Option<String>| value.clone().unwrap_or_else(|| "not set".into());
    let line = |Difference { what, found, asked }: &Difference| {
        format!("\n  {what}: there {}, here {}", of(found), of(asked))
    };
    let mut lines: String = differences.iter().map(line).collect();
    if differences
        .iter()
        .any(|difference| difference.what == "build")
    {
        lines +=
            "\n  another build of qrt may compute other bits: go on with that one, or render anew";
    }
    lines
}
