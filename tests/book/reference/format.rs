//! The page of the scene format.

use super::examples::{CHAPTERS, EXAMPLES};
use super::kinds::{default, kind, meaning, words};
use super::markdown::{plain, sentence, wrapped};
use serde_yaml::{Mapping, Value};
use std::fmt::Write as _;

const HEAD: &str = "\
# Reference of the format

A scene is a YAML file of the blocks below. This page is generated from the types that read scenes,
as is the JSON Schema that `qrt schema` prints. [Scenes in YAML](yaml.md) teaches how to write a
scene, and [Error codes](error-codes.md) explains each error.

- A *block* is a map of keys. A key that is unknown or written twice is an error.
- A *number* is a YAML number, finite, at most 1e30 in size unless another range stands with it. No
  value is ever clamped: what is out of range is an error.
- A *point* is a list of three numbers `[x, y, z]` in *scene units*: any unit of length you like,
  the same throughout. Axes are right-handed.
- A *colour* is a list of three numbers `[red, green, blue]`, linear, with the primaries of sRGB;
  one number stands for three equal ones.
- An *expression* is a formula in quotes, such as `\"sqrt(1 - u^2)\"`, or a number.
- One *of several kinds* is a map with a single key, as in `{ mirror: { ... } }`.
- Lengths and points are in scene units, angles in degrees, and sizes of registers in bits.

The name of a key here, such as `camera.perspective.vfov`, is what `--set` takes on the command
line: `--set camera.perspective.vfov=30`. Elements of lists have numbers from 0, as in
`--set 'sampling.depths[1].map=uniform-hemisphere'`, and materials their names, as in
`--set materials.white.lambertian.albedo=[0.5,0.5,0.5]`.

";

/// Returns the whole page.
pub(crate) fn page() -> String {
    let schema: Value = serde_yaml::from_str(&qrt::scene::schema::text()).unwrap();
    let blocks = entries(&schema, "properties");
    let mut page = HEAD.to_owned();
    let names = |needed: bool| {
        let names = blocks.iter().map(|(name, _)| name.as_str().unwrap());
        let names = names.filter(|name| is_required(&schema, name) == needed);
        let links: Vec<String> = names.map(|name| format!("[`{name}`](#{name})")).collect();
        links.join(", ")
    };
    page += &wrapped(&format!("Every scene has {}.", names(true)), "", "");
    let rest = format!("These may be left out: {}.", names(false));
    page.push('\n');
    page += &wrapped(&rest, "", "");
    for (name, block) in blocks {
        let name = name.as_str().unwrap();
        write!(page, "\n<a id=\"{name}\"></a>\n## `{name}`\n\n").unwrap();
        let needed = if is_required(&schema, name) {
            "Required."
        } else {
            "May be left out."
        };
        let chapter = CHAPTERS.iter().find(|(key, ..)| *key == name);
        let more = chapter.map_or_else(String::new, |(_, title, file)| {
            format!(" More in [{title}]({file}).")
        });
        let about = format!("{} {needed}{more}", sentence(&meaning(block)));
        page += &wrapped(&about, "", "");
        let example = EXAMPLES.iter().find(|(key, _)| *key == name);
        let (_, example) = example.expect("every block has an example");
        write!(page, "\n```yaml\n{example}```\n").unwrap();
        describe(&mut page, name, block);
    }
    page
}

fn entries<'a>(schema: &'a Value, key: &str) -> &'a Mapping {
    let found = schema.get(key).and_then(Value::as_mapping);
    found.unwrap_or_else(|| panic!("a block without `{key}`"))
}

fn is_required(schema: &Value, key: &str) -> bool {
    let required = schema.get("required").and_then(Value::as_sequence);
    required.is_some_and(|all| all.iter().any(|name| name.as_str() == Some(key)))
}

/// Describes the contents of a block, of a list of blocks or of a map of them.
fn describe(page: &mut String, path: &str, schema: &Value) {
    let named = schema
        .get("additionalProperties")
        .filter(|named| named.is_mapping());
    if let Some(named) = named {
        write!(
            page,
            "\n{}",
            wrapped("A map from names to one of these kinds each:", "", "")
        )
        .unwrap();
        return variants(page, path, named);
    }
    if let Some(item) = schema
        .get("items")
        .filter(|item| item.get("properties").is_some())
    {
        let several = if is_variant(item) {
            "primitives, each one of these kinds"
        } else {
            "blocks"
        };
        write!(
            page,
            "\n{}",
            wrapped(&format!("A list of {several}:"), "", "")
        )
        .unwrap();
        return keys_or_variants(page, path, item);
    }
    if schema.get("properties").is_some() {
        if is_variant(schema) {
            page.push_str("\nOne of these kinds:\n");
        } else {
            page.push('\n');
        }
        return keys_or_variants(page, path, schema);
    }
    let kind = sentence(&kind(schema));
    write!(page, "\n{}", wrapped(&kind, "", "")).unwrap();
}

fn keys_or_variants(page: &mut String, path: &str, schema: &Value) {
    if is_variant(schema) {
        variants(page, path, schema);
    } else {
        keys(page, path, schema, "");
    }
}

fn is_variant(schema: &Value) -> bool {
    schema.get("maxProperties").is_some()
}

fn variants(page: &mut String, path: &str, schema: &Value) {
    for (name, part) in entries(schema, "properties") {
        let name = name.as_str().unwrap();
        let path = format!("{path}.{name}");
        write!(page, "\n<a id=\"{path}\"></a>\n### `{name}`\n\n").unwrap();
        writeln!(page, "{}", wrapped(&sentence(&meaning(part)), "", "")).unwrap();
        keys(page, &path, part, "");
    }
}

/// Writes an entry for each key: its name, the kind of its value, its meaning.
fn keys(page: &mut String, path: &str, schema: &Value, indent: &str) {
    for (name, part) in entries(schema, "properties") {
        let name = name.as_str().unwrap();
        let path = format!("{path}.{name}");
        let missing = match (default(part), is_required(schema, name)) {
            (Some(default), _) => format!("; default `{default}`"),
            (None, _) if is_variant(schema) => String::new(),
            (None, true) => "; required".to_owned(),
            (None, false) => "; may be left out".to_owned(),
        };
        let inner = format!("{indent}  ");
        let head = format!("{indent}- <a id=\"{path}\"></a>**`{name}`**: ");
        *page += &wrapped(&format!("{}{missing}.", kind(part)), &head, &inner);
        // The kind stands on a line of its own.
        page.pop();
        *page += "\\\n";
        *page += &wrapped(&sentence(&meaning(part)), &inner, &inner);
        for (word, meaning) in words(part) {
            let head = format!("{inner}- `{word}`: ");
            *page += &wrapped(&sentence(&plain(&meaning)), &head, &format!("{inner}  "));
        }
        if let Some(item) = items(part).filter(|item| item.get("properties").is_some()) {
            keys(page, &path, item, &inner);
        }
        let choices = part.get("anyOf").and_then(Value::as_sequence);
        let blocks = choices.into_iter().flatten().chain([part]);
        for block in blocks.filter(|block| block.get("properties").is_some()) {
            keys(page, &path, block, &inner);
        }
    }
}

/// The schema of a list's items, also where something shorter may stand for the list.
fn items(schema: &Value) -> Option<&Value> {
    let choices = schema.get("anyOf").and_then(Value::as_sequence);
    let mut lists = choices.into_iter().flatten().chain([schema]);
    lists.find_map(|list| list.get("items"))
}

/// Collects the schema's entry at each path below `path`, independently of this page.
fn walk<'a>(path: &str, schema: &'a Value, found: &mut Vec<(String, &'a Value)>) {
    for (name, part) in schema
        .get("properties")
        .and_then(Value::as_mapping)
        .into_iter()
        .flatten()
    {
        let name = name.as_str().unwrap();
        let path = if path.is_empty() {
            name.to_owned()
        } else {
            format!("{path}.{name}")
        };
        found.push((path.clone(), part));
        walk(&path, part, found);
    }
    let choices = schema.get("anyOf").and_then(Value::as_sequence);
    let parts = [schema.get("items"), schema.get("additionalProperties")];
    for part in parts
        .into_iter()
        .flatten()
        .chain(choices.into_iter().flatten())
    {
        walk(path, part, found);
    }
}

#[test]
fn every_key_of_the_schema_is_on_the_page_and_nothing_else() {
    let schema: Value = serde_yaml::from_str(&qrt::scene::schema::text()).unwrap();
    let mut found = Vec::new();
    walk("", &schema, &mut found);
    let page = page();
    let mark = "<a id=\"";
    // The text between an anchor and the next.
    let entries: Vec<(&str, &str)> = page
        .split(mark)
        .skip(1)
        .map(|entry| entry.split_once("\"></a>").unwrap())
        .collect();
    let mut paths: Vec<&str> = found.iter().map(|(path, _)| &**path).collect();
    let mut anchors: Vec<&str> = entries.iter().map(|(path, _)| *path).collect();
    paths.sort_unstable();
    anchors.sort_unstable();
    assert_eq!(paths, anchors);
    for (path, part) in found {
        let (_, entry) = entries.iter().find(|(other, _)| *other == path).unwrap();
        // Compare the entry as one line, because the page wraps it.
        let entry = entry.split_whitespace().collect::<Vec<_>>().join(" ");
        let name = path.rsplit('.').next().unwrap();
        assert!(entry.contains(&format!("`{name}`")), "{path}: {entry}");
        let words = part.get("enum").and_then(Value::as_sequence);
        for word in words.into_iter().flatten() {
            let word = format!("- `{}`: ", word.as_str().unwrap());
            assert!(entry.contains(&word), "{path} without {word}: {entry}");
        }
        let depth = path.split('.').count();
        if depth > 1 && part.get("default").is_some() {
            assert!(entry.contains("; default `"), "{path}: {entry}");
        }
    }
    assert!(page.contains("default `[0, 1, 0]`"));
}

#[test]
fn every_block_has_an_example_of_its_own() {
    let schema: Value = serde_yaml::from_str(&qrt::scene::schema::text()).unwrap();
    let names = entries(&schema, "properties").keys();
    let names: Vec<&str> = names.filter_map(Value::as_str).collect();
    let mut examples = EXAMPLES.map(|(name, _)| name);
    examples.sort_unstable_by_key(|name| names.iter().position(|other| other == name));
    assert_eq!(names, examples);
    for (name, example) in EXAMPLES {
        assert!(example.starts_with(&format!("{name}:")), "{example}");
    }
}
