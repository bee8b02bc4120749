//! Problems and their places, collected so that an author sees all of them at once.
//!
//! A problem of a scene names its place by [`Path`], never by line. The front end that read the
//! scene converts the path into file, line and column (or a token's span). A problem of the text
//! itself has its [`Span`] from the start.

use super::kinds::{Description, What};
use super::path::{Path, Place, Step};
use super::tree::Span;
use std::collections::HashSet;
use std::ops::Range;

/// A problem and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The kind of the problem, with its arguments.
    pub what: What,
    /// The place of the problem.
    pub at: At,
    /// The byte range within the string at that place, if the problem concerns only a part of it.
    pub within: Option<Range<usize>>,
    /// A second relevant place, such as the first definition of a duplicate.
    pub also: Option<At>,
}

/// The place of a problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum At {
    /// The value at this path in the scene. If the scene could not be read, the root path stands
    /// for the file.
    Path(Path),
    /// A place in the text.
    Span(Span),
}

impl From<Path> for At {
    fn from(path: Path) -> Self {
        Self::Path(path)
    }
}

impl From<&Place<'_>> for Path {
    fn from(place: &Place<'_>) -> Self {
        place.path()
    }
}

impl From<Span> for At {
    fn from(span: Span) -> Self {
        Self::Span(span)
    }
}

impl Problem {
    /// Creates a problem at the place `at`.
    pub fn new(at: impl Into<At>, what: impl Into<What>) -> Self {
        Self {
            what: what.into(),
            at: at.into(),
            within: None,
            also: None,
        }
    }

    /// Adds a second relevant place.
    pub fn also(mut self, at: impl Into<At>) -> Self {
        self.also = Some(at.into());
        self
    }

    /// The problem's path in the scene; `None` for a problem of the text.
    pub fn path(&self) -> Option<&Path> {
        match &self.at {
            At::Path(path) => Some(path),
            At::Span(_) => None,
        }
    }

    /// Returns the problem in words, for the author of a scene's text.
    pub fn description(&self) -> Description {
        self.what.description()
    }

    /// The problem's stable code: `QRT0101`.
    pub fn code(&self) -> &'static str {
        self.description().code
    }

    /// Prefixes the problem's paths with `path`.
    pub fn below(mut self, path: &Path) -> Self {
        for at in [Some(&mut self.at), self.also.as_mut()]
            .into_iter()
            .flatten()
        {
            if let At::Path(inner) = at {
                inner.0.splice(0..0, path.0.iter().cloned());
            }
        }
        self
    }
}

/// Maximum number of problems that [`Problems`] keeps.
pub(crate) const KEPT: usize = 1 << 16;

/// The problems found so far, collected by all readers and checks.
///
/// A faulty value is reported, marked, and replaced by a harmless one, so that the rest is still
/// read and checked. Later problems about a marked value are suppressed, because the first problem
/// may be their only cause.
#[derive(Debug, Default)]
pub struct Problems {
    /// At most [`KEPT`] problems: more are of no use to a reader, and a hostile scene may have any
    /// number.
    found: Vec<Problem>,
    /// Values that were replaced or are out of range.
    marked: Vec<Path>,
    /// `places` holds the marked values, `above` all values that contain one. Both are empty until
    /// [`Problems::finalize`].
    places: HashSet<Path>,
    above: HashSet<Path>,
}

impl Problems {
    /// Adds a problem at `at`, unless it concerns a marked value.
    pub fn add(&mut self, at: impl Into<At>, what: impl Into<What>) {
        self.push(Problem::new(at, what));
    }

    /// Adds a problem as [`Problems::add`] does.
    pub fn push(&mut self, problem: Problem) {
        let follows = |at: &At| matches!(at, At::Path(path) if self.touches(path));
        if self.found.len() < KEPT
            && !follows(&problem.at)
            && !problem.also.as_ref().is_some_and(follows)
        {
            self.found.push(problem);
        }
    }

    /// Adds a problem about the value at `path`, and marks the value as unreliable.
    pub fn refuse(&mut self, path: impl Into<Path>, what: impl Into<What>) {
        if self.found.len() < KEPT {
            let path = path.into();
            self.mark(path.clone());
            self.found.push(Problem::new(path, what));
        }
    }

    /// Marks the value at `path` as unreliable.
    pub fn mark(&mut self, path: Path) {
        self.marked.push(path);
    }

    /// Suppresses problems about marked values from now on.
    pub fn finalize(&mut self) {
        for path in std::mem::take(&mut self.marked) {
            let path = path.values();
            for length in 0..path.0.len() {
                self.above.insert(Path(path.0[..length].to_vec()));
            }
            self.places.insert(path);
        }
    }

    /// True if the value at `path`, or a value that contains it, is marked.
    pub fn covers(&self, path: &Path) -> bool {
        let path = path.values();
        (0..=path.0.len()).any(|n| self.places.contains(&Path(path.0[..n].to_vec())))
    }

    /// True if the value at `path` is marked, lies within a marked value, or contains one.
    pub fn touches(&self, path: &Path) -> bool {
        !self.places.is_empty() && (self.covers(path) || self.above.contains(&path.values()))
    }

    /// Returns the problems added after the first `count`.
    pub fn since(&mut self, count: usize) -> &mut [Problem] {
        &mut self.found[count..]
    }

    /// Number of problems.
    pub fn count(&self) -> usize {
        self.found.len()
    }

    /// All problems, in the order found.
    pub fn all(self) -> Vec<Problem> {
        self.found
    }

    /// Returns `value` if there are no problems.
    ///
    /// # Errors
    /// All problems, if there are any.
    pub fn result<T>(self, value: T) -> Result<T, Vec<Problem>> {
        if self.found.is_empty() {
            Ok(value)
        } else {
            Err(self.found)
        }
    }
}

impl Extend<Problem> for Problems {
    fn extend<I: IntoIterator<Item = Problem>>(&mut self, problems: I) {
        for problem in problems {
            self.push(problem);
        }
    }
}

impl Path {
    /// Returns the path with each step to a key's name replaced by the step to its value.
    fn values(&self) -> Self {
        let value = |step: &Step| match step {
            Step::Name(name) => Step::Key(name.clone()),
            other => other.clone(),
        };
        Self(self.0.iter().map(value).collect())
    }
}
