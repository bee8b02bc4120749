//! Writing a result so that its name never shows an incomplete file.
//!
//! The crate `tempfile` has some of these steps: a new file of random name in the same folder, its
//! removal on drop, and the rename. It would replace the loop over names in `Partial::beside` alone.
//! The partial file is locked before anything is written and until it has its final name, so that the
//! next write recognises and removes the files of killed processes; its name is derived from the final
//! one and fits into 255 bytes; the file and its folder are synced; and every step is an operation of
//! [`crate::disk`], where tests make each one fail.

#[cfg(test)]
mod tests;

use crate::disk::{self, DiskFile, Lock, ResolvedPath};
use std::collections::hash_map::RandomState;
use std::ffi::{OsStr, OsString};
use std::fs::{self, Metadata};
use std::hash::{BuildHasher as _, Hasher as _};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Suffix of the names of partial files and checkpoints.
pub const PARTIAL: &str = ".qrt-partial";

/// Hexadecimal digits of a partial file's random number.
const RANDOM_DIGITS: usize = 16;

/// The longest name that file systems in use give a file, in bytes.
const LONGEST_NAME: usize = 255;

/// Number of random names that are tried before an error.
const ATTEMPTS: u32 = 64;

/// Writes the file at `path`, through `write`, all or nothing. qrt writes the bytes to a partial
/// file beside it (`NAME.16 random hexadecimal digits.qrt-partial`), with the permissions of the
/// file that it replaces, and renames it to `path` once everything is on the disk. If anything
/// fails, the old file at `path` is still complete, and the partial file is removed. A process that
/// is killed meanwhile leaves only the partial file behind; the next call for the same file removes
/// it. A link is followed, even to a file that does not exist yet. A device or pipe cannot be
/// replaced and is written to directly. The same holds for `/dev/stdout`, to whatever file a shell
/// has redirected it.
///
/// # Errors
/// Errors of `write` and of the file system.
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
    // The lock is held until the file has its final name.
    replaced(path, write).map(drop)
}

/// As [`replace_file`], but returns the file, open and locked.
pub(crate) fn replaced<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<DiskFile>) -> Result<(), E>,
) -> Result<DiskFile, E> {
    let place = ResolvedPath::resolve(path)?;
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

/// Checks that a file can be written at `place`: creates a partial file beside it and removes that.
///
/// # Errors
/// Errors of the file system.
pub fn try_writing(place: &ResolvedPath) -> io::Result<()> {
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

/// A partial file's name. Unless the file was renamed, dropping this value removes it.
struct Partial {
    path: PathBuf,
    renamed: bool,
}

impl Partial {
    /// A new file beside the one at `place`, locked until it is closed.
    fn beside(place: &ResolvedPath) -> io::Result<(Self, DiskFile)> {
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
            // Another process may have taken the file for abandoned before it was locked.
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
            // A destructor cannot report an error, and the next write to the same file tries again.
            let _ = disk::remove(&self.path);
        }
    }
}

/// Returns an unpredictable name: `NAME.16 hexadecimal digits.qrt-partial`.
fn partial_name(name: &OsStr) -> OsString {
    // The system's random numbers key the hasher.
    let random = RandomState::new().build_hasher().finish();
    let mut partial = shortened(name, RANDOM_DIGITS + 1 + PARTIAL.len());
    partial.push(format!(".{random:016x}{PARTIAL}"));
    partial
}

/// Returns whether `partial` is the name of a partial file of `name`.
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

/// Path of a picture's checkpoint: beside the picture, its name and [`PARTIAL`]. A name that is too
/// long for that is cut, and a checksum of the whole name distinguishes it from others that begin
/// alike.
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

/// Returns `name`, if `more` bytes fit behind it. Otherwise returns the part of its beginning that
/// fits, `~` and a checksum of the whole name.
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

/// Removes the partial files of `target` that killed processes left: those that no process has
/// locked. A file that can't be opened or removed stays.
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
        // The process that wrote it may have renamed it meanwhile.
        if ours && file.has_its_name().unwrap_or(false) {
            let _ = disk::remove(&path);
        }
    }
}

/// Gives a file the permissions of the one that it will replace.
#[cfg(unix)]
fn keep_permissions(file: &DiskFile, replaced: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    // Read, write and execute bits only: the new file's owner may differ, so it must not inherit
    // `setuid`.
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
