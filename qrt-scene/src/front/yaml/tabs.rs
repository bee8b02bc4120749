//! Replaces tabs between a key's colon and its value. YAML allows them, but `saphyr-parser` refuses
//! them before letters, digits and signs, because it takes them for an indentation.

use super::Locator;
use saphyr_parser::{Event, Parser, ScalarStyle};
use std::borrow::Cow;
use std::ops::Range;

/// Returns the text with a space in place of each tab between a colon and a value, byte for byte.
///
/// Only the parser knows which tabs are in quotes or in a block of text. So it reads the text with
/// all tabs replaced, which changes no place; tabs that turn out to be in quotes or blocks are then
/// kept. Text after a syntax error is not read, and its tabs do not matter.
pub(super) fn spaced(text: &str) -> Cow<'_, str> {
    let tabs = behind_colons(text);
    if tabs.is_empty() {
        return Cow::Borrowed(text);
    }
    let all = replaced(text, &tabs);
    let mut contents = contents(&all).into_iter().peekable();
    let outside = |tabs: &Range<usize>| {
        while contents.next_if(|range| range.end <= tabs.start).is_some() {}
        contents.peek().is_none_or(|range| tabs.start < range.start)
    };
    let tabs: Vec<_> = tabs.into_iter().filter(outside).collect();
    Cow::Owned(replaced(text, &tabs))
}

/// Returns the runs of tabs between a colon and a character before which the parser refuses them,
/// in quotes or not.
fn behind_colons(text: &str) -> Vec<Range<usize>> {
    let refused = |next: char| next.is_ascii_alphanumeric() || matches!(next, '-' | '_');
    let colons = text.match_indices(":\t");
    let tabs = colons.filter_map(|(colon, _)| {
        let next = text[colon + 1..].trim_start_matches('\t');
        let end = text.len() - next.len();
        next.starts_with(refused).then_some(colon + 1..end)
    });
    tabs.collect()
}

/// Returns the text with spaces in `places`.
fn replaced(text: &str, places: &[Range<usize>]) -> String {
    let mut spaced = String::with_capacity(text.len());
    for place in places {
        spaced.push_str(&text[spaced.len()..place.start]);
        spaced.extend(std::iter::repeat_n(' ', place.len()));
    }
    spaced.push_str(&text[spaced.len()..]);
    spaced
}

/// Returns the places of quoted scalars and of blocks of text, up to the first syntax error. No
/// other scalar has a colon before a blank.
fn contents(text: &str) -> Vec<Range<usize>> {
    let mut locator = Locator::new(text, 0, 0);
    let events = Parser::new_from_str(text).map_while(Result::ok);
    let scalars = events.filter_map(|(event, span)| {
        let marked = matches!(event, Event::Scalar(_, style, ..) if style != ScalarStyle::Plain);
        marked.then(|| {
            let span = locator.span(&span);
            span.start..span.end
        })
    });
    scalars.collect()
}

#[cfg(test)]
mod tests {
    use super::super::read;
    use super::*;
    use qrt_syntax::tree::Value;
    use qrt_syntax::{Problems, Report, Source};

    #[test]
    fn only_tabs_between_a_colon_and_its_value_are_replaced() {
        for (text, expected) in [
            ("a: 1", "a: 1"),
            ("a:\tb\nb:\t\t-1\nc: \td", "a: b\nb:  -1\nc: \td"),
            ("a:\t[b,\tc]\nd:\t\"e\"\n", "a:\t[b,\tc]\nd:\t\"e\"\n"),
            ("\"a:\tb\":\tc\n'd:\te':\tf", "\"a:\tb\": c\n'd:\te': f"),
            ("ä: \"ö:\tü:\tu\"\nb:\tc", "ä: \"ö:\tü:\tu\"\nb: c"),
            (
                "a: \"b:\tc\n  d:\te\"\nf:\tg",
                "a: \"b:\tc\n  d:\te\"\nf: g",
            ),
            ("a: |\n  b:\tc\nd:\te\n", "a: |\n  b:\tc\nd: e\n"),
            (
                "a: >-\n  b:\tc\n\n  d:\te\n:\tf",
                "a: >-\n  b:\tc\n\n  d:\te\n: f",
            ),
            ("a: |2\n    b:\tc\r\nd:\te", "a: |2\n    b:\tc\r\nd: e"),
            ("{a:\tb, 'c:\td':\te}", "{a: b, 'c:\td': e}"),
            // An error of syntax, at its own place.
            ("a:\tb:\tc\nd:\te", "a: b: c\nd: e"),
        ] {
            assert_eq!(spaced(text), expected, "{text:?}");
        }
    }

    #[test]
    fn a_tab_behind_each_of_very_many_colons_is_allowed() {
        const LINES: usize = 40_000;
        let line = |n: usize| format!("key{n}:\tvalue{n}\nquoted{n}: \"a:\tb\"\n");
        let text: String = (0..LINES).map(line).collect();
        let source = Source::new("text", &text);
        let mut problems = Problems::default();
        let node = read(&source, 0..text.len(), 0, &mut problems).unwrap();
        let Value::Map(entries) = &node.value else {
            panic!("no map");
        };
        assert_eq!(entries.len(), 2 * LINES);
        let [.., plain, quoted] = &entries[..] else {
            panic!("no entries");
        };
        let span = plain.value.span;
        assert_eq!(text[span.start..span.end], format!("value{}", LINES - 1));
        let Value::Scalar(scalar) = &quoted.value.value else {
            panic!("no scalar");
        };
        assert_eq!(scalar.text, "a:\tb");
    }

    #[test]
    fn what_is_wrong_behind_replaced_tabs_is_told_at_its_place() {
        let line = |n: usize| format!("\"ä:\ta{n}\":\tb\n");
        let mut text: String = (0..1000).map(line).collect();
        text += "b:\t'c\n";
        let source = Source::new("text", &text);
        let mut problems = Problems::default();
        assert!(read(&source, 0..text.len(), 0, &mut problems).is_none());
        let report = Report::new(vec![source], None, problems.all());
        let told = report.problems().last().unwrap();
        let place = told.place.as_ref().map(|place| (place.line, place.column));
        assert_eq!(place, Some((1001, 4)), "{report}");
    }
}
