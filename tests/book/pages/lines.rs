//! Lengths of the lines of pages.

use crate::book::page::Page;

/// The longest line of prose.
const WIDTH: usize = 100;

/// Delimiters of the target of a link, or of its name; no line can break within them.
const TARGETS: [(&str, char); 4] = [
    ("](", ')'),
    (" src=\"", '"'),
    (" href=\"", '"'),
    (" id=\"", '"'),
];

/// Returns the lines of prose that are too long even without the targets of their links, with their lengths.
///
/// Lines within blocks may have any length, and the rows of tables cannot break.
pub(crate) fn long(page: &Page) -> Vec<(usize, usize)> {
    let prose = page.prose();
    let lines = page.text.lines().zip(prose.lines()).zip(1..);
    let long = lines.filter_map(|((line, prose), number)| {
        let bare = prose.trim_start();
        let length = line.chars().count() - targets(line, prose);
        let counts = !bare.is_empty() && !bare.starts_with('|');
        (counts && length > WIDTH).then_some((number, length))
    });
    long.collect()
}

/// Returns the number of characters of a line in targets of links. `prose` is the line with blanks in
/// place of everything that is not prose, byte by byte.
fn targets(line: &str, prose: &str) -> usize {
    let of = |(open, close): (&str, char)| -> usize {
        let starts = prose.match_indices(open).map(|(at, _)| at + open.len());
        let lengths = starts.filter_map(|start| {
            let end = start + prose[start..].find(close)?;
            Some(line.get(start..end)?.chars().count())
        });
        lengths.sum()
    };
    TARGETS.into_iter().map(of).sum()
}

#[test]
fn lines_are_measured_without_the_targets_of_their_links() {
    let long_in = |text: &str| long(&Page::new("page.md", text));
    let (words, target) = ("é".repeat(90), "x".repeat(90));
    for right in [
        format!("{words}\n"),
        format!("{words}[a]({target})[c]({target})\n"),
        format!("{words} $é$ [a]({target})\n"),
        format!("<figure><img src=\"{target}\" alt=\"words\"></figure>\n"),
        format!("| {words} | {words} |\n"),
        format!("```text\n{words}{words}\n```\n"),
    ] {
        assert_eq!(long_in(&right), [], "{right}");
    }
    for (wrong, length) in [
        (format!("\n{words} and much more\n"), 104),
        (format!("\n{words} [and much more](a.md)\n"), 108),
        (format!("\n{words} and `[much](more)`\n"), 109),
        (format!("\n<img src=\"{target}\" alt=\"{words}\">\n"), 109),
    ] {
        assert_eq!(long_in(&wrong), [(2, length)], "{wrong}");
    }
}
