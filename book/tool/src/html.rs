//! Small functions on HTML that several modules need.

/// Returns the same HTML on one line, with nothing in it that Markdown would interpret.
///
/// Between tags, each character that means something in Markdown becomes a character reference;
/// a `|`, which would end a table's cell, does so everywhere.
pub(crate) fn within_markdown(html: &str) -> String {
    let mut safe = String::with_capacity(html.len() + 64);
    let mut in_tag = false;
    let mut previous = ' ';
    for c in html.chars() {
        match c {
            '<' => {
                in_tag = true;
                safe.push('<');
            }
            '>' => {
                in_tag = false;
                safe.push('>');
            }
            '\n' | '\r' => safe.push(' '),
            '|' => safe.push_str("&#124;"),
            '\\' | '`' | '*' | '_' | '{' | '}' | '[' | ']' | '~' | '$' | '\'' | '"' | '!' | ':'
                if !in_tag =>
            {
                reference(&mut safe, c);
            }
            // Smart punctuation would turn these into dashes or an ellipsis.
            '-' | '.' if !in_tag && previous == c => reference(&mut safe, c),
            _ => safe.push(c),
        }
        previous = c;
    }
    safe
}

fn reference(html: &mut String, c: char) {
    html.push_str("&#");
    html.push_str(&u32::from(c).to_string());
    html.push(';');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markdown_finds_nothing_of_its_own_in_what_is_made_safe() {
        let safe = within_markdown("<i title='a*b|'>*a* | b_c [d]\n-- ...</i>");
        assert!(!safe.contains('\n'));
        let mut html = String::new();
        let parser = pulldown_cmark::Parser::new_ext(
            &safe,
            pulldown_cmark::Options::ENABLE_SMART_PUNCTUATION
                | pulldown_cmark::Options::ENABLE_TABLES,
        );
        pulldown_cmark::html::push_html(&mut html, parser);
        assert_eq!(
            html.replace("&#124;", "|"),
            "<p><i title='a*b|'>*a* | b_c [d] -- ...</i></p>\n"
        );
    }
}
