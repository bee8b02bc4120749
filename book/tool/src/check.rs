//! The check of the finished book: every link resolves, nothing is loaded from elsewhere, and
//! nothing is large.

use crate::complaint::Complaint;
use anyhow::{Context as _, Result};
use html5ever::tendril::StrTendril;
use html5ever::tokenizer::states::RawKind;
use html5ever::tokenizer::{
    BufferQueue, TagKind, Token, TokenSink, TokenSinkResult, Tokenizer, TokenizerOpts,
};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Limit on the size of a page, in bytes.
const PAGE: usize = 320_000;

/// Limits on the size of WebAssembly, in bytes, by a part of its name: the playground's, and any figure's. Larger
/// files give a note only: they result where some of the tools that shrink them are missing.
const WASM: [(&str, usize); 2] = [("playground", 5_000_000), ("", 500_000)];

/// The result of the check.
#[derive(Debug, Default)]
pub(crate) struct Report {
    /// All faults.
    pub(crate) complaints: Vec<Complaint>,
    /// Number of pages.
    pub(crate) pages: usize,
    /// Number of references on them.
    pub(crate) links: usize,
    /// The largest page, and its size.
    pub(crate) largest: (String, usize),
    /// Remarks that are no faults.
    pub(crate) notes: Vec<String>,
}

/// A reference from one file to another, or to an address.
struct Reference {
    target: String,
    /// True if a reader follows it, false if the browser loads it by itself.
    followed: bool,
}

#[derive(Default)]
struct Page {
    ids: BTreeSet<String>,
    references: Vec<Reference>,
    playground: bool,
}

/// Checks the book in `folder`; complaints name that folder `seen`.
pub(crate) fn check(folder: &Path, seen: &str) -> Result<Report> {
    let mut report = Report::default();
    let mut pages: BTreeMap<String, Page> = BTreeMap::new();
    let mut names = BTreeSet::new();
    for file in crate::files::all(folder)? {
        let name = crate::files::relative(folder, &file);
        let kind = file.extension().unwrap_or_default().to_string_lossy();
        names.insert(name.clone());
        let size = usize::try_from(file.metadata()?.len())?;
        let (limit, text) = match &*kind {
            "html" => (PAGE, true),
            "svg" | "css" | "js" => (usize::MAX, true),
            _ => (usize::MAX, false),
        };
        if size >= limit {
            report.complaints.push(Complaint::about(
                &format!("{seen}/{name}"),
                format!("has {size} bytes; less than {limit} are allowed"),
            ));
        }
        let most = WASM.iter().find(|(part, _)| name.contains(part));
        if kind == "wasm"
            && let Some((_, most)) = most
            && size >= *most
        {
            report.notes.push(format!(
                "{name} has {size} bytes; wasm-opt (Binaryen) makes less than {most} of it"
            ));
        }
        if !text {
            continue;
        }
        let content = std::fs::read_to_string(&file)
            .with_context(|| format!("cannot read {}", file.display()))?;
        let page = match &*kind {
            "css" => style_sheet(&content),
            "js" => script(&name, &content),
            _ => parse(&content),
        };
        if kind == "html" {
            report.pages += 1;
            if size > report.largest.1 {
                report.largest = (name.clone(), size);
            }
        }
        pages.insert(name, page);
    }
    if !names.contains("index.html") {
        report
            .complaints
            .push(Complaint::about(seen, "there is no index.html"));
    }
    for (name, page) in &pages {
        let mut complain = |message: String| {
            report
                .complaints
                .push(Complaint::about(&format!("{seen}/{name}"), message));
        };
        if page.playground {
            complain("has listings that would be sent to a playground".to_owned());
        }
        for reference in &page.references {
            report.links += 1;
            if let Err(message) = resolve(name, reference, &names, &pages) {
                complain(message);
            }
        }
    }
    report.complaints.sort();
    report.complaints.dedup();
    Ok(report)
}

/// Checks that a reference has a target.
fn resolve(
    from: &str,
    reference: &Reference,
    names: &BTreeSet<String>,
    pages: &BTreeMap<String, Page>,
) -> Result<(), String> {
    let target = reference.target.trim();
    let lower = target.to_ascii_lowercase();
    if lower.starts_with("data:") {
        return Ok(());
    }
    let scheme = lower
        .split_once(':')
        .map(|(scheme, _)| scheme)
        .filter(|scheme| {
            !scheme.is_empty()
                && scheme
                    .chars()
                    .all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c))
        });
    if scheme.is_some() || lower.starts_with("//") {
        return match scheme {
            Some("http" | "https" | "mailto") if reference.followed => Ok(()),
            Some("http" | "https") | None => Err(format!("`{target}` is loaded from another host")),
            Some(scheme) => Err(format!("`{target}`: unknown scheme `{scheme}:`")),
        };
    }
    let (path, fragment) = match target.split_once('#') {
        Some((path, fragment)) => (path, decoded(fragment)),
        None => (target, String::new()),
    };
    let path = decoded(path.split('?').next().unwrap_or_default());
    let file = if path.is_empty() {
        from.to_owned()
    } else {
        let file =
            joined(from, &path).ok_or_else(|| format!("`{target}` leads out of the book"))?;
        match &*file {
            "" => "index.html".to_owned(),
            folder if path.ends_with('/') => format!("{folder}/index.html"),
            _ => file,
        }
    };
    if !names.contains(&file) {
        return Err(format!("`{target}` leads nowhere: there is no {file}"));
    }
    if fragment.is_empty() {
        return Ok(());
    }
    match pages.get(&file) {
        Some(page) if !page.ids.contains(&fragment) => Err(format!(
            "`{target}` leads nowhere: {file} has no #{fragment}"
        )),
        _ => Ok(()),
    }
}

/// Joins a path to the file that it is relative to; `None` if it leads out of the book.
fn joined(from: &str, path: &str) -> Option<String> {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in path.strip_prefix('/').map_or(path, |_| "..//").split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            part => parts.push(part),
        }
    }
    Some(parts.join("/"))
}

/// Decodes `%20` and similar escapes.
pub(crate) fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = (*first == b'%')
            .then(|| after.get(..2))
            .flatten()
            .and_then(|digits| std::str::from_utf8(digits).ok())
            .and_then(|digits| u8::from_str_radix(digits, 16).ok());
        bytes.push(code.unwrap_or(*first));
        rest = if code.is_some() { &after[2..] } else { after };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Returns the references of HTML or SVG, and its ids.
fn parse(text: &str) -> Page {
    let queue = BufferQueue::default();
    queue.push_back(StrTendril::from_slice(text));
    let tokenizer = Tokenizer::new(Sink::default(), TokenizerOpts::default());
    let _ = tokenizer.feed(&queue);
    tokenizer.end();
    tokenizer.sink.page.into_inner()
}

#[derive(Default)]
struct Sink {
    page: RefCell<Page>,
    in_style: RefCell<bool>,
}

impl TokenSink for Sink {
    type Handle = ();

    fn process_token(&self, token: Token, _line: u64) -> TokenSinkResult<()> {
        let mut page = self.page.borrow_mut();
        match token {
            Token::CharacterTokens(text) if *self.in_style.borrow() => {
                page.references.extend(urls(&text));
            }
            Token::TagToken(tag) => {
                *self.in_style.borrow_mut() =
                    tag.kind == TagKind::StartTag && &*tag.name == "style";
                if tag.kind != TagKind::StartTag {
                    return TokenSinkResult::Continue;
                }
                for attribute in &tag.attrs {
                    let value = &*attribute.value;
                    let mut refer = |target: &str, followed| {
                        page.references.push(Reference {
                            target: target.to_owned(),
                            followed,
                        });
                    };
                    match &*attribute.name.local {
                        "href" | "xlink:href" => {
                            refer(value, matches!(&*tag.name, "a" | "area"));
                        }
                        "src" | "poster" | "data" => refer(value, false),
                        "srcset" => {
                            for candidate in value.split(',') {
                                let url = candidate.split_whitespace().next();
                                refer(url.unwrap_or_default(), false);
                            }
                        }
                        "id" | "name" => {
                            page.ids.insert(value.to_owned());
                        }
                        "style" | "fill" | "stroke" | "clip-path" | "mask" | "filter"
                        | "marker-start" | "marker-mid" | "marker-end" => {
                            page.references.extend(urls(value));
                        }
                        "class" => {
                            page.playground |= value.split(' ').any(|class| class == "playground");
                        }
                        _ => {}
                    }
                }
                match &*tag.name {
                    "script" => {
                        return TokenSinkResult::RawData(RawKind::ScriptData);
                    }
                    "style" => return TokenSinkResult::RawData(RawKind::Rawtext),
                    _ => {}
                }
            }
            _ => {}
        }
        TokenSinkResult::Continue
    }
}

/// Returns the references of a style sheet.
fn style_sheet(text: &str) -> Page {
    Page {
        references: urls(text),
        ..Page::default()
    }
}

/// Returns the targets of `url(...)` and `@import "..."`.
fn urls(css: &str) -> Vec<Reference> {
    let load = |target: &str| Reference {
        target: target.trim().trim_matches(['"', '\'']).to_owned(),
        followed: false,
    };
    let urls = css
        .split("url(")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .map(load);
    let imports = css
        .split("@import")
        .skip(1)
        .filter_map(|rest| rest.split(';').next())
        .filter(|import| !import.contains("url("))
        .map(load);
    urls.chain(imports).collect()
}

/// Returns the references of a script: the table of contents' links, the search index's pages, and the
/// addresses on other hosts in our own scripts.
fn script(name: &str, text: &str) -> Page {
    let file = name.rsplit('/').next().unwrap_or(name);
    let mut page = Page::default();
    if file.starts_with("toc") {
        page.references = parse(text).references;
    } else if file.starts_with("searchindex") {
        let urls = text
            .split_once("\"doc_urls\":[")
            .and_then(|(_, rest)| rest.split(']').next())
            .unwrap_or_default();
        page.references = urls
            .split(',')
            .map(|url| Reference {
                target: url.trim_matches('"').to_owned(),
                followed: true,
            })
            .collect();
    } else if name.starts_with("interactive/") {
        for scheme in ["http://", "https://"] {
            page.references.extend(
                text.split(scheme)
                    .skip(1)
                    .filter_map(|rest| rest.split(['"', '\'', '`', ' ', '\n']).next())
                    // Names of namespaces look like addresses, but browsers do not load them.
                    .filter(|rest| !rest.starts_with("www.w3.org/"))
                    .map(|rest| Reference {
                        target: format!("{scheme}{rest}"),
                        followed: false,
                    }),
            );
        }
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the report on a book of `files`.
    fn reported(files: &[(&str, &str)]) -> Report {
        let folder = tempfile::tempdir().unwrap();
        let files: BTreeMap<String, &str> = files
            .iter()
            .map(|&(name, text)| (name.to_owned(), text))
            .collect();
        crate::files::write_all(folder.path(), &files).unwrap();
        check(folder.path(), "b").unwrap()
    }

    fn checked(files: &[(&str, &str)]) -> Vec<String> {
        let report = reported(files);
        report.complaints.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn right_links_pass() {
        let index = "<h1 id='top'>x</h1><a href='a/b.html#caf%C3%A9'>1</a><a href='#top'>2</a>\
            <a href='https://example.org/x'>3</a><a href='a/b.html?q=1'>4</a><img src=i.svg>\
            <script>if (1 <a href='nowhere'>2) {}</script><img src='data:image/png;base64,AA'>";
        let page = "<p id='café'><a href='../index.html'>x</a><a href='../#top'>y</a>\
            <link rel=stylesheet href='../s.css'>";
        let svg = "<svg xmlns='http://www.w3.org/2000/svg'><path id='p' fill='url(#p)'/></svg>";
        let css = "a { background: url(\"i.svg\") }";
        assert_eq!(
            checked(&[
                ("index.html", index),
                ("a/b.html", page),
                ("i.svg", svg),
                ("s.css", css)
            ]),
            [""; 0]
        );
    }

    #[test]
    fn a_wrong_link_is_caught() {
        let index = "<a href='none.html'>1</a><a href='index.html#none'>2</a><img src='no.png'>\
            <a href='../x'>3</a><a href='source:x'>4</a>";
        assert_eq!(
            checked(&[
                ("index.html", index),
                ("s.css", "a { background: url('no.svg') }"),
                ("toc-1.js", "x.innerHTML = '<a href=\"gone.html\">';"),
                (
                    "searchindex-1.js",
                    "{\"doc_urls\":[\"index.html#gone\",\"index.html\"]}"
                ),
            ]),
            [
                "b/index.html: `../x` leads out of the book",
                "b/index.html: `index.html#none` leads nowhere: index.html has no #none",
                "b/index.html: `no.png` leads nowhere: there is no no.png",
                "b/index.html: `none.html` leads nowhere: there is no none.html",
                "b/index.html: `source:x`: unknown scheme `source:`",
                "b/s.css: `no.svg` leads nowhere: there is no no.svg",
                "b/searchindex-1.js: `index.html#gone` leads nowhere: index.html has no #gone",
                "b/toc-1.js: `gone.html` leads nowhere: there is no gone.html",
            ]
        );
    }

    #[test]
    fn what_is_loaded_from_another_host_is_caught() {
        let index = "<script src='https://example.org/x.js'></script><img src='//example.org/x'>\
            <link href='http://example.org/x.css' rel=stylesheet><p style='background: \
            url(https://example.org/y)'><style>@import 'https://example.org/z';</style>\
            <pre class='playground'></pre>";
        let script = "fetch('https://example.org/w'); const n = 'http://www.w3.org/2000/svg';";
        let said = checked(&[("index.html", index), ("interactive/figures.js", script)]);
        assert_eq!(said.len(), 7, "{said:?}");
        let hosts = said
            .iter()
            .filter(|said| said.contains("is loaded from another host"));
        assert_eq!(hosts.count(), 6);
    }

    #[test]
    fn what_is_too_large_is_caught() {
        let large = " ".repeat(PAGE);
        assert_eq!(
            checked(&[("index.html", &large)]),
            ["b/index.html: has 320000 bytes; less than 320000 are allowed"]
        );
        for (name, most) in [("playground", 5_000_000), ("picture", 500_000)] {
            let (small, large) = (" ".repeat(most - 1), " ".repeat(most));
            let [x, y] = ["x", "y"].map(|folder| format!("{folder}/{name}.wasm"));
            let report = reported(&[("index.html", ""), (&x, &small), (&y, &large)]);
            assert!(report.complaints.is_empty());
            let note =
                format!("{y} has {most} bytes; wasm-opt (Binaryen) makes less than {most} of it");
            assert_eq!(report.notes, [note]);
        }
        assert_eq!(checked(&[]), ["b: there is no index.html"]);
    }
}
