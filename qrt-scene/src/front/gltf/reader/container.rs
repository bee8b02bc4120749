//! The parts of a glTF file: its JSON text and its binary data.

use crate::scene::meshes::{FileError, FilePlace};
use ::gltf::Document;
use ::gltf::json::Root;
use ::gltf::json::mesh::Semantic;
use ::gltf::json::validation::{Checked, Validate as _};
use qrt_syntax::MeshFile;
use std::path::Path;

/// Maximum number of bytes of a JSON text, base64 data included.
const MOST_TEXT: usize = 64 << 20;

/// Maximum numbers of objects, lists and commas in a JSON text, which bound its memory: while it is
/// parsed, an object takes up to 750 bytes, a list 250, and any other value, of which all but the
/// first of a list follow a comma, 100. The least of them have texts of two or three bytes.
const MOST: [(u8, usize); 3] = [(b'{', 1 << 18), (b'[', 1 << 19), (b',', 1 << 21)];

/// Returns the JSON text and the binary data of a file, which are in chunks if the file is binary.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), MeshFile> {
    let Some(chunks) = bytes.strip_prefix(b"glTF") else {
        return Ok((bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None));
    };
    let word = |bytes: &[u8], at: usize| -> Option<u32> {
        let word = bytes.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(word))
    };
    let version = word(chunks, 0).ok_or(MeshFile::GltfShort)?;
    if version != 2 {
        return Err(MeshFile::GltfVersion { version });
    }
    let chunk = |rest: &mut &[u8]| -> Option<(u32, usize)> {
        let (length, kind) = (word(rest, 0)? as usize, word(rest, 4)?);
        *rest = rest.get(8..)?;
        (length <= rest.len()).then_some((kind, length))
    };
    // Bytes after the length that the header states are not the file's.
    let length = word(chunks, 4).ok_or(MeshFile::GltfShort)?;
    let chunks = match (length as usize).checked_sub(4) {
        Some(length) => chunks.get(..length).unwrap_or(chunks),
        None => return Err(MeshFile::GltfShort),
    };
    let mut rest = chunks.get(8..).ok_or(MeshFile::GltfShort)?;
    let (kind, length) = chunk(&mut rest).ok_or(MeshFile::GltfShort)?;
    if kind != u32::from_le_bytes(*b"JSON") {
        return Err(MeshFile::GltfNoText);
    }
    let (text, mut rest) = rest.split_at(length);
    // Chunks have lengths of whole words, and those of other kinds are skipped.
    while !rest.is_empty() {
        let (kind, length) = chunk(&mut rest).ok_or(MeshFile::GltfShort)?;
        let (binary, after) = rest.split_at(length);
        if kind == u32::from_le_bytes(*b"BIN\0") {
            return Ok((text, Some(binary)));
        }
        rest = after;
    }
    Ok((text, None))
}

/// Reads the JSON text of the file at `path`, and checks its indices.
pub(super) fn document(path: &Path, text: &[u8]) -> Result<Document, FileError> {
    let whole = |what| FileError::new(what, path, FilePlace::Whole);
    let exceeds = |(sign, most)| text.split(|byte| *byte == sign).nth(most + 1).is_some();
    if text.len() > MOST_TEXT || MOST.into_iter().any(exceeds) {
        let bytes = MOST_TEXT;
        let [objects, lists, commas] = MOST.map(|(_, most)| most);
        return Err(whole(MeshFile::GltfLarge {
            bytes,
            objects,
            lists,
            commas,
        }));
    }
    let root = Root::from_slice(text).map_err(|error| {
        let (line, why) = (error.line(), error.to_string());
        FileError::new(MeshFile::GltfText { why }, path, line.max(1))
    })?;
    let needed = |name: &&String| !KNOWN.contains(&name.as_str());
    if let Some(name) = root.extensions_required.iter().find(needed) {
        let name = name.clone();
        return Err(whole(MeshFile::GltfExtension { name }));
    }
    if let Some(place) = undefined_positions(&root) {
        let why = "index out of bounds".to_owned();
        return Err(FileError::new(MeshFile::GltfText { why }, path, place));
    }
    // The crate's own list of faults could take more memory than the text.
    let mut fault = None;
    root.validate(&root, ::gltf::json::Path::new, &mut |place, what| {
        fault.get_or_insert_with(|| (place(), what));
    });
    if let Some((place, what)) = fault {
        let why = what.to_string().to_lowercase();
        let place = FilePlace::Part(place.to_string());
        return Err(FileError::new(MeshFile::GltfText { why }, path, place));
    }
    Ok(Document::from_json_without_validation(root))
}

/// Returns the place of the first primitive whose positions are no accessor of the file. The crate's
/// checks panic at such an index.
fn undefined_positions(root: &Root) -> Option<FilePlace> {
    let positions = Checked::Valid(Semantic::Positions);
    let meshes = root.meshes.iter().enumerate();
    meshes
        .flat_map(|(number, mesh)| {
            let primitives = mesh.primitives.iter().enumerate();
            primitives.map(move |(place, primitive)| (number, place, primitive))
        })
        .find(|(.., primitive)| {
            let index = primitive.attributes.get(&positions);
            index.is_some_and(|index| index.value() >= root.accessors.len())
        })
        .map(|(number, place, _)| {
            FilePlace::Part(format!(
                "meshes[{number}].primitives[{place}].attributes[\"POSITION\"]"
            ))
        })
}

/// Extensions that a file may require.
const KNOWN: [&str; 3] = [
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_transmission",
];

/// Returns the bytes of a `data:` URI in base64; `None` if it cannot be read.
pub(super) fn data_uri(uri: &str) -> Option<Vec<u8>> {
    let (head, data) = uri.split_once(',')?;
    if !head.ends_with(";base64") {
        return None;
    }
    let data = data.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(data.len() / 4 * 3 + 3);
    for group in data.chunks(4) {
        let mut bits = 0_u32;
        for byte in group {
            let digit = match byte {
                b'A'..=b'Z' => byte - b'A',
                b'a'..=b'z' => byte - b'a' + 26,
                b'0'..=b'9' => byte - b'0' + 52,
                b'+' => 62,
                b'/' => 63,
                _ => return None,
            };
            bits = bits << 6 | u32::from(digit);
        }
        // A digit alone has fewer bits than a byte.
        let count = (group.len() * 6 / 8).checked_sub(usize::from(group.len() == 1));
        let bits = bits << (6 * (4 - group.len()));
        bytes.extend_from_slice(&bits.to_be_bytes()[1..][..count.filter(|n| *n > 0)?]);
    }
    Some(bytes)
}

/// Returns a relative URI with its `%` escapes replaced.
pub(super) fn unescaped(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let digit = |at: usize| {
            after
                .get(at)
                .and_then(|byte| char::from(*byte).to_digit(16))
        };
        if let (b'%', Some(high), Some(low)) = (first, digit(0), digit(1)) {
            bytes.push((16 * high + low) as u8);
            rest = &after[2..];
        } else {
            bytes.push(*first);
            rest = after;
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_read_as_it_is_written() {
        for (text, bytes) in [
            ("", &b""[..]),
            ("Zg==", b"f"),
            ("Zm8=", b"fo"),
            ("Zm9v", b"foo"),
            ("Zm9vYg", b"foob"),
            ("+/+/", b"\xfb\xff\xbf"),
        ] {
            let uri = format!("data:application/octet-stream;base64,{text}");
            assert_eq!(data_uri(&uri).as_deref(), Some(bytes), "{text}");
        }
        for uri in ["data:", "data:,a", "data:;base64,a", "data:;base64,a-bc"] {
            assert_eq!(data_uri(uri), None, "{uri}");
        }
    }

    #[test]
    fn escapes_of_names_are_replaced() {
        assert_eq!(unescaped("my%20mesh.bin"), "my mesh.bin");
        assert_eq!(unescaped("50%.bin%2"), "50%.bin%2");
        assert_eq!(unescaped("caf%c3%A9"), "caf\u{e9}");
    }
}
