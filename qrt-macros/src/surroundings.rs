//! The text of the author's file around a macro's tokens. A macro sees its own tokens only.

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;
use std::path::PathBuf;

/// Returns the text of a token's file before the token, if the author wrote the token.
pub(crate) fn before(span: Span) -> Option<String> {
    let mut text = std::fs::read_to_string(file(span)?).ok()?;
    let start = span.start();
    let lines = text.split_inclusive('\n').take(start.line.checked_sub(1)?);
    let line = lines.map(str::len).sum::<usize>();
    let (column, _) = text.get(line..)?.char_indices().nth(start.column)?;
    text.truncate(line + column);
    Some(text)
}

fn file(span: Span) -> Option<PathBuf> {
    #[cfg(test)]
    if let Some(file) = crate::tests::checks::file() {
        return Some(file);
    }
    span.local_file()
}

/// Returns the path by which functions beside the function `name` call it: `name`, or `Self::name`
/// in an `impl`. `None` in a trait, and in the tokens of a macro, which may put them anywhere.
pub(crate) fn path(name: &Ident) -> Option<TokenStream> {
    let is_method = is_method(&before(name.span())?)?;
    Some(if is_method {
        quote!(Self::#name)
    } else {
        quote!(#name)
    })
}

/// True if an item at the end of `text` is in an `impl`; `None` if it is in a trait or in a macro's
/// tokens.
fn is_method(text: &str) -> Option<bool> {
    let tokens = tokens(text);
    let token = |at: usize| tokens.get(at).map_or("", |(token, _)| *token);
    // For each pair of brackets around the end, and for the file: the kind of code in it, and the
    // first token of the item there.
    let mut scopes = vec![(Some(false), 0)];
    for at in 0..tokens.len() {
        match token(at) {
            ";" => scopes.last_mut()?.1 = at + 1,
            "{" | "(" | "[" => {
                let &(outer, start) = scopes.last()?;
                let is = |word: &str| (start..at).any(|at| token(at) == word);
                let is_macro =
                    (at >= 1 && token(at - 1) == "!") || (at >= 2 && token(at - 2) == "!");
                let kind = match token(at) {
                    "{" if !is_macro && !is("fn") && is("trait") => None,
                    "{" if !is_macro => outer.map(|_| is("impl") && !is("fn")),
                    _ => None,
                };
                scopes.push((kind, at + 1));
            }
            "}" | ")" | "]" => {
                scopes.pop();
                // The braces of a constant argument are within an item.
                if token(at) == "}" && !matches!(token(at + 1), ">" | ",") {
                    scopes.last_mut()?.1 = at + 1;
                }
            }
            _ => {}
        }
    }
    scopes.last()?.0
}

/// Returns the words and the signs of a Rust text, with their lines, without comments and literals.
pub(crate) fn tokens(text: &str) -> Vec<(&str, usize)> {
    let mut tokens = Vec::new();
    let (mut at, mut line) = (0, 1);
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let is_word = |c: char| c == '_' || c.is_alphanumeric();
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            comment(rest)
        } else if let Some(length) = raw(rest) {
            length
        } else if first == '"' {
            quoted(rest, '"')
        } else if first == '\'' {
            // A lifetime has no second quote.
            let mut after = rest.chars().skip(1);
            match (after.next(), after.next()) {
                (Some('\\'), _) | (_, Some('\'')) => quoted(rest, '\''),
                _ => {
                    tokens.push((&rest[..1], line));
                    1
                }
            }
        } else if is_word(first) {
            let length = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
            tokens.push((&rest[..length], line));
            length
        } else {
            if !first.is_whitespace() {
                tokens.push((&rest[..first.len_utf8()], line));
            }
            first.len_utf8()
        };
        line += rest[..length].matches('\n').count();
        at += length;
    }
    tokens
}

/// Returns the length of the comment that `text` begins with; comments nest.
fn comment(text: &str) -> usize {
    let (mut at, mut depth) = (0, 0);
    while let Some(next) = text[at..].find(['/', '*']) {
        at += next;
        let (step, change) = match text.get(at..at + 2) {
            Some("/*") => (2, 1),
            Some("*/") => (2, -1),
            _ => (1, 0),
        };
        at += step;
        depth += change;
        if depth == 0 {
            return at;
        }
    }
    text.len()
}

/// Returns the length of the raw string that `text` begins with, such as `br#".."#`.
fn raw(text: &str) -> Option<usize> {
    let mut prefixes = ["r", "br", "cr"].into_iter();
    let rest = prefixes.find_map(|prefix| text.strip_prefix(prefix))?;
    let inner = rest.trim_start_matches('#');
    let marks = &rest[..rest.len() - inner.len()];
    let inner = inner.strip_prefix('"')?;
    let end = format!("\"{marks}");
    let length = inner.find(&end).map_or(inner.len(), |at| at + end.len());
    Some(text.len() - inner.len() + length)
}

/// Returns the length of the literal between two `quote`s that `text` begins with.
fn quoted(text: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (at, letter) in text.char_indices().skip(1) {
        match letter {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            letter if letter == quote => return at + letter.len_utf8(),
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_is_a_method_if_it_stands_in_an_impl() {
        for (text, expected) in [
            ("use a::b; #[reversible] fn ", Some(false)),
            (
                "impl A<{ 1 + 1 }> for B { fn c() {} pub(super) fn ",
                Some(true),
            ),
            ("impl A { fn b() -> impl C { fn ", Some(false)),
            ("#[cfg(test)] mod a { struct B; impl B { } fn ", Some(false)),
            (
                "const _: () = { impl A { const B: [u8; 2] = [1, 2]; fn ",
                Some(true),
            ),
            ("fn a() { let b = if c { d } else { e }; fn ", Some(false)),
            ("trait A { fn ", None),
            ("macro_rules! a { () => { fn ", None),
            ("a! { impl B { fn ", None),
            ("a!(", None),
            ("} } fn ", None),
        ] {
            assert_eq!(is_method(text), expected, "{text}");
        }
    }

    #[test]
    fn comments_and_literals_are_no_tokens() {
        let text = "a /* b /* c */ */ 'd' '\\'' e<'f> \"\\\"g\" br##\"\"# h\"## // i\n1.5r";
        let tokens = tokens(text);
        let words: Vec<&str> = tokens.iter().map(|(token, _)| *token).collect();
        assert_eq!(words, ["a", "e", "<", "'", "f", ">", "1", ".", "5r"]);
        assert_eq!(tokens.last(), Some(&("5r", 2)));
    }
}
