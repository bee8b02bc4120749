//! Scenes as constant data, which `qrt!` writes into programs.

use super::{Files, of_tree};
use crate::scene::text::Data;
use crate::valid::InvalidScene;
use crate::valid::ValidScene;
use qrt_syntax::number;
use qrt_syntax::tree::{Entry, Node, Scalar, Span, Value};
use std::sync::Arc;

/// An item of a scene's data. What a map or a list contains follows it, in order.
///
/// ```
/// use qrt_scene::front::{Files, Item, from_items};
/// use qrt_scene::{Film, Scene};
/// let scene = Scene { film: Film { width: 8, height: 6 }, ..Scene::default() };
/// let data = scene.encode();
/// let items = data.items();
/// assert_eq!(items[1..3], [Item::Text("name"), Item::Text("scene")]);
/// assert_eq!(from_items(&items, Files::held(&[]))?.scene(), &scene);
/// # Ok::<(), qrt_scene::valid::InvalidScene>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Item<'a> {
    /// A map with this number of entries. The key of an entry, a text, precedes its value.
    Map(usize),
    /// A list with this number of elements.
    List(usize),
    /// A text.
    Text(&'a str),
    /// A number.
    Number(f64),
    /// `true` or `false`.
    Bool(bool),
}

impl Data {
    /// Returns the data as items.
    pub fn items(&self) -> Vec<Item<'_>> {
        let mut items = Vec::new();
        self.push_items(&mut items);
        items
    }

    fn push_items<'a>(&'a self, items: &mut Vec<Item<'a>>) {
        match self {
            Self::Number(value) => items.push(Item::Number(*value)),
            Self::Bool(value) => items.push(Item::Bool(*value)),
            Self::Text(text) => items.push(Item::Text(text)),
            Self::List(elements) => {
                items.push(Item::List(elements.len()));
                for element in elements {
                    element.push_items(items);
                }
            }
            Self::Map(entries) => {
                items.push(Item::Map(entries.len()));
                for (key, value) in entries {
                    items.push(Item::Text(key));
                    value.push_items(items);
                }
            }
        }
    }
}

/// Reads and checks the scene of `items`, with meshes from `files`.
///
/// # Errors
/// All problems of the scene.
pub fn from_items(items: &[Item<'_>], files: Files<'_>) -> Result<ValidScene, InvalidScene> {
    of_tree(&node(&mut items.iter()), files).map_err(InvalidScene::new)
}

/// Returns the value of the next items; null if there are none.
fn node<'a>(items: &mut impl Iterator<Item = &'a Item<'a>>) -> Node {
    let scalar = |text: String, quoted| Value::Scalar(Scalar { text, quoted });
    let value = match items.next() {
        None => Value::Null,
        Some(Item::Text(text)) => scalar((*text).to_owned(), true),
        Some(Item::Number(value)) => scalar(number(*value), false),
        Some(Item::Bool(value)) => scalar(value.to_string(), false),
        Some(Item::List(length)) => {
            Value::List(Arc::new((0..*length).map(|_| node(items)).collect()))
        }
        Some(Item::Map(length)) => {
            let entries = (0..*length).map_while(|_| match items.next() {
                Some(Item::Text(key)) => Some(Entry {
                    key: (*key).to_owned(),
                    key_span: Span::default(),
                    value: node(items),
                }),
                _ => None,
            });
            Value::Map(Arc::new(entries.collect()))
        }
    };
    Node {
        span: Span::default(),
        value,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::front::load;
    use std::path::Path;

    /// Loads every example scene, and reads it again from its items.
    #[test]
    fn items_hold_every_example_scene() {
        let mut count = 0;
        for folder in ["scenes-yaml", "tests/good_scenes"] {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
                .join("..")
                .join(folder);
            for entry in std::fs::read_dir(&folder).unwrap() {
                let path = entry.unwrap().path();
                if path.extension().is_none_or(|end| end != "yaml") {
                    continue;
                }
                let valid = load(&path, &[])
                    .unwrap_or_else(|report| panic!("{report}"))
                    .valid;
                let data = valid.scene().encode();
                let read = from_items(&data.items(), Files::of_folder(&folder)).unwrap();
                assert_eq!(read.scene(), valid.scene(), "{}", path.display());
                assert_eq!(
                    read.fingerprint(),
                    valid.fingerprint(),
                    "{}",
                    path.display()
                );
                count += 1;
            }
        }
        assert!(count > 15, "{count} scenes");
    }

    #[test]
    fn items_of_an_invalid_scene_are_refused() {
        let items = [Item::Map(2), Item::Text("name"), Item::Number(7.0)];
        let invalid = from_items(&items, Files::held(&[])).unwrap_err();
        let paths = invalid
            .iter()
            .map(|problem| problem.path().map(ToString::to_string));
        assert!(paths.flatten().any(|path| path == "name"), "{invalid}");
    }
}
