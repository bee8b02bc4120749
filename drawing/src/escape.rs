//! Escapes of text within XML and HTML.

/// Escapes text for use between tags or within a quoted attribute.
///
/// XML has no control characters, not even escaped ones. All of them except tabs and line ends
/// become U+FFFD, the replacement character.
///
/// ```
/// assert_eq!(qrt_drawing::escaped("a <&\"> b\u{7}"), "a &lt;&amp;&quot;&gt; b\u{fffd}");
/// ```
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + text.len() / 8);
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\t' | '\n' | '\r' => out.push(c),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}
