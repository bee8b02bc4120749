//! From a tree to typed data, with every error: a faulty value is reported, marked, and replaced by
//! a harmless one, so that the rest is still read and checked.

use crate::codes;
use crate::front::tree::{Node, Value};
use crate::report::{Path, Problem, Step};

/// A path under construction, without allocation on the way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'a> {
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
    pub(crate) const ROOT: Place<'static> = Place {
        parent: None,
        step: At::Root,
    };

    /// The value of `key` below this.
    pub(crate) fn key(&'a self, key: &'a str) -> Place<'a> {
        Place {
            parent: Some(self),
            step: At::Key(key),
        }
    }

    /// Element `index` below this.
    pub(crate) fn item(&'a self, index: usize) -> Place<'a> {
        Place {
            parent: Some(self),
            step: At::Item(index),
        }
    }

    /// As a path.
    pub(crate) fn path(&self) -> Path {
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

    /// The key at the end of this, or else the value: where to show what a map lacks.
    pub(crate) fn name(&self) -> Path {
        let mut path = self.path();
        if let Some(Step::Key(key)) = path.0.last() {
            let name = Step::Name(key.clone());
            path.0.pop();
            path.0.push(name);
        }
        path
    }
}

/// What is wrong so far.
#[derive(Debug, Default)]
pub(crate) struct Decoder {
    /// All problems, in the order found.
    pub(crate) problems: Vec<Problem>,
    /// Values that were replaced: what the checks say of these, or of what holds them, is moot.
    pub(crate) replaced: Vec<Path>,
}

/// A key that a record may have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    /// The key.
    pub(crate) name: &'static str,
    /// Whether it must be written.
    pub(crate) required: bool,
}

impl Decoder {
    /// Reports a problem about the value at `at`, which is replaced.
    pub(crate) fn replace(&mut self, at: &Place<'_>, problem: Problem) {
        self.problems.push(problem);
        self.replaced.push(at.path());
    }

    /// Reports that `node` is not `expected`.
    pub(crate) fn wrong_type(
        &mut self,
        node: &Node,
        at: &Place<'_>,
        expected: &str,
        help: Option<String>,
    ) {
        let message = format!("expected {expected}, found {}", node.found());
        let kind = expected
            .split_once(" (")
            .map_or(expected, |(_, kind)| kind.trim_end_matches(')'));
        let mut problem = Problem::new(codes::WRONG_TYPE, at.path(), message);
        problem.label = format!("not {kind}");
        problem.help = help;
        self.replace(at, problem);
    }

    /// Whether `node` is a map; reports what it has beyond `fields` and what it lacks of them.
    pub(crate) fn record(
        &mut self,
        node: &Node,
        at: &Place<'_>,
        noun: &str,
        fields: &[Field],
    ) -> bool {
        let Value::Map(entries) = &node.value else {
            let keys: Vec<_> = fields.iter().map(|field| field.name).collect();
            let help = format!("write a map with {}", listed(&keys, "and"));
            self.wrong_type(node, at, &format!("{noun} (a map)"), Some(help));
            return false;
        };
        let all: Vec<_> = fields.iter().map(|field| field.name).collect();
        let absent: Vec<_> = all
            .iter()
            .copied()
            .filter(|name| node.entry(name).is_none())
            .collect();
        let mut misspelt = Vec::new();
        for entry in entries {
            if all.contains(&entry.key.as_str()) {
                continue;
            }
            let key = crate::front::tree::shorten(&entry.key);
            let path = at.path().name(entry.key.as_str());
            let message = format!("unknown key `{key}` in {noun}");
            let mut problem = Problem::new(codes::UNKNOWN_KEY, path, message);
            problem.help = Some(match nearest(&entry.key, &all) {
                Some(name) => {
                    misspelt.push(name);
                    format!("did you mean `{name}`?")
                }
                None => format!("the keys of {noun} are {}", listed(&all, "and")),
            });
            self.problems.push(problem);
        }
        let missing = fields
            .iter()
            .filter(|field| field.required)
            .map(|field| field.name);
        let missing: Vec<_> = missing
            .filter(|name| absent.contains(name) && !misspelt.contains(name))
            .collect();
        if !missing.is_empty() {
            let message = format!("{noun} lacks {}", listed(&missing, "and"));
            let problem = Problem::new(codes::MISSING_KEY, at.name(), message)
                .label(format!("{} missing here", listed(&missing, "and")));
            self.problems.push(problem);
        }
        true
    }

    /// The single entry of a variant, known by `names`; reports anything else.
    pub(crate) fn variant<'n>(
        &mut self,
        node: &'n Node,
        at: &Place<'_>,
        noun: &str,
        names: &[&str],
    ) -> Option<(&'n str, &'n Node)> {
        let Value::Map(entries) = &node.value else {
            let help = match &node.value {
                Value::Scalar(scalar) => nearest(&scalar.text, names)
                    .map(|name| format!("write a map: `{{ {name}: {{ ... }} }}`")),
                _ => None,
            };
            let help = help.unwrap_or_else(|| {
                format!("write a map with one of the keys {}", listed(names, "or"))
            });
            self.wrong_type(node, at, &format!("{noun} (a map)"), Some(help));
            return None;
        };
        let known = entries
            .iter()
            .find(|entry| names.contains(&entry.key.as_str()));
        if entries.len() != 1 {
            let path = match (known, entries.iter().find(|entry| Some(*entry) != known)) {
                (Some(_), Some(other)) => at.path().name(other.key.as_str()),
                _ => at.name(),
            };
            let message = format!(
                "{noun} is of exactly one kind, found {} keys",
                entries.len()
            );
            let help = match known {
                Some(entry) => format!(
                    "keep one key; what describes the `{}` goes inside its map",
                    entry.key
                ),
                None => format!("write one of the keys {}", listed(names, "or")),
            };
            let problem = Problem::new(codes::ONE_VARIANT, path, message).help(help);
            if known.is_some() {
                self.problems.push(problem);
            } else {
                self.replace(at, problem);
            }
            return known.map(|entry| (entry.key.as_str(), &entry.value));
        }
        if let Some(entry) = known {
            return Some((entry.key.as_str(), &entry.value));
        }
        let entry = entries.first()?;
        let key = crate::front::tree::shorten(&entry.key);
        let path = at.path().name(entry.key.as_str());
        let message = format!("no kind of {} is called `{key}`", noun_alone(noun));
        let help = match nearest(&entry.key, names) {
            Some(name) => format!("did you mean `{name}`?"),
            None => format!("there are {}", listed(names, "and")),
        };
        self.replace(
            at,
            Problem::new(codes::UNKNOWN_VARIANT, path, message).help(help),
        );
        None
    }

    /// The index in `names` of the word that `node` is; reports anything else.
    pub(crate) fn word(
        &mut self,
        node: &Node,
        at: &Place<'_>,
        noun: &str,
        names: &[&str],
    ) -> Option<usize> {
        let choice = listed(names, "or");
        let Value::Scalar(scalar) = &node.value else {
            self.wrong_type(
                node,
                at,
                &format!("{noun} (a word)"),
                Some(format!("write {choice}")),
            );
            return None;
        };
        let found = names.iter().position(|name| *name == scalar.text);
        if found.is_none() {
            let text = crate::front::tree::shorten(&scalar.text);
            let message = format!("no {} is called `{text}`", noun_alone(noun));
            let help = match nearest(&scalar.text, names) {
                Some(name) => format!("did you mean `{name}`?"),
                None => format!("write {choice}"),
            };
            self.replace(
                at,
                Problem::new(codes::UNKNOWN_WORD, at.path(), message).help(help),
            );
        }
        found
    }
}

fn noun_alone(noun: &str) -> &str {
    noun.strip_prefix("a ")
        .or_else(|| noun.strip_prefix("an "))
        .unwrap_or(noun)
}

/// `a`, `b` and `c`
pub fn listed(names: &[&str], last: &str) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        None => String::new(),
        Some((only, [])) => only.clone(),
        Some((end, rest)) => format!("{} {last} {end}", rest.join(", ")),
    }
}

/// The name that `text` was probably meant to be: at most a third of its letters away.
pub fn nearest<'a>(text: &str, names: &[&'a str]) -> Option<&'a str> {
    let lower = text.to_lowercase();
    let candidates = names.iter().filter_map(|name| {
        let length = name.chars().count().max(lower.chars().count());
        if length > 64 {
            return None;
        }
        let distance = edit_distance(&lower, &name.to_lowercase());
        (distance <= (length / 3).max(1) && distance < length).then_some((distance, *name))
    });
    candidates
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

/// Insertions, deletions, substitutions and swaps of neighbours (optimal string alignment).
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let change = usize::from(a[i - 1] != b[j - 1]);
            row[j] = (last[j] + 1).min(row[j - 1] + 1).min(last[j - 1] + change);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let names = ["white", "red", "green", "light"];
        assert_eq!(nearest("whit", &names), Some("white"));
        assert_eq!(nearest("WHITE", &names), Some("white"));
        assert_eq!(nearest("rde", &names), Some("red"));
        assert_eq!(nearest("lihgt", &names), Some("light"));
        assert_eq!(nearest("purple", &names), None);
        assert_eq!(nearest("", &names), None);
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "abc"), 3);
    }
}
