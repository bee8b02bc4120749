//! From text to a scene: YAML, overrides of the command line, meshes.

mod files;
pub mod obj;
pub mod overrides;
pub mod tree;
pub mod yaml;

use crate::codes;
use crate::diagnostics::{Report, Source};
use crate::report::{Faulty, Path, Problem};
use crate::scene::Scene;
use crate::scene::decode::{Decoder, Place};
use crate::scene::shape::Part;
use crate::valid::{ValidScene, validate};
pub use files::Files;
use files::Unread;
use tree::Node;
use yaml::Reading;

/// Bytes that a scene file may have.
pub const MAX_BYTES: u64 = 16 << 20;

/// A scene that was read and checked, with the text it came from.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub valid: ValidScene,
    /// Its text as written.
    pub source: Source,
    /// Texts of overrides.
    overrides: Vec<Source>,
    tree: Node,
}

impl Loaded {
    /// A report of problems that were found in the scene after it was loaded, each at its place.
    pub fn report(&self, problems: Vec<Problem>) -> Report {
        let mut sources = vec![self.source.clone()];
        sources.extend(self.overrides.iter().cloned());
        Report::of_tree(sources, &self.tree, Vec::new(), problems)
    }
}

/// The scene of the file at `path`, with overrides such as `film.width=8`, meshes and all.
///
/// # Errors
/// Everything that is wrong with it, with places.
pub fn load(path: &std::path::Path, sets: &[String]) -> Result<Loaded, Report> {
    load_below("".as_ref(), path, sets)
}

/// As [`load`], of a path relative to `root`; errors name files as seen from there.
///
/// # Errors
/// Everything that is wrong with it, with places.
pub fn load_below(
    root: &std::path::Path,
    path: &std::path::Path,
    sets: &[String],
) -> Result<Loaded, Report> {
    let folder = path.parent().unwrap_or(std::path::Path::new(""));
    let files = Files::below(root, folder);
    let source = read_file(files, path)?;
    from_source(source, sets, files)
}

/// The scene of a YAML text; `folder` is where its meshes are.
///
/// # Errors
/// Everything that is wrong with it, with places.
///
/// ```
/// let report = qrt_core::front::parse("name: 7", "seven.yaml", &[], "".as_ref()).unwrap_err();
/// assert!(report.to_string().contains("--> seven.yaml:1:7"));
/// ```
pub fn parse(
    text: &str,
    name: &str,
    sets: &[String],
    folder: &std::path::Path,
) -> Result<Loaded, Report> {
    parse_with(text, name, sets, Files::of_folder(folder))
}

/// As [`parse`], with meshes from wherever `files` says.
///
/// # Errors
/// Everything that is wrong with it, with places.
pub fn parse_with(
    text: &str,
    name: &str,
    sets: &[String],
    files: Files<'_>,
) -> Result<Loaded, Report> {
    from_source(Source::new(name, text), sets, files)
}

fn from_source(source: Source, sets: &[String], files: Files<'_>) -> Result<Loaded, Report> {
    let mut sources = vec![source];
    let Reading {
        mut tree,
        mut problems,
    } = yaml::read(&sources[0], 0..sources[0].text.len(), 0);
    for text in sets {
        let number = sources.len() as u32;
        let source = Source::new("<--set>", text.as_str());
        match (overrides::read(&source, number), &mut tree) {
            (Ok(set), Some(tree)) => {
                problems.extend(overrides::apply(tree, set).err().map(|placed| *placed));
            }
            (Ok(_), None) => {}
            (Err(found), _) => problems.extend(found),
        }
        sources.push(source);
    }
    let Some(tree) = tree else {
        return Err(Report::of_placed(sources, problems));
    };
    match of_tree(&tree, files) {
        Ok(valid) if problems.is_empty() => Ok(Loaded {
            valid,
            source: sources.remove(0),
            overrides: sources,
            tree,
        }),
        Ok(_) => Err(Report::of_placed(sources, problems)),
        Err(found) => Err(Report::of_tree(sources, &tree, problems, found)),
    }
}

/// The scene of a tree, whatever front end made it.
///
/// # Errors
/// Everything that is wrong with it.
pub fn of_tree(tree: &Node, files: Files<'_>) -> Result<ValidScene, Vec<Problem>> {
    let mut decoder = Decoder::default();
    let scene = Scene::decode(tree, &Place::ROOT, &mut decoder);
    let meshes = obj::load_all(&scene, files);
    let checked = validate(scene, &meshes);
    let Decoder {
        mut problems,
        replaced,
    } = decoder;
    match checked {
        Ok(valid) if problems.is_empty() => return Ok(valid),
        Ok(_) => {}
        Err(found) => {
            let faulty = Faulty::of(&replaced);
            // Where the materials could not be read, nobody knows which names there are.
            let nameless = replaced.contains(&Path::root().key("materials"));
            problems.extend(found.into_iter().filter(|problem| {
                let unknown = nameless && problem.code == codes::UNKNOWN_MATERIAL;
                !unknown && !faulty.touches(&problem.path)
            }));
        }
    }
    Err(problems)
}

fn read_file(files: Files<'_>, path: &std::path::Path) -> Result<Source, Report> {
    let name = path.display().to_string();
    let fail = |code, message: String, help: Option<&str>| {
        let mut problem = Problem::new(code, Path::root(), message);
        problem.help = help.map(str::to_owned);
        Report::of_file(&name, problem)
    };
    let unreadable = |why: Unread| {
        use std::io::ErrorKind;
        let (message, help) = match why {
            Unread::Irregular { is_folder: true } => {
                ("this is a folder".to_owned(), Some("name a scene file"))
            }
            Unread::Irregular { is_folder: false } => {
                let message = "this is not a regular file".to_owned();
                (message, Some("name a scene file"))
            }
            Unread::TooLarge => {
                let message = format!("the file is larger than {} MiB", MAX_BYTES >> 20);
                let help = "put large geometry into OBJ meshes";
                return fail(codes::TOO_LARGE, message, Some(help));
            }
            Unread::Failed(error) => match error.kind() {
                ErrorKind::NotFound => (
                    "there is no such file".to_owned(),
                    Some("check the path, or start a scene with `qrt new NAME`"),
                ),
                ErrorKind::PermissionDenied => ("you may not read this file".to_owned(), None),
                _ => (format!("the file cannot be read: {error}"), None),
            },
        };
        fail(codes::UNREADABLE, message, help)
    };
    let bytes = files.read(path, MAX_BYTES).map_err(unreadable)?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..at].split(|&byte| byte == b'\n').count();
        let message = format!("the file is not UTF-8 text: byte {at}, on line {line}");
        fail(codes::NOT_UTF8, message, Some("save it as UTF-8"))
    })?;
    Ok(Source::new(name, text))
}
