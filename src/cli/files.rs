//! Checks of output files before the work that fills them.

use super::failure::Failure;
use super::terminal;
use qrt_runtime::disk::ResolvedPath;
use qrt_runtime::replace_file::{PARTIAL, try_writing};
use std::fs;
use std::path::{Path, PathBuf};

/// Name of standard output in place of a file.
pub(crate) const STDOUT: &str = "-";

/// A file that a command writes: the path as the user gave it, and the place to which it leads.
#[derive(Clone, Debug)]
pub(crate) struct Output {
    asked: PathBuf,
    place: ResolvedPath,
}

impl Output {
    /// Resolves the path `asked`.
    ///
    /// # Errors
    /// `asked` is a folder, its folder does not exist, or it is `-`.
    pub(crate) fn new(asked: &Path) -> Result<Self, Failure> {
        keep_off_stdout(asked)?;
        let place = ResolvedPath::resolve(asked).map_err(|error| Failure::file(asked, &error))?;
        if place.is_folder() {
            let message = format!("`{}` is a folder", asked.display());
            return Err(Failure::Usage(message));
        }
        let asked = asked.to_path_buf();
        Ok(Self { asked, place })
    }

    /// Resolves the path `asked`, where `-` is standard output.
    ///
    /// # Errors
    /// Same as [`Output::new`].
    pub(crate) fn or_stdout(asked: &Path) -> Result<Self, Failure> {
        if asked != Path::new(STDOUT) {
            return Self::new(asked);
        }
        Ok(Self {
            asked: asked.to_path_buf(),
            place: ResolvedPath::standard_output(),
        })
    }

    /// True if the output is standard output, given as `-`.
    pub(crate) fn is_stdout(&self) -> bool {
        self.place.path() == Path::new(STDOUT)
    }

    /// Checks that the file can be written, as far as that can be known beforehand.
    ///
    /// # Errors
    /// The error of the file system.
    pub(crate) fn try_writing(&self) -> Result<(), Failure> {
        try_writing(&self.place).map_err(|error| Failure::file(&self.asked, &error))
    }

    /// Checks that the name does not end as the names of checkpoints, which keep unfinished renders.
    ///
    /// # Errors
    /// The name ends in that way.
    pub(crate) fn keep_off_checkpoints(&self) -> Result<(), Failure> {
        let named = |path: &Path| path.as_os_str().to_string_lossy().ends_with(PARTIAL);
        if named(&self.asked) || named(self.place.path()) {
            let message = format!(
                "`{}` is named as a checkpoint is: choose a name that does not end in `{PARTIAL}`",
                self.asked.display()
            );
            return Err(Failure::Usage(message));
        }
        Ok(())
    }

    /// True if the output is a device or a pipe.
    pub(crate) fn is_device(&self) -> bool {
        self.place.is_device()
    }

    /// Returns the path to write to. Creates its folder again if the folder has vanished since the beginning,
    /// so that no work is lost.
    ///
    /// # Errors
    /// The error of the file system.
    pub(crate) fn path(&self) -> Result<&Path, Failure> {
        let path = self.place.path();
        if self.is_device() {
            return Ok(path);
        }
        if let Some(folder) = path.parent().filter(|folder| !folder.exists()) {
            fs::create_dir_all(folder).map_err(|error| Failure::file(folder, &error))?;
            terminal::note(&format!(
                "the folder `{}` has vanished, and is made again",
                folder.display()
            ));
        }
        Ok(path)
    }
}

/// Refuses `-` for an output that standard output cannot take.
///
/// # Errors
/// `asked` is `-`.
pub(crate) fn keep_off_stdout(asked: &Path) -> Result<(), Failure> {
    if asked != Path::new(STDOUT) {
        return Ok(());
    }
    let message = "standard output, `-`, takes none of this: name a file (`./-` is one)";
    Err(Failure::Usage(message.to_owned()))
}

/// Refuses to write one of `outputs` over another or over one of `inputs`, under whatever names.
/// Several outputs may go to the same device, which takes them one after another.
///
/// # Errors
/// The first output that would be written over another file.
pub(crate) fn keep_apart<'a>(
    inputs: impl IntoIterator<Item = &'a Path>,
    outputs: &[&Output],
) -> Result<(), Failure> {
    let refused = |output: &Output, other: &Path| {
        let message = if output.asked == other {
            format!("`{}` is used for two different things", other.display())
        } else {
            format!(
                "`{}` is `{}`: one file is used for two different things",
                output.asked.display(),
                other.display()
            )
        };
        Err(Failure::Usage(message))
    };
    for input in inputs {
        // A missing input is reported when it is read.
        if let Ok(place) = ResolvedPath::resolve(input)
            && let Some(output) = outputs
                .iter()
                .find(|output| output.place.is_same_as(&place))
        {
            return refused(output, input);
        }
    }
    for (number, output) in outputs.iter().enumerate() {
        let mut earlier = outputs[..number].iter();
        if let Some(other) = earlier.find(|other| other.place.is_same_as(&output.place)) {
            return refused(output, &other.asked);
        }
    }
    Ok(())
}

/// Returns a scene's result in the current folder: `folder/box.yaml` and `png` give `box.png`.
pub(crate) fn named_after(scene: &Path, extension: &str) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or("scene".as_ref()).to_owned();
    name.push(".");
    name.push(extension);
    name.into()
}
