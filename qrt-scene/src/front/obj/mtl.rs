//! The material libraries of a mesh, and the materials of the scene language that theirs become.
//!
//! The book's page on meshes has the table of this mapping.

use super::{FileError, Library, bare, name, numbers, split, statements, text_of, tokens};
use crate::front::meshes::surface;
use crate::scene::meshes::FileMaterial;
use crate::scene::{Dielectric, Emitter, Lambertian, Material, Phong, Rgb};
use qrt_syntax::tree::shorten;
use qrt_syntax::{MeshFile, nearest};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

/// The definitions of all libraries of a mesh, in order.
#[derive(Default)]
pub(super) struct Materials {
    list: Vec<Definition>,
    /// Indices into `list` by name. The map is only looked up, never walked.
    by_name: HashMap<String, usize>,
    /// The same by names without comments and quotes; `None` if several have the name.
    by_bare_name: HashMap<String, Option<usize>>,
    has_libraries: bool,
    /// The first error of a library as a whole: it matters if a material is missing.
    fault: Option<FileError>,
    /// True if a material is missing.
    is_missing: bool,
}

/// A material and its statements.
struct Definition {
    name: String,
    /// The library, as the OBJ file names it, and its path.
    file: String,
    path: PathBuf,
    line: usize,
    statements: Statements,
    fault: Option<FileError>,
}

/// The statements of a material, the last of each kind.
#[derive(Default)]
struct Statements {
    /// True if Blender wrote the library.
    by_blender: bool,
    ambient: Option<Rgb>,
    diffuse: Option<Rgb>,
    specular: Option<Rgb>,
    radiance: Option<Rgb>,
    filter: Option<Rgb>,
    exponent: Option<f64>,
    ior: Option<f64>,
    dissolve: Option<f64>,
    transparency: Option<f64>,
    illumination: Option<u8>,
    roughness: Option<f64>,
    metallic: Option<f64>,
    /// The keyword of a texture of the diffuse colour or of the radiance, and its line.
    texture: Option<(String, usize)>,
    /// Keywords of statements that have no counterpart.
    other: BTreeSet<String>,
}

/// Maximum number of statements that name libraries, and of names in each.
const MOST_LIBRARIES: usize = 64;

/// Maximum number of bytes of a library's name that holds blanks.
const LONGEST_NAME: usize = 4096;

/// Maximum number of keywords without a counterpart that are named.
const MOST_NAMED: usize = 16;

impl Materials {
    /// Reads the libraries that the OBJ file at `obj` names; `names` has each statement's text with
    /// its line. Adds the paths of the files to `files`.
    pub(super) fn read(
        obj: &Path,
        names: &[(String, usize)],
        library: Library<'_>,
        files: &mut Vec<PathBuf>,
    ) -> Self {
        let mut materials = Self {
            has_libraries: !names.is_empty(),
            ..Self::default()
        };
        let mut statements = HashSet::new();
        let beside = |name: &str| obj.parent().unwrap_or(Path::new("")).join(name);
        for (text, line) in names {
            if !statements.insert(text) {
                continue;
            }
            if statements.len() > MOST_LIBRARIES {
                let most = MOST_LIBRARIES;
                let what = MeshFile::ManyLibraries { most };
                materials.add_fault(FileError::new(what, obj, *line));
                break;
            }
            // A statement may name several files, and a file's name may hold blanks or a `#`.
            let whole = [text.as_str(), bare(text)];
            let whole = whole.into_iter().filter(|name| name.len() <= LONGEST_NAME);
            let whole: Vec<String> = whole.flat_map(spellings).collect();
            let mut found = whole.iter();
            let names = match found.find(|name| library(&beside(name)).is_ok()) {
                Some(name) => vec![name.clone()],
                None => bare(text)
                    .split_whitespace()
                    .take(MOST_LIBRARIES)
                    .map(|word| {
                        let [written, slashed] = spellings(bare(word));
                        let is_slashed = library(&beside(&written)).is_err()
                            && library(&beside(&slashed)).is_ok();
                        if is_slashed { slashed } else { written }
                    })
                    .collect(),
            };
            for name in names {
                let path = beside(&name);
                if files.contains(&path) {
                    continue;
                }
                match library(&path) {
                    Ok(bytes) => {
                        materials.add_all(&path, &name, &bytes);
                        files.push(path);
                    }
                    Err(what) => materials.add_fault(FileError::new(what, obj, *line)),
                }
            }
        }
        materials
    }

    fn add_fault(&mut self, fault: FileError) {
        self.fault.get_or_insert(fault);
    }

    /// The error of a library that no face has needed.
    pub(super) fn unneeded(self) -> Option<FileError> {
        self.fault.filter(|_| !self.is_missing)
    }

    /// Returns the material of the faces after the statement `usemtl NAME` on line `line` of the
    /// file at `obj`.
    pub(super) fn material(&mut self, name: &str, obj: &Path, line: usize) -> FileMaterial {
        let bare_name = bare(name);
        let by_bare_name = || self.by_bare_name.get(bare_name).copied().flatten();
        let found = self.by_name.get(name).copied().or_else(by_bare_name);
        let Some(definition) = found.map(|index| &self.list[index]) else {
            self.is_missing = true;
            let missing = || FileError::new(self.missing(bare_name), obj, line);
            return FileMaterial {
                name: bare_name.to_owned(),
                label: bare_name.to_owned(),
                material: Err(self.fault.clone().unwrap_or_else(missing)),
                left_out: BTreeSet::new(),
                file: obj.to_owned(),
                place: line.into(),
            };
        };
        let mut left_out = BTreeSet::new();
        let material = match &definition.fault {
            Some(fault) => Err(fault.clone()),
            None => definition.material(&mut left_out),
        };
        let name = &definition.name;
        let is_clear = self
            .by_bare_name
            .get(bare(name))
            .is_some_and(Option::is_some);
        FileMaterial {
            name: if is_clear { bare(name) } else { name }.to_owned(),
            label: format!("{}:{name}", definition.file),
            material,
            left_out,
            file: definition.path.clone(),
            place: definition.line.into(),
        }
    }

    fn missing(&self, name: &str) -> MeshFile {
        let names = self.list.iter().map(|material| material.name.as_str());
        let near = nearest(name, names).map(str::to_owned);
        let name = name.to_owned();
        if self.has_libraries {
            MeshFile::UnknownMaterial { name, near }
        } else {
            MeshFile::NoLibrary { name }
        }
    }

    /// Adds the materials of the library at `path`, which the OBJ file calls `file`.
    fn add_all(&mut self, path: &Path, file: &str, bytes: &[u8]) {
        let text = match text_of(path, bytes) {
            Ok(text) => text,
            Err(fault) => return self.add_fault(fault),
        };
        let by_blender = text.trim_start().starts_with("# Blender");
        // A name that cannot be read has no index; its statements are skipped.
        let mut current = Some(None);
        for (line, statement) in statements(&text) {
            let read = match (split(&statement), current) {
                (Ok(("newmtl", rest)), _) => {
                    let added = name("newmtl", rest, MeshFile::NamelessMaterial);
                    let added = added.map(|name| self.add(path, file, line, name));
                    current = added.as_ref().ok().map(|index| Some(*index));
                    added.map(|index| self.list[index].statements.by_blender = by_blender)
                }
                (Ok((keyword, rest)), Some(Some(index))) => {
                    let Definition {
                        statements, fault, ..
                    } = &mut self.list[index];
                    if let Err(what) = statements.read(keyword, rest, line) {
                        fault.get_or_insert_with(|| FileError::new(what, path, line));
                    }
                    Ok(())
                }
                (Ok((keyword @ ("Kd" | "Ke" | "map_Kd" | "map_Ke"), _)), Some(None)) => {
                    let keyword = keyword.to_owned();
                    Err(MeshFile::BeforeMaterials { keyword })
                }
                (Ok(_), _) => Ok(()),
                (Err(what), _) => Err(what),
            };
            if let Err(what) = read {
                self.add_fault(FileError::new(what, path, line));
            }
        }
    }

    /// Adds a material without statements, and returns its index. A second one of a name
    /// makes the name an error.
    fn add(&mut self, path: &Path, file: &str, line: usize, name: String) -> usize {
        let number = self.list.len();
        let first = *self.by_name.entry(name.clone()).or_insert(number);
        if let Some(old) = self.list.get_mut(first) {
            let what = MeshFile::SecondMaterial {
                name: name.clone(),
                file: old.file.clone(),
                line: old.line,
            };
            old.fault = Some(FileError::new(what, path, line));
        } else {
            let of_name = self.by_bare_name.entry(bare(&name).to_owned());
            of_name
                .and_modify(|index| *index = None)
                .or_insert(Some(number));
        }
        self.list.push(Definition {
            name,
            file: file.to_owned(),
            path: path.to_owned(),
            line,
            statements: Statements::default(),
            fault: None,
        });
        number
    }
}

/// The name of a file as it is written, and with `/` for `\`; neither has `./` before it.
fn spellings(name: &str) -> [String; 2] {
    [name.to_owned(), name.replace('\\', "/")].map(|name| {
        let mut rest = name.as_str();
        while let Some(beside) = rest.strip_prefix("./") {
            rest = beside.trim_start_matches('/');
        }
        rest.to_owned()
    })
}

impl Statements {
    fn read(&mut self, keyword: &str, rest: &str, line: usize) -> Result<(), MeshFile> {
        match keyword {
            "Kd" => {
                let kd = colour(keyword, rest)?;
                self.diffuse = Some(reflectance(keyword, kd)?);
            }
            "Ke" => {
                let radiance = colour(keyword, rest)?;
                if let Some(value) = radiance.into_iter().find(|c| *c < 0.0) {
                    let keyword = keyword.to_owned();
                    return Err(MeshFile::NegativeRadiance { keyword, value });
                }
                self.radiance = Some(radiance);
            }
            "Ka" | "Ks" | "Tf" => {
                let colour = match colour(keyword, rest) {
                    Err(MeshFile::NotRgb { .. }) => {
                        self.leave_out(keyword);
                        return Ok(());
                    }
                    colour => colour?,
                };
                match keyword {
                    "Ka" => self.ambient = Some(colour),
                    "Ks" => self.specular = Some(colour),
                    _ => self.filter = Some(colour),
                }
            }
            "Ns" => self.exponent = Some(number(keyword, rest, f64::MAX)?),
            "Ni" => self.ior = Some(number(keyword, rest, f64::MAX)?),
            // The dissolve depends on the direction.
            "d" if tokens(rest).next() == Some("-halo") => self.leave_out("d -halo"),
            "d" => self.dissolve = Some(number(keyword, rest, 1.0)?),
            "Tr" => self.transparency = Some(number(keyword, rest, 1.0)?),
            "Pr" => self.roughness = Some(number(keyword, rest, 1.0)?),
            "Pm" => self.metallic = Some(number(keyword, rest, 1.0)?),
            "illum" => {
                let model = number(keyword, rest, 10.0)?;
                if model.fract() != 0.0 {
                    return Err(MeshFile::Illumination { model });
                }
                self.illumination = Some(model as u8);
            }
            "map_Kd" | "map_Ke" => {
                self.texture
                    .get_or_insert_with(|| (keyword.to_owned(), line));
            }
            // The ambient light of local models, and parameters of effects that are left out.
            "map_Ka" | "sharpness" | "Pcr" | "anisor" => {}
            // Effects that are written with the weight 0 if there are none.
            "Ps" | "Pc" | "aniso" if matches!(numbers(rest, 1, true)?[..], [0.0]) => {}
            _ => self.leave_out(keyword),
        }
        Ok(())
    }

    fn leave_out(&mut self, keyword: &str) {
        if self.other.len() < MOST_NAMED {
            self.other.insert(shorten(keyword));
        }
    }
}

impl Definition {
    /// Returns the material of the scene language that is meant. Adds the keywords of statements
    /// without a counterpart to `left_out`.
    fn material(&self, left_out: &mut BTreeSet<String>) -> Result<Material, FileError> {
        let said = &self.statements;
        let fail = |what| FileError::new(what, &self.path, self.line);
        if let Some((keyword, line)) = &said.texture {
            let (keyword, name) = (keyword.clone(), bare(&self.name).to_owned());
            let what = MeshFile::Texture { keyword, name };
            return Err(FileError::new(what, &self.path, *line));
        }
        left_out.extend(said.other.iter().cloned());
        let mut leave_out = |keyword: &str, is_written: bool| {
            if is_written {
                left_out.insert(keyword.to_owned());
            }
        };
        let empty = || {
            let name = bare(&self.name).to_owned();
            fail(MeshFile::EmptyMaterial { name })
        };
        let is_pbr = said.by_blender || said.roughness.is_some() || said.metallic.is_some();
        let specular = said.specular.filter(|ks| *ks != [0.0; 3]);
        let (kd, ks) = (mean(said.diffuse), mean(said.specular));

        // `Tr` alone is 1 - d. Some exporters write both, and some of them a wrong `Tr`.
        let opacity = said.dissolve.or(said.transparency.map(|tr| 1.0 - tr));
        let transparency = if said.dissolve.is_some() { "d" } else { "Tr" };
        let is_partial = opacity.is_some_and(|opacity| opacity > 0.0 && opacity < 1.0);
        let is_glass = opacity.is_some_and(|opacity| opacity < 0.5)
            || match said.illumination {
                Some(4 | 9) => opacity.is_none(),
                Some(6 | 7) => !said.by_blender,
                _ => false,
            }
            || is_pbr && mean(said.filter) >= 0.5;
        // Blender writes the metallic value as the ambient colour, too.
        let is_reflecting = matches!(said.illumination, Some(3 | 5 | 6 | 8));
        let by_blender = || said.ambient.filter(|_| said.by_blender && is_reflecting);
        let metallic = said.metallic.or_else(|| by_blender().map(|ka| ka[0]));
        let is_metal = match metallic {
            Some(metallic) => metallic >= 0.5,
            None => is_reflecting && specular.is_some() && ks >= kd,
        };
        let roughness = said.roughness.or_else(|| {
            let exponent = said.exponent.filter(|_| said.by_blender)?;
            Some((1.0 - (exponent / 1000.0).sqrt()).max(0.0))
        });

        if let Some(radiance) = said.radiance.filter(|ke| *ke != [0.0; 3]) {
            leave_out("Ks", specular.is_some() && !said.by_blender);
            leave_out(transparency, opacity.is_some_and(|opacity| opacity < 1.0));
            leave_out("Pm", said.metallic.is_some_and(|metallic| metallic > 0.0));
            let albedo = said.diffuse.unwrap_or_default();
            let albedo = albedo.into();
            return Ok(Emitter { radiance, albedo }.into());
        }
        if is_glass {
            let ior = said.ior.unwrap_or(surface::GLASS);
            if !surface::IORS.contains(&ior) {
                return Err(fail(MeshFile::Ior { ior }));
            }
            let is_tinted = |colour: Option<Rgb>| colour.is_some_and(|c| c != [c[0]; 3]);
            leave_out("Kd", is_tinted(said.diffuse));
            leave_out("Tf", is_tinted(said.filter));
            leave_out(
                "Pr",
                said.roughness.is_some_and(|roughness| roughness > 0.0),
            );
            leave_out(transparency, is_partial);
            return Ok(Dielectric::clear(ior).into());
        }
        leave_out(transparency, is_partial);
        if is_metal {
            let (keyword, colour) = match metallic {
                Some(_) => ("Kd", said.diffuse),
                None => ("Ks", specular),
            };
            leave_out("Pm", metallic.is_some_and(|metallic| metallic < 1.0));
            leave_out("Kd", keyword == "Ks" && kd > 0.0);
            let colour = reflectance(keyword, colour.ok_or_else(empty)?).map_err(fail)?;
            return Ok(surface::metal(colour, roughness.unwrap_or(0.0)));
        }
        leave_out("Pm", metallic.is_some_and(|metallic| metallic > 0.0));
        let diffuse = said.diffuse.unwrap_or_default();
        if let (Some(specular), Some(exponent), false) = (specular, said.exponent, is_pbr)
            && !matches!(said.illumination, Some(0 | 1))
            && diffuse.iter().zip(&specular).all(|(kd, ks)| kd + ks <= 1.0)
            && specular.iter().all(|ks| *ks >= 0.0)
            && exponent <= surface::MOST_EXPONENT
        {
            let phong = Phong {
                diffuse,
                specular,
                exponent,
            };
            return Ok(phong.into());
        }
        leave_out("Ks", specular.is_some());
        let albedo = said.diffuse.ok_or_else(empty)?;
        let albedo = albedo.into();
        Ok(Lambertian { albedo }.into())
    }
}

fn mean(colour: Option<Rgb>) -> f64 {
    colour.map_or(0.0, |[r, g, b]| (r + g + b) / 3.0)
}

/// Returns `colour` if a surface can reflect it.
fn reflectance(keyword: &str, colour: Rgb) -> Result<Rgb, MeshFile> {
    let off = colour.into_iter().find(|c| !(0.0..=1.0).contains(c));
    match off {
        None => Ok(colour),
        Some(value) => {
            let keyword = keyword.to_owned();
            Err(MeshFile::NotAlbedo { keyword, value })
        }
    }
}

/// Reads a number from 0 to `most`.
fn number(keyword: &str, rest: &str, most: f64) -> Result<f64, MeshFile> {
    let keyword = keyword.to_owned();
    match numbers(rest, 2, true)?[..] {
        [value] if (0.0..=most).contains(&value) => Ok(value),
        [value] => Err(MeshFile::StatementRange {
            keyword,
            value,
            most,
        }),
        ref other => Err(MeshFile::StatementCount {
            keyword,
            given: other.len(),
        }),
    }
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
