//! `index.html`: tables and plots in one self-contained file.

use super::figure::Figure;
use super::fronts::{PRICES, candidates, front};
use super::preview::Preview;
use super::table::{ERROR_NAMES, Row};
use super::{Band, Sweep, Trade};
use super::{advice, rivals};
use qrt_core::inspect::grouped;
use qrt_drawing::{coloured, escaped, style_sheet};
use std::fmt::Write as _;

/// Meanings of the errors, in the order of [`ERROR_NAMES`].
const MEANINGS: [&str; 6] = [
    "their exact mean, against far more paths with other shifts",
    "the count of thresholds, against the mean of the same paths",
    "the circuit's numbers, against real ones on the same paths and comparators",
    "what the estimator says, against S/N",
    "paths of D rays, against paths so long that almost nothing more comes",
    "what the estimator says, against the limit of D rays",
];

const RULES: &str = "\
:root{color-scheme:light dark}
body{margin:0 auto;max-width:1180px;padding:1rem;background:$page;color:$ink;\
font:16px/1.5 system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif}
h1{font-size:1.5rem;margin:.5rem 0}h2{font-size:1.2rem;margin:2rem 0 .5rem}
p,figcaption{max-width:46rem}figcaption,.soft{color:$soft}figcaption{font-size:.9rem}
.figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,520px),1fr));gap:1.5rem}
figure{margin:0;min-width:0}.wide{overflow-x:auto}.wide svg{display:block;min-width:500px;width:100%}
.scene{display:grid;grid-template-columns:minmax(0,1fr);gap:1rem}.scene img{display:block;width:100%;max-width:24rem;height:auto;image-rendering:pixelated}
.scene pre{max-height:24rem;overflow:auto;margin:.5rem 0;font-size:.8125rem}
@media(min-width:700px){.scene.two{grid-template-columns:minmax(0,24rem) minmax(0,1fr)}}
.wide:focus-visible{outline:2px solid $s0;outline-offset:2px}
table{border-collapse:collapse;font-size:.875rem;font-variant-numeric:tabular-nums}
th,td{padding:.25rem .6rem;text-align:right;border-bottom:1px solid $grid;white-space:nowrap}
th{font-weight:600;text-align:right;color:$soft}.left,th.left{text-align:left}
.own td{vertical-align:top}.own .left{white-space:normal}.range{color:$soft}details{margin:.5rem 0}summary{cursor:pointer;padding:.3rem 0}
code{font-size:.9em}";

pub(super) fn html(trade: &Trade, preview: Option<&Preview>, figures: &[Figure]) -> String {
    let name = escaped(&trade.name);
    let [pixels, film] = trade.pixels;
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{name}: speed against accuracy</title>\n<style>\n{}{}\n</style>\n</head>\n\
         <body>\n<main>\n<h1>{name}: speed against accuracy</h1>\n\
         <p>{} settings, measured by qrt {} on {} of {} pixels, seed {}. Errors are root mean squares \
         over pixels and channels, relative to the mean radiance {:.4}, with 95&nbsp;% intervals of a \
         bootstrap over pixels; the limit is the mean of 2<sup>{}</sup> paths with other shifts. All \
         rows are in <a href=\"trade.csv\">trade.csv</a>, whose columns have the errors' names in \
         small letters.</p>\n",
        coloured(RULES),
        style_sheet(),
        trade.rows.len(),
        env!("CARGO_PKG_VERSION"),
        grouped(pixels),
        grouped(film),
        trade.seed,
        trade.scene().map_or(0.0, |row| row.mean),
        trade.reference_bits,
    );
    scene(&mut out, trade, preview);
    let sentences = advice::sentences(trade);
    if !sentences.is_empty() {
        let lines = sentences
            .iter()
            .map(|line| format!("<li>{}</li>", marked(line)));
        let lines: String = lines.collect();
        let _ = writeln!(out, "<h2>What to change next</h2>\n<ul>{lines}</ul>");
    }
    if let Some(row) = trade.scene() {
        own(&mut out, row);
    }
    let _ = writeln!(
        out,
        "<h2>Against classical rivals</h2>\n<p>{}</p>\n<ul>",
        marked(rivals::ABOUT)
    );
    for line in rivals::sentences(trade) {
        let _ = writeln!(out, "<li>{}</li>", marked(&line));
    }
    out.push_str("</ul>\n<h2>Plots</h2>\n<div class=\"figures\">\n");
    for figure in figures {
        let _ = writeln!(
            out,
            "<figure id=\"{}\">{}{}</div><figcaption>{}</figcaption></figure>",
            figure.name,
            wide("plot"),
            figure.plot.draw().inline_svg(),
            marked(figure.says)
        );
    }
    out.push_str("</div>\n<h2>Best settings</h2>\n");
    out.push_str("<p>What no other setting beats in both the total error and the price.</p>\n");
    let rows = candidates(trade);
    for (number, (_, title, _, price)) in PRICES.into_iter().enumerate() {
        let open = if number == 0 { " open" } else { "" };
        let _ = writeln!(out, "<details{open}><summary>By {title}</summary>");
        let best = front(&rows, price);
        table(&mut out, &best, |row| row.setting.described());
        out.push_str("</details>\n");
    }
    out.push_str("<h2>All settings</h2>\n");
    for sweep in Sweep::ALL {
        let rows: Vec<&Row> = trade.rows_of(sweep).collect();
        let _ = writeln!(
            out,
            "<details><summary>{} ({})</summary>",
            sweep.name(),
            rows.len()
        );
        table(&mut out, &rows, |row| row.setting.swept(sweep));
        out.push_str("</details>\n");
    }
    for (setting, why) in &trade.left_out {
        let what = marked(&format!("{}: {why}", setting.described()));
        let _ = writeln!(out, "<p>Left out: {what}.</p>");
    }
    out.push_str("</main>\n</body>\n</html>\n");
    out
}

/// Converts a sentence to HTML: text between backticks is code.
fn marked(sentence: &str) -> String {
    let mut out = String::new();
    let mut parts = sentence.split('`').peekable();
    while let Some(words) = parts.next() {
        out.push_str(&escaped(words));
        match parts.next_if(|_| true) {
            // A backtick without its partner stays a backtick.
            Some(code) if parts.peek().is_none() => {
                let _ = write!(out, "`{}", escaped(code));
            }
            Some(code) => {
                let _ = write!(out, "<code>{}</code>", escaped(code));
            }
            None => {}
        }
    }
    out
}

/// The start of a box that scrolls content wider than a phone, by keyboard, too.
fn wide(what: &str) -> String {
    format!("<div class=\"wide\" role=\"group\" aria-label=\"{what}\" tabindex=\"0\">")
}

/// Writes the scene: its picture, if there is one, and its text.
fn scene(out: &mut String, trade: &Trade, preview: Option<&Preview>) {
    let two = if preview.is_some() { " two" } else { "" };
    let _ = writeln!(out, "<div class=\"scene{two}\">");
    if let Some(preview) = preview {
        let every = match preview.step {
            1 => "Every pixel".to_owned(),
            step => format!("One pixel of every {step} by {step}"),
        };
        let _ = writeln!(
            out,
            "<figure><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"The scene {}, a small \
             picture\"><figcaption>{every}, the exact mean of 2<sup>{}</sup> paths that sample \
             lamps, at exposure {}.</figcaption></figure>",
            preview.address(),
            preview.width,
            preview.height,
            escaped(&trade.name),
            preview.path_bits,
            signed(preview.exposure),
        );
    }
    let _ = writeln!(
        out,
        "<details open><summary>The scene's text</summary><pre class=\"wide\" role=\"group\" \
         aria-label=\"the scene's text\" tabindex=\"0\">{}</pre></details>\n</div>",
        escaped(&trade.scene_text)
    );
}

/// A whole number with its sign.
fn signed(value: f64) -> String {
    let sign = if value < 0.0 { "\u{2212}" } else { "+" };
    match value.abs() {
        0.0 => "0".to_owned(),
        size => format!("{sign}{size:.0}"),
    }
}

/// Writes the costs and errors of the scene as it is.
fn own(out: &mut String, row: &Row) {
    let _ = writeln!(
        out,
        "<h2>The scene as it is</h2>\n<p>{}: {} queries of a pixel, each of {} Toffoli gates on {} \
         qubits.</p>\n{}<table class=\"own\">\n<tr><th class=\"left\">error</th><th>RMSE<br>95&nbsp;% \
         interval</th></tr>",
        escaped(&row.setting.described()),
        grouped(row.queries.round() as u64),
        grouped(row.cost.toffoli),
        grouped(row.cost.qubits),
        wide("errors of the scene as it is"),
    );
    for ((name, band), meaning) in ERROR_NAMES.iter().zip(row.errors).zip(MEANINGS) {
        let _ = writeln!(
            out,
            "<tr><td class=\"left\"><b>{name}</b>: {meaning}</td><td>{}<br><span class=\"range\">{} to \
             {}</span></td></tr>",
            percent(band.value),
            percent(band.low),
            percent(band.high)
        );
    }
    out.push_str("</table></div>\n");
}

fn table(out: &mut String, rows: &[&Row], name: impl Fn(&Row) -> String) {
    out.push_str(&wide("settings"));
    out.push_str("<table>\n<tr><th class=\"left\">setting</th>");
    for (name, meaning) in ERROR_NAMES.iter().zip(MEANINGS) {
        let name = name.replace(", ", ",<br>");
        let _ = write!(out, "<th title=\"{meaning}\">{name}</th>");
    }
    out.push_str(
        "<th>queries</th><th>Toffoli</th><th>qubits</th><th>Toffoli \u{d7} queries</th>\
         <th>ms a pixel</th></tr>\n",
    );
    for row in rows {
        let _ = write!(out, "<tr><td class=\"left\">{}</td>", escaped(&name(row)));
        for Band { value, .. } in row.errors {
            let _ = write!(out, "<td>{}</td>", percent(value));
        }
        let _ = writeln!(
            out,
            "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.3}</td></tr>",
            grouped(row.queries.round() as u64),
            grouped(row.cost.toffoli),
            grouped(row.cost.qubits),
            grouped(row.toffoli_x_queries().round() as u64),
            1e3 * row.seconds
        );
    }
    out.push_str("</table></div>\n");
}

/// A percentage with three digits; `0` if it is zero.
fn percent(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let percent = 100.0 * value;
    let digits = (2.0 - libm::floor(libm::log10(percent))).clamp(0.0, 6.0) as usize;
    format!("{percent:.digits$}&nbsp;%")
}

#[cfg(test)]
mod tests {
    use super::marked;

    #[test]
    fn backticks_become_code() {
        for (sentence, html) in [
            ("", ""),
            ("a < b", "a &lt; b"),
            ("run `qrt a>b` twice", "run <code>qrt a&gt;b</code> twice"),
            ("`a`", "<code>a</code>"),
            ("`a` and `b`", "<code>a</code> and <code>b</code>"),
            ("no other: `a", "no other: `a"),
        ] {
            assert_eq!(marked(sentence), html);
        }
    }
}
