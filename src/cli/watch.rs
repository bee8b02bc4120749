//! `qrt render --watch`: renders again whenever a file of the scene is saved.

use super::failure::Failure;
use super::terminal;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, SystemTime};

/// Interval between two looks at the files.
const TICK: Duration = Duration::from_millis(100);

/// Files with their times of last change; `None` for a file that does not exist.
#[derive(Debug, PartialEq)]
struct Times(Vec<(PathBuf, Option<(SystemTime, u64)>)>);

impl Times {
    fn read(files: &[PathBuf]) -> Self {
        let time = |path: &PathBuf| {
            let found = std::fs::metadata(path).ok()?;
            Some((found.modified().ok()?, found.len()))
        };
        Self(
            files
                .iter()
                .map(|path| (path.clone(), time(path)))
                .collect(),
        )
    }

    fn changed(&self) -> bool {
        let files: Vec<PathBuf> = self.0.iter().map(|(path, _)| path.clone()).collect();
        *self != Self::read(&files)
    }
}

/// Calls `render` now, and again whenever one of its files changes, until `interrupted`. `render` ends
/// early when its flag says that its input is out of date, and adds the files that it reads to the list.
/// Its errors are printed; the next change is a new attempt.
///
/// # Errors
/// At first, an error in the command line, which no change of a file would mend.
pub(crate) fn watch(
    scene: &Path,
    interrupted: &AtomicBool,
    mut render: impl FnMut(&AtomicBool, &mut Vec<PathBuf>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let mut files = vec![scene.to_owned()];
    let mut first = true;
    while !interrupted.load(Ordering::Relaxed) {
        // The times are taken before the files are read, so a file saved meanwhile is read again.
        let before = Times::read(&files);
        let (outdated, done) = (AtomicBool::new(false), AtomicBool::new(false));
        let mut read = vec![scene.to_owned()];
        let result = std::thread::scope(|threads| {
            threads.spawn(|| {
                while !done.load(Ordering::Relaxed) {
                    std::thread::sleep(TICK);
                    if interrupted.load(Ordering::Relaxed) || before.changed() {
                        outdated.store(true, Ordering::Relaxed);
                    }
                }
            });
            let result = render(&outdated, &mut read);
            done.store(true, Ordering::Relaxed);
            result
        });
        if let Err(failure) = result
            && !outdated.load(Ordering::Relaxed)
        {
            if first && matches!(failure, Failure::Usage(_)) {
                return Err(failure);
            }
            terminal::error(&failure);
        }
        first = false;
        // An unreadable scene names no files, so the previous list is kept.
        if read.len() >= files.len() {
            files = read;
        }
        let after = Times::read(&files);
        let stale = |path: &PathBuf| {
            let of = |times: &Times| times.0.iter().find(|(own, _)| own == path).cloned();
            of(&before).is_some_and(|then| Some(then) != of(&after))
        };
        if files.iter().any(stale) {
            continue;
        }
        while !interrupted.load(Ordering::Relaxed) && !after.changed() {
            std::thread::sleep(TICK);
        }
    }
    Ok(())
}
