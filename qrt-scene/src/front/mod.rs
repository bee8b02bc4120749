//! From text or constant data to a scene: YAML, overrides of the command line, meshes.

mod files;
mod gltf;
mod items;
mod mesh_files;
pub mod meshes;
pub mod obj;
pub mod overrides;
mod ply;
pub mod yaml;

use crate::scene::Scene;
use crate::scene::shape::Part;
use crate::valid::InvalidScene;
use crate::valid::{self, ValidScene};
pub use files::Files;
pub(crate) use files::Unread;
pub use items::{Item, from_items};
pub use mesh_files::load_all;
use qrt_syntax::tree::Node;
use qrt_syntax::{File, Place, Problem, Problems, Report, Source, line_after};

/// Maximum number of bytes of a scene file.
pub const MAX_BYTES: u64 = 16 << 20;

/// A scene that was read and checked, with the text it came from.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, checked.
    pub valid: ValidScene,
    /// The scene's text as it was read.
    pub source: Source,
    /// Texts of overrides.
    overrides: Vec<Source>,
    tree: Node,
}

impl Loaded {
    /// Returns the warnings, about parts that are not errors but probably unintended, each at its
    /// place; `None` if there are none.
    pub fn warnings(&self) -> Option<Report> {
        let found = self.valid.warnings();
        (!found.is_empty()).then(|| self.report(found.to_vec()).warning())
    }

    /// A report of problems that were found in the scene after it was loaded, each at its place.
    pub fn report(&self, problems: Vec<Problem>) -> Report {
        let mut sources = vec![self.source.clone()];
        sources.extend(self.overrides.iter().cloned());
        Report::new(sources, Some(&self.tree), problems)
    }
}

/// Loads and checks the scene of the file at `path`, with overrides such as `film.width=8` and its
/// meshes.
///
/// # Errors
/// All problems of the scene, with places.
pub fn load(path: &std::path::Path, sets: &[String]) -> Result<Loaded, Report> {
    load_with(path, sets, |files| files)
}

/// Loads as [`load`] does, with `access` changing the access to the scene's own files: see
/// [`Files::allowing`].
///
/// # Errors
/// All problems of the scene, with places.
pub fn load_with<'a>(
    path: &'a std::path::Path,
    sets: &[String],
    access: impl FnOnce(Files<'a>) -> Files<'a>,
) -> Result<Loaded, Report> {
    let files = access(Files::of_folder(folder_of(path)));
    let source = read_file(path, |most| files.read_named(path, most))?;
    from_source(source, sets, files)
}

fn folder_of(path: &std::path::Path) -> &std::path::Path {
    path.parent().unwrap_or(std::path::Path::new(""))
}

/// Loads as [`load`] does, from a path relative to `root`, below which all its files are. Errors
/// name files relative to `root`.
///
/// # Errors
/// All problems of the scene, with places.
pub fn load_below(
    root: &std::path::Path,
    path: &std::path::Path,
    sets: &[String],
) -> Result<Loaded, Report> {
    let allowed = [root.to_path_buf()];
    let files = Files::below(root, folder_of(path)).allowing(&allowed);
    let all = Files::below(root, "".as_ref());
    let source = read_file(path, |most| all.read(path, most))?;
    from_source(source, sets, files)
}

/// Reads and checks the scene of a YAML text; its meshes are in `folder`.
///
/// # Errors
/// All problems of the scene, with places.
///
/// ```
/// let report = qrt_scene::front::parse("name: 7", "seven.yaml", &[], "".as_ref()).unwrap_err();
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

/// Reads and checks as [`parse`] does, with meshes from `files`.
///
/// # Errors
/// All problems of the scene, with places.
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
    let mut problems = Problems::default();
    let mut tree = yaml::read(&sources[0], 0..sources[0].text.len(), 0, &mut problems);
    for text in sets {
        let number = sources.len() as u32;
        let source = Source::new("<--set>", text.as_str());
        let set = overrides::read(&source, number, &mut problems);
        if let (Some(set), Some(tree)) = (set, &mut tree) {
            overrides::apply(tree, set, &mut problems);
        }
        sources.push(source);
    }
    let Some(tree) = tree else {
        return Err(Report::new(sources, None, problems.all()));
    };
    match decoded(&tree, files, problems) {
        Ok(valid) => Ok(Loaded {
            valid,
            source: sources.remove(0),
            overrides: sources,
            tree,
        }),
        Err(found) => Err(Report::new(sources, Some(&tree), found)),
    }
}

/// Decodes and checks the scene of a tree from any front end.
///
/// # Errors
/// All problems of the scene.
pub fn of_tree(tree: &Node, files: Files<'_>) -> Result<ValidScene, Vec<Problem>> {
    decoded(tree, files, Problems::default())
}

fn decoded(
    tree: &Node,
    files: Files<'_>,
    mut problems: Problems,
) -> Result<ValidScene, Vec<Problem>> {
    let scene = Scene::decode(tree, &Place::ROOT, &mut problems);
    let meshes = mesh_files::load_all(&scene, files);
    valid::check(scene, &meshes, problems)
}

fn read_file(
    path: &std::path::Path,
    read: impl FnOnce(u64) -> Result<Vec<u8>, Unread>,
) -> Result<Source, Report> {
    let name = path.display().to_string();
    let fail = |what| Report::of_file(&name, what);
    let unreadable = |why: Unread| {
        use std::io::ErrorKind;
        fail(match why {
            Unread::Irregular { is_folder: true } => File::Folder,
            Unread::Irregular { is_folder: false } => File::Irregular,
            Unread::TooLarge => File::TooLarge { most: MAX_BYTES },
            Unread::Outside => File::Outside,
            Unread::Failed(error) => match error.kind() {
                ErrorKind::NotFound => File::Missing,
                ErrorKind::PermissionDenied => File::Denied,
                _ => File::Failed {
                    why: error.to_string(),
                },
            },
        })
    };
    let bytes = read(MAX_BYTES).map_err(unreadable)?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to();
        let line = line_after(&error.as_bytes()[..byte]);
        fail(File::NotUtf8 { byte, line })
    })?;
    Ok(Source::new(name, text))
}

impl Scene {
    /// Checks the scene, with the meshes that it names in `folder`.
    ///
    /// # Errors
    /// All problems of the scene.
    pub fn validate(self, folder: &std::path::Path) -> Result<ValidScene, InvalidScene> {
        let meshes = mesh_files::load_all(&self, Files::of_folder(folder));
        valid::validate(self, &meshes)
    }

    /// Reads the scene of a YAML text called `name`, without checking it.
    ///
    /// ```
    /// let scene = qrt_scene::Scene::from_yaml(
    ///     "
    /// name: dark
    /// camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
    /// film: { width: 8, height: 8 }
    /// materials: {}
    /// geometry: []
    /// ",
    ///     "dark.yaml",
    /// )?;
    /// assert_eq!(scene.sampling.path_bits, 12);
    /// assert_eq!(qrt_scene::Scene::from_yaml(&scene.to_yaml(), "printed.yaml")?, scene);
    /// # Ok::<(), qrt_syntax::Report>(())
    /// ```
    ///
    /// # Errors
    /// All problems that prevent reading, with places.
    pub fn from_yaml(text: &str, name: &str) -> Result<Self, Report> {
        let source = Source::new(name, text);
        let mut problems = Problems::default();
        let tree = yaml::read(&source, 0..source.text.len(), 0, &mut problems);
        let scene = tree
            .as_ref()
            .map(|tree| Scene::decode(tree, &Place::ROOT, &mut problems));
        let problems = problems.all();
        match scene {
            Some(scene) if problems.is_empty() => Ok(scene),
            _ => Err(Report::new(vec![source], tree.as_ref(), problems)),
        }
    }
}
