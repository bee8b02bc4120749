//! The material libraries of a mesh: what their materials reflect and emit.

use super::{Library, ObjError, name, numbers, split, statements, text_of, words};
use crate::scene::Rgb;
use crate::scene::meshes::ObjMaterial;
use crate::syntax::codes;
use crate::syntax::nearest;
use crate::syntax::tree::shorten;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

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
    /// Those of the libraries that the OBJ file at `obj` names, each name with its line. The files
    /// are added to `files`.
    pub(super) fn read(
        obj: &Path,
        names: &[(String, usize)],
        library: Library<'_>,
        files: &mut Vec<PathBuf>,
    ) -> Result<Self, ObjError> {
        let mut materials = Self::default();
        let beside = |name: &str| obj.parent().unwrap_or(Path::new("")).join(name);
        for (name, line) in names {
            // A statement may name several files, and a file's name may hold blanks.
            let names = if library(&beside(name)).is_ok() {
                vec![name.as_str()]
            } else {
                name.split_whitespace().collect()
            };
            for name in names {
                let path = beside(name);
                if files.contains(&path) {
                    continue;
                }
                let bytes = library(&path).map_err(|error| error.at(obj, *line))?;
                materials.add_all(&path, name, &bytes)?;
                files.push(path);
            }
        }
        Ok(materials)
    }

    /// The place of `name` in the list.
    pub(super) fn find(&self, name: &str, no_libraries: bool) -> Result<usize, ObjError> {
        self.by_name.get(name).copied().ok_or_else(|| {
            let message = format!("no material `{}`", shorten(name));
            if no_libraries {
                return ObjError::new(codes::OBJ_NO_LIBRARY, message)
                    .help("the file names no material library: a `mtllib` statement is missing");
            }
            let names = self.list.iter().map(|material| material.name.as_str());
            ObjError::new(codes::OBJ_MATERIAL, message).help(match nearest(name, names) {
                Some(near) => format!("did you mean `{near}`?"),
                None => "`newmtl` in a material library names it".to_owned(),
            })
        })
    }

    pub(super) fn into_list(self) -> Vec<ObjMaterial> {
        let public = |material: Material| ObjMaterial {
            name: format!("{}:{}", material.file, material.name),
            radiance: material.radiance.unwrap_or_default(),
            albedo: material.albedo.unwrap_or_default(),
        };
        self.list.into_iter().map(public).collect()
    }

    /// Adds those of the library at `path`, which the OBJ file calls `file`.
    fn add_all(&mut self, path: &Path, file: &str, bytes: &[u8]) -> Result<(), ObjError> {
        let first = self.list.len();
        for (line, statement) in statements(&text_of(path, bytes)?) {
            let read = split(&statement).and_then(|(keyword, rest)| match keyword {
                "newmtl" => self.add(file, line, rest),
                "Kd" | "Ke" | "map_Kd" | "map_Ke" => {
                    set(self.list[first..].last_mut(), keyword, rest)
                }
                // What has no part in a scene; its operands are of many kinds.
                _ => Ok(()),
            });
            read.map_err(|error| error.at(path, line))?;
        }
        let mut added = self.list[first..].iter();
        match added.find(|added| added.albedo.is_none() && added.radiance.is_none()) {
            None => Ok(()),
            Some(Material { name, line, .. }) => {
                let message = format!("material `{}` has neither `Kd` nor `Ke`", shorten(name));
                Err(ObjError::new(codes::MTL_EMPTY, message)
                    .help("`Kd r g b` is its albedo, `Ke r g b` its radiance")
                    .at(path, *line))
            }
        }
    }

    fn add(&mut self, file: &str, line: usize, rest: &str) -> Result<(), ObjError> {
        let name = name("newmtl", rest, codes::MTL_STATEMENT)?;
        let number = self.list.len();
        if let Some(old) = self.by_name.insert(name.clone(), number) {
            let Material { file, line, .. } = &self.list[old];
            let message = format!("a second material `{}`", shorten(&name));
            return Err(ObjError::new(codes::MTL_DUPLICATE, message)
                .help(format!("the first is in {file}, line {line}")));
        }
        self.list.push(Material {
            name,
            file: file.to_owned(),
            line,
            albedo: None,
            radiance: None,
        });
        Ok(())
    }
}

/// What a statement says of the colours of the material that it stands below.
fn set(material: Option<&mut Material>, keyword: &str, rest: &str) -> Result<(), ObjError> {
    let Some(material) = material else {
        let message = format!("`{keyword}` stands before any `newmtl`");
        return Err(ObjError::new(codes::MTL_STATEMENT, message));
    };
    if keyword.starts_with("map_") {
        let message = format!("`{keyword}`: there are no textures");
        return Err(ObjError::new(codes::MTL_TEXTURE, message)
            .help("give the mesh a `material` in the scene, or a plain colour here"));
    }
    let colour = colour(keyword, rest)?;
    let off = |is_off: fn(&f64) -> bool| colour.iter().copied().find(is_off);
    if keyword == "Ke" {
        if let Some(off) = off(|c| *c < 0.0) {
            let message = format!("the radiance `Ke` is {off}, which is negative");
            return Err(ObjError::new(codes::MTL_RADIANCE, message));
        }
        material.radiance = Some(colour);
    } else {
        if let Some(off) = off(|c| !(0.0..=1.0).contains(c)) {
            let message = format!("the albedo `Kd` is {off}, which is not in [0, 1]");
            return Err(ObjError::new(codes::MTL_ALBEDO, message));
        }
        material.albedo = Some(colour);
    }
    Ok(())
}

/// `r g b`, or one number for grey.
fn colour(keyword: &str, rest: &str) -> Result<Rgb, ObjError> {
    let first = words(rest).next().unwrap_or_default();
    let message = if matches!(first, "spectral" | "xyz") {
        format!("`{keyword} {first}` is not read: colours are linear RGB")
    } else {
        match numbers(rest, 4).as_deref() {
            Ok([grey]) => return Ok([*grey; 3]),
            Ok([r, g, b]) => return Ok([*r, *g, *b]),
            Ok(other) => format!("`{keyword}` takes 3 numbers, or 1, not {}", other.len()),
            Err(error) => error.message.clone(),
        }
    };
    Err(ObjError::new(codes::MTL_STATEMENT, message))
}
