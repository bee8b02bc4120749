//! The measurements of `trade`.

use crate::trade::Trade;
use serde_json::{Number, Value, json};

/// Returns all rows, by the names of the columns of `trade.csv`, and the settings that were left out.
pub fn trade(measured: &Trade) -> Value {
    let rows = measured.rows.iter().map(|row| {
        let cells = row.cells().into_iter();
        Value::Object(cells.map(|(name, text)| (name, cell(&text))).collect())
    });
    let left_out = measured
        .left_out
        .iter()
        .map(|(setting, why)| json!({ "setting": setting.values().join(","), "why": why }));
    json!({
        "version": 1,
        "qrt": env!("CARGO_PKG_VERSION"),
        "scene": measured.name,
        "seed": measured.seed,
        "pixels": measured.pixels[0],
        "reference_bits": measured.reference_bits,
        "rows": rows.collect::<Vec<_>>(),
        "left_out": left_out.collect::<Vec<_>>(),
    })
}

/// A cell's number if it is one, otherwise its word.
fn cell(text: &str) -> Value {
    let whole = text.parse::<u64>().map(Value::from);
    let number = || Number::from_f64(text.parse().ok()?).map(Value::Number);
    whole.ok().or_else(number).unwrap_or_else(|| json!(text))
}
