//! The material libraries of a mesh: the albedos and radiances of their materials.

use super::{Library, ObjError, name, numbers, split, statements, text_of, tokens};
use crate::scene::Rgb;
use crate::scene::meshes::ObjMaterial;
use crate::syntax::{MeshFile, nearest};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The materials of all libraries of a mesh, in order.
#[derive(Default)]
pub(super) struct Materials {
    list: Vec<Material>,
    /// Indices into `list` by name. The map is only looked up, never walked.
    by_name: HashMap<String, usize>,
}

/// The properties of a material that a scene uses.
struct Material {
    name: String,
    file: String,
    line: usize,
    albedo: Option<Rgb>,
    radiance: Option<Rgb>,
}

impl Materials {
    /// Reads the libraries that the OBJ file at `obj` names; `names` has each name with its line.
    /// Adds their paths to `files`.
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
                let bytes = library(&path).map_err(|what| ObjError::new(what, obj, *line))?;
                materials.add_all(&path, name, &bytes)?;
                files.push(path);
            }
        }
        Ok(materials)
    }

    /// Returns the index of the material `name` in the list.
    pub(super) fn find(&self, name: &str, no_libraries: bool) -> Result<usize, MeshFile> {
        self.by_name.get(name).copied().ok_or_else(|| {
            let names = self.list.iter().map(|material| material.name.as_str());
            let near = nearest(name, names).map(str::to_owned);
            let name = name.to_owned();
            if no_libraries {
                MeshFile::NoLibrary { name }
            } else {
                MeshFile::UnknownMaterial { name, near }
            }
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

    /// Adds the materials of the library at `path`, which the OBJ file calls `file`.
    fn add_all(&mut self, path: &Path, file: &str, bytes: &[u8]) -> Result<(), ObjError> {
        let first = self.list.len();
        for (line, statement) in statements(&text_of(path, bytes)?) {
            let read = split(&statement).and_then(|(keyword, rest)| match keyword {
                "newmtl" => self.add(file, line, rest),
                "Kd" | "Ke" | "map_Kd" | "map_Ke" => {
                    set(self.list[first..].last_mut(), keyword, rest)
                }
                // Other statements have no meaning in a scene, and operands of many kinds.
                _ => Ok(()),
            });
            read.map_err(|what| ObjError::new(what, path, line))?;
        }
        let mut added = self.list[first..].iter();
        match added.find(|added| added.albedo.is_none() && added.radiance.is_none()) {
            None => Ok(()),
            Some(Material { name, line, .. }) => {
                let name = name.clone();
                Err(ObjError::new(MeshFile::EmptyMaterial { name }, path, *line))
            }
        }
    }

    fn add(&mut self, file: &str, line: usize, rest: &str) -> Result<(), MeshFile> {
        let name = name("newmtl", rest, MeshFile::NamelessMaterial)?;
        let number = self.list.len();
        if let Some(old) = self.by_name.insert(name.clone(), number) {
            let Material { file, line, .. } = &self.list[old];
            let (file, line) = (file.clone(), *line);
            return Err(MeshFile::SecondMaterial { name, file, line });
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

/// Sets the colour of a statement in `material`, the material above it.
fn set(material: Option<&mut Material>, keyword: &str, rest: &str) -> Result<(), MeshFile> {
    let owned = keyword.to_owned();
    let Some(material) = material else {
        return Err(MeshFile::BeforeMaterials { keyword: owned });
    };
    if keyword.starts_with("map_") {
        return Err(MeshFile::Texture { keyword: owned });
    }
    let colour = colour(keyword, rest)?;
    let off = |is_off: fn(&f64) -> bool| colour.iter().copied().find(is_off);
    if keyword == "Ke" {
        if let Some(value) = off(|c| *c < 0.0) {
            return Err(MeshFile::NegativeRadiance { value });
        }
        material.radiance = Some(colour);
    } else {
        if let Some(value) = off(|c| !(0.0..=1.0).contains(c)) {
            return Err(MeshFile::NotAlbedo { value });
        }
        material.albedo = Some(colour);
    }
    Ok(())
}

/// Reads `r g b`, or one number for grey.
fn colour(keyword: &str, rest: &str) -> Result<Rgb, MeshFile> {
    let keyword = keyword.to_owned();
    if let Some(space @ ("spectral" | "xyz")) = tokens(rest).next() {
        let space = space.to_owned();
        return Err(MeshFile::NotRgb { keyword, space });
    }
    match numbers(rest, 4, true)?[..] {
        [grey] => Ok([grey; 3]),
        [r, g, b] => Ok([r, g, b]),
        ref other => Err(MeshFile::Colour {
            keyword,
            given: other.len(),
        }),
    }
}
