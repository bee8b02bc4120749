//! Tests that no text causes a panic or an endless run: a mutated scene is either accepted or refused with at
//! least one error, and every error can be rendered.

#![allow(clippy::format_collect)]

use super::cases;
use proptest::prelude::*;
use qrt::scene::front;
use qrt::syntax::Source;
use std::time::{Duration, Instant};

/// Parses a text and renders its errors.
fn judge(text: &str, sets: &[String]) {
    match front::parse(text, "mutated.yaml", sets, "tests/good_scenes".as_ref()) {
        Ok(loaded) => assert!(loaded.valid.scene().film.width > 0),
        Err(report) => {
            assert!(!report.codes().is_empty());
            for colour in [false, true] {
                assert!(report.render(colour).contains("error"));
            }
            // The text of a scene must not reach the terminal as a control sequence.
            let text = report.render(false);
            assert!(
                !text.contains(|c: char| c.is_control() && c != '\n'),
                "{text:?}"
            );
        }
    }
}

fn texts() -> Vec<String> {
    let mut texts = Vec::new();
    for folder in ["tests/good_scenes", "tests/bad_scenes"] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|end| end == "yaml") {
                let bytes = std::fs::read(path).unwrap();
                texts.push(String::from_utf8_lossy(&bytes).into_owned());
            }
        }
    }
    texts.sort();
    texts
}

/// Pieces of text that have a meaning somewhere.
const PIECES: &[&str] = &[
    "\t",
    "\r",
    "\r\n",
    "\n",
    "\0",
    "\u{feff}",
    "\u{85}",
    "\u{2028}",
    "é",
    "漢",
    "🦀",
    "e\u{301}",
    "\u{200d}",
    "[",
    "]",
    "{",
    "}",
    ":",
    ": ",
    "- ",
    ",",
    "#",
    " # ",
    "&a ",
    "*a",
    "!x ",
    "!!str ",
    "<<: ",
    "? ",
    "| ",
    ">-\n",
    "'",
    "\"",
    "\\",
    "\\u12",
    "%YAML 1.2\n---\n",
    "%TAG ! x\n",
    "---\n",
    "...\n",
    "@",
    "`",
    "~",
    ".nan",
    "-.inf",
    "1e999",
    "1e-999",
    "-0",
    "0x",
    "99999999999999999999",
    "1e30",
    "-1e30",
    "5e-324",
    "\u{1b}[31m",
    "\"\\e[2J\"",
    "\u{7}",
    "\u{202e}",
    "null",
    "true",
    "auto",
    "\"",
    "white",
    "bsdf",
    "{ mesh: { obj: . } }",
    "mesh: { obj: /dev/null }",
    "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
    "- - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - ",
];

#[derive(Clone, Debug)]
enum Mutation {
    Flip(prop::sample::Index, u8),
    Insert(prop::sample::Index, prop::sample::Index),
    Delete(prop::sample::Index, usize),
    DropLine(prop::sample::Index),
    DoubleLine(prop::sample::Index),
    SwapLines(prop::sample::Index, prop::sample::Index),
    Truncate(prop::sample::Index),
    Indent(prop::sample::Index, usize),
    Splice(prop::sample::Index, prop::sample::Index),
}

fn mutate(text: &str, mutation: &Mutation, texts: &[String]) -> String {
    let edit = |edit: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = text.as_bytes().to_vec();
        edit(&mut bytes);
        String::from_utf8_lossy(&bytes).into_owned()
    };
    let lines = || {
        text.split_inclusive('\n')
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let boundary =
        |index: &prop::sample::Index| text.floor_char_boundary(index.index(text.len() + 1));
    if text.is_empty() {
        return text.to_owned();
    }
    match mutation {
        Mutation::Flip(at, mask) => edit(&|bytes| {
            let at = at.index(bytes.len());
            bytes[at] ^= mask;
        }),
        Mutation::Insert(at, piece) => {
            let at = boundary(at);
            format!("{}{}{}", &text[..at], piece.get(PIECES), &text[at..])
        }
        Mutation::Delete(at, length) => edit(&|bytes| {
            let at = at.index(bytes.len());
            let end = (at + length).min(bytes.len());
            bytes.drain(at..end);
        }),
        Mutation::DropLine(at) => {
            let mut lines = lines();
            lines.remove(at.index(lines.len()));
            lines.concat()
        }
        Mutation::DoubleLine(at) => {
            let mut lines = lines();
            let at = at.index(lines.len());
            lines.insert(at, lines[at].clone());
            lines.concat()
        }
        Mutation::SwapLines(a, b) => {
            let mut lines = lines();
            let (a, b) = (a.index(lines.len()), b.index(lines.len()));
            lines.swap(a, b);
            lines.concat()
        }
        Mutation::Truncate(at) => text[..boundary(at)].to_owned(),
        Mutation::Indent(at, by) => {
            let mut lines = lines();
            let at = at.index(lines.len());
            lines[at].insert_str(0, &" ".repeat(*by));
            lines.concat()
        }
        Mutation::Splice(at, other) => {
            let other = other.get(texts);
            let at = boundary(at);
            let from = other.floor_char_boundary(other.len() / 2);
            format!("{}{}", &text[..at], &other[from..])
        }
    }
}

fn mutations() -> impl Strategy<Value = Mutation> {
    let at = any::<prop::sample::Index>;
    prop_oneof![
        (at(), 1u8..).prop_map(|(a, mask)| Mutation::Flip(a, mask)),
        (at(), at()).prop_map(|(a, b)| Mutation::Insert(a, b)),
        (at(), 1usize..20).prop_map(|(a, n)| Mutation::Delete(a, n)),
        at().prop_map(Mutation::DropLine),
        at().prop_map(Mutation::DoubleLine),
        (at(), at()).prop_map(|(a, b)| Mutation::SwapLines(a, b)),
        at().prop_map(Mutation::Truncate),
        (at(), 1usize..5).prop_map(|(a, n)| Mutation::Indent(a, n)),
        (at(), at()).prop_map(|(a, b)| Mutation::Splice(a, b)),
    ]
}

proptest! {
    #![proptest_config(cases(3000))]

    #[test]
    fn mutated_scenes(
        which in any::<prop::sample::Index>(),
        mutations in prop::collection::vec(mutations(), 1..6),
    ) {
        static TEXTS: std::sync::LazyLock<Vec<String>> = std::sync::LazyLock::new(texts);
        let mut text = which.get(&TEXTS).clone();
        for mutation in &mutations {
            text = mutate(&text, mutation, &TEXTS);
        }
        let start = Instant::now();
        judge(&text, &[]);
        prop_assert!(start.elapsed() < Duration::from_secs(5), "{}", text);
    }

    #[test]
    fn any_text(text in "[ -~\n\t\r\u{0}\u{85}\u{feff}äß漢🦀]{0,80}") {
        judge(&text, &[]);
    }

    #[test]
    fn any_override(
        set in "[a-z.\\[\\]0-9= {},\"'*&!:é-]{0,40}",
        key in "(film|sampling|depths|counting|budget|materials|geometry)(\\.[a-z_]{1,8}|\\[[0-9]\\]){0,3}",
        value in "[ -~]{0,20}",
    ) {
        let base = "name: a\ngeometry: []\nmaterials: {}\nfilm: { width: 1, height: 1 }\n";
        judge(base, &[set, format!("{key}={value}")]);
    }
}

/// Texts that are cheap to write and expensive to read for a careless reader.
#[test]
fn bombs_are_refused_in_time() {
    let scene = std::fs::read_to_string("tests/good_scenes/least.yaml").unwrap();
    let many = 20_000;
    let numbered = |format: &dyn Fn(usize) -> String| (0..many).map(format).collect::<String>();
    let bombs = [
        ("brackets", format!("name: {}", "[".repeat(many))),
        ("braces", format!("name: {}", "{a: ".repeat(many))),
        ("dashes", format!("name:\n  {}", "- ".repeat(many))),
        ("questions", "? ".repeat(many)),
        (
            "indents",
            (0..2000).map(|n| format!("{:n$}a:\n", "")).collect(),
        ),
        ("quotes", "'".repeat(many * 5 + 1)),
        ("blanks", format!("name: \"{}\"", " \n".repeat(many))),
        ("digits", format!("name: {}", "9".repeat(many * 10))),
        (
            "zeros",
            format!(
                "film: {{ width: 0.{}1e{}0 }}",
                "0".repeat(many),
                "9".repeat(100)
            ),
        ),
        ("long key", format!("{}: 1\n", "k".repeat(many))),
        (
            "unknown keys",
            scene.clone() + &numbered(&|n| format!("k{n}: 1\n")),
        ),
        ("double keys", scene.clone() + &"k: 1\n".repeat(many)),
        ("anchors", numbered(&|n| format!("- &a{n} x\n"))),
        ("aliases", format!("- &a x\n{}", "- *a\n".repeat(many))),
        (
            "unknown materials",
            scene.replace("materials: {}", "materials:\n")
                + &numbered(&|n| {
                    format!("  material-{n}: {{ mirror: {{ reflectance: [1, 1, 2] }} }}\n")
                }),
        ),
        (
            "unknown names",
            scene.replace("geometry: []", "geometry:\n")
                + &numbered(&|n| {
                    let points = "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]";
                    format!("  - triangle: {{ vertices: {points}, material: material-{n} }}\n")
                }),
        ),
        (
            "depths",
            scene.clone()
                + "sampling: { depths: ["
                + &"{ bits: [1, 1], map: x }, ".repeat(many)
                + "] }",
        ),
        (
            "comments",
            "# ä\n".repeat(many) + &scene + &"#\n".repeat(many),
        ),
        (
            "one line",
            format!("{{ name: x, geometry: [{}] }}", "ä, ".repeat(many)),
        ),
        ("tags", format!("name: {}x", "!a ".repeat(many))),
        ("tagged", numbered(&|n| format!("- !t{n} x\n"))),
    ];
    for (name, text) in bombs {
        let start = Instant::now();
        judge(&text, &[]);
        let seconds = start.elapsed().as_secs_f64();
        println!("{name}: {seconds:.3} s");
        assert!(seconds < 10.0, "{name}: {seconds} s");
    }
}

/// Places at the very end, between the bytes of a character, and behind the end.
#[test]
fn any_place_can_be_shown() {
    use qrt::syntax::tree::Span;
    use qrt::syntax::{Camera, Problem, Report, What};
    let what = What::OfFile {
        what: Box::new(Camera::NoView.into()),
        place: "here\n\tand there".into(),
    };
    for text in [
        "",
        "\n",
        "é",
        "漢\n字",
        "a\tb\r\nc",
        "🦀🦀\n\n",
        "\t\t\u{301}x\u{200d}\n",
    ] {
        let source = Source::new("any.yaml", text);
        for start in 0..text.len() + 3 {
            for end in 0..text.len() + 3 {
                for other in [None, Some(0), Some(text.len())] {
                    let span = |start, end| Span {
                        source: 0,
                        start,
                        end,
                    };
                    let mut problem = Problem::new(span(start, end), what.clone());
                    problem.also = other.map(|at| span(at, at + 1).into());
                    let report = Report::new(vec![source.clone()], None, vec![problem]);
                    assert!(report.render(false).contains("any.yaml"));
                }
            }
        }
    }
}
