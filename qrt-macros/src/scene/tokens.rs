//! The tokens of a macro's input, numbered: a place in a scene's tree is the numbers of its first
//! and its last token.

use proc_macro2::{Delimiter, Spacing, Span, TokenStream, TokenTree};
use qrt_syntax::tree;

/// A token and its place.
#[derive(Clone, Debug)]
pub(crate) struct Token {
    /// The kind of the token.
    pub(crate) kind: Kind,
    /// The number of the token's first span, and of its last: a group has two.
    pub(crate) first: usize,
    pub(crate) last: usize,
}

/// The kind of a token.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    /// A name or a keyword.
    Word(String),
    /// One character of punctuation, and whether the next one belongs to it.
    Sign(char, bool),
    /// A number: its digits without `_`, and its suffix.
    Number(String, String),
    /// A text in quotes, escapes resolved.
    Text(String),
    /// Another literal, as written.
    Other(String),
    /// The tokens in brackets.
    Group(Delimiter, Vec<Token>),
}

impl PartialEq for Token {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind
    }
}

impl Token {
    /// Returns the place of the token in the input.
    pub(crate) fn place(&self) -> tree::Span {
        place(self.first, self.last)
    }

    /// True if it is this word.
    pub(crate) fn is_word(&self, text: &str) -> bool {
        matches!(&self.kind, Kind::Word(word) if word == text)
    }

    /// True if it is this character of punctuation.
    pub(crate) fn is_sign(&self, sign: char) -> bool {
        matches!(&self.kind, Kind::Sign(own, _) if *own == sign)
    }

    /// Returns the word, if the token is one.
    pub(crate) fn word(&self) -> Option<&str> {
        match &self.kind {
            Kind::Word(word) => Some(word),
            _ => None,
        }
    }

    /// Returns the name: a word, or a text in quotes.
    pub(crate) fn name(&self) -> Option<&str> {
        match &self.kind {
            Kind::Word(text) | Kind::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Returns the tokens in these brackets.
    pub(crate) fn group(&self, brackets: Delimiter) -> Option<&[Token]> {
        match &self.kind {
            Kind::Group(own, tokens) if *own == brackets => Some(tokens),
            _ => None,
        }
    }

    /// Describes the token, for "expected a value, found ...".
    pub(crate) fn found(&self) -> String {
        match &self.kind {
            Kind::Word(text) | Kind::Other(text) => format!("`{text}`"),
            Kind::Sign(sign, _) => format!("`{sign}`"),
            Kind::Number(digits, suffix) => format!("`{digits}{suffix}`"),
            Kind::Text(text) => format!("the text {text:?}"),
            Kind::Group(Delimiter::Parenthesis, _) => "`(...)`".to_owned(),
            Kind::Group(Delimiter::Bracket, _) => "`[...]`".to_owned(),
            Kind::Group(..) => "`{ ... }`".to_owned(),
        }
    }
}

/// Returns tokens as an author writes them.
pub(crate) fn written(tokens: &[Token]) -> String {
    let mut text = String::new();
    for token in tokens {
        let own = match &token.kind {
            Kind::Word(word) | Kind::Other(word) => word.clone(),
            Kind::Sign(sign, _) => sign.to_string(),
            Kind::Number(digits, suffix) => format!("{digits}{suffix}"),
            Kind::Text(text) => format!("{text:?}"),
            Kind::Group(Delimiter::Bracket, inner) => format!("[{}]", written(inner)),
            Kind::Group(Delimiter::Brace, inner) => format!("{{ {} }}", written(inner)),
            Kind::Group(_, inner) => format!("({})", written(inner)),
        };
        let joins = text.is_empty()
            || own == ","
            || own.starts_with('^')
            || text.ends_with('^')
            || own.starts_with('(') && text.ends_with(|c: char| c.is_alphanumeric());
        if !joins {
            text.push(' ');
        }
        text.push_str(&own);
    }
    text
}

/// Returns the place from the first of these tokens to the last.
pub(crate) fn place_of(tokens: &[Token]) -> Option<tree::Span> {
    let (first, last) = (tokens.first()?, tokens.last()?);
    Some(place(first.first, last.last))
}

/// Returns the place from one token's number to another's.
pub(crate) fn place(start: usize, end: usize) -> tree::Span {
    tree::Span {
        source: 0,
        start,
        end,
    }
}

/// Returns the place from the beginning of one place to the end of another.
pub(crate) fn join(from: tree::Span, to: tree::Span) -> tree::Span {
    place(from.start, to.end)
}

/// The compiler's span of each token.
#[derive(Debug, Default)]
pub(crate) struct Table(Vec<Span>);

impl Table {
    /// Reads and numbers tokens.
    pub(crate) fn read(&mut self, stream: TokenStream) -> Vec<Token> {
        let mut tokens = Vec::new();
        for tree in stream {
            if let TokenTree::Group(group) = &tree
                && group.delimiter() == Delimiter::None
            {
                // The value of another macro's variable: one token, or a whole expression.
                let first = self.0.len();
                let mut inner = self.read(group.stream());
                if inner.len() == 1 {
                    tokens.append(&mut inner);
                } else if first < self.0.len() {
                    tokens.push(Token {
                        kind: Kind::Group(Delimiter::Parenthesis, inner),
                        first,
                        last: self.0.len() - 1,
                    });
                }
                continue;
            }
            tokens.push(self.token(tree));
        }
        tokens
    }

    fn token(&mut self, tree: TokenTree) -> Token {
        let first = self.0.len();
        let kind = match tree {
            TokenTree::Group(group) => {
                self.0.push(group.span_open());
                let inner = self.read(group.stream());
                self.0.push(group.span_close());
                Kind::Group(group.delimiter(), inner)
            }
            TokenTree::Ident(ident) => {
                self.0.push(ident.span());
                let text = ident.to_string();
                Kind::Word(text.strip_prefix("r#").unwrap_or(&text).to_owned())
            }
            TokenTree::Punct(punct) => {
                self.0.push(punct.span());
                Kind::Sign(punct.as_char(), punct.spacing() == Spacing::Joint)
            }
            TokenTree::Literal(literal) => {
                self.0.push(literal.span());
                let text = literal.to_string();
                match syn::Lit::new(literal) {
                    syn::Lit::Int(n) => Kind::Number(n.base10_digits().into(), n.suffix().into()),
                    syn::Lit::Float(n) => Kind::Number(n.base10_digits().into(), n.suffix().into()),
                    syn::Lit::Str(text) if text.suffix().is_empty() => Kind::Text(text.value()),
                    _ => Kind::Other(text),
                }
            }
        };
        let last = self.0.len() - 1;
        Token { kind, first, last }
    }

    /// Returns the spans of a place's first and last token.
    pub(crate) fn ends(&self, place: tree::Span) -> (Span, Span) {
        let span = |number: usize| self.0.get(number).copied().unwrap_or_else(Span::call_site);
        (span(place.start), span(place.end))
    }
}

/// Returns the parts between commas, without an empty part after the last comma.
pub(crate) fn between_commas(tokens: &[Token]) -> Vec<&[Token]> {
    let mut parts: Vec<_> = tokens.split(|token| token.is_sign(',')).collect();
    if parts.last().is_some_and(|last| last.is_empty()) {
        parts.pop();
    }
    parts
}
