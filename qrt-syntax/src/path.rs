//! Places in a scene: `materials.cloth.bsdf.value[0]`.

use std::fmt;

/// One step into a scene.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// The value of a key.
    Key(String),
    /// The key itself, if the problem is the key's name.
    Name(String),
    /// An element of a list, from 0.
    Item(usize),
}

/// A path to a place in a scene: `materials.cloth.bsdf.value[0]`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Path(pub Vec<Step>);

impl Path {
    /// The scene itself.
    pub fn root() -> Self {
        Self::default()
    }
    /// Returns the path of the value of `key` below this path.
    pub fn key(&self, key: impl Into<String>) -> Self {
        self.with(Step::Key(key.into()))
    }
    /// Returns the path of the key `key` itself below this path.
    pub fn name(&self, key: impl Into<String>) -> Self {
        self.with(Step::Name(key.into()))
    }
    /// Returns the path of element `index` below this path.
    pub fn item(&self, index: usize) -> Self {
        self.with(Step::Item(index))
    }
    fn with(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }
}

/// Writes the path in the syntax of `--set`: a key with `.`, `=`, `[` or the like is quoted.
impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            let dot = if i == 0 { "" } else { "." };
            match step {
                Step::Key(key) | Step::Name(key) if is_plain(key) => write!(f, "{dot}{key}")?,
                Step::Key(key) | Step::Name(key) => {
                    let escaped = key.replace('\\', "\\\\").replace('"', "\\\"");
                    write!(f, "{dot}\"{escaped}\"")?;
                }
                Step::Item(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// True if a key needs no quotation marks in a path.
fn is_plain(key: &str) -> bool {
    !key.is_empty() && key.trim() == key && !key.starts_with('"') && !key.contains(['.', '=', '['])
}

/// A path under construction: a linked list on the stack, without allocation.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    parent: Option<&'a Place<'a>>,
    step: At<'a>,
}

#[derive(Clone, Copy, Debug)]
enum At<'a> {
    Root,
    Key(&'a str),
    Item(usize),
}

impl<'a> Place<'a> {
    /// The scene itself.
    pub const ROOT: Place<'static> = Place {
        parent: None,
        step: At::Root,
    };

    /// Returns the place of the value of `key` below this place.
    pub fn key(&'a self, key: &'a str) -> Place<'a> {
        self.with(At::Key(key))
    }

    /// Returns the place of element `index` below this place.
    pub fn item(&'a self, index: usize) -> Place<'a> {
        self.with(At::Item(index))
    }

    fn with(&'a self, step: At<'a>) -> Place<'a> {
        let parent = Some(self);
        Place { parent, step }
    }

    /// Converts the place to a [`Path`].
    pub fn path(&self) -> Path {
        let mut steps = Vec::new();
        let mut place = Some(self);
        while let Some(Place { parent, step }) = place {
            match step {
                At::Root => {}
                At::Key(key) => steps.push(Step::Key((*key).to_owned())),
                At::Item(index) => steps.push(Step::Item(*index)),
            }
            place = *parent;
        }
        steps.reverse();
        Path(steps)
    }

    /// Returns the path of the final key itself, or of the value if the path does not end in a key.
    /// Problems about missing keys of a map point there.
    pub fn name(&self) -> Path {
        let mut path = self.path();
        if let Some(Step::Key(key)) = path.0.last() {
            let name = Step::Name(key.clone());
            path.0.pop();
            path.0.push(name);
        }
        path
    }
}
