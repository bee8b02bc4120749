//! Blocks of YAML: whole scenes, or parts of them.

use super::diff::diff;
use qrt::scene::front;
use std::path::Path;

/// Blocks of a scene that replace those that a page leaves out.
const BASE: [(&str, &str); 5] = [
    ("name", "name: base\n"),
    (
        "camera",
        "camera: { perspective: { eye: [0, 1, 4], target: [0, 1, 0], vfov: 40 } }\n",
    ),
    ("film", "film: { width: 8, height: 8 }\n"),
    (
        "materials",
        "\
materials:
  white: { lambertian: { albedo: [0.7, 0.7, 0.7] } }
  lamp: { emitter: { radiance: [4, 4, 4] } }
",
    ),
    (
        "geometry",
        "\
geometry:
  - quad: { vertices: [[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], material: white }
  - quad: { vertices: [[-1, 3, -1], [1, 3, -1], [1, 3, 1], [-1, 3, 1]], material: lamp }
",
    ),
];

/// Returns the file that a block's first line names, and true if the block replaces only parts of it.
pub(crate) fn file(body: &str) -> Option<(&str, bool)> {
    let line = body.lines().next()?.strip_prefix("# ")?;
    let (name, partial) = match line.strip_prefix("in ") {
        Some(name) => (name, true),
        None => (line, false),
    };
    let plain = name
        .bytes()
        .all(|byte| byte.is_ascii_alphanumeric() || b"-._".contains(&byte));
    (plain && name.strip_suffix(".yaml").is_some()).then_some((name, partial))
}

/// Returns the key of a block at the start of a line.
fn key(line: &str) -> Option<&str> {
    let (key, _) = line.split_once(':')?;
    let plain = key
        .bytes()
        .all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    (plain && !key.is_empty()).then_some(key)
}

/// Returns the text before the first block, and the blocks, each with its key.
fn blocks(text: &str) -> (String, Vec<(String, String)>) {
    let mut head = String::new();
    let mut blocks: Vec<(String, String)> = Vec::new();
    for line in text.split_inclusive('\n') {
        if let Some(key) = key(line) {
            blocks.push((key.to_owned(), line.to_owned()));
        } else {
            let last = blocks.last_mut().map_or(&mut head, |(_, block)| block);
            last.push_str(line);
        }
    }
    (head, blocks)
}

/// Completes a scene with the base's blocks where some are missing.
pub(crate) fn completed(text: &str) -> String {
    let (_, own) = blocks(text);
    let has = |key: &str| own.iter().any(|(other, _)| other == key);
    let mut scene = text.to_owned();
    for (key, block) in BASE {
        if has(key) {
            continue;
        }
        // The base's primitives use the base's materials.
        let bare = key == "geometry" && has("materials");
        scene.push_str(if bare { "geometry: []\n" } else { block });
    }
    scene
}

/// Returns `old` with the blocks of `new` in place of its own.
pub(crate) fn replaced(old: &str, new: &str) -> String {
    let (mut out, mut kept) = blocks(old);
    for (key, block) in blocks(new).1 {
        match kept.iter_mut().find(|(other, _)| *other == key) {
            Some((_, old)) => *old = block,
            None => kept.push((key, block)),
        }
    }
    out.extend(kept.into_iter().map(|(_, block)| block));
    out
}

/// The verdict of qrt on a scene.
pub(crate) enum Verdict {
    /// The scene is valid.
    Accepted,
    /// The scene is refused, with this report.
    Refused(String),
}

/// Parses the scene in `text` with the name `name`, with meshes in `folder`.
pub(crate) fn judge(text: &str, name: &str, folder: &Path) -> Verdict {
    match front::parse(text, name, &[], folder) {
        Ok(_) => Verdict::Accepted,
        Err(report) => Verdict::Refused(report.render(false)),
    }
}

/// Compares a report with the one that a page shows: the name of the file is the page's, and the last
/// line, which counts the errors, may be left out.
///
/// # Errors
/// The lines that differ.
pub(crate) fn is_told(report: &str, shown: &str) -> Result<(), String> {
    let name = |text: &str| {
        let place = text.split_once("--> ")?.1.split(':').next()?;
        Some(place.to_owned())
    };
    let report = match (name(report), name(shown)) {
        (Some(own), Some(shown)) => report.replace(&own, &shown),
        _ => report.to_owned(),
    };
    let mut said: Vec<&str> = report.lines().map(str::trim_end).collect();
    let shown: Vec<&str> = shown.trim_end().lines().map(str::trim_end).collect();
    if shown == said {
        return Ok(());
    }
    said.pop();
    while said.last().is_some_and(|line| line.is_empty()) {
        said.pop();
    }
    if shown == said {
        Ok(())
    } else {
        Err(format!("the report is another:\n{}", diff(&shown, &said)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accepts(text: &str) -> bool {
        let scene = completed(text);
        matches!(
            judge(&scene, "scene.yaml", "scenes-yaml".as_ref()),
            Verdict::Accepted
        )
    }

    #[test]
    fn parts_of_a_scene_are_completed() {
        for right in [
            "",
            "film: { width: 2, height: 2 }\n",
            "materials:\n  red: { lambertian: { albedo: [1, 0, 0] } }\n",
            "geometry:\n  - mesh: { obj: meshes/knot.obj, material: lamp }\n",
            "accuracy: { error: 0.1, confidence: 0.9 }\n",
        ] {
            assert!(accepts(right), "{right}");
        }
        for wrong in [
            "film: { width: 0, height: 2 }\n",
            "materials:\n  red: { lambertian: { albedo: [2, 0, 0] } }\n",
            "geometry:\n  - mesh: { obj: meshes/not.obj, material: lamp }\n",
            "velvet: { lambertian: { albedo: [1, 0, 0] } }\n",
            "  path_bits: 3\n",
        ] {
            assert!(!accepts(wrong), "{wrong}");
        }
    }

    #[test]
    fn the_first_line_may_name_a_file() {
        assert_eq!(file("# box.yaml\nname: box\n"), Some(("box.yaml", false)));
        assert_eq!(file("# in box.yaml\nname: box\n"), Some(("box.yaml", true)));
        for text in [
            "",
            "name: box\n",
            "# a box\n",
            "# ../box.yaml\n",
            "# as in box.yaml\n",
        ] {
            assert_eq!(file(text), None, "{text}");
        }
    }

    #[test]
    fn blocks_are_replaced_whole_or_added() {
        let old = "# a scene\nname: a\nfilm:\n  width: 1\n\ncamera: 3\n";
        let new = "# in a.yaml\nfilm: 2\nbudget:\n  qubits: 4\n";
        let found = replaced(old, new);
        assert_eq!(
            found,
            "# a scene\nname: a\nfilm: 2\ncamera: 3\nbudget:\n  qubits: 4\n"
        );
    }

    #[test]
    fn a_report_is_compared_word_by_word() {
        let text = completed("film: { widht: 2, height: 2 }\n");
        let Verdict::Refused(report) = judge(&text, "scene.yaml", "".as_ref()) else {
            panic!("it is wrong");
        };
        let other = report.replace("scene.yaml", "box.yaml");
        assert_eq!(is_told(&report, &other), Ok(()));
        let (without_count, _) = other.trim_end().rsplit_once('\n').unwrap();
        assert_eq!(is_told(&report, without_count), Ok(()));
        assert!(is_told(&report, &other.replace("did you mean", "use")).is_err());
        assert!(is_told(&report, &without_count[..40]).is_err());
    }
}
