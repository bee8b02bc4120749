//! Tests of the conversion of chapters.

use super::traced::origins;
use super::*;
use pulldown_cmark::Parser;
use std::path::Path;

fn workshop(root: &Path) -> Workshop {
    Workshop {
        formulas: Formulas::new(),
        sources: Sources::new(root),
        bibliography: crate::bibliography::Bibliography::default(),
        figures: Figures::default(),
        complaints: Vec::new(),
    }
}

fn processed(content: &str) -> (Processed, Vec<String>) {
    let mut workshop = workshop(Path::new(env!("CARGO_MANIFEST_DIR")));
    let chapter = Chapter {
        file: "x.md",
        page: "x.html",
        name: "X",
        original: content,
    };
    let processed = workshop.process(&chapter, content);
    let complaints = workshop
        .complaints
        .iter()
        .map(ToString::to_string)
        .collect();
    (processed, complaints)
}

/// Renders HTML as mdBook does in its next step.
fn html(markdown: &str) -> String {
    let mut html = String::new();
    let options = (options() - Options::ENABLE_MATH) | Options::ENABLE_SMART_PUNCTUATION;
    pulldown_cmark::html::push_html(&mut html, Parser::new_ext(markdown, options));
    html
}

#[test]
fn formulas_are_read_outside_code_only() {
    let content = "Let $x_1*y_1*z$ be, and `$x$`.\n\n```sh\n$ qrt\n$$ a $$\n```\n\n    $ qrt\n";
    let (processed, complaints) = processed(content);
    assert_eq!(complaints, [""; 0]);
    assert_eq!(processed.markdown.matches("class=\"katex\"").count(), 1);
    assert!(processed.markdown.contains("`$x$`"));
    assert!(processed.markdown.contains("```sh\n$ qrt\n$$ a $$\n```"));
    assert!(processed.markdown.contains("    $ qrt"));
    assert!(!html(&processed.markdown).contains("<em>"));
}

#[test]
fn a_dollar_is_written_with_a_backslash() {
    let (processed, complaints) = processed("It costs \\$3, or \\$4.\n");
    assert_eq!(complaints, [""; 0]);
    assert_eq!(processed.markdown, "It costs \\$3, or \\$4.\n");
    let (_, complaints) = super::tests::processed("Well.\n\nIt costs $3.\n");
    assert_eq!(
        complaints,
        ["x.md:3: a `$` without its pair at `$3.`: a dollar is written `\\$`"]
    );
}

#[test]
fn displayed_formulas_may_look_like_lists() {
    let (processed, complaints) =
        processed("Text\n$$\na\n- b\n+ c\n= d\n$$\nmore.\n\n- item\n  $$x$$\n");
    assert_eq!(complaints, [""; 0]);
    let html = html(&processed.markdown);
    assert_eq!(html.matches("class=\"katex-display\"").count(), 2);
    assert!(html.contains("<p>more.</p>"));
    assert_eq!(html.matches("<li>").count(), 1);
    let item = html.split("<li>").nth(1).unwrap();
    assert!(
        item.split("</li>")
            .next()
            .unwrap()
            .contains("katex-display")
    );
}

#[test]
fn formulas_stand_in_tables_and_headings() {
    let (processed, complaints) = processed(
        "| a | b |\n|---|---|\n| $P(x \\| y)$ | $\\{0, 1\\}^n$ |\n\n## The sign of $\\lvert x\\rvert$\n",
    );
    assert_eq!(complaints, [""; 0]);
    let html = html(&processed.markdown);
    assert_eq!(html.matches("<td>").count(), 2);
    assert_eq!(html.matches("class=\"katex\"").count(), 3);
}

#[test]
fn a_bad_formula_is_refused_at_its_line() {
    let (_, complaints) = processed("One\n\n$a$ and\n$\\wrong$\n\n$$\n\\frac{1\n$$\n");
    assert_eq!(complaints.len(), 2);
    assert!(complaints[0].starts_with("x.md:6: "), "{complaints:?}");
    assert!(complaints[1].starts_with("x.md:4: `\\wrong`: KaTeX parse error: Undefined"));
}

#[test]
fn lines_are_those_of_the_file_whatever_it_includes() {
    let original = "a\n```rust\n{{#include x}}\n```\nb\n";
    let expanded = "a\n```rust\n1\n2\n3\n```\nb\n";
    assert_eq!(origins(expanded, original), [1, 2, 3, 3, 3, 4, 5]);
}

#[test]
fn equations_and_links_lead_to_sources() {
    let content = "See [it](source:src/equation.rs#Equation).\n\n```equation 3\na = b\n---\n\
        what: `a` is $b$\ncode: src/equation.rs#parse\ntest: src/equation.rs#a_block_is_read\n\
        erratum: c\n```\n\nand [this](source:src/equation.rs#Nothing)\n";
    let (processed, complaints) = processed(content);
    assert_eq!(
        complaints,
        ["x.md:12: src/equation.rs does not define `Nothing`"]
    );
    let markdown = &processed.markdown;
    assert!(markdown.contains("See [it](source/src/equation.rs.html#L"));
    assert!(markdown.contains("<div class=\"equation\" id=\"eq-3\">"));
    assert!(markdown.contains("errata.html#c"));
    assert_eq!(processed.equations.len(), 1);
    assert_eq!(processed.equations[0].1, 3);

    let mut workshop = workshop(Path::new(env!("CARGO_MANIFEST_DIR")));
    let (equation, line) = processed.equations.into_iter().next().unwrap();
    let indexed = Indexed {
        equation,
        page: "x.html".to_owned(),
        name: "X".to_owned(),
        file: "x.md".to_owned(),
        line,
    };
    let chapter = Chapter {
        file: "equations.md",
        page: "equations.html",
        name: "Equations",
        original: "",
    };
    let index = workshop.index(&chapter, &[indexed]);
    assert!(index.contains("<a href=\"x.html#eq-3\">(3)</a>"));
    assert!(index.contains("<code>a</code> is <span class=\"katex\">"));
    assert!(workshop.complaints.is_empty());
}

#[test]
fn interactive_figures_are_noticed() {
    let figure = "<figure class=\"qrt-interactive\" data-figure=\"map\"><img src=\"a.svg\" alt=\"\"></figure>\n";
    assert!(processed(figure).0.interactive);
    assert!(!processed("`data-figure=\"map\"`\n").0.interactive);
}

/// Returns a block of equation 3, each line after `indent`.
fn equation(indent: &str) -> String {
    let lines = [
        "```equation 3",
        "a = b",
        "---",
        "what: it",
        "code: src/equation.rs#parse",
        "test: src/equation.rs#a_block_is_read",
        "```",
    ];
    lines.map(|line| format!("{indent}{line}\n")).concat()
}

#[test]
fn an_equation_that_is_never_closed_is_told_at_its_line() {
    let open = equation("").replace("\n```\n", "\n\nMore.\n\n- words: many\n");
    let (shown, complaints) = processed(&format!("One\n\n{open}"));
    assert_eq!(
        complaints,
        ["x.md:3: this equation's block is never closed"]
    );
    assert!(shown.equations.is_empty());
    // Each of these fences must leave the block open.
    for end in ["    ```", "``", "~~~", "```text"] {
        let open = equation("").replace("\n```\n", &format!("\n{end}\n"));
        let (_, complaints) = processed(&open);
        assert_eq!(
            complaints,
            ["x.md:1: this equation's block is never closed"],
            "{end}"
        );
    }
}

#[test]
fn what_is_code_by_its_indentation_is_no_fence() {
    let text = format!("One\n\n{}\nTwo\n\n    $$a$$\n", equation("    "));
    let (shown, complaints) = processed(&text);
    assert_eq!(complaints, [""; 0]);
    assert!(shown.equations.is_empty());
    assert_eq!(shown.markdown, text);
    // An indented fence inside a block does not close it.
    let text = "```text\n    ```\n$x$\n```\n\n$y$\n";
    let (shown, _) = processed(text);
    assert!(
        shown
            .markdown
            .starts_with("```text\n    ```\n$x$\n```\n\n<span")
    );
    // In a list, the lines of the list are indented, and the block counts as a fence.
    let text = format!("1. one\n\n   - two\n\n{}", equation("     "));
    let (shown, complaints) = processed(&text);
    assert_eq!(complaints, [""; 0]);
    assert_eq!(shown.equations.len(), 1);
}

#[test]
fn an_equation_stands_in_lines_of_its_own() {
    let quoted = equation("> ");
    let (shown, complaints) = processed(&quoted);
    assert_eq!(
        complaints,
        ["x.md:1: an equation's fence stands at the beginning of its line"]
    );
    assert!(shown.equations.is_empty());
}

#[test]
fn figures_are_numbered_and_have_captions() {
    let content = "\
See [Figure](#fig-plane).

![a plane
of two](figures/plane.svg)
; left | right
: The plane, with $x$.
More of it.

<figure class=\"qrt-interactive\" data-figure=\"map\">
<img src=\"figures/map.svg\" alt=\"map\">
</figure>
: To be moved.

After.
";
    let mut workshop = workshop(Path::new(env!("CARGO_MANIFEST_DIR")));
    let chapter = Chapter {
        file: "x.md",
        page: "x.html",
        name: "X",
        original: content,
    };
    let processed = workshop.process(&chapter, content);
    assert!(processed.interactive);
    let html = html(&workshop.numbered(&chapter, &processed.markdown));
    assert_eq!(workshop.complaints, []);
    assert!(
        html.contains("<figure class=\"qrt-figure\" id=\"fig-plane\">"),
        "{html}"
    );
    assert!(
        html.contains("<strong>Figure 1.</strong> The plane, with "),
        "{html}"
    );
    assert!(
        html.contains("<a href=\"#fig-plane\">Figure 1</a>"),
        "{html}"
    );
    assert!(
        html.contains("<span>left</span><span>right</span>"),
        "{html}"
    );
    assert!(html.contains("id=\"fig-interactive-map\""), "{html}");
    assert!(
        html.contains("<strong>Figure 2.</strong> To be moved."),
        "{html}"
    );
    let ends = |tag: &str| html.matches(&format!("</{tag}>")).count();
    assert_eq!((ends("figure"), ends("figcaption")), (2, 2), "{html}");
}

#[test]
fn all_figures_are_listed() {
    let content = "\
![a plane](figures/plane.svg)
: The [plane](y.md#plane), with $x$. More of it.

{{#figures}}
";
    let mut workshop = workshop(Path::new(env!("CARGO_MANIFEST_DIR")));
    let chapter = Chapter {
        file: "x.md",
        page: "x.html",
        name: "X & Y",
        original: content,
    };
    let processed = workshop.process(&chapter, content);
    let html = html(&workshop.numbered(&chapter, &processed.markdown));
    assert_eq!(workshop.complaints, []);
    let start =
        "<h2>X &amp; Y</h2><ul><li><a href=\"x.html#fig-plane\">Figure 1</a>. The plane, with ";
    assert!(html.contains(start), "{html}");
    let (_, list) = html.split_once(start).unwrap();
    assert!(
        !list.contains("More of it") && !list.contains('['),
        "{html}"
    );
}

#[test]
fn a_figure_without_a_caption_or_that_is_not_there_is_told() {
    let (_, complaints) = processed("![a plane](figures/plane.svg)\n\nAfter.\n");
    assert_eq!(complaints.len(), 1);
    assert!(complaints[0].starts_with("x.md:1: this figure has no caption"));
    let mut workshop = workshop(Path::new(env!("CARGO_MANIFEST_DIR")));
    let chapter = Chapter {
        file: "x.md",
        page: "x.html",
        name: "X",
        original: "",
    };
    workshop.numbered(&chapter, "[Figure](y.md#fig-none)");
    assert_eq!(workshop.complaints.len(), 1);
}
