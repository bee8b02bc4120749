//! The file system, as far as results and checkpoints use it: each operation that can fail, once.
//!
//! Links are never followed here: what a path leads to is found beforehand, by [`Place`]. Under test,
//! any operation can be made to fail, or the power to be cut before it: see `faults`.

#[cfg(test)]
pub(crate) mod faults;
mod place;

pub use place::Place;
pub(crate) use place::folder;

use place::Identity;
use std::fs::{self, File, Metadata, OpenOptions, Permissions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// What is done to files.
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

/// Before an operation on the file or folder at a path: under test, it may fail.
#[cfg(not(test))]
#[expect(clippy::unnecessary_wraps, reason = "tests have another")]
fn begin(_: Operation, _: &Path) -> io::Result<()> {
    Ok(())
}

/// Whether an error of locking says that the file system has no locks. Some of Linux's network file systems
/// say so by ENOLCK, 37, which has no kind.
pub(crate) fn has_no_locks(error: &io::Error) -> bool {
    let enolck = cfg!(target_os = "linux") && error.raw_os_error() == Some(37);
    error.kind() == ErrorKind::Unsupported || enolck
}

/// An open file.
#[derive(Debug)]
pub struct DiskFile {
    file: File,
    /// The name under which it was opened, or that it was given since.
    path: PathBuf,
}

/// Who has a file's lock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lock {
    Ours,
    Others,
    /// Some network file systems have no locks.
    None,
}

/// Makes a file where there is none, nor a link.
pub(crate) fn create_new(path: &Path) -> io::Result<DiskFile> {
    begin(Operation::Create, path)?;
    let mut options = OpenOptions::new();
    let options = options.read(true).write(true).create_new(true);
    let file = (options.open(path)).map_err(|error| naming_folder(path, error))?;
    #[cfg(test)]
    faults::created(path, &file);
    Ok(DiskFile::new(file, path))
}

/// So that a name that became a link is not followed, and of one that became a pipe no writer is waited for.
#[cfg(unix)]
const OPEN_FLAGS: i32 = libc::O_NOFOLLOW | libc::O_NONBLOCK;
/// How often the file of a name is opened that changes meanwhile.
const ATTEMPTS: u32 = 64;

/// Opens the regular file at `path`, or makes it where that is asked for and there is none, and locks it
/// against other processes until it is closed. None if another has it; of one that was removed or replaced
/// before it was locked, what has its name is opened.
pub(crate) fn open_locked(path: &Path, create: bool) -> io::Result<Option<DiskFile>> {
    for _ in 0..ATTEMPTS {
        let file = match open(path, true) {
            Err(error) if create && error.kind() == ErrorKind::NotFound => create_new(path),
            opened => opened,
        };
        let file = match file {
            Ok(file) => file,
            // It was made or removed meanwhile.
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

/// Opens a regular file that is there; a link or a device is an error of the kind
/// [`ErrorKind::InvalidInput`].
pub(crate) fn open(path: &Path, write: bool) -> io::Result<DiskFile> {
    let irregular = || io::Error::new(ErrorKind::InvalidInput, "is no regular file");
    begin(Operation::Open, path)?;
    let before = fs::symlink_metadata(path)?;
    // A pipe would be waited for, and a device may do anything.
    if !before.is_file() {
        return Err(irregular());
    }
    let mut options = OpenOptions::new();
    options.read(true).write(write);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, OPEN_FLAGS);
    let file = match options.open(path) {
        // It became a link.
        #[cfg(unix)]
        Err(error) if error.raw_os_error() == Some(libc::ELOOP) => return Err(irregular()),
        opened => opened?,
    };
    // The name may have got another file in between.
    let opened = file.metadata()?;
    if !opened.is_file() || Identity::of(&opened) != Identity::of(&before) {
        return Err(match fs::symlink_metadata(path) {
            Ok(now) if now.is_file() => io::Error::from(ErrorKind::NotFound),
            Ok(_) => irregular(),
            Err(error) => error,
        });
    }
    Ok(DiskFile::new(file, path))
}

/// Opens a regular file to be read. Pipes, which may never end, and devices are refused, before they are
/// opened.
///
/// ```
/// # #[cfg(unix)] {
/// let refused = qrt_runtime::disk::open_regular("/dev/zero".as_ref()).unwrap_err();
/// assert_eq!(refused.to_string(), "it is no regular file");
/// # }
/// ```
///
/// # Errors
/// It cannot be opened, or is no regular file.
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

/// The bytes of a regular file: [`open_regular`].
///
/// # Errors
/// It cannot be read, or is no regular file.
pub fn read_regular(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_regular(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The same error of making a file at `path`, with the name of its folder where the folder takes no new
/// files.
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

/// Makes the names in the folder of `path` durable. Where folders can't be opened or have nothing
/// to make durable, there is nothing to be done.
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

    /// A device or a pipe, which is written to as it is.
    pub(crate) fn device(path: &Path) -> io::Result<Self> {
        begin(Operation::Open, path)?;
        // What a shell has led into a file begins where others have ended.
        let file = OpenOptions::new().append(true).open(path)?;
        Ok(Self::new(file, path))
    }

    pub(crate) fn metadata(&self) -> io::Result<Metadata> {
        self.file.metadata()
    }

    /// Gives it another name, in place of a file that has it.
    pub(crate) fn rename(&mut self, to: &Path) -> io::Result<()> {
        begin(Operation::Rename, &self.path)?;
        fs::rename(&self.path, to)?;
        self.path = to.to_path_buf();
        Ok(())
    }

    /// Whether the name under which it was opened is still this file's.
    pub(crate) fn has_its_name(&self) -> io::Result<bool> {
        match fs::symlink_metadata(&self.path) {
            Ok(found) => {
                let own = self.file.metadata()?;
                Ok(found.is_file() && Identity::of(&found) == Identity::of(&own))
            }
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Locks it against other processes until it is closed.
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

    /// Makes its contents durable, and its length.
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
            // A disk that is full takes what it has room for.
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
