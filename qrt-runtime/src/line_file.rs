//! A text file that grows line by line, and whose finished lines survive a crash.

#[cfg(test)]
mod tests;

use crate::disk::{self, DiskFile};
use crate::replace_file::replaced;
use std::fs;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A text file, locked against other processes until it is dropped. Each write is durable when its
/// function returns: neither a kill nor a power cut loses it.
///
/// ```
/// use qrt_runtime::line_file::LineFile;
/// let path = std::env::temp_dir().join(format!("qrt-doc-{}.csv", std::process::id()));
/// let Some(mut file) = LineFile::open(&path)? else {
///     panic!("another process writes this file");
/// };
/// file.start("x,y\n")?;
/// file.append("1,2\n")?;
/// drop(file);
/// assert_eq!(std::fs::read_to_string(&path)?, "x,y\n1,2\n");
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), std::io::Error>(())
/// ```
pub struct LineFile {
    file: DiskFile,
    path: PathBuf,
}

impl LineFile {
    /// Opens the file at `path`, or creates it. `None` if another process has it open.
    ///
    /// # Errors
    /// Errors of the file system; a link or a device has the kind
    /// [`InvalidInput`](io::ErrorKind::InvalidInput).
    pub fn open(path: &Path) -> io::Result<Option<Self>> {
        let file = disk::open_locked(path, true)?;
        let path = path.to_path_buf();
        Ok(file.map(|file| Self { file, path }))
    }

    /// Reads the whole file. The next [`append`](Self::append) writes at its end.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn read(&mut self) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.file.rewind()?;
        self.file.read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    /// Drops the bytes from the offset `end` on. The next [`append`](Self::append) writes there.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn truncate(&mut self, end: u64) -> io::Result<()> {
        self.file.set_len(end)?;
        self.file.seek(SeekFrom::Start(end)).map(drop)
    }

    /// Drops all bytes, and writes `text` in their place. Makes the file's name durable, too.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn start(&mut self, text: &str) -> io::Result<()> {
        self.truncate(0)?;
        self.append(text)?;
        disk::sync_folder(&self.path)
    }

    /// Writes `text` after the bytes that were read or written last.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn append(&mut self, text: &str) -> io::Result<()> {
        self.file.write_all(text.as_bytes())?;
        self.file.sync()
    }

    /// Replaces the file by one that holds `text`, all or nothing, and creates the folder if it is
    /// missing. The lock passes to the new file before that takes the name.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn replace(&mut self, text: &str) -> io::Result<()> {
        fs::create_dir_all(disk::folder(&self.path))?;
        self.file = replaced(&self.path, |out| out.write_all(text.as_bytes()))?;
        self.truncate(text.len() as u64)
    }

    /// Returns true if the file has lost its name, and no other file has it.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn is_removed(&self) -> io::Result<bool> {
        Ok(!self.file.has_its_name()? && !self.path.exists())
    }
}
