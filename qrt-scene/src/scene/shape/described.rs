//! The JSON Schema of records and variants.

use crate::scene::text::Data;

/// A key of a record, for the record's schema.
pub(crate) struct FieldSchema<'a> {
    pub(crate) name: &'a str,
    pub(crate) doc: &'a str,
    pub(crate) is_required: bool,
    /// The schema of the key's value.
    pub(crate) shape: Data,
    pub(crate) default: Option<Data>,
}

/// Returns the schema of a record: its keys, the required ones, and no others.
pub(crate) fn record_schema(doc: &str, fields: Vec<FieldSchema<'_>>) -> Data {
    let mut properties = Vec::new();
    let mut required = Vec::new();
    for field in fields {
        let FieldSchema {
            name,
            doc,
            is_required,
            shape,
            default,
        } = field;
        let mut schema = described(doc, shape);
        if let Some(default) = default {
            schema = schema.with("default", default);
        }
        properties.push((name.to_owned(), schema));
        if is_required {
            required.push(Data::text(name));
        }
    }
    let schema = Data::map([
        ("description", Data::text(doc.trim())),
        ("type", Data::text("object")),
        ("properties", Data::Map(properties)),
    ]);
    let schema = if required.is_empty() {
        schema
    } else {
        schema.with("required", Data::List(required))
    };
    schema.with("additionalProperties", Data::Bool(false))
}

/// Returns the schema of a record that has exactly one of `keys`.
pub(crate) fn one_of(schema: Data, keys: &[&str]) -> Data {
    let requires = |key: &&str| Data::map([("required", Data::List(vec![Data::text(*key)]))]);
    schema.with("oneOf", Data::List(keys.iter().map(requires).collect()))
}

/// Returns the schema of a variant: a map with exactly one of the keys.
pub(crate) fn variant_schema(doc: &str, kinds: Vec<(&str, &str, Data)>) -> Data {
    let properties = kinds.into_iter();
    let properties = properties.map(|(name, doc, part)| (name.to_owned(), described(doc, part)));
    Data::map([
        ("description", Data::text(doc.trim())),
        ("type", Data::text("object")),
        ("properties", Data::Map(properties.collect())),
        ("additionalProperties", Data::Bool(false)),
        ("minProperties", Data::Number(1.0)),
        ("maxProperties", Data::Number(1.0)),
    ])
}

/// Returns `schema` with `doc` as its description, in place of its own.
fn described(doc: &str, schema: Data) -> Data {
    let mut entries = vec![("description".to_owned(), Data::text(doc.trim()))];
    if let Data::Map(own) = schema {
        entries.extend(own.into_iter().filter(|(key, _)| key != "description"));
    }
    Data::Map(entries)
}
