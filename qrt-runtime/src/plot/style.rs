//! Colours, for light and for dark pages.

/// Styles of series; beyond, they come again.
pub const STYLES: usize = 14;

/// The style of plots, in a class of their own so that a page may hold it, too. Two series of one
/// colour differ in their marks, which are filled or hollow. The colours are Okabe and Ito's, which
/// the colour-blind can tell apart, darkened or lightened until they stand out from their page.
pub const CSS: &str = "\
.plot{font:14px system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif;\
--ink:#1f2328;--soft:#59636e;--grid:#d1d9e0;--page:#ffffff;\
--c0:#0a5ea8;--c1:#b3500a;--c2:#08795a;--c3:#a5377f;--c4:#7a6200;--c5:#6a4fc4;--c6:#2b7f9e}
.plot text{fill:var(--ink);stroke:none}.plot .soft{fill:var(--soft)}
.plot .title{font-weight:600;font-size:15px}.plot .page{fill:var(--page)}
.plot .grid{stroke:var(--grid);fill:none}.plot .axis{stroke:var(--soft);fill:none}
.plot .lead{stroke:var(--soft);fill:none;stroke-width:.7}
.plot .line{fill:none;stroke-width:1.8}.plot .bar{fill:none;stroke-width:1.2;opacity:.65}
.plot .band{stroke:none;opacity:.13}.plot .mark{stroke-width:1.6}.plot .hollow{fill:var(--page)}
.plot .s0{stroke:var(--c0);color:var(--c0)}.plot .s1{stroke:var(--c1);color:var(--c1)}
.plot .s2{stroke:var(--c2);color:var(--c2)}.plot .s3{stroke:var(--c3);color:var(--c3)}
.plot .s4{stroke:var(--c4);color:var(--c4)}.plot .s5{stroke:var(--c5);color:var(--c5)}
.plot .s6{stroke:var(--c6);color:var(--c6)}.plot .ink{fill:currentColor}
@media (prefers-color-scheme:dark){.plot{--ink:#e6edf3;--soft:#9da7b3;--grid:#343b44;--page:#0d1117;\
--c0:#5fb0f5;--c1:#f0883e;--c2:#35c79a;--c3:#e883c4;--c4:#d9b832;--c5:#ab96f5;--c6:#63c5e0}}
@media print{.plot{--page:#ffffff}}";

/// Marks of radius 4 about the origin, by the colour that they are first used with.
const MARKS: [&str; 7] = [
    "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z",
    "M-3.6 -3.6h7.2v7.2h-7.2z",
    "M0 -4.8l4.5 7.8h-9z",
    "M0 -5.2l5 5.2l-5 5.2l-5 -5.2z",
    "M0 4.8l4.5 -7.8h-9z",
    "M-5 -1.5h3.5v-3.5h3v3.5h3.5v3h-3.5v3.5h-3v-3.5h-3.5z",
    "M-4.6 -1.2l4.6 -3.6l4.6 3.6l-1.8 5.4h-5.6z",
];

/// The class of the colour of series `number`.
pub(super) fn class(number: usize) -> usize {
    number % MARKS.len()
}

/// Whether its marks are hollow, and its line is dashed.
pub(super) fn hollow(number: usize) -> bool {
    number / MARKS.len() % 2 == 1
}

/// The outline of its marks.
pub(super) fn mark(number: usize) -> &'static str {
    MARKS[class(number)]
}
