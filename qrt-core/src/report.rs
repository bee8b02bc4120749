//! What is wrong with a scene: problems that name a place in it, gathered so that an author sees
//! them all at once.
//!
//! A problem names its place by [`Path`], never by line: the front end that read the scene turns
//! the path into file, line and column (or a token's span).

pub use crate::scene::decode::{listed, nearest};
use std::collections::HashSet;
use std::fmt;
use std::ops::Range;

/// One step into a scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// The value of a key.
    Key(String),
    /// The key itself, where the problem is the name.
    Name(String),
    /// An element of a list, from 0.
    Item(usize),
}

/// Where in a scene: `materials.cloth.bsdf.value[0]`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Path(pub Vec<Step>);

impl Path {
    /// The scene itself.
    pub fn root() -> Self {
        Self::default()
    }
    /// The value of `key` below this.
    pub fn key(&self, key: impl Into<String>) -> Self {
        self.with(Step::Key(key.into()))
    }
    /// The key `key` itself below this.
    pub fn name(&self, key: impl Into<String>) -> Self {
        self.with(Step::Name(key.into()))
    }
    /// Element `index` below this.
    pub fn item(&self, index: usize) -> Self {
        self.with(Step::Item(index))
    }
    /// The same place, values in place of names.
    fn values(&self) -> Self {
        let value = |step: &Step| match step {
            Step::Name(name) => Step::Key(name.clone()),
            other => other.clone(),
        };
        Self(self.0.iter().map(value).collect())
    }
    fn with(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                Step::Key(key) | Step::Name(key) if i == 0 => write!(f, "{key}")?,
                Step::Key(key) | Step::Name(key) => write!(f, ".{key}")?,
                Step::Item(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// Places whose values are already known to be wrong.
#[derive(Clone, Debug, Default)]
pub(crate) struct Faulty {
    places: HashSet<Path>,
    above: HashSet<Path>,
}

impl Faulty {
    /// Of these places.
    pub(crate) fn of<'a>(paths: impl IntoIterator<Item = &'a Path>) -> Self {
        let mut faulty = Self::default();
        for path in paths {
            let path = path.values();
            for length in 0..path.0.len() {
                faulty.above.insert(Path(path.0[..length].to_vec()));
            }
            faulty.places.insert(path);
        }
        faulty
    }

    /// Whether `path` is one of the places, or within one, or holds one: what is said of it then
    /// may only follow from what is already known.
    pub(crate) fn touches(&self, path: &Path) -> bool {
        let path = path.values();
        let within = (0..=path.0.len()).any(|n| self.places.contains(&Path(path.0[..n].to_vec())));
        within || self.above.contains(&path)
    }
}

/// One thing that is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Stable code: `QRT0101`.
    pub code: &'static str,
    /// Where.
    pub path: Path,
    /// Bytes within the string found at `path`, where the problem is a part of it.
    pub within: Option<Range<usize>>,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// What stands beside the caret; may be empty.
    pub label: String,
    /// The right thing to write.
    pub help: Option<String>,
    /// Another place that matters (first definition of a duplicate, say), and why.
    pub also: Option<(Path, String)>,
}

impl Problem {
    /// A problem at `path`.
    pub fn new(code: &'static str, path: Path, message: impl Into<String>) -> Self {
        Self {
            code,
            path,
            within: None,
            message: message.into(),
            label: String::new(),
            help: None,
            also: None,
        }
    }
    /// With words beside the caret.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }
    /// With the right thing to write.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
    /// Underlining only these bytes of the string at the path.
    pub fn within(mut self, range: Range<usize>) -> Self {
        self.within = Some(range);
        self
    }
    /// With another place that matters.
    pub fn also(mut self, path: Path, why: impl Into<String>) -> Self {
        self.also = Some((path, why.into()));
        self
    }
}
