//! Line starts of a text.

/// Start of each line of `text` but the first, as a byte offset. A line ends in LF, CR LF or CR.
///
/// Editors number lines by this rule, and so do YAML, OBJ and MTL files.
pub fn line_starts(text: &[u8]) -> impl Iterator<Item = usize> {
    let ends = |(at, byte): (usize, &u8)| match byte {
        b'\n' => Some(at + 1),
        b'\r' if text.get(at + 1) != Some(&b'\n') => Some(at + 1),
        _ => None,
    };
    text.iter().enumerate().filter_map(ends)
}

/// Number of the line, from 1, in which the byte after `before` stands.
pub fn line_after(before: &[u8]) -> usize {
    1 + line_starts(before).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_in_lf_or_cr_lf_or_cr() {
        let starts = |text: &str| line_starts(text.as_bytes()).collect::<Vec<_>>();
        assert_eq!(starts("a\nb\r\nc\rd"), [2, 5, 7]);
        assert_eq!(starts("\n\r\r\n\n\r"), [1, 2, 4, 5, 6]);
        assert_eq!(line_after(b"a\r\nb\rc\n"), 4);
        assert_eq!(line_after(b""), 1);
    }
}
