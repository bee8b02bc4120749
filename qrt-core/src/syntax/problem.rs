//! Problems with places, gathered so that an author sees them all at once.
//!
//! A problem of a scene names its place by [`Path`], never by line: the front end that read the scene
//! turns the path into file, line and column (or a token's span). One of the text itself has its
//! [`Span`] from the beginning.

use super::kinds::{What, Words};
use super::path::{Path, Place, Step};
use super::tree::Span;
use std::collections::HashSet;
use std::ops::Range;

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// What is wrong.
    pub what: What,
    /// Where the problem is.
    pub at: At,
    /// Bytes within the string found there, where the problem is a part of it.
    pub within: Option<Range<usize>>,
    /// Another place that matters: the first definition of a duplicate, say.
    pub also: Option<At>,
}

/// Where a problem is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum At {
    /// What this path leads to in the scene; the root of a scene that could not be read is the
    /// file.
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
    /// A problem at this place.
    pub fn new(at: impl Into<At>, what: impl Into<What>) -> Self {
        Self {
            what: what.into(),
            at: at.into(),
            within: None,
            also: None,
        }
    }

    /// The same problem with another place that matters.
    pub fn also(mut self, at: impl Into<At>) -> Self {
        self.also = Some(at.into());
        self
    }

    /// The problem's path in the scene; none for a problem of the text.
    pub fn path(&self) -> Option<&Path> {
        match &self.at {
            At::Path(path) => Some(path),
            At::Span(_) => None,
        }
    }

    /// How a scene's text is told of it.
    pub fn words(&self) -> Words {
        self.what.words()
    }

    /// The problem's stable code: `QRT0101`.
    pub fn code(&self) -> &'static str {
        self.words().code
    }

    /// This, of something that stands at `path`.
    pub(crate) fn below(mut self, path: &Path) -> Self {
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

/// As many problems are kept.
pub(crate) const KEPT: usize = 1 << 16;

/// Everything that is wrong so far: the one gatherer of all readers and checks.
///
/// A value that cannot be taken as it is gets reported, marked, and replaced by a harmless one, so that
/// the rest is still read and checked. What is found later about such values is not said: it may only
/// follow from what is known.
#[derive(Debug, Default)]
pub struct Problems {
    /// At most [`KEPT`]: nobody reads more, and a hostile scene may have any number.
    found: Vec<Problem>,
    /// Values that are replaced, or out of their range.
    marked: Vec<Path>,
    /// These, and all that holds one of them; both empty until [`Problems::finalize`].
    places: HashSet<Path>,
    above: HashSet<Path>,
}

impl Problems {
    /// Adds a problem, unless it only follows from what is known.
    pub fn add(&mut self, at: impl Into<At>, what: impl Into<What>) {
        self.push(Problem::new(at, what));
    }

    /// As [`Problems::add`].
    pub fn push(&mut self, problem: Problem) {
        let follows = |at: &At| matches!(at, At::Path(path) if self.touches(path));
        if self.found.len() < KEPT
            && !follows(&problem.at)
            && !problem.also.as_ref().is_some_and(follows)
        {
            self.found.push(problem);
        }
    }

    /// Adds a problem about the value at `path`, which is not to be relied on.
    pub(crate) fn refuse(&mut self, path: impl Into<Path>, what: impl Into<What>) {
        if self.found.len() < KEPT {
            let path = path.into();
            self.mark(path.clone());
            self.found.push(Problem::new(path, what));
        }
    }

    /// The value at `path` is not to be relied on.
    pub(crate) fn mark(&mut self, path: Path) {
        self.marked.push(path);
    }

    /// From here on, nothing is said of what is marked.
    pub(crate) fn finalize(&mut self) {
        for path in std::mem::take(&mut self.marked) {
            let path = path.values();
            for length in 0..path.0.len() {
                self.above.insert(Path(path.0[..length].to_vec()));
            }
            self.places.insert(path);
        }
    }

    /// Whether the value at `path`, or one that holds it, is marked.
    pub(crate) fn covers(&self, path: &Path) -> bool {
        let path = path.values();
        (0..=path.0.len()).any(|n| self.places.contains(&Path(path.0[..n].to_vec())))
    }

    /// Whether `path` is marked, or is within what is, or holds some of it.
    pub(crate) fn touches(&self, path: &Path) -> bool {
        !self.places.is_empty() && (self.covers(path) || self.above.contains(&path.values()))
    }

    /// The problems added since there were `count` of them.
    pub(crate) fn since(&mut self, count: usize) -> &mut [Problem] {
        &mut self.found[count..]
    }

    /// How many problems there are.
    pub fn count(&self) -> usize {
        self.found.len()
    }

    /// All problems, in the order found.
    pub fn all(self) -> Vec<Problem> {
        self.found
    }

    /// `value`, if nothing is wrong.
    ///
    /// # Errors
    /// Everything that is wrong.
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
    /// The same place, values in place of names.
    fn values(&self) -> Self {
        let value = |step: &Step| match step {
            Step::Name(name) => Step::Key(name.clone()),
            other => other.clone(),
        };
        Self(self.0.iter().map(value).collect())
    }
}
