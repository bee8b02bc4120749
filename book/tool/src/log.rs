//! Warnings that mdBook writes only to its log, for example that an included file is missing.

use crate::complaint::Complaint;
use anyhow::{Context as _, Result};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Collects warnings and errors.
#[derive(Clone, Default)]
pub(crate) struct Log(Arc<Mutex<Vec<String>>>);

impl Log {
    /// Returns the warnings so far, as complaints about the chapters in `src`; complaints name it `seen`.
    pub(crate) fn complaints(&self, src: &Path, seen: &str) -> Result<Vec<Complaint>> {
        let said = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if said.is_empty() {
            return Ok(Vec::new());
        }
        let mut chapters = BTreeMap::new();
        for file in crate::files::all(src)? {
            if file.extension().is_some_and(|kind| kind == "md") {
                let text = std::fs::read_to_string(&file)
                    .with_context(|| format!("cannot read {}", file.display()))?;
                chapters.insert(crate::files::relative(src, &file), text);
            }
        }
        Ok(placed(&said, &chapters, seen))
    }
}

/// Assigns messages to the places that they name, if they name one.
fn placed(said: &[String], chapters: &BTreeMap<String, String>, seen: &str) -> Vec<Complaint> {
    let mut complaints: Vec<Complaint> = Vec::new();
    for said in said {
        match complaints.last_mut() {
            // The line belongs to the message before it.
            Some(last) if said.starts_with("Caused By: ") => {
                last.message.push('\n');
                last.message.push_str(said);
            }
            _ => complaints.push(match place(said, chapters) {
                Some((chapter, line)) => Complaint::at(&format!("{seen}/{chapter}"), line, said),
                None => Complaint::about(seen, said),
            }),
        }
    }
    complaints
}

/// Returns the chapter that a message names, or the one with the text that it quotes, for example
/// `{{#include x}}`, and the line there.
fn place<'a>(said: &str, chapters: &'a BTreeMap<String, String>) -> Option<(&'a str, usize)> {
    let quoted = said.find("{{#").and_then(|start| {
        let end = said[start..].find("}}")?;
        Some(&said[start..start + end + 2])
    });
    let quoting = quoted.and_then(|quoted| {
        chapters.iter().find_map(|(name, text)| {
            let line = text.lines().position(|line| line.contains(quoted))?;
            Some((&**name, line + 1))
        })
    });
    let mut words = said.split(|c: char| c.is_whitespace() || "`\"'(),:".contains(c));
    quoting.or_else(|| {
        words.find_map(|word| {
            let (name, _) = chapters.get_key_value(word.trim_end_matches('.'))?;
            Some((&**name, 0))
        })
    })
}

impl Subscriber for Log {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() <= Level::WARN
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1)
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        struct Message(String);
        impl Visit for Message {
            fn record_debug(&mut self, field: &Field, value: &dyn std::fmt::Debug) {
                if field.name() == "message" {
                    let _ = write!(self.0, "{value:?}");
                }
            }
        }
        let mut message = Message(String::new());
        event.record(&mut message);
        let mut said = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        said.push(message.0);
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_is_said_at_the_chapter_that_it_names() {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [
            ("a.md", "One\n\n```rust\n{{#include ../none.rs}}\n```\n"),
            ("b.md", "Two <b>\n"),
        ] {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let log = Log::default();
        assert_eq!(log.complaints(folder.path(), "book/src").unwrap(), []);
        // The messages are in mdBook's words.
        tracing::subscriber::with_default(log.clone(), || {
            let include = "{{#include ../none.rs}}";
            tracing::error!("Error updating \"{include}\", Could not read file for link {include}");
            tracing::warn!("Caused By: No such file");
            tracing::warn!("unclosed HTML tag `<b>` found in `b.md`");
            tracing::error!("Stack depth exceeded in b.md. Check for cyclic includes");
            tracing::warn!("search index is very large (9 bytes)");
            tracing::info!("all else is well");
        });
        let complaints = log.complaints(folder.path(), "book/src").unwrap();
        let said: Vec<String> = complaints.iter().map(ToString::to_string).collect();
        assert_eq!(
            said,
            [
                "book/src/a.md:4: Error updating \"{{#include ../none.rs}}\", Could not read file \
                 for link {{#include ../none.rs}}\nCaused By: No such file",
                "book/src/b.md: unclosed HTML tag `<b>` found in `b.md`",
                "book/src/b.md: Stack depth exceeded in b.md. Check for cyclic includes",
                "book/src: search index is very large (9 bytes)",
            ]
        );
    }
}
