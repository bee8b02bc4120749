//! Fault injection for tests: any operation below a watched folder, in any thread, can be made to
//! fail.

use super::Operation;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

static WATCHED: Mutex<Vec<Arc<Watch>>> = Mutex::new(Vec::new());

/// A watched folder. Dropping it ends the watch.
pub(crate) struct Watched(Arc<Watch>);

struct Watch {
    folder: PathBuf,
    state: Mutex<State>,
}

struct State {
    plan: Plan,
    /// The operations so far.
    done: Vec<Operation>,
    disk: Durable,
}

/// The fault to inject.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Plan {
    Nothing,
    /// The operation of this number, counted from 0, fails.
    Fail(usize),
    /// The operation of this number and all later ones fail, and nothing more reaches the disk.
    Cut(usize),
}

/// A file: its inode number, and how many files were created with that inode number while watched.
type Id = (u64, u32);

/// The names of the files in a folder, and the contents of each file.
type Listed = (BTreeMap<PathBuf, Id>, BTreeMap<Id, Vec<u8>>);

/// The durable state of a folder, which survives a power cut: its names at their last sync, and
/// each file's contents at the last sync of that file.
#[derive(Clone, Default)]
struct Durable {
    names: BTreeMap<PathBuf, Id>,
    contents: BTreeMap<Id, Vec<u8>>,
    /// Number of files created with each inode number.
    created: BTreeMap<u64, u32>,
    /// The folder at the time of the power cut, synced or not.
    seen: Option<Listed>,
}

impl Durable {
    fn id(&self, found: &fs::Metadata) -> Id {
        let number = number(found);
        (number, self.created.get(&number).copied().unwrap_or(0))
    }

    fn listed(&self, folder: &Path) -> Listed {
        let mut listed = Listed::default();
        for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
            let id = self.id(&entry.metadata().unwrap());
            listed.1.insert(id, fs::read(entry.path()).unwrap());
            listed.0.insert(entry.path(), id);
        }
        listed
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(unix)]
fn number(found: &fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(found)
}

#[cfg(not(unix))]
fn number(_: &fs::Metadata) -> u64 {
    0
}

impl Watched {
    /// Watches `folder`, and takes all its present files as durable.
    pub(crate) fn new(folder: &Path, plan: Plan) -> Self {
        let folder = fs::canonicalize(folder).unwrap();
        let mut disk = Durable::default();
        (disk.names, disk.contents) = disk.listed(&folder);
        let done = Vec::new();
        let state = Mutex::new(State { plan, done, disk });
        let watch = Arc::new(Watch { folder, state });
        locked(&WATCHED).push(Arc::clone(&watch));
        Self(watch)
    }

    /// All operations so far, including those that failed.
    pub(crate) fn done(&self) -> Vec<Operation> {
        locked(&self.0.state).done.clone()
    }

    /// Ends the watch, and changes the folder to its state after a power cut: only synced names and
    /// contents remain. For each name and each file's contents, `luck` decides whether an unsynced
    /// change survives too.
    pub(crate) fn after_the_cut(self, mut luck: impl FnMut() -> bool) {
        let folder = self.0.folder.clone();
        let disk = locked(&self.0.state).disk.clone();
        drop(self);
        let now = disk.listed(&folder);
        for path in now.0.keys() {
            fs::remove_file(path).unwrap();
        }
        let (seen, written) = disk.seen.unwrap_or(now);
        let all = disk.names.keys().chain(seen.keys());
        for name in all.cloned().collect::<std::collections::BTreeSet<_>>() {
            let names = if luck() { &seen } else { &disk.names };
            let Some(file) = names.get(&name) else {
                continue;
            };
            let synced = disk.contents.get(file).cloned().unwrap_or_default();
            let written = written.get(file).unwrap_or(&synced);
            // An unsynced write may reach the disk whole, or only its beginning.
            let bytes = match luck() {
                true if luck() => &written[..],
                true => &written[..synced.len().midpoint(written.len()).min(written.len())],
                false => &synced[..],
            };
            fs::write(name, bytes).unwrap();
        }
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        locked(&WATCHED).retain(|watch| !Arc::ptr_eq(watch, &self.0));
    }
}

fn watching(path: &Path) -> Option<Arc<Watch>> {
    let path = fs::canonicalize(super::folder(path)).ok()?;
    let watched = locked(&WATCHED);
    let found = watched.iter().find(|watch| path.starts_with(&watch.folder));
    found.cloned()
}

/// Records an operation, and fails if the plan says so.
pub(super) fn begin(operation: Operation, path: &Path) -> io::Result<()> {
    let own = path.join("file");
    let path = if operation == Operation::SyncFolder {
        &own
    } else {
        path
    };
    let Some(watch) = watching(path) else {
        return Ok(());
    };
    let mut state = locked(&watch.state);
    let number = state.done.len();
    state.done.push(operation);
    match state.plan {
        Plan::Fail(which) if which == number => Err(io::Error::other("a fault of this test")),
        Plan::Cut(from) if from <= number => {
            if state.disk.seen.is_none() {
                state.disk.seen = Some(state.disk.listed(&watch.folder));
            }
            Err(io::Error::other("the power is cut"))
        }
        _ => {
            if operation == Operation::SyncFolder {
                state.disk.names = state.disk.listed(&watch.folder).0;
            }
            Ok(())
        }
    }
}

/// Records that a file's contents are durable.
pub(super) fn synced(path: &Path, file: &File) {
    use std::io::{Read as _, Seek as _, SeekFrom};
    let Some(watch) = watching(path) else {
        return;
    };
    let mut file = file;
    let at = file.stream_position().unwrap();
    let mut bytes = Vec::new();
    file.rewind().unwrap();
    file.read_to_end(&mut bytes).unwrap();
    file.seek(SeekFrom::Start(at)).unwrap();
    let mut state = locked(&watch.state);
    let id = state.disk.id(&file.metadata().unwrap());
    state.disk.contents.insert(id, bytes);
}

/// Records that a file was created.
pub(super) fn created(path: &Path, file: &File) {
    let Some(watch) = watching(path) else {
        return;
    };
    let number = number(&file.metadata().unwrap());
    *locked(&watch.state).disk.created.entry(number).or_default() += 1;
}
