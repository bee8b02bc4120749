//! The check of an MTL file's text, and its plain form.

use super::scan::shown;
use super::{ObjError, Statements, number, words};
use crate::scene::Rgb;
use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

/// The materials of all libraries of a mesh, in order.
#[derive(Default)]
pub(super) struct Materials {
    list: Vec<Material>,
    /// Their places by name; only looked up.
    by_name: HashMap<String, usize>,
}

/// What a material says that a scene uses.
struct Material {
    name: String,
    file: String,
    line: usize,
    albedo: Option<Rgb>,
    radiance: Option<Rgb>,
}

impl Materials {
    /// The number of the material `name`.
    pub(super) fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Their names.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|material| material.name.as_str())
    }

    /// Their names as `FILE.mtl:NAME`.
    pub(super) fn full_names(&self) -> Vec<String> {
        self.list
            .iter()
            .map(|m| format!("{}:{}", m.file, m.name))
            .collect()
    }

    /// All of them as one library, by number, with digits that read back as the same numbers.
    pub(super) fn plain(&self) -> String {
        let mut text = String::new();
        for (number, material) in self.list.iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "newmtl {number}");
            for (keyword, colour) in [("Kd", material.albedo), ("Ke", material.radiance)] {
                if let Some([r, g, b]) = colour {
                    let _ = writeln!(text, "{keyword} {r} {g} {b}");
                }
            }
        }
        text
    }

    /// Adds those of the library at `path`, which the OBJ file calls `file`.
    pub(super) fn read(&mut self, path: &Path, file: &str, bytes: &[u8]) -> Result<(), ObjError> {
        let materials = &mut self.list;
        let first = materials.len();
        let mut statements = Statements::new(path, bytes);
        while let Some(statement) = statements.next()? {
            let line = statement.line;
            let error = |code, message: String| ObjError::new(code, path, message).at(line);
            let (keyword, rest) = statement.split();
            match keyword {
                "newmtl" => {
                    if rest.is_empty() {
                        return Err(error("QRT0337", "`newmtl` without a name".to_owned()));
                    }
                    if rest.contains(char::REPLACEMENT_CHARACTER) {
                        let message = "the name after `newmtl` is not UTF-8 text";
                        return Err(error("QRT0322", message.to_owned()));
                    }
                    if let Some(old) = self.by_name.get(rest).and_then(|old| materials.get(*old)) {
                        let message = format!("a second material `{}`", shown(rest));
                        let place = format!("the first is in {}, line {}", old.file, old.line);
                        return Err(error("QRT0340", message).help(place));
                    }
                    self.by_name.insert(rest.to_owned(), materials.len());
                    materials.push(Material {
                        name: rest.to_owned(),
                        file: file.to_owned(),
                        line,
                        albedo: None,
                        radiance: None,
                    });
                }
                "Kd" | "Ke" | "map_Kd" | "map_Ke" => {
                    let Some(material) = materials[first..].last_mut() else {
                        let message = format!("`{keyword}` stands before any `newmtl`");
                        return Err(error("QRT0337", message));
                    };
                    if keyword.starts_with("map_") {
                        let message = format!("`{keyword}`: there are no textures");
                        return Err(error("QRT0342", message).help(
                            "give the mesh a `material` in the scene, or a plain colour here",
                        ));
                    }
                    let colour = colour(path, line, keyword, rest)?;
                    if keyword == "Kd" {
                        if let Some(off) = colour.iter().find(|c| !(0.0..=1.0).contains(*c)) {
                            let message =
                                format!("the albedo `Kd` is {off}, which is not in [0, 1]");
                            return Err(error("QRT0338", message));
                        }
                        material.albedo = Some(colour);
                    } else {
                        if let Some(off) = colour.iter().find(|c| **c < 0.0) {
                            let message = format!("the radiance `Ke` is {off}, which is negative");
                            return Err(error("QRT0339", message));
                        }
                        material.radiance = Some(colour);
                    }
                }
                // What has no part in a scene; its operands are of many kinds.
                _ => {}
            }
        }
        match materials[first..]
            .iter()
            .find(|m| m.albedo.is_none() && m.radiance.is_none())
        {
            None => Ok(()),
            Some(material) => {
                let message = format!(
                    "material `{}` has neither `Kd` nor `Ke`",
                    shown(&material.name)
                );
                Err(ObjError::new("QRT0341", path, message)
                    .at(material.line)
                    .help("`Kd r g b` is its albedo, `Ke r g b` its radiance"))
            }
        }
    }
}

/// `r g b`, or one number for grey.
fn colour(path: &Path, line: usize, keyword: &str, rest: &str) -> Result<Rgb, ObjError> {
    let first = words(rest).next().unwrap_or_default();
    if matches!(first, "spectral" | "xyz") {
        let message = format!("`{keyword} {first}` is not read: colours are linear RGB");
        return Err(ObjError::new("QRT0337", path, message).at(line));
    }
    let numbers = words(rest)
        .take(4)
        .map(|word| number(path, line, word))
        .collect::<Result<Vec<f64>, _>>()
        .map_err(|error| ObjError {
            code: "QRT0337",
            ..error
        })?;
    match numbers[..] {
        [grey] => Ok([grey; 3]),
        [r, g, b] => Ok([r, g, b]),
        _ => {
            let message = format!("`{keyword}` takes 3 numbers, or 1, not {}", numbers.len());
            Err(ObjError::new("QRT0337", path, message).at(line))
        }
    }
}
