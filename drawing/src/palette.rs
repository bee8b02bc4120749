//! The colour palette, for light and dark pages.

use std::fmt::Write as _;

/// Number of styles of series. Further series repeat the styles from the first.
pub const STYLES: usize = 16;

/// Colours by name, on light and on dark pages.
const PALETTE: [(&str, [&str; 2]); 21] = [
    // Text and strokes; secondary text; grids; the background.
    ("ink", ["#1f2328", "#e6edf3"]),
    ("soft", ["#59636e", "#9da7b3"]),
    ("grid", ["#d1d9e0", "#343b44"]),
    ("page", ["#ffffff", "#0d1117"]),
    // Boxes of circuits: compute, uncompute, phase flip.
    ("box", ["#f3f5f8", "#232932"]),
    ("undo", ["#e6eaf0", "#2d3540"]),
    ("flip", ["#fdf0d5", "#4a3b17"]),
    // Roles of registers, as areas with text on them: Paul Tol's bright scheme, distinguishable
    // with any colour vision, lighter on dark pages.
    ("id", ["#4477aa", "#6f9fd0"]),
    ("comparator", ["#aa3377", "#cf6aa3"]),
    ("work", ["#66ccee", "#4aa9c9"]),
    ("scratch", ["#b8bcc4", "#5d646f"]),
    ("colour", ["#ee6677", "#f08a96"]),
    ("flag", ["#228833", "#4fae5f"]),
    // Series of points, as lines on the page: Okabe and Ito's colours, distinguishable for the
    // colour-blind, darkened or lightened for contrast with the page.
    ("s0", ["#0a5ea8", "#5fb0f5"]),
    ("s1", ["#b3500a", "#f0883e"]),
    ("s2", ["#08795a", "#35c79a"]),
    ("s3", ["#a5377f", "#e883c4"]),
    ("s4", ["#7a6200", "#d9b832"]),
    ("s5", ["#6a4fc4", "#ab96f5"]),
    ("s6", ["#2b7f9e", "#63c5e0"]),
    ("s7", ["#b02a37", "#f5848f"]),
];

/// Style rules of drawings. All are under one class, so that a page can contain drawings. Two
/// series of the same colour differ in their marks, which are filled or hollow.
const RULES: &str = "\
.drawing{font:14px system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif}
.drawing text{fill:$ink;stroke:none}.drawing .soft{fill:$soft}.drawing .page{fill:$page}
.drawing .title{font-weight:600;font-size:15px}.drawing .small{font-size:12px}
.drawing.large{font-size:12px}.drawing.large .title{font-size:18px}
.drawing.large .small{font-size:10.5px}
.drawing .mid{text-anchor:middle}.drawing .end{text-anchor:end}
.drawing .grid{stroke:$grid;fill:none}.drawing .axis{color:$soft;stroke:currentColor;fill:none}
.drawing .lead{stroke:$soft;fill:none;stroke-width:.7}
.drawing .s0{color:$s0}.drawing .s1{color:$s1}.drawing .s2{color:$s2}.drawing .s3{color:$s3}
.drawing .s4{color:$s4}.drawing .s5{color:$s5}.drawing .s6{color:$s6}.drawing .s7{color:$s7}
.drawing .line{fill:none;stroke:currentColor;stroke-width:1.8}
.drawing .thin{fill:none;stroke:currentColor;stroke-width:1}.drawing .dash{stroke-dasharray:6 4}
.drawing .bar{fill:none;stroke:currentColor;stroke-width:1.2;opacity:.65}
.drawing .band{fill:currentColor;opacity:.13}
.drawing .mark{fill:currentColor;stroke:currentColor;stroke-width:1.6}.drawing .hollow{fill:$page}
.drawing .dots{fill:none;stroke:currentColor;stroke-width:3.4;stroke-linecap:round}
.drawing .solid{fill:currentColor;stroke:none}
.drawing .pale{fill:currentColor;fill-opacity:.22;stroke:currentColor;stroke-width:1}
.drawing .wire{stroke:$ink;fill:none}.drawing .dot{fill:$ink}
.drawing .box{fill:$box;stroke:$ink}.drawing .undo{fill:$undo}.drawing .flip{fill:$flip}
.drawing .stage{fill:$undo}.drawing .stage2{fill:$box}
.drawing .id{fill:$id}.drawing .comparator{fill:$comparator}.drawing .work{fill:$work}
.drawing .scratch{fill:$scratch}.drawing .colour{fill:$colour}.drawing .flag{fill:$flag}
.drawing .edge{stroke:$page;stroke-width:.4}.drawing .in-use{stroke:$ink;fill:none;stroke-width:1.2}
";

/// Returns the style sheet of drawings. A file of its own contains it; a page needs it once for all
/// its drawings.
pub fn style_sheet() -> String {
    let print = "@media print{.drawing .page,.drawing .hollow{fill:#ffffff}}";
    format!("{}{print}", coloured(RULES))
}

/// Returns style rules in which each `$name` is replaced by that colour of the palette.
///
/// The first part has all rules, with the colours of light pages. The second part has the
/// declarations of colours again, for dark pages. There a colour overrides every rule of the first
/// part with the same specificity. So a declaration without a colour, such as `stroke:none`, must
/// not rely on its later position to override a colour.
///
/// The colours are written into the rules. Variables would not work, since few programs besides
/// browsers support them.
///
/// ```
/// assert_eq!(
///     qrt_drawing::coloured("p{margin:0;color:$ink}"),
///     "p{margin:0;color:#1f2328}@media (prefers-color-scheme:dark){p{color:#e6edf3}}\n"
/// );
/// ```
pub fn coloured(rules: &str) -> String {
    let mut dark = String::new();
    for rule in rules.split('}').filter(|rule| rule.contains('$')) {
        let (selector, declarations) = rule.split_once('{').unwrap_or_default();
        let of_colour: Vec<&str> = (declarations.split(';'))
            .filter(|declaration| declaration.contains('$'))
            .collect();
        // Writing to a string cannot fail.
        let _ = write!(dark, "{}{{{}}}", selector.trim(), of_colour.join(";"));
    }
    let [light, dark] = [(rules, 0), (&*dark, 1)].map(|(rules, page)| named(rules, page));
    format!("{light}@media (prefers-color-scheme:dark){{{dark}}}\n")
}

/// Replaces the names of colours in `rules` by the colours for a light page (0) or a dark page (1).
fn named(rules: &str, page: usize) -> String {
    let mut parts = rules.split('$');
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !c.is_ascii_alphanumeric());
        let (name, rest) = part.split_at(end.unwrap_or(part.len()));
        let known = PALETTE.iter().find(|(known, _)| *known == name);
        out.push_str(known.map_or("inherit", |(_, colours)| colours[page]));
        out.push_str(rest);
    }
    out
}

/// Outlines of marks of radius 4 about the origin, one for each colour of series.
const MARKS: [&str; 8] = [
    "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z",
    "M-3.6 -3.6h7.2v7.2h-7.2z",
    "M0 -4.8l4.5 7.8h-9z",
    "M0 -5.2l5 5.2l-5 5.2l-5 -5.2z",
    "M0 4.8l4.5 -7.8h-9z",
    "M-5 -1.5h3.5v-3.5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5z",
    "M-4.6 -1.2l4.6 -3.6l4.6 3.6l-1.8 5.4h-5.6z",
    "M0 -5.2l1.6 3.6h3.4l-2.4 2.8l1 4l-3.6 -2l-3.6 2l1 -4l-2.4 -2.8h3.4z",
];

/// Returns the class of the colour of series `number`.
pub(crate) fn series(number: usize) -> String {
    format!("s{}", number % MARKS.len())
}

/// True if the marks of series `number` are hollow and its line is dashed.
pub(crate) fn hollow(number: usize) -> bool {
    number / MARKS.len() % 2 == 1
}

/// Returns the outline of the marks of series `number`.
pub(crate) fn mark(number: usize) -> &'static str {
    MARKS[number % MARKS.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_is_in_the_palette_and_has_a_use() {
        let sheet = style_sheet();
        assert!(
            !sheet.contains('$') && !sheet.contains("inherit"),
            "{sheet}"
        );
        for (name, colours) in PALETTE {
            for colour in colours {
                assert!(sheet.contains(colour), "{name}");
            }
        }
    }

    /// The book's interactive figures are drawn by scripts, in the same colours.
    #[test]
    fn the_figures_that_scripts_draw_have_no_other_colours() {
        let file = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../book/interactive/figures.css"
        );
        let sheet = std::fs::read_to_string(file).unwrap();
        let mut colours = sheet
            .split("--qrt-")
            .filter_map(|part| part.split_once(": #"));
        let known = |colour: &str| PALETTE.iter().any(|(_, both)| both.contains(&colour));
        assert!(colours.clone().count() >= 8);
        assert!(colours.all(|(_, rest)| known(&format!("#{}", &rest[..6]))));
    }
}
