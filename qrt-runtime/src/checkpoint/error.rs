//! Why a checkpoint can't be used.

use super::format::VERSION;
use std::path::PathBuf;
use std::{fmt, io};

/// In what a checkpoint differs from the render that asks for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// `scene`, `seed`, `film`, `crop`, or the name of an option.
    pub what: String,
    /// In the checkpoint.
    pub found: Option<String>,
    /// Now.
    pub asked: Option<String>,
}

/// Why a checkpoint can't be used.
#[derive(Debug)]
#[allow(missing_docs)]
pub enum CheckpointError {
    /// The file system refused.
    Io { path: PathBuf, source: io::Error },
    /// Another process is writing to it.
    InUse { path: PathBuf },
    /// Some other file.
    Foreign { path: PathBuf },
    /// Written by another version of this format.
    Version { path: PathBuf, version: u32 },
    /// The header fails its sum.
    Damaged { path: PathBuf },
    /// It belongs to another render.
    Differs {
        path: PathBuf,
        differences: Vec<Difference>,
    },
    /// A tile outside the crop, or whose pixels or queries don't fill it.
    Tile {
        x: u32,
        y: u32,
        width: u32,
        height: u32,
    },
}

impl fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { path, source } => write!(f, "`{}`: {source}", path.display()),
            Self::InUse { path } => {
                write!(f, "`{}` is being written by another render", path.display())
            }
            Self::Foreign { path } => write!(f, "`{}` is not a checkpoint of qrt", path.display()),
            Self::Version { path, version } => write!(
                f,
                "`{}` is a checkpoint of format {version}; this qrt reads {VERSION}",
                path.display()
            ),
            Self::Damaged { path } => {
                write!(
                    f,
                    "`{}` is damaged: delete it and render anew",
                    path.display()
                )
            }
            Self::Differs { path, differences } => {
                write!(f, "`{}` belongs to another render", path.display())?;
                for Difference { what, found, asked } in differences {
                    let of = |v: &Option<String>| v.clone().unwrap_or_else(|| "not set".into());
                    write!(f, "\n  {what}: there {}, here {}", of(found), of(asked))?;
                }
                Ok(())
            }
            Self::Tile {
                x,
                y,
                width,
                height,
            } => write!(
                f,
                "a tile of {width} x {height} at ({x}, {y}) is not filled or not in the crop"
            ),
        }
    }
}

impl std::error::Error for CheckpointError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}
