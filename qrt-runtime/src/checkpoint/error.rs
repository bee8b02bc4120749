//! Errors of reading and writing checkpoints.

use super::VERSION;
use std::io;
use std::path::PathBuf;

/// A property in which a checkpoint differs from the render that opens it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CheckpointDifference {
    /// The name of the property: `scene`, `seed`, `film`, `crop`, or the name of an option.
    pub what: String,
    /// Its value in the checkpoint; `None` if the checkpoint does not set it.
    pub found: Option<String>,
    /// Its value in the render; `None` if the render does not set it.
    pub asked: Option<String>,
}

/// An error of reading or writing a checkpoint.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)]
pub enum CheckpointError {
    /// An operation of the file system failed.
    #[error("`{}`: {source}", .path.display())]
    Io { path: PathBuf, source: io::Error },
    /// Another process holds the lock of the file.
    #[error("`{}` is being written by another render", .path.display())]
    InUse { path: PathBuf },
    /// The path is a link, a folder or a device.
    #[error(
        "`{}` is a link or no regular file, which a checkpoint never is: remove it, or name another \
         picture",
        .path.display()
    )]
    Irregular { path: PathBuf },
    /// Another process removed or replaced the file, and the finished tiles in it are lost.
    #[error(
        "`{}` was removed or replaced while it was written: the tiles that it had are lost",
        .path.display()
    )]
    Lost { path: PathBuf },
    /// The file is not a checkpoint.
    #[error("`{}` is not a checkpoint of qrt", .path.display())]
    Foreign { path: PathBuf },
    /// The file has another version of the checkpoint format.
    #[error("`{}` is a checkpoint of format {version}; this qrt reads {VERSION}", .path.display())]
    Version { path: PathBuf, version: u32 },
    /// The header does not match its CRC-32, or does not decode.
    #[error("`{}` is damaged: delete it and render anew", .path.display())]
    Damaged { path: PathBuf },
    /// The checkpoint belongs to another render.
    #[error("`{}` belongs to another render{}", .path.display(), listed(.differences))]
    Differs {
        path: PathBuf,
        differences: Vec<CheckpointDifference>,
    },
    /// A tile is outside the crop, or its number of pixels or queries is not its area.
    #[error("a tile of {width} x {height} at ({x}, {y}) is not filled or not in the crop")]
    Tile {
        x: u32,
        y: u32,
        width: u32,
        height: u32,
    },
}

/// Formats one line for each difference.
fn listed(differences: &[CheckpointDifference]) -> String {
    let of = |value: &Option<String>| value.clone().unwrap_or_else(|| "not set".into());
    let line = |CheckpointDifference { what, found, asked }: &CheckpointDifference| {
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
