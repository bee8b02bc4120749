//! The JSON Schema (draft-07) of scenes, for editors, from the same definitions as the types.

use crate::scene::Scene;
use crate::scene::shape::Part;
use crate::scene::text::Data;

/// The schema's text, ending in a line feed.
///
/// ```
/// assert!(qrt_scene::schema::text().contains("http://json-schema.org/draft-07/schema#"));
/// ```
pub fn text() -> String {
    let head = [
        ("$schema", "http://json-schema.org/draft-07/schema#"),
        ("title", "qrt scene"),
    ];
    let mut entries: Vec<(String, Data)> = head
        .iter()
        .map(|(key, value)| ((*key).to_owned(), Data::text(*value)))
        .collect();
    if let Data::Map(own) = Scene::schema() {
        entries.extend(own);
    }
    Data::Map(entries).to_json()
}
