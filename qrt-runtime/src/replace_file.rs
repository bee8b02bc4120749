//! Writing a result so that its name never shows half of it.

#[cfg(test)]
mod tests;

use crate::disk::{self, DiskFile, Lock, Place};
use std::collections::hash_map::RandomState;
use std::ffi::{OsStr, OsString};
use std::fs::{self, Metadata};
use std::hash::{BuildHasher as _, Hasher as _};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// What the names of partial files and checkpoints end in.
pub const PARTIAL: &str = ".qrt-partial";

/// Hexadecimal digits of a partial file's random number.
const RANDOM_DIGITS: usize = 16;

/// The longest name that file systems in use give a file, in bytes.
const LONGEST_NAME: usize = 255;

/// Random names that are tried before it is given up.
const ATTEMPTS: u32 = 64;

/// Writes the file at `path`, through `write`, all or nothing: the bytes go to a file beside it
/// (`NAME.16 random hexadecimal digits.qrt-partial`) that takes its name, and the permissions of the
/// file that it replaces, once everything is on the disk. If anything fails, what was at `path` is
/// still there, whole, and the partial file is removed; a process killed meanwhile leaves only the
/// partial file behind, which the next to write the same file removes. A link is followed, to a file
/// that is not there yet, too. A device or pipe cannot be replaced and is written to directly, as is
/// `/dev/stdout`, into whatever file a shell may have led it.
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
    write: impl FnOnce(&mut BufWriter<DiskFile>) -> Result<(), E>,
) -> Result<(), E> {
    // Its lock is held until it has its name.
    replaced(path, write).map(drop)
}

/// As [`replace_file`], and hands over the file, open and locked.
pub(crate) fn replaced<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<DiskFile>) -> Result<(), E>,
) -> Result<DiskFile, E> {
    let place = Place::of(path)?;
    if place.is_device() {
        return write_through(DiskFile::device(path)?, write);
    }
    let (mut partial, file) = Partial::beside(&place)?;
    let mut file = write_through(file, write)?;
    file.sync()?;
    file.rename(place.path())?;
    partial.renamed = true;
    disk::sync_folder(place.path())?;
    Ok(file)
}

/// Finds out whether a file can be written at `place`, by making a partial file beside it and
/// removing that.
///
/// # Errors
/// What the file system says.
pub fn try_writing(place: &Place) -> io::Result<()> {
    if place.is_device() {
        return Ok(());
    }
    Partial::beside(place).map(drop)
}

fn write_through<E: From<io::Error>>(
    file: DiskFile,
    write: impl FnOnce(&mut BufWriter<DiskFile>) -> Result<(), E>,
) -> Result<DiskFile, E> {
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    out.flush()?;
    Ok(out.into_inner().map_err(io::IntoInnerError::into_error)?)
}

/// The name of a partial file, which is removed when this is dropped unless it was renamed.
struct Partial {
    path: PathBuf,
    renamed: bool,
}

impl Partial {
    /// A new file beside the one at `place`, locked until it is closed.
    fn beside(place: &Place) -> io::Result<(Self, DiskFile)> {
        if place.is_folder() {
            return Err(io::Error::new(ErrorKind::IsADirectory, "is a directory"));
        }
        let target = place.path();
        let Some(name) = target.file_name() else {
            return Err(io::Error::new(ErrorKind::InvalidInput, "names no file"));
        };
        remove_abandoned(target);
        for _ in 0..ATTEMPTS {
            let path = target.with_file_name(partial_name(name));
            let file = match disk::create_new(&path) {
                Ok(file) => file,
                Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
                Err(error) => return Err(error),
            };
            let renamed = false;
            let partial = Self { path, renamed };
            // Before it was locked, another process may have taken it for abandoned.
            if file.try_lock()? == Lock::Others || !file.has_its_name()? {
                continue;
            }
            if place.is_file() {
                keep_permissions(&file, &fs::metadata(target)?)?;
            }
            return Ok((partial, file));
        }
        let message = "no name for a partial file is free";
        Err(io::Error::new(ErrorKind::AlreadyExists, message))
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        if !self.renamed {
            // There is nobody to tell, and the next to write the same file tries again.
            let _ = disk::remove(&self.path);
        }
    }
}

/// A name that nobody can foresee: `NAME.16 hexadecimal digits.qrt-partial`.
fn partial_name(name: &OsStr) -> OsString {
    // Keyed by the system's own random numbers.
    let random = RandomState::new().build_hasher().finish();
    let mut partial = shortened(name, RANDOM_DIGITS + 1 + PARTIAL.len());
    partial.push(format!(".{random:016x}{PARTIAL}"));
    partial
}

/// Whether `partial` is such a name.
fn is_partial_name(partial: &OsStr, name: &OsStr) -> bool {
    let name = shortened(name, RANDOM_DIGITS + 1 + PARTIAL.len());
    let partial = partial.as_encoded_bytes();
    let digits = partial
        .strip_prefix(name.as_encoded_bytes())
        .and_then(|rest| rest.strip_prefix(b"."))
        .and_then(|rest| rest.strip_suffix(PARTIAL.as_bytes()));
    let hexadecimal = |digit: &u8| matches!(digit, b'0'..=b'9' | b'a'..=b'f');
    digits.is_some_and(|digits| digits.len() == RANDOM_DIGITS && digits.iter().all(hexadecimal))
}

/// The path of the checkpoint of a picture: beside it, its name and [`PARTIAL`]. A name that leaves no
/// room for that is cut, and a checksum of all of it tells it from others that begin alike.
///
/// ```
/// use qrt_runtime::replace_file::checkpoint_of;
/// use std::path::Path;
/// assert_eq!(checkpoint_of(Path::new("a/box.png")), Path::new("a/box.png.qrt-partial"));
/// let long = checkpoint_of(Path::new(&format!("{}.png", "x".repeat(250))));
/// assert_eq!(long.as_os_str().len(), 255);
/// ```
pub fn checkpoint_of(picture: &Path) -> PathBuf {
    let name = picture.file_name().unwrap_or_default();
    let mut partial = shortened(name, PARTIAL.len());
    partial.push(PARTIAL);
    picture.with_file_name(partial)
}

/// `name`, if `more` bytes fit behind it; or else as much of its beginning as does, `~` and a checksum of
/// all of it.
fn shortened(name: &OsStr, more: usize) -> OsString {
    let room = LONGEST_NAME - more;
    if name.len() <= room {
        return name.to_owned();
    }
    let sum = format!("~{:08x}", crc32fast::hash(name.as_encoded_bytes()));
    let text = name.to_string_lossy();
    let start = &text[..text.floor_char_boundary(room - sum.len())];
    OsString::from(format!("{start}{sum}"))
}

/// Removes the partial files of `target` that processes left which were killed: those that nobody
/// has locked. What can't be looked at or removed stays.
pub(crate) fn remove_abandoned(target: &Path) {
    let Some(name) = target.file_name() else {
        return;
    };
    let entries = fs::read_dir(disk::folder(target)).into_iter().flatten();
    for entry in entries.flatten() {
        if !is_partial_name(&entry.file_name(), name) {
            continue;
        }
        let path = target.with_file_name(entry.file_name());
        let Ok(file) = disk::open(&path, false) else {
            continue;
        };
        let ours = matches!(file.try_lock(), Ok(Lock::Ours));
        // A process that wrote it may have given it its name meanwhile.
        if ours && file.has_its_name().unwrap_or(false) {
            let _ = disk::remove(&path);
        }
    }
}

/// Gives a file the permissions of the one that it will replace.
#[cfg(unix)]
fn keep_permissions(file: &DiskFile, replaced: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    // Reading, writing and running; whose the file is may change, and so no `setuid`.
    let mode = replaced.permissions().mode() & 0o777;
    if file.metadata()?.permissions().mode() & 0o777 == mode {
        return Ok(());
    }
    file.set_permissions(fs::Permissions::from_mode(mode))
}

#[cfg(not(unix))]
fn keep_permissions(_: &DiskFile, _: &Metadata) -> io::Result<()> {
    Ok(())
}
