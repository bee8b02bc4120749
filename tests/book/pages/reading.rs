//! Tests of the parser of pages.

use crate::book::page::Page;

fn page(text: &str) -> Page {
    Page::new("page.md", text)
}

#[test]
fn fences_have_their_place_and_their_text() {
    let text = "\
words

- item

  ```console
  $ qrt
    more
  ```

````text
```rust
```
````

``` equation 3
x
";
    let page = page(text);
    let found = page.fences();
    let infos: Vec<_> = found.iter().map(|fence| &*fence.info).collect();
    assert_eq!(infos, ["console", "text", "equation 3"]);
    assert_eq!((found[0].line, found[0].indent), (5, 2));
    assert_eq!(found[0].body, "$ qrt\n  more\n");
    assert_eq!(&text[found[0].range.clone()], "  $ qrt\n    more\n");
    assert_eq!(found[1].body, "```rust\n```\n");
    assert_eq!(found[2].language(), "equation");
    assert!(found[1].closed && !found[2].closed);
}

#[test]
fn prose_is_what_is_neither_code_nor_formula() {
    let text =
        "a `b ü` c $d\\$ e$ f\n$$\ng\n$$\nh \\$ i\n```text\nj\n```\nk <!-- l --> m ``n`o`` p\n";
    let prose = page(text).prose();
    assert_eq!(prose.lines().count(), text.lines().count());
    let letters: String = prose.chars().filter(|c| c.is_alphabetic()).collect();
    assert_eq!(letters, "acfhikmp");
    // A dollar sign that opens no formula stays.
    assert!(page("costs $5 and\n\nmore").prose().contains('$'));
}

#[test]
fn links_are_found_with_their_lines() {
    let text = "\
[one](a.md#b) and `[no](c.md)`
![a picture
of two](figures/d.svg)
<figure><img src=\"figures/e.svg\" alt=\"three\"></figure>
[`code`](source:src/lib.rs#prelude) $[x](y)$ [(4)](f.md#eq-4)
";
    let links = page(text).links();
    let found: Vec<_> = links
        .iter()
        .map(|link| (link.line, &*link.target, link.is_picture))
        .collect();
    let expected = [
        (1, "a.md#b", false),
        (3, "figures/d.svg", true),
        (4, "figures/e.svg", true),
        (5, "source:src/lib.rs#prelude", false),
        (5, "f.md#eq-4", false),
    ];
    assert_eq!(found, expected);
    assert_eq!(links[1].text, "a picture\nof two");
    assert_eq!(links[2].text, "three");
    assert_eq!(links[4].text, "(4)");
}
