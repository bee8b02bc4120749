//! Kinds of blocks that pages may have.

use crate::book::page::{Fence, Page};
use std::fs;
use std::path::Path;

/// Languages of blocks that are only shown, and not checked.
const PLAIN: [&str; 6] = ["text", "sh", "toml", "json", "csv", "latex"];

/// Returns the faults of a page's blocks.
pub(crate) fn failures(page: &Page) -> Vec<String> {
    let fences = page.fences();
    let mut failures = Vec::new();
    for (i, fence) in fences.iter().enumerate() {
        let told = check(fence, fences.get(i + 1));
        failures.extend(
            told.err()
                .map(|what| format!("{}: {what}", page.at(fence.line))),
        );
    }
    failures
}

fn check(fence: &Fence, next: Option<&Fence>) -> Result<(), String> {
    if !fence.closed {
        return Err("this block is never closed".to_owned());
    }
    let included = included(&fence.body);
    for include in &included {
        include.check()?;
    }
    let alone = match &included[..] {
        [include] if fence.body.lines().count() == 1 => Some(include),
        _ => None,
    };
    match &*fence.info {
        "" => Err("a block without a language would be taken for Rust".to_owned()),
        "rust" if included.is_empty() => Ok(()),
        "rust" => Err("an included program is shown by `rust,ignore`".to_owned()),
        "rust,ignore" => match alone {
            Some(include) if include.path.starts_with("examples/") => Ok(()),
            Some(include) if include.path.starts_with("tests/compile_fail/ui/") => {
                let words = include
                    .path
                    .strip_suffix(".rs")
                    .map(|path| format!("{path}.stderr"));
                let follows = next.filter(|next| next.info == "text").and_then(|next| {
                    let included = self::included(&next.body);
                    (next.body.lines().count() == 1).then_some(included)
                });
                let follows = follows.and_then(|all| Some(all.first()?.path.clone()));
                if words.is_some() && words == follows {
                    Ok(())
                } else {
                    Err("the compiler's words do not follow this program".to_owned())
                }
            }
            _ => Err(
                "`rust,ignore` holds one include, of `examples` or `tests/compile_fail/ui`"
                    .to_owned(),
            ),
        },
        "python" => match alone {
            Some(include) if include.path.starts_with("python/examples/") => Ok(()),
            _ => Err("`python` holds one include, of `python/examples`".to_owned()),
        },
        info if info.starts_with("equation ") => Ok(()),
        "console" | "yaml" | "yaml,wrong" => Ok(()),
        info if PLAIN.contains(&info) => Ok(()),
        info => Err(format!("no block is of the kind `{info}`")),
    }
}

/// A line `{{#include PATH}}`, `{{#include PATH:FIRST:LAST}}` or `{{#include PATH:ANCHOR}}`.
struct Include {
    path: String,
    part: Option<String>,
}

fn included(body: &str) -> Vec<Include> {
    let find = |line: &str| {
        let inner = line
            .trim()
            .strip_prefix("{{#include ")?
            .strip_suffix("}}")?
            .trim();
        let (path, part) = match inner.split_once(':') {
            Some((path, part)) => (path, Some(part.to_owned())),
            None => (inner, None),
        };
        // The path is relative to the pages' folder.
        let path = path.strip_prefix("../../").unwrap_or(path).to_owned();
        Some(Include { path, part })
    };
    body.lines().filter_map(find).collect()
}

impl Include {
    fn check(&self) -> Result<(), String> {
        let path = Path::new(&self.path);
        let text = fs::read_to_string(path).map_err(|_| format!("there is no `{}`", self.path))?;
        let Some(part) = &self.part else {
            return Ok(());
        };
        let count = text.lines().count();
        let mut ends = part.split(':').map(|end| match end {
            "" => Ok(1),
            _ => end.parse::<usize>(),
        });
        let there = match (ends.next(), ends.next()) {
            (Some(Err(_)), _) => text.contains(&format!("ANCHOR: {part}")),
            (Some(Ok(first)), None) => (1..=count).contains(&first),
            (Some(Ok(first)), Some(Ok(last))) => 1 <= first && last <= count,
            _ => false,
        };
        if there {
            Ok(())
        } else {
            Err(format!("`{}` has no part `{part}`", self.path))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> Vec<String> {
        failures(&Page::new("page.md", text))
    }

    #[test]
    fn blocks_that_nobody_would_test_are_told() {
        for wrong in [
            "```\nlet x = 1;\n```\n",
            "```rust\nlet x = 1;\n",
            "```rust,no_run\nlet x = 1;\n```\n",
            "```rust,ignore\nlet x = 1;\n```\n",
            "```rust,compile_fail\nlet x = 1;\n```\n",
            "```rust,ignore\n{{#include ../../src/lib.rs}}\n```\n",
            "```rust,ignore\n{{#include ../../examples/none.rs}}\n```\n",
            "```rust,ignore\n{{#include ../../examples/scene.rs:nowhere}}\n```\n",
            "```rust,ignore\n{{#include ../../examples/scene.rs:1:100000}}\n```\n",
            "```rust\n{{#include ../../examples/scene.rs}}\n```\n",
            "```rust,ignore\n{{#include ../../tests/compile_fail/ui/reversible_while.rs}}\n```\n",
            "```ruts\nlet x = 1;\n```\n",
        ] {
            assert_eq!(told(wrong).len(), 1, "{wrong}");
        }
        for right in [
            "```rust\nlet x = 1;\n```\n",
            "```text\n```\n",
            "```rust,ignore\n{{#include ../../examples/scene.rs}}\n```\n",
            "```rust,ignore\n{{#include ../../examples/scene.rs:2:9}}\n```\n",
        ] {
            assert_eq!(told(right), [""; 0], "{right}");
        }
    }

    #[test]
    fn a_program_that_does_not_compile_stands_above_its_own_error() {
        let pair = |rs: &str, stderr: &str| {
            format!(
                "```rust,ignore\n{{{{#include ../../tests/compile_fail/ui/{rs}.rs}}}}\n```\n\n\
                 ```text\n{{{{#include ../../tests/compile_fail/ui/{stderr}.stderr}}}}\n```\n"
            )
        };
        assert_eq!(told(&pair("reversible_while", "reversible_while")), [""; 0]);
        assert_eq!(told(&pair("reversible_while", "reversible_loop")).len(), 1);
    }
}
