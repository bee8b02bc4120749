//! The answer to a call of the playground: named numbers, lists of numbers and texts.
//!
//! All numbers are in one list of `f64`, so that a script reads them from the module's memory
//! without parsing. The index is JSON: it maps a name to `[place]` for a number, to
//! `[place, length]` for a list, or to a text.

use std::fmt::Write;

/// Named values, in the order in which they were added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    numbers: Vec<f64>,
    entries: Vec<(&'static str, Entry)>,
}

#[derive(Clone, Debug, PartialEq)]
enum Entry {
    Number(usize),
    List(usize, usize),
    Text(String),
}

impl Answer {
    /// Adds a number.
    pub fn number(mut self, name: &'static str, value: f64) -> Self {
        self.entries.push((name, Entry::Number(self.numbers.len())));
        self.numbers.push(value);
        self
    }

    /// Adds a list of numbers.
    pub fn list(self, name: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        self.list_from(name, &mut values.into_iter())
    }

    /// Compiled once for all kinds of iterators, because browsers have to load the code.
    fn list_from(mut self, name: &'static str, values: &mut dyn Iterator<Item = f64>) -> Self {
        let start = self.numbers.len();
        for value in values {
            self.numbers.push(value);
        }
        let length = self.numbers.len() - start;
        self.entries.push((name, Entry::List(start, length)));
        self
    }

    /// Adds a text.
    pub fn text(mut self, name: &'static str, text: impl Into<String>) -> Self {
        self.entries.push((name, Entry::Text(text.into())));
        self
    }

    /// Adds several texts without line feeds as one text, with a line for each.
    pub fn lines(self, name: &'static str, lines: &[impl AsRef<str>]) -> Self {
        let mut text = String::new();
        for (place, line) in lines.iter().enumerate() {
            if place > 0 {
                text.push('\n');
            }
            text.push_str(line.as_ref());
        }
        self.text(name, text)
    }

    /// Returns all numbers.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }

    /// Returns the number with that name.
    pub fn number_of(&self, name: &str) -> Option<f64> {
        match self.entry(name)? {
            Entry::Number(place) => self.numbers.get(*place).copied(),
            _ => None,
        }
    }

    /// Returns the list with that name.
    pub fn list_of(&self, name: &str) -> Option<&[f64]> {
        match self.entry(name)? {
            Entry::List(start, length) => self.numbers.get(*start..start + length),
            _ => None,
        }
    }

    /// Returns the text with that name.
    pub fn text_of(&self, name: &str) -> Option<&str> {
        match self.entry(name)? {
            Entry::Text(text) => Some(text),
            _ => None,
        }
    }

    fn entry(&self, name: &str) -> Option<&Entry> {
        let mut entries = self.entries.iter();
        entries
            .find(|(own, _)| *own == name)
            .map(|(_, entry)| entry)
    }

    /// Returns the index as JSON.
    pub fn index(&self) -> String {
        let mut out = String::from("{");
        for (place, (name, entry)) in self.entries.iter().enumerate() {
            if place > 0 {
                out.push(',');
            }
            quote(&mut out, name);
            out.push(':');
            match entry {
                Entry::Number(place) => {
                    let _ = write!(out, "[{place}]");
                }
                Entry::List(start, length) => {
                    let _ = write!(out, "[{start},{length}]");
                }
                Entry::Text(text) => quote(&mut out, text),
            }
        }
        out.push('}');
        out
    }
}

/// Writes a text as a JSON string.
fn quote(out: &mut String, text: &str) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            c if c < ' ' => {
                let _ = write!(out, "\\u{:04x}", c as u32);
            }
            c => out.push(c),
        }
    }
    out.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_given_is_found_under_its_name() {
        let answer = Answer::default()
            .number("one", 1.0)
            .list("few", [2.0, 3.0])
            .number("nan", f64::NAN)
            .lines("lines", &["", "b"]);
        assert_eq!(answer.number_of("one"), Some(1.0));
        assert_eq!(answer.list_of("few"), Some(&[2.0, 3.0][..]));
        assert_eq!(answer.text_of("lines"), Some("\nb"));
        assert_eq!(answer.number_of("few"), None);
        assert_eq!(
            answer.index(),
            r#"{"one":[0],"few":[1,2],"nan":[3],"lines":"\nb"}"#
        );
        assert!(answer.numbers()[3].is_nan());
    }

    #[test]
    fn texts_are_strings_of_json() {
        let answer = Answer::default().text("text", "\"\\\t\u{1}é\n");
        assert_eq!(answer.index(), r#"{"text":"\"\\\u0009\u0001é\n"}"#);
    }
}
