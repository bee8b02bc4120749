//! The words of a page, without code and formulas.

use super::fences;

/// Returns `text` with fences, code spans, formulas and comments replaced by blanks.
pub(super) fn blanked(text: &str) -> String {
    let mut out = text.as_bytes().to_vec();
    for fence in fences::read(text) {
        let opening = text[..fence.range.start].trim_end_matches('\n');
        let opening = opening.rfind('\n').map_or(0, |at| at + 1);
        let closing = &text[fence.range.end..];
        let closing = closing.find('\n').unwrap_or(closing.len());
        blank(&mut out, opening, fence.range.end + closing);
    }
    // The result is UTF-8: blanks replace whole characters, because the marks searched for below begin
    // and end with ASCII.
    let prose = String::from_utf8(out.clone()).expect("whole characters are blanked");
    let mut at = 0;
    while at < prose.len() {
        let rest = &prose[at..];
        if let Some(escaped) = rest.strip_prefix('\\') {
            at += 1 + escaped.chars().next().map_or(0, char::len_utf8);
        } else if rest.starts_with("<!--") {
            let end = rest.find("-->").map_or(rest.len(), |end| end + 3);
            blank(&mut out, at, at + end);
            at += end;
        } else if rest.starts_with('`') {
            let ticks = rest.bytes().take_while(|&byte| byte == b'`').count();
            let end = closing(&rest[ticks..], &rest[..ticks], '`').map(|end| ticks + end);
            if let Some(end) = end {
                blank(&mut out, at + ticks, at + end);
                at += end + ticks;
            } else {
                at += ticks;
            }
        } else if let Some(display) = rest.strip_prefix("$$") {
            let end = display.find("$$").map_or(rest.len(), |end| end + 4);
            blank(&mut out, at, at + end);
            at += end;
        } else if let Some(formula) = rest.strip_prefix('$') {
            let end = closing(formula, "$", '\\').map(|end| end + 2);
            if let Some(end) = end {
                blank(&mut out, at, at + end);
            }
            at += end.unwrap_or(1);
        } else {
            at += rest.chars().next().map_or(1, char::len_utf8);
        }
    }
    String::from_utf8(out).expect("whole characters are blanked")
}

fn blank(text: &mut [u8], from: usize, to: usize) {
    for byte in &mut text[from..to] {
        if *byte != b'\n' {
            *byte = b' ';
        }
    }
}

/// Returns the offset of `mark` in the paragraph at the start of `text`, not beside another `except`.
fn closing(text: &str, mark: &str, except: char) -> Option<usize> {
    let paragraph = text.find("\n\n").unwrap_or(text.len());
    let text = &text[..paragraph];
    text.match_indices(mark).map(|(at, _)| at).find(|&at| {
        let after = &text[at + mark.len()..];
        !text[..at].ends_with(except) && (except == '\\' || !after.starts_with(except))
    })
}
