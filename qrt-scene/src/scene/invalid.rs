//! The error type of a scene built in Rust that is not valid.

use qrt_syntax::{At, Problem};
use std::fmt;
use std::ops::Deref;

/// The problems of an invalid scene, which [`crate::valid::validate`] returns in place of a
/// [`crate::valid::ValidScene`].
///
/// It implements [`std::error::Error`], so `?` passes it on. Its text shows every problem with its
/// code, its path in the scene and what to write instead. It dereferences to the slice of its
/// problems, which has at least one element.
///
/// ```
/// use qrt_scene::{Film, Scene};
/// use qrt_scene::valid::validate;
///
/// let scene = Scene { film: Film { width: 4, height: 0 }, ..Scene::default() };
/// let invalid = validate(scene, &Default::default()).unwrap_err();
/// assert_eq!(invalid[0].code(), "QRT0201");
/// assert!(invalid.to_string().starts_with("error[QRT0201] at film.height: "), "{invalid}");
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct InvalidScene(Vec<Problem>);

impl InvalidScene {
    pub(crate) fn new(problems: Vec<Problem>) -> Self {
        Self(problems)
    }

    /// The problems, in the order in which they were found.
    pub fn into_problems(self) -> Vec<Problem> {
        self.0
    }
}

impl Deref for InvalidScene {
    type Target = [Problem];
    fn deref(&self) -> &[Problem] {
        &self.0
    }
}

impl IntoIterator for InvalidScene {
    type Item = Problem;
    type IntoIter = std::vec::IntoIter<Problem>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a InvalidScene {
    type Item = &'a Problem;
    type IntoIter = std::slice::Iter<'a, Problem>;
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl fmt::Display for InvalidScene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, problem) in self.iter().enumerate() {
            if place > 0 {
                f.write_str("\n")?;
            }
            let words = problem.description();
            write!(f, "error[{}]", words.code)?;
            match &problem.at {
                At::Path(path) if !path.0.is_empty() => write!(f, " at {path}")?,
                _ => {}
            }
            write!(f, ": {}", words.message)?;
            if !words.label.is_empty() {
                write!(f, " ({})", words.label)?;
            }
            if let Some(help) = words.help {
                write!(f, "\n  help: {help}")?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for InvalidScene {}
