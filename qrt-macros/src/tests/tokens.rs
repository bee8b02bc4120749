//! The fuzzer's target on the programs of `tests/ui`, and on changes of them that are the same each time.

use std::fs;
use std::path::Path;

#[path = "../../../fuzz/tokens.rs"]
mod targets;

/// Numbers as good as random.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 33) as usize % count.max(1)
    }
}

/// A text in pieces: words and single characters.
fn pieces(text: &str) -> Vec<&str> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let length = if word(first) {
            rest.find(|c| !word(c)).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        let (piece, after) = rest.split_at(length);
        pieces.push(piece);
        rest = after;
    }
    pieces
}

#[test]
fn of_any_tokens_items_are_made_or_errors() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/ui");
    let mut files: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "rs"))
        .collect();
    files.sort();
    let texts = files.iter().map(|file| fs::read_to_string(file).unwrap());
    let texts: Vec<String> = texts.filter(|text| text.len() < 2000).collect();
    assert!(texts.len() > 200);
    for text in &texts {
        targets::tokens(text.as_bytes());
    }
    let mut numbers = Numbers(3);
    for _ in 0..3000 {
        let mut changed = pieces(&texts[numbers.below(texts.len())]);
        let other = pieces(&texts[numbers.below(texts.len())]);
        for _ in 0..=numbers.below(3) {
            let at = numbers.below(changed.len());
            let from = numbers.below(other.len());
            match numbers.below(3) {
                0 => changed[at] = other[from],
                1 => {
                    let piece = &other[from..(from + numbers.below(8)).min(other.len())];
                    drop(changed.splice(at..at, piece.iter().copied()));
                }
                _ => {
                    drop(changed.drain(at..(at + numbers.below(4)).min(changed.len())));
                }
            }
        }
        targets::tokens(changed.concat().as_bytes());
    }
}
