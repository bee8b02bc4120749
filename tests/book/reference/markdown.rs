//! Text of generated pages.

/// The longest line of a page.
const WIDTH: usize = 100;

/// Wraps `text` into lines that begin with `first`, then with `rest`.
pub(crate) fn wrapped(text: &str, first: &str, rest: &str) -> String {
    let mut out = first.to_owned();
    let mut length = first.chars().count();
    let mut fresh = true;
    for word in words(text) {
        let more = word.chars().count() + usize::from(!fresh);
        if !fresh && length + more > WIDTH {
            out.push('\n');
            out.push_str(rest);
            length = rest.chars().count();
            fresh = true;
        }
        if !fresh {
            out.push(' ');
            length += 1;
        }
        out.push_str(word);
        length += word.chars().count();
        fresh = false;
    }
    out.push('\n');
    out
}

/// Splits at blanks, but keeps a code span in one piece.
fn words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut start = None;
    let mut code = false;
    for (at, c) in text.char_indices() {
        code ^= c == '`';
        match start {
            Some(from) if c.is_whitespace() && !code => {
                words.push(&text[from..at]);
                start = None;
            }
            None if !c.is_whitespace() => start = Some(at),
            _ => {}
        }
    }
    words.extend(start.map(|from| &text[from..]));
    words
}

/// Escapes plain words for Markdown.
pub(crate) fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut code = false;
    for c in text.chars() {
        code ^= c == '`';
        if !code && matches!(c, '*' | '_' | '[' | ']' | '$' | '|' | '\\') {
            out.push('\\');
        }
        match c {
            '<' if !code => out.push_str("&lt;"),
            _ => out.push(c),
        }
    }
    out
}

/// Makes a sentence: with a capital letter, and a full stop.
pub(crate) fn sentence(text: &str) -> String {
    let mut letters = text.trim().chars();
    let first = letters.next().map(|c| c.to_ascii_uppercase());
    let text: String = first.into_iter().chain(letters).collect();
    if text.ends_with(['.', '?', '!', ':']) {
        text
    } else {
        text + "."
    }
}

#[test]
fn words_are_wrapped_at_the_width() {
    let text = "word ".repeat(60);
    let lines = wrapped(&text, "- ", "  ");
    assert!(lines.lines().all(|line| line.chars().count() <= WIDTH));
    assert_eq!(lines.matches("word").count(), 60);
    assert!(lines.starts_with("- word") && lines.contains("\n  word"));
    assert_eq!(
        plain("a_b * `c_d` [0, 1] < $"),
        "a\\_b \\* `c_d` \\[0, 1\\] &lt; \\$"
    );
    assert_eq!(sentence("one thing"), "One thing.");
}
