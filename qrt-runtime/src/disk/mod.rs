//! File operations of results and checkpoints; each operation that can fail has one function here.
//!
//! These functions never follow links: [`ResolvedPath`] resolves a path beforehand. A test can make
//! any operation fail, or cut the power before it: see `faults`.

#[cfg(test)]
pub(crate) mod faults;
mod place;

pub use place::ResolvedPath;
pub(crate) use place::folder;

use place::Identity;
use std::fs::{self, File, Metadata, OpenOptions, Permissions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// An operation on a file or folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(test, derive(PartialOrd, Ord))]
pub(crate) enum Operation {
    Create,
    Open,
    Write,
    SetLength,
    SetPermissions,
    Sync,
    Lock,
    Rename,
    Remove,
    SyncFolder,
}

#[cfg(test)]
use faults::begin;

/// Called before an operation on the file or folder at a path. In tests, it may fail.
#[cfg(not(test))]
#[expect(clippy::unnecessary_wraps, reason = "tests have another")]
fn begin(_: Operation, _: &Path) -> io::Result<()> {
    Ok(())
}

/// Returns whether a locking error means that the file system has no locks. Some of Linux's network
/// file systems return ENOLCK, 37, which has no [`ErrorKind`].
pub(crate) fn has_no_locks(error: &io::Error) -> bool {
    let enolck = cfg!(target_os = "linux") && error.raw_os_error() == Some(37);
    error.kind() == ErrorKind::Unsupported || enolck
}

/// An open file.
#[derive(Debug)]
pub struct DiskFile {
    file: File,
    /// The name under which the file was opened, or its last name since.
    path: PathBuf,
}

/// The holder of a file's lock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lock {
    Ours,
    Others,
    /// No lock: some network file systems have none.
    None,
}

/// Creates a file; an error if a file or a link is there.
pub(crate) fn create_new(path: &Path) -> io::Result<DiskFile> {
    begin(Operation::Create, path)?;
    let mut options = OpenOptions::new();
    let options = options.read(true).write(true).create_new(true);
    let file = (options.open(path)).map_err(|error| naming_folder(path, error))?;
    #[cfg(test)]
    faults::created(path, &file);
    Ok(DiskFile::new(file, path))
}

/// Flags that refuse a name that has become a link, and don't wait for the writer of a pipe.
#[cfg(unix)]
const OPEN_FLAGS: i32 = libc::O_NOFOLLOW | libc::O_NONBLOCK;
/// Number of attempts to open a file whose name changes meanwhile.
const ATTEMPTS: u32 = 64;

/// Opens the regular file at `path` and locks it against other processes until it is closed.
/// Creates the file if there is none and `create` is set. If the file is removed or replaced before
/// it is locked, opens the file that now has the name. `None` if another process has the lock, or
/// after too many attempts.
pub(crate) fn open_locked(path: &Path, create: bool) -> io::Result<Option<DiskFile>> {
    for _ in 0..ATTEMPTS {
        let file = match open(path, true) {
            Err(error) if create && error.kind() == ErrorKind::NotFound => create_new(path),
            opened => opened,
        };
        let file = match file {
            Ok(file) => file,
            // Another process made or removed the file in the meantime: try again.
            Err(error)
                if create && error.kind() == ErrorKind::NotFound && folder(path).is_dir() =>
            {
                continue;
            }
            Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
            Err(error) => return Err(error),
        };
        if file.try_lock()? == Lock::Others {
            break;
        }
        if file.has_its_name()? {
            return Ok(Some(file));
        }
    }
    Ok(None)
}

/// Opens an existing regular file; for a link or a device the error has the kind
/// [`ErrorKind::InvalidInput`].
pub(crate) fn open(path: &Path, write: bool) -> io::Result<DiskFile> {
    let irregular = || io::Error::new(ErrorKind::InvalidInput, "is no regular file");
    begin(Operation::Open, path)?;
    let before = fs::symlink_metadata(path)?;
    // Opening a pipe may wait for ever, and opening a device may have side effects.
    if !before.is_file() {
        return Err(irregular());
    }
    let mut options = OpenOptions::new();
    options.read(true).write(write);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, OPEN_FLAGS);
    let file = match options.open(path) {
        // The name has become a link.
        #[cfg(unix)]
        Err(error) if error.raw_os_error() == Some(libc::ELOOP) => return Err(irregular()),
        opened => opened?,
    };
    // Another process may have given the name to another file in between.
    let opened = file.metadata()?;
    if !opened.is_file() || Identity::from_metadata(&opened) != Identity::from_metadata(&before) {
        return Err(match fs::symlink_metadata(path) {
            Ok(now) if now.is_file() => io::Error::from(ErrorKind::NotFound),
            Ok(_) => irregular(),
            Err(error) => error,
        });
    }
    Ok(DiskFile::new(file, path))
}

/// Opens a regular file for reading. Pipes, which may never end, and devices are refused before
/// they are opened.
///
/// ```
/// # #[cfg(unix)] {
/// let refused = qrt_runtime::disk::open_regular("/dev/zero".as_ref()).unwrap_err();
/// assert_eq!(refused.to_string(), "it is no regular file");
/// # }
/// ```
///
/// # Errors
/// If the file cannot be opened, or is not a regular file.
pub fn open_regular(path: &Path) -> io::Result<File> {
    let irregular = || {
        Err(io::Error::new(
            ErrorKind::InvalidInput,
            "it is no regular file",
        ))
    };
    if !fs::metadata(path)?.is_file() {
        return irregular();
    }
    let file = File::open(path)?;
    if file.metadata()?.is_file() {
        Ok(file)
    } else {
        irregular()
    }
}

/// Reads a regular file, opened by [`open_regular`].
///
/// # Errors
/// If the file cannot be read, or is not a regular file.
pub fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_regular(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Adds the name of the folder to an `error` of creating a file at `path`, if the folder accepts no
/// new files.
pub fn naming_folder(path: &Path, error: io::Error) -> io::Error {
    use ErrorKind::{NotFound, PermissionDenied, ReadOnlyFilesystem};
    if !matches!(
        error.kind(),
        NotFound | PermissionDenied | ReadOnlyFilesystem
    ) {
        return error;
    }
    let folder = folder(path).display();
    let message = format!("no file can be made in the folder `{folder}`: {error}");
    io::Error::new(error.kind(), message)
}

/// Removes a file.
pub(crate) fn remove(path: &Path) -> io::Result<()> {
    begin(Operation::Remove, path)?;
    fs::remove_file(path)
}

/// Makes the names in the folder of `path` durable. Does nothing where folders can't be opened or
/// synced.
pub(crate) fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = folder(path);
    begin(Operation::SyncFolder, folder)?;
    if !cfg!(unix) {
        return Ok(());
    }
    let synced = match File::open(folder) {
        Ok(opened) => opened.sync_all(),
        Err(error) if error.kind() == ErrorKind::PermissionDenied => return Ok(()),
        Err(error) => return Err(error),
    };
    match synced {
        Err(error)
            if matches!(
                error.kind(),
                ErrorKind::InvalidInput | ErrorKind::Unsupported
            ) =>
        {
            Ok(())
        }
        synced => synced,
    }
}

impl DiskFile {
    fn new(file: File, path: &Path) -> Self {
        let path = path.to_path_buf();
        Self { file, path }
    }

    /// Opens a device or a pipe for writing.
    pub(crate) fn device(path: &Path) -> io::Result<Self> {
        begin(Operation::Open, path)?;
        // Append: the shell may have redirected the device into a file that others write to as
        // well.
        let file = OpenOptions::new().append(true).open(path)?;
        Ok(Self::new(file, path))
    }

    pub(crate) fn metadata(&self) -> io::Result<Metadata> {
        self.file.metadata()
    }

    /// Renames the file, and replaces a file that has the new name.
    pub(crate) fn rename(&mut self, to: &Path) -> io::Result<()> {
        begin(Operation::Rename, &self.path)?;
        fs::rename(&self.path, to)?;
        self.path = to.to_path_buf();
        Ok(())
    }

    /// Returns whether the file still has the name under which it was opened.
    pub(crate) fn has_its_name(&self) -> io::Result<bool> {
        match fs::symlink_metadata(&self.path) {
            Ok(found) => {
                let own = self.file.metadata()?;
                Ok(found.is_file()
                    && Identity::from_metadata(&found) == Identity::from_metadata(&own))
            }
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Locks the file against other processes until it is closed.
    pub(crate) fn try_lock(&self) -> io::Result<Lock> {
        begin(Operation::Lock, &self.path)?;
        match self.file.try_lock() {
            Ok(()) => Ok(Lock::Ours),
            Err(TryLockError::WouldBlock) => Ok(Lock::Others),
            Err(TryLockError::Error(error)) if has_no_locks(&error) => Ok(Lock::None),
            Err(TryLockError::Error(error)) => Err(error),
        }
    }

    pub(crate) fn set_len(&self, length: u64) -> io::Result<()> {
        begin(Operation::SetLength, &self.path)?;
        self.file.set_len(length)
    }

    pub(crate) fn set_permissions(&self, permissions: Permissions) -> io::Result<()> {
        begin(Operation::SetPermissions, &self.path)?;
        self.file.set_permissions(permissions)
    }

    /// Makes the contents and the length of the file durable.
    pub(crate) fn sync(&self) -> io::Result<()> {
        begin(Operation::Sync, &self.path)?;
        self.file.sync_data()?;
        #[cfg(test)]
        faults::synced(&self.path, &self.file);
        Ok(())
    }
}

impl Write for DiskFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Err(error) = begin(Operation::Write, &self.path) {
            // A full disk accepts the bytes that it has room for, so the fault writes half of them.
            let _ = self.file.write(&bytes[..bytes.len() / 2]);
            return Err(error);
        }
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Read for DiskFile {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.file.read(bytes)
    }
}

impl Seek for DiskFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}
