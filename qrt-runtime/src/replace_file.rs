//! Writing a result so that its name never shows half of it.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process;

/// Writes the file at `path`, through `write`, all or nothing: the bytes go to a file beside it
/// (`NAME.PID.qrt-partial`) that takes its name once everything is on the disk. If anything fails,
/// what was at `path` is still there, whole, and the partial file is removed; a process killed
/// meanwhile leaves only the partial file behind. A link is followed. A device or pipe (such as
/// `/dev/stdout`) cannot be replaced and is written to directly.
///
/// # Errors
/// What `write` returns, or what the file system says.
///
/// ```
/// use std::io::{self, Write};
/// let path = std::env::temp_dir().join(format!("qrt-doc-{}.txt", std::process::id()));
/// qrt_runtime::replace_file::replace_file(&path, |out| writeln!(out, "whole"))?;
/// assert_eq!(std::fs::read_to_string(&path)?, "whole\n");
/// std::fs::remove_file(&path)?;
/// # Ok::<(), io::Error>(())
/// ```
pub fn replace_file<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    let target = match fs::metadata(path) {
        Ok(found) if found.is_file() => fs::canonicalize(path)?,
        Ok(found) if found.is_dir() => {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "is a directory").into());
        }
        Ok(_) => return write_through(OpenOptions::new().write(true).open(path)?, write).map(drop),
        Err(_) => path.to_path_buf(),
    };
    let partial = Partial(partial_name(&target)?);
    let file = write_through(File::create(&partial.0)?, write)?;
    file.sync_all()?;
    drop(file);
    fs::rename(&partial.0, &target)?;
    Ok(())
}

fn write_through<E: From<io::Error>>(
    file: File,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<File, E> {
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    out.flush()?;
    Ok(out.into_inner().map_err(io::IntoInnerError::into_error)?)
}

fn partial_name(target: &Path) -> io::Result<PathBuf> {
    let Some(name) = target.file_name() else {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "names no file"));
    };
    let mut partial = name.to_owned();
    partial.push(format!(".{}.qrt-partial", process::id()));
    Ok(target.with_file_name(partial))
}

/// A partial file, removed when dropped. After the rename nothing has its name.
struct Partial(PathBuf);

impl Drop for Partial {
    fn drop(&mut self) {
        // There is nobody to tell, and a file that is left over does no harm.
        let _ = fs::remove_file(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = Scratch::new();
        let path = folder.path("result");
        replace_file(&path, |out| out.write_all(b"old")).unwrap();
        let failed = replace_file(&path, |out| {
            out.write_all(&vec![b'x'; 100_000])?;
            Err(io::Error::other("the pen broke"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "the pen broke");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(folder.names(), ["result"]);
        replace_file(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(folder.names(), ["result"]);
    }

    #[test]
    fn the_name_appears_only_when_all_is_written() {
        let folder = Scratch::new();
        let path = folder.path("result");
        replace_file(&path, |out| {
            out.write_all(b"half")?;
            out.flush()?;
            assert!(!path.exists());
            out.write_all(b" and half")
        })
        .unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"half and half");
    }

    #[test]
    fn folders_and_missing_folders_are_errors() {
        let folder = Scratch::new();
        let nothing = |_: &mut BufWriter<File>| Ok::<(), io::Error>(());
        assert!(replace_file(&folder.path(""), nothing).is_err());
        assert!(replace_file(&folder.path("none/result"), nothing).is_err());
        assert!(replace_file(Path::new(""), nothing).is_err());
        assert!(replace_file(Path::new(".."), nothing).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_devices_are_written_to() {
        let folder = Scratch::new();
        let (real, link) = (folder.path("real"), folder.path("link"));
        fs::write(&real, "old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        replace_file(&link, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        replace_file(Path::new("/dev/null"), |out| out.write_all(b"gone")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
