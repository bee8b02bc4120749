//! Tabs between a key's colon and its value, which YAML allows and `saphyr-parser` refuses before letters,
//! digits and signs: there, it takes them for an indentation.

use saphyr_parser::Parser;
use std::borrow::Cow;

/// Words of the parser's error.
const REFUSED: &str = "':' must be followed by a valid YAML whitespace";

/// Bytes that are read again in all. Beyond, tabs are left to be refused.
const MOST_READ: usize = 1 << 26;

/// The text with spaces in place of such tabs, byte for byte.
///
/// The parser alone knows which tabs are in quotes, so each is replaced when it is refused.
pub(super) fn spaced(text: &str) -> Cow<'_, str> {
    let mut text = Cow::Borrowed(text);
    let mut read = 0;
    while text.contains(":\t") {
        let Some(at) = refused(&text) else {
            break;
        };
        let kept = text[..at].trim_end_matches('\t').len();
        read += text.len();
        if kept == at || read > MOST_READ {
            break;
        }
        text.to_mut()
            .replace_range(kept..at, &" ".repeat(at - kept));
    }
    text
}

/// The byte after the first tabs that are refused.
fn refused(text: &str) -> Option<usize> {
    let error = Parser::new_from_str(text).find_map(Result::err)?;
    let is_tab = error.info() == REFUSED;
    is_tab.then(|| super::Locator::new(text, 0, 0).offset(error.marker()))
}
