//! The name by which the author's crate knows `qrt`. It is another name if the crate's Cargo.toml
//! says `quantum = { package = "qrt" }`.

use proc_macro2::{Group, Ident, Span, TokenStream, TokenTree};
use std::path::Path;

/// Splits `crate = path`, with a semicolon if more follows, off a macro's input. The path is where
/// the author finds `qrt`, for example as `library::qrt` in a library that re-exports it.
pub(crate) fn given(input: TokenStream) -> (Option<TokenStream>, TokenStream) {
    let mut rest = input.clone().into_iter();
    let [first, second] = [rest.next(), rest.next()].map(|token| token.map(|t| t.to_string()));
    if [first.as_deref(), second.as_deref()] != [Some("crate"), Some("=")] {
        return (None, input);
    }
    let is_end = |token: &TokenTree| matches!(token, TokenTree::Punct(p) if p.as_char() == ';');
    let path: TokenStream = rest.by_ref().take_while(|token| !is_end(token)).collect();
    match syn::parse2::<syn::Path>(path.clone()) {
        Ok(_) => (Some(path), rest.collect()),
        Err(_) => (None, input),
    }
}

/// Returns the expansion with the path by which the author knows `qrt`: as `given`, or by the name
/// that it has in the crate in `folder`.
pub(crate) fn named(tokens: TokenStream, folder: &Path, given: Option<TokenStream>) -> TokenStream {
    if let Some(path) = given {
        return renamed(tokens, &path);
    }
    match name(folder) {
        Some(name) if name != "qrt" => {
            let name = Ident::new(&name, Span::call_site());
            renamed(tokens, &quote::quote!(::#name))
        }
        _ => tokens,
    }
}

/// Replaces every `::qrt` that begins a path.
fn renamed(tokens: TokenStream, path: &TokenStream) -> TokenStream {
    let mut out: Vec<TokenTree> = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                let mut inner = Group::new(group.delimiter(), renamed(group.stream(), path));
                inner.set_span(group.span());
                out.push(inner.into());
            }
            TokenTree::Ident(ident) if ident == "qrt" && begins_path(&out) => {
                out.truncate(out.len() - 2);
                out.extend(path.clone());
            }
            other => out.push(other),
        }
    }
    out.into_iter().collect()
}

/// True if `tokens` end in the two colons that begin a path. A segment or its arguments before them
/// would make it the middle of one.
fn begins_path(tokens: &[TokenTree]) -> bool {
    let [before @ .., first, second] = tokens else {
        return false;
    };
    if !is(first, ':') || !is(second, ':') {
        return false;
    }
    match before {
        [.., quote, TokenTree::Ident(_)] if is(quote, '\'') => true,
        [.., TokenTree::Ident(word)] => KEYWORDS.contains(&word.to_string().as_str()),
        [.., close] if is(close, '>') => !ends_segment(before),
        _ => true,
    }
}

/// The keywords that a path may follow.
const KEYWORDS: [&str; 18] = [
    "as", "break", "const", "dyn", "else", "for", "if", "impl", "in", "let", "match", "mut", "pub",
    "return", "use", "where", "while", "yield",
];

/// True if the `>` that `tokens` end in closes a qualified type or the arguments of a segment. False
/// if it is an operator, or closes the parameters of `impl<..>` or `for<..>`.
fn ends_segment(tokens: &[TokenTree]) -> bool {
    let follows = |at: usize, sign: char| at > 0 && is(&tokens[at - 1], sign);
    let mut depth = 0;
    for at in (0..tokens.len()).rev() {
        let TokenTree::Punct(sign) = &tokens[at] else {
            continue;
        };
        match sign.as_char() {
            ';' => return false,
            '>' if !follows(at, '-') && !follows(at, '=') => depth += 1,
            '<' if tokens.get(at + 1).is_none_or(|next| !is(next, '=')) => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            // A qualified type may follow `for`, too, and begins with no lifetime.
            let has_lifetimes = |next: &TokenTree| is(next, '\'') || is(next, '>');
            let has_lifetimes = tokens.get(at + 1).is_some_and(has_lifetimes);
            let declares = |word: &Ident| word == "impl" || word == "for" && has_lifetimes;
            return sign.as_char() == '<'
                && !matches!(&tokens[..at], [.., TokenTree::Ident(word)] if declares(word));
        }
    }
    false
}

fn is(token: &TokenTree, sign: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == sign)
}

fn name(folder: &Path) -> Option<String> {
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).ok()?;
    let workspace = || {
        let folders = folder.ancestors();
        let manifests = folders.filter_map(|f| std::fs::read_to_string(f.join("Cargo.toml")).ok());
        let mut roots = manifests.filter(|text| text.contains("[workspace"));
        roots.next().unwrap_or_default()
    };
    dependency(&manifest, workspace).map(|name| name.replace('-', "_"))
}

/// A dependency, as a manifest describes it.
struct Entry {
    name: String,
    /// True if its package is `qrt`, by this name or another.
    is_qrt: bool,
    /// True if the workspace's manifest states the package.
    inherited: bool,
}

fn dependency(manifest: &str, workspace: impl Fn() -> String) -> Option<String> {
    let entries = entries(manifest);
    if let Some(own) = entries.iter().find(|entry| entry.is_qrt) {
        return Some(own.name.clone());
    }
    let shared = workspace();
    let shared = self::entries(&shared);
    let of = |entry: &&Entry| {
        let same = |other: &Entry| other.is_qrt && other.name == entry.name;
        entry.inherited && shared.iter().any(same)
    };
    let inherited = entries.iter().find(of)?;
    Some(inherited.name.clone())
}

/// Returns the entries of all tables of dependencies, as far as they identify the package.
fn entries(manifest: &str) -> Vec<Entry> {
    let mut found = Vec::new();
    // The state at a line: within a table of dependencies, or of the named one of them.
    let (mut within, mut of): (bool, Option<String>) = (false, None);
    for line in manifest.lines() {
        let line: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        let line = line.replace('\'', "\"");
        if let Some(header) = line.strip_prefix('[') {
            let header = header.split(']').next().unwrap_or_default();
            within = header.ends_with("dependencies");
            of = header
                .rsplit_once("dependencies.")
                .map(|(_, name)| name.trim_matches('"').to_owned());
            continue;
        }
        let Some((key, value)) = line.split_once('=') else {
            continue;
        };
        let key = key.replace('"', "");
        let (name, said) = match (&of, key.split_once('.')) {
            (Some(name), _) => (name.clone(), line.clone()),
            (None, _) if !within => continue,
            (None, Some((name, rest))) => (name.to_owned(), format!("{rest}={value}")),
            (None, None) => (key, value.to_owned()),
        };
        found.push(Entry {
            is_qrt: said.contains("package=\"qrt\"") || name == "qrt",
            inherited: said.contains("workspace=true"),
            name,
        });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use quote::quote;

    fn found(manifest: &str, workspace: &str) -> Option<String> {
        dependency(manifest, || workspace.to_owned())
    }

    #[test]
    fn a_dependency_is_found_however_it_is_written() {
        for renamed in [
            "[dependencies]\nquantum = { path = \"..\", package = \"qrt\" }",
            "[dev-dependencies]\nquantum = {package='qrt', version = \"1\"} # ours",
            "[dependencies.quantum]\nversion = \"1\"\npackage = \"qrt\"",
            "[dependencies]\nrand = \"1\"\nquantum.package = \"qrt\"",
            "[target.'cfg(unix)'.dependencies]\n\"quantum\" = { package = \"qrt\" }",
        ] {
            assert_eq!(found(renamed, "").as_deref(), Some("quantum"), "{renamed}");
        }
        let plain = "[package]\nname = \"mine\"\n[dependencies]\nqrt = \"1\"";
        assert_eq!(found(plain, "").as_deref(), Some("qrt"));
        assert_eq!(found("[package]\npackage = \"qrt\"", ""), None);
        let other = "[dependencies]\nother = { package = \"qrt-core\" }";
        assert_eq!(found(other, ""), None);
    }

    #[test]
    fn a_dependency_may_be_the_workspaces() {
        let shared = "[workspace.dependencies]\nquantum = { package = \"qrt\", version = \"1\" }";
        for inherited in [
            "[dependencies]\nquantum.workspace = true",
            "[dependencies]\nrand.workspace = true\nquantum = { workspace = true }",
            "[dependencies.quantum]\nworkspace = true",
        ] {
            assert_eq!(
                found(inherited, shared).as_deref(),
                Some("quantum"),
                "{inherited}"
            );
        }
        assert_eq!(found("[dependencies]\nrand.workspace = true", shared), None);
    }

    #[test]
    fn only_paths_from_the_crate_are_renamed() {
        let tokens = quote!(
            use ::qrt::circuit::Bit; let qrt: ::qrt::Qrt = { f::<::qrt::X>(qrt) };
        );
        let renamed = quote!(
            use ::quantum::circuit::Bit; let qrt: ::quantum::Qrt = { f::<::quantum::X>(qrt) };
        );
        assert_eq!(
            super::renamed(tokens, &quote!(::quantum)).to_string(),
            renamed.to_string()
        );
    }

    #[test]
    fn a_path_that_is_given_is_used() {
        let (path, rest) = given(quote!(crate = library::qrt; scene Room {}));
        assert_eq!(rest.to_string(), quote!(scene Room {}).to_string());
        let path = path.unwrap_or_default();
        for (tokens, expected) in [
            (
                quote! {
                    impl ::qrt::Host for own::qrt::Host {
                        fn f() -> ::qrt::X<Vec<u8>> { g::<Y>::qrt::h() }
                    }
                },
                quote! {
                    impl library::qrt::Host for own::qrt::Host {
                        fn f() -> library::qrt::X<Vec<u8>> { g::<Y>::qrt::h() }
                    }
                },
            ),
            // After a lifetime.
            (
                quote!(
                    fn f<'a>(x: &'a ::qrt::X) -> &'static ::qrt::Y {
                        break 'a ::qrt::Z;
                    }
                ),
                quote!(
                    fn f<'a>(x: &'a library::qrt::X) -> &'static library::qrt::Y {
                        break 'a library::qrt::Z;
                    }
                ),
            ),
            // After parameters and bounds, and after arguments and qualified types.
            (
                quote!(
                    impl<const W: u32, F: Fn(A<B>) -> C<D>> ::qrt::X for <Y as Z<W>>::qrt::A {}
                ),
                quote!(
                    impl<const W: u32, F: Fn(A<B>) -> C<D>> library::qrt::X for <Y as Z<W>>::qrt::A {}
                ),
            ),
            (
                quote!(
                    fn f(x: &dyn for<'a> ::qrt::X<'a>, y: Y<Fn() -> Z<W>>::qrt::A) {}
                ),
                quote!(
                    fn f(x: &dyn for<'a> library::qrt::X<'a>, y: Y<Fn() -> Z<W>>::qrt::A) {}
                ),
            ),
            // After operators.
            (
                quote!(x < y; x > ::qrt::X; x >> ::qrt::X; x <= y && z > ::qrt::X),
                quote!(x < y; x > library::qrt::X; x >> library::qrt::X;
                    x <= y && z > library::qrt::X),
            ),
            // After keywords, and after a name that only looks like one.
            (
                quote!(struct X(pub ::qrt::Y) where ::qrt::Y: Z; if ::qrt::A {} r#if::qrt::A),
                quote!(struct X(pub library::qrt::Y) where library::qrt::Y: Z;
                    if library::qrt::A {} r#if::qrt::A),
            ),
        ] {
            assert_eq!(
                super::renamed(tokens, &path).to_string(),
                expected.to_string()
            );
        }
        for other in [quote!(scene Room {}), quote!(crate = "qrt"), quote!(crate)] {
            let (path, rest) = given(other.clone());
            assert!(path.is_none());
            assert_eq!(rest.to_string(), other.to_string());
        }
    }

    /// Returns `tokens` without literals, which show an author's code.
    fn without_literals(tokens: TokenStream) -> TokenStream {
        let kept = tokens.into_iter().filter_map(|token| match token {
            TokenTree::Literal(_) => None,
            TokenTree::Group(group) => {
                let inner = without_literals(group.stream());
                Some(Group::new(group.delimiter(), inner).into())
            }
            other => Some(other),
        });
        kept.collect()
    }

    /// Panics unless all paths from the crate in `tokens` are renamed.
    fn assert_all_renamed(tokens: TokenStream, from: &str) {
        let tokens = super::renamed(without_literals(tokens), &quote!(::quantum)).to_string();
        assert!(tokens.contains(":: quantum"), "{from}");
        if let Some(at) = tokens.find(":: qrt") {
            let start = at.saturating_sub(80);
            panic!("{from}: {}", &tokens[start..at]);
        }
    }

    #[test]
    fn no_path_of_generated_code_is_left_over() {
        for (name, text) in [
            ("small.rs", include_str!("generate/snapshots/small.rs")),
            (
                "parabola.rs",
                include_str!("reversible/snapshots/parabola.rs"),
            ),
            (
                "polynomial.rs",
                include_str!("reversible/snapshots/polynomial.rs"),
            ),
            (
                "rotate_where.rs",
                include_str!("reversible/snapshots/rotate_where.rs"),
            ),
        ] {
            assert_all_renamed(text.parse().unwrap_or_default(), name);
        }
        // A scene and every kind of statement, which crates of several kinds compile.
        let program = include_str!("../../.ci/newcomer/both_macros.rs");
        let items =
            syn::parse_str(program).map_or_else(|_| Vec::new(), |file: syn::File| file.items);
        assert!(!items.is_empty());
        for item in items {
            let expansion = match item {
                syn::Item::Macro(scene) => crate::scene::expand(scene.mac.tokens, "".as_ref()),
                syn::Item::Fn(mut function) => {
                    let count = function.attrs.len();
                    let is_doc = |attribute: &syn::Attribute| attribute.path().is_ident("doc");
                    function.attrs.retain(is_doc);
                    if function.attrs.len() == count {
                        continue;
                    }
                    crate::reversible::expand(&TokenStream::new(), quote!(#function))
                }
                _ => continue,
            };
            let text = expansion.to_string();
            assert!(!text.contains("compile_error"), "{text}");
            assert_all_renamed(expansion, "both_macros.rs");
        }
    }
}
