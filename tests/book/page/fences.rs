//! Fenced blocks.

use std::ops::Range;

/// A fenced block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fence {
    /// Text after the opening backticks: `rust,ignore`, `equation 17`.
    pub(crate) info: String,
    /// Line of the opening backticks, from 1.
    pub(crate) line: usize,
    /// The text between the backticks, without the fence's own indentation.
    pub(crate) body: String,
    /// Byte range, within the page, of the text between the backticks.
    pub(crate) range: Range<usize>,
    /// Number of blanks before the opening backticks.
    pub(crate) indent: usize,
    /// True if the page has closing backticks.
    pub(crate) closed: bool,
}

impl Fence {
    /// Returns the block's language, the beginning of its `info`.
    pub(crate) fn language(&self) -> &str {
        self.info.split([' ', ',']).next().unwrap_or_default()
    }
}

/// Returns the indentation and the number of backticks of a fence that opens or closes on this line.
pub(super) fn ticks(line: &str) -> Option<(usize, usize)> {
    let bare = line.trim_start_matches([' ', '>']);
    let count = bare.bytes().take_while(|&byte| byte == b'`').count();
    // A line such as ```` ```code``` ```` opens no fence.
    let opens = count >= 3 && !bare[count..].contains('`');
    opens.then(|| (line.len() - bare.len(), count))
}

pub(super) fn read(text: &str) -> Vec<Fence> {
    let mut fences: Vec<Fence> = Vec::new();
    let mut open: Option<usize> = None;
    let mut at = 0;
    for (number, line) in text.split_inclusive('\n').enumerate() {
        let start = at;
        at += line.len();
        let line = line.trim_end_matches(['\n', '\r']);
        let found = ticks(line);
        match (open, fences.last_mut()) {
            (Some(count), Some(fence)) => {
                let info = line.trim_start().trim_start_matches('`').trim();
                if found.is_some_and(|(_, closing)| closing >= count) && info.is_empty() {
                    fence.range.end = start;
                    fence.closed = true;
                    open = None;
                } else {
                    let indent = fence.indent.min(line.len() - line.trim_start().len());
                    fence.body.push_str(&line[indent..]);
                    fence.body.push('\n');
                    fence.range.end = at;
                }
            }
            _ => {
                if let Some((indent, count)) = found {
                    fences.push(Fence {
                        info: line[indent + count..].trim().to_owned(),
                        line: number + 1,
                        body: String::new(),
                        range: at..at,
                        indent,
                        closed: false,
                    });
                    open = Some(count);
                }
            }
        }
    }
    fences
}
