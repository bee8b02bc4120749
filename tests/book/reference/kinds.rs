//! Describes the kinds of values in the JSON Schema in words.

use super::markdown::plain;
use serde_yaml::Value;

/// Bound on numbers of scenes.
const LARGEST: f64 = 1e30;

/// Formats a number as people write it.
fn number(value: &Value) -> String {
    let value = value.as_f64().expect("a bound is a number");
    let size = value.abs();
    if value == 2.0_f64.powi(53) {
        return "2^53".to_owned();
    }
    if size >= 1e15 {
        return format!("{value:e}");
    }
    if value.fract() != 0.0 || size < 10_000.0 {
        return format!("{value}");
    }
    let digits = format!("{value}");
    let (sign, digits) = digits
        .strip_prefix('-')
        .map_or(("", &*digits), |rest| ("-", rest));
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    format!("{sign}{out}")
}

/// Formats a range: `from 0 to 1`, `above 0 and below 180`; empty if only the largest size bounds it.
fn range(schema: &Value) -> String {
    let get = |key: &str| schema.get(key);
    let is_largest = |value: &Value| value.as_f64().is_some_and(|v| v.abs() >= LARGEST);
    let low = match (get("minimum"), get("exclusiveMinimum")) {
        (Some(low), _) if !is_largest(low) => Some((number(low), false)),
        (_, Some(low)) => Some((number(low), true)),
        _ => None,
    };
    let high = match (get("maximum"), get("exclusiveMaximum")) {
        (Some(high), _) if !is_largest(high) => Some((number(high), false)),
        (_, Some(high)) => Some((number(high), true)),
        _ => None,
    };
    match (low, high) {
        (Some((low, false)), Some((high, false))) => format!(", from {low} to {high}"),
        (Some((low, open)), Some((high, shut))) => {
            let low = format!("{} {low}", if open { "above" } else { "at least" });
            format!(
                ", {low} and {} {high}",
                if shut { "below" } else { "at most" }
            )
        }
        (Some((low, true)), None) => format!(", above {low}"),
        (Some((low, false)), None) => format!(", {low} or more"),
        (None, Some((high, _))) => format!(", up to {high}"),
        (None, None) => String::new(),
    }
}

fn is_type(schema: &Value, name: &str) -> bool {
    schema.get("type").and_then(Value::as_str) == Some(name)
}

fn is_expression(schema: &Value) -> bool {
    schema.get("type").is_some_and(Value::is_sequence)
}

fn length(schema: &Value, key: &str) -> Option<u64> {
    schema.get(key).and_then(Value::as_u64)
}

/// Describes the kind of a value, and its range: `three numbers, from 0 to 1`.
///
/// # Panics
/// If the schema has a form that this page has no words for.
pub(crate) fn kind(schema: &Value) -> String {
    if let Some(choices) = schema.get("anyOf").and_then(Value::as_sequence) {
        let lists = choices
            .iter()
            .filter(|choice| is_type(choice, "array"))
            .count();
        return match &choices[..] {
            [word, other] if word.get("const").is_some() => {
                let word = word["const"].as_str().expect("a word");
                format!("`{word}`, or a {}", kind(other))
            }
            [first, second, other] if second.get("const").is_some() => {
                let word = |choice: &Value| choice["const"].as_str().expect("a word").to_owned();
                let (first, second) = (word(first), word(second));
                format!("`{first}`, `{second}`, or {}", kind(other))
            }
            [words, other] if words.get("enum").is_some() && other.get("pattern").is_some() => {
                "one of the words below, or parts with hyphens between them".to_owned()
            }
            [colour, grey] if is_type(colour, "array") && is_type(grey, "number") => {
                format!("{}; or one number, which is grey", kind(colour))
            }
            [colour, grey, pattern] if is_type(grey, "number") && is_type(pattern, "object") => {
                format!(
                    "{}; or one number, which is grey; or a pattern",
                    kind(colour)
                )
            }
            [list, count] if is_type(list, "array") && is_type(count, "integer") => {
                format!("{}; or a {}", kind(list), kind(count))
            }
            [one, _, _] if is_expression(one) && lists == 2 => {
                "expression, or a list of one or three".to_owned()
            }
            _ => panic!("no words for {choices:?}"),
        };
    }
    if schema.get("enum").is_some() {
        return "one of the words below".to_owned();
    }
    if is_expression(schema) {
        return "expression".to_owned();
    }
    if is_type(schema, "string") {
        return "text, not empty".to_owned();
    }
    if is_type(schema, "integer") {
        return format!("whole number{}", range(schema));
    }
    if is_type(schema, "number") {
        return format!("number{}", range(schema));
    }
    if is_type(schema, "array") {
        return list(schema);
    }
    if is_type(schema, "object") {
        return "block".to_owned();
    }
    panic!("no words for {schema:?}")
}

fn list(schema: &Value) -> String {
    let item = &schema["items"];
    let (least, most) = (length(schema, "minItems"), length(schema, "maxItems"));
    let each = range(item);
    if (least, most) == (Some(3), Some(3)) && is_type(item, "number") && !each.is_empty() {
        return format!("colour{}", each.replacen(", ", ", each part ", 1));
    }
    let one = if is_type(item, "array") && kind(item) == "three numbers" {
        "point".to_owned()
    } else if is_expression(item) {
        "expression".to_owned()
    } else {
        kind(item)
    };
    // For example `whole number, from 0 to 24`.
    let end = one.find(',').unwrap_or(one.len());
    let several = format!("{}s{}", &one[..end], &one[end..]);
    match (least, most) {
        (Some(n), Some(m)) if n == m => format!("{} {several}", count(n)),
        (Some(0), None) => format!("list of {several}"),
        (Some(1), None) => format!("list of at least one {one}"),
        other => panic!("no words for a list of {other:?}"),
    }
}

fn count(n: u64) -> String {
    let words = ["no", "one", "two", "three", "four"];
    words
        .get(n as usize)
        .map_or_else(|| n.to_string(), |word| (*word).to_owned())
}

/// Returns the words that a value may be, each with its meaning.
pub(crate) fn words(schema: &Value) -> Vec<(String, String)> {
    let texts = |key: &str| -> Vec<String> {
        let list = schema.get(key).and_then(Value::as_sequence);
        let texts = list.into_iter().flatten().filter_map(Value::as_str);
        texts.map(str::to_owned).collect()
    };
    let choices = schema.get("anyOf").and_then(Value::as_sequence);
    let choice = choices
        .into_iter()
        .flatten()
        .find(|choice| choice.get("enum").is_some());
    if let Some(choice) = choice {
        return words(choice);
    }
    let (words, meanings) = (texts("enum"), texts("enumDescriptions"));
    assert_eq!(words.len(), meanings.len(), "every word has a meaning");
    words.into_iter().zip(meanings).collect()
}

/// Returns the default of a value.
pub(crate) fn default(schema: &Value) -> Option<String> {
    schema.get("default").map(flow)
}

/// Formats YAML on one line.
fn flow(value: &Value) -> String {
    match value {
        Value::Sequence(items) => {
            let items: Vec<String> = items.iter().map(flow).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Mapping(entries) => {
            let entries = entries.iter();
            let entries: Vec<String> = entries
                .map(|(k, v)| format!("{}: {}", flow(k), flow(v)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
        Value::String(text) => text.clone(),
        Value::Number(_) => number(value),
        other => panic!("no words for {other:?}"),
    }
}

/// Returns the meaning of a value: its description without the default, which another place shows.
pub(crate) fn meaning(schema: &Value) -> String {
    let text = schema
        .get("description")
        .and_then(Value::as_str)
        .unwrap_or_default();
    let Some((before, default)) = text.split_once("; default ") else {
        return plain(text);
    };
    // The default ends at the end of the sentence.
    let end = default.find(". ").unwrap_or(default.len() - 1);
    plain(&format!("{before}{}", &default[end..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words_of(schema: &str) -> String {
        kind(&serde_yaml::from_str(schema).unwrap())
    }

    #[test]
    fn schemas_are_put_into_words() {
        for (schema, words) in [
            (
                "{ type: integer, minimum: 1, maximum: 65536 }",
                "whole number, from 1 to 65,536",
            ),
            (
                "{ type: number, exclusiveMinimum: 0, exclusiveMaximum: 180 }",
                "number, above 0 and below 180",
            ),
            (
                "{ type: number, exclusiveMinimum: 0, maximum: 1e30 }",
                "number, above 0",
            ),
            (
                "{ type: array, items: { type: number, minimum: -1e30, maximum: 1e30 }, minItems: 3, \
                 maxItems: 3 }",
                "three numbers",
            ),
            (
                "{ type: array, items: { type: number, minimum: 0, maximum: 1 }, minItems: 3, \
                 maxItems: 3 }",
                "colour, each part from 0 to 1",
            ),
            (
                "{ anyOf: [{ const: auto }, { type: integer, minimum: 4, maximum: 30 }] }",
                "`auto`, or a whole number, from 4 to 30",
            ),
        ] {
            assert_eq!(words_of(schema), words, "{schema}");
        }
    }

    #[test]
    fn a_default_is_not_said_twice() {
        let said = |text: &str| {
            let schema = format!("{{ description: \"{text}\" }}");
            meaning(&serde_yaml::from_str(&schema).unwrap())
        };
        assert_eq!(
            said("So many paths; default 12. Only that."),
            "So many paths. Only that."
        );
        assert_eq!(said("So many; default [0, 1]."), "So many.");
        assert_eq!(said("So many."), "So many.");
    }
}
