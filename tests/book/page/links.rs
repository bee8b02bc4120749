//! Links and pictures.

/// A link or a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Link {
    /// Line of its target, from 1.
    pub(crate) line: usize,
    /// Target of the link.
    pub(crate) target: String,
    /// The text, or the description of a picture.
    pub(crate) text: String,
    /// True if it is a picture.
    pub(crate) is_picture: bool,
}

fn line_of(text: &str, at: usize) -> usize {
    1 + text[..at].matches('\n').count()
}

/// Returns links as in Markdown, and `src` and `href` as in HTML, in `prose`.
pub(super) fn read(prose: &str) -> Vec<Link> {
    let mut links = Vec::new();
    for (at, _) in prose.match_indices("](") {
        let rest = &prose[at + 2..];
        let Some(end) = rest
            .find([')', '\n'])
            .filter(|&end| rest[end..].starts_with(')'))
        else {
            continue;
        };
        let open = opening(&prose[..at]);
        links.push(Link {
            line: line_of(prose, at),
            target: rest[..end].trim().to_owned(),
            text: prose[open..at].to_owned(),
            is_picture: prose[..open.saturating_sub(1)].ends_with('!'),
        });
    }
    for attribute in [" src=\"", " href=\""] {
        for (at, _) in prose.match_indices(attribute) {
            let rest = &prose[at + attribute.len()..];
            let end = rest.find('"').unwrap_or(rest.len());
            let tag = &prose[prose[..at].rfind('<').unwrap_or(at)..];
            let tag = &tag[..tag.find('>').unwrap_or(tag.len())];
            let text = tag.split("alt=\"").nth(1).unwrap_or_default();
            links.push(Link {
                line: line_of(prose, at),
                target: rest[..end].to_owned(),
                text: text.split('"').next().unwrap_or_default().to_owned(),
                is_picture: attribute == " src=\"",
            });
        }
    }
    links.sort_by_key(|link| link.line);
    links
}

/// Returns the offset after the bracket that opens the text at the end of `before`.
fn opening(before: &str) -> usize {
    let mut depth = 0;
    for (at, c) in before.char_indices().rev() {
        match c {
            ']' => depth += 1,
            '[' if depth == 0 => return at + 1,
            '[' => depth -= 1,
            _ => {}
        }
    }
    before.len()
}
