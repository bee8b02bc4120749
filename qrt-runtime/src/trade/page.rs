//! `index.html`: tables and plots together, in one file that asks nobody for anything.

use super::figures::Figure;
use super::fronts::{PRICES, candidates, front};
use super::summary::differs;
use super::table::{ERRORS, Row};
use super::{Band, Sweep, Trade};
use super::{advice, rivals};
use qrt_core::inspect::grouped;
use qrt_drawing::{coloured, escaped, style_sheet};
use std::fmt::Write as _;

/// What errors mean, as [`ERRORS`].
const MEANINGS: [&str; 6] = [
    "paths: their exact mean, against far more paths with other shifts",
    "comparators: the count of thresholds, against the mean of the same paths",
    "width: the circuit's numbers, against real ones on the same paths and comparators",
    "counting: what the estimator says, against S/N",
    "depth: paths of D rays, against paths so long that almost nothing more comes",
    "total: what the estimator says, against the limit of D rays",
];

const RULES: &str = "\
:root{color-scheme:light dark}
body{margin:0 auto;max-width:1180px;padding:1rem;background:$page;color:$ink;\
font:16px/1.5 system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif}
h1{font-size:1.5rem;margin:.5rem 0}h2{font-size:1.2rem;margin:2rem 0 .5rem}
p,figcaption{max-width:46rem}figcaption,.soft{color:$soft}figcaption{font-size:.9rem}
.figures{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,520px),1fr));gap:1.5rem}
figure{margin:0;min-width:0}.wide{overflow-x:auto}.wide svg{display:block;min-width:min(460px,100%);width:100%}
table{border-collapse:collapse;font-size:.875rem;font-variant-numeric:tabular-nums}
th,td{padding:.25rem .6rem;text-align:right;border-bottom:1px solid $grid;white-space:nowrap}
th{font-weight:600;text-align:right;color:$soft}.left,th.left{text-align:left}
.says{white-space:normal;min-width:8rem}.range{color:$soft;font-size:.8em}details{margin:.5rem 0}summary{cursor:pointer;padding:.3rem 0}
code{font-size:.9em}";

pub(super) fn html(trade: &Trade, figures: &[Figure]) -> String {
    let name = escaped(&trade.name);
    let [pixels, film] = trade.pixels;
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{name}: speed against accuracy</title>\n<style>\n{}{}\n</style>\n</head>\n\
         <body>\n<h1>{name}: speed against accuracy</h1>\n\
         <p>{} settings, measured by qrt {} on {} of {} pixels, seed {}. Errors are root mean squares \
         over pixels and channels, relative to the mean radiance {:.4}, with 95&nbsp;% intervals of a \
         bootstrap over pixels; the limit is the mean of 2<sup>{}</sup> paths with other shifts. All \
         rows are in <a href=\"trade.csv\">trade.csv</a>.</p>\n",
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
    let sentences = advice::sentences(trade);
    if !sentences.is_empty() {
        let lines = sentences
            .iter()
            .map(|line| format!("<li>{}</li>", escaped(line)));
        let lines: String = lines.collect();
        let _ = writeln!(out, "<h2>What to change next</h2>\n<ul>{lines}</ul>");
    }
    if let Some(row) = trade.scene() {
        own(&mut out, row);
    }
    let _ = writeln!(
        out,
        "<details><summary>The scene's text</summary><pre class=\"wide\">{}</pre></details>",
        escaped(&trade.scene_text)
    );
    let _ = writeln!(
        out,
        "<h2>Against classical rivals</h2>\n<p>{}</p>\n<ul>",
        escaped(rivals::ABOUT)
    );
    for line in rivals::sentences(trade) {
        let _ = writeln!(out, "<li>{}</li>", escaped(&line));
    }
    out.push_str("</ul>\n<h2>Plots</h2>\n<div class=\"figures\">\n");
    for figure in figures {
        let _ = writeln!(
            out,
            "<figure id=\"{}\"><div class=\"wide\">{}</div><figcaption>{}</figcaption></figure>",
            figure.name,
            figure.plot.draw().inline_svg(),
            escaped(figure.says)
        );
    }
    out.push_str("</div>\n<h2>Best settings</h2>\n");
    out.push_str("<p>What no other setting beats in both the total error and the price.</p>\n");
    let rows = candidates(trade);
    for (number, (_, title, _, price)) in PRICES.into_iter().enumerate() {
        let open = if number == 0 { " open" } else { "" };
        let _ = writeln!(out, "<details{open}><summary>By {title}</summary>");
        let best = front(&rows, price);
        table(&mut out, &best, |row| differs(&row.setting));
        out.push_str("</details>\n");
    }
    out.push_str("<h2>All settings</h2>\n");
    for sweep in Sweep::ALL {
        let rows: Vec<&Row> = trade.of(sweep).collect();
        let _ = writeln!(
            out,
            "<details><summary>{} ({})</summary>",
            sweep.name(),
            rows.len()
        );
        table(&mut out, &rows, |row| value(sweep, row));
        out.push_str("</details>\n");
    }
    for (setting, why) in &trade.left_out {
        let what = escaped(&format!("{}: {why}", differs(setting)));
        let _ = writeln!(out, "<p>Left out: {what}.</p>");
    }
    out.push_str("</body>\n</html>\n");
    out
}

/// The scene as it is.
fn own(out: &mut String, row: &Row) {
    let _ = writeln!(
        out,
        "<h2>The scene as it is</h2>\n<p>{}: {} queries of a pixel, each of {} Toffoli gates on {} \
         qubits.</p>\n<div class=\"wide\"><table>\n<tr><th class=\"left\">error</th><th>RMSE</th>\
         <th>95&nbsp;%</th><th class=\"left\">of</th></tr>",
        escaped(&differs(&row.setting)),
        grouped(row.queries.round() as u64),
        grouped(row.cost.toffoli),
        grouped(row.cost.qubits),
    );
    for ((name, band), meaning) in ERRORS.iter().zip(row.errors).zip(MEANINGS) {
        let _ = writeln!(
            out,
            "<tr><td class=\"left\"><code>{name}</code></td><td>{}</td><td class=\"range\">{} to \
             {}</td><td class=\"left says\">{meaning}</td></tr>",
            percent(band.value),
            percent(band.low),
            percent(band.high)
        );
    }
    out.push_str("</table></div>\n");
}

/// What a sweep changes.
fn value(sweep: Sweep, row: &Row) -> String {
    let setting = &row.setting;
    match sweep {
        Sweep::Scene => "as it is".to_owned(),
        Sweep::Counting | Sweep::BesideRivals => {
            format!("{} t={}", setting.estimator, setting.phase_bits)
        }
        Sweep::Repetitions => format!(
            "{} t={} B={}",
            setting.estimator, setting.phase_bits, setting.repetitions
        ),
        Sweep::Strata => match setting.strata {
            Some(strata) => format!("{strata}"),
            None => "auto".to_owned(),
        },
        Sweep::Comparator => format!("{} bits", setting.comparator_bits),
        Sweep::Fraction => format!("{} bits", setting.fraction),
        Sweep::Paths => format!("{} 2^{}", setting.sequence, setting.path_bits),
        Sweep::Circuit => format!("{}, {}", setting.uncompute, setting.nearest),
        Sweep::Model => setting.model.name().to_owned(),
        Sweep::Depth => format!("{} rays", setting.depths),
        Sweep::RandomPaths | Sweep::ClassicalNet => format!("2^{} paths", setting.path_bits),
    }
}

fn table(out: &mut String, rows: &[&Row], name: impl Fn(&Row) -> String) {
    out.push_str("<div class=\"wide\"><table>\n<tr><th class=\"left\">setting</th>");
    for (error, meaning) in ERRORS.iter().zip(MEANINGS) {
        let word = meaning.split(':').next().unwrap_or_default();
        let _ = write!(
            out,
            "<th title=\"{meaning}\"><code>{error}</code><br>{word}</th>"
        );
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

/// Three digits, or none of what is nothing.
fn percent(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let percent = 100.0 * value;
    let digits = (2.0 - libm::floor(libm::log10(percent))).clamp(0.0, 6.0) as usize;
    format!("{percent:.digits$}&nbsp;%")
}
