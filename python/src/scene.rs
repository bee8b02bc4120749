//! Scenes: reads and checks them, and plans their parameters.

use crate::{errors, work};
use pyo3::prelude::*;
use qrt_runtime::Prepared;
use qrt_runtime::memory::Memory;
use qrt_runtime::plan;
use qrt_runtime::prepared::PrepareError;
use qrt_runtime::render::RenderError;
use qrt_scene::front::{self, Files, Loaded};
use qrt_scene::valid::ValidScene;
use qrt_syntax::Report;
use std::fs;
use std::path::{Path, PathBuf};

/// Files by their names in the scene, with their contents.
pub(crate) type Held = Vec<(String, Vec<u8>)>;

/// A scene that was read and checked: what `qrt.load`, `qrt.parse` and `qrt.from_dict` make. It does not
/// change; their `set=` makes others.
#[pyclass(frozen, module = "qrt")]
pub(crate) struct Scene {
    pub(crate) loaded: Loaded,
    pub(crate) sets: Vec<String>,
    /// The folder of its files.
    folder: PathBuf,
    /// Other folders that it may read files of.
    allow_files: Vec<PathBuf>,
    /// Contents of its files, if they came with it from another process.
    held: Option<Held>,
}

/// Loads the scene of a YAML file. `sets` are overrides, `KEY=VALUE`.
#[pyfunction]
pub(crate) fn load(
    py: Python<'_>,
    path: PathBuf,
    sets: Vec<String>,
    allow_files: Vec<PathBuf>,
) -> PyResult<Scene> {
    let read = py.detach(|| front::load_with(&path, &sets, |files| files.allowing(&allow_files)));
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    Scene::new(py, read, sets, (folder, allow_files), None)
}

/// Parses the scene of a YAML text, whose name in errors is `name`; its files are below `folder`.
#[pyfunction]
pub(crate) fn parse(
    py: Python<'_>,
    text: &str,
    name: &str,
    sets: Vec<String>,
    folder: PathBuf,
    allow_files: Vec<PathBuf>,
) -> PyResult<Scene> {
    let files = Files::of_folder(&folder).allowing(&allow_files);
    let read = py.detach(|| front::parse_with(text, name, &sets, files));
    Scene::new(py, read, sets, (folder, allow_files), None)
}

/// Restores a scene of another process from its text and the files that it came with.
#[pyfunction]
pub(crate) fn restore(
    py: Python<'_>,
    text: &str,
    name: &str,
    sets: Vec<String>,
    files: Held,
    fingerprint: &str,
) -> PyResult<Scene> {
    let held: Vec<(&str, &[u8])> = files
        .iter()
        .map(|(name, bytes)| (&**name, &**bytes))
        .collect();
    let read = py.detach(|| front::parse_with(text, name, &sets, Files::held(&held)));
    let scene = Scene::new(py, read, sets, Default::default(), Some(files))?;
    if scene.valid().fingerprint().to_string() == fingerprint {
        Ok(scene)
    } else {
        let message = "the scene's files have changed since it was read: load it again";
        Err(errors::job(py, message))
    }
}

impl Scene {
    fn new(
        py: Python<'_>,
        read: Result<Loaded, Report>,
        sets: Vec<String>,
        (folder, allow_files): (PathBuf, Vec<PathBuf>),
        held: Option<Held>,
    ) -> PyResult<Self> {
        let loaded = read.map_err(|report| errors::scene(py, &report))?;
        if let Some(report) = loaded.warnings() {
            errors::warn(py, &report)?;
        }
        Ok(Self {
            loaded,
            sets,
            folder,
            allow_files,
            held,
        })
    }

    /// Returns the scene of the same text and files with more overrides.
    pub(crate) fn with_sets(&self, py: Python<'_>, more: Vec<String>) -> PyResult<Self> {
        let sets = [self.sets.clone(), more].concat();
        let source = &self.loaded.source;
        let read = py.detach(|| {
            let held = self.held.iter().flatten();
            let held: Vec<(&str, &[u8])> = held.map(|(name, bytes)| (&**name, &**bytes)).collect();
            let files = match self.held {
                Some(_) => Files::held(&held),
                None => Files::of_folder(&self.folder).allowing(&self.allow_files),
            };
            front::parse_with(&source.text, &source.name, &sets, files)
        });
        let folders = (self.folder.clone(), self.allow_files.clone());
        Self::new(py, read, sets, folders, self.held.clone())
    }

    pub(crate) fn valid(&self) -> &ValidScene {
        &self.loaded.valid
    }

    /// Returns the exception of a render's error, at its place in the scene.
    pub(crate) fn failure(&self, py: Python<'_>, error: RenderError) -> PyErr {
        errors::render(py, error, |problems| self.loaded.report(problems))
    }

    /// Returns the exception of a scene that cannot be prepared, by a method without a memory budget of its own.
    pub(crate) fn unprepared(&self, py: Python<'_>, error: PrepareError) -> PyErr {
        match error {
            PrepareError::WouldNotFit(error) => errors::request(py, error),
            error => self.failure(py, error.into()),
        }
    }

    /// Returns the scene ready for work, with the parameters that the planner chose for its accuracy, if it
    /// asks for one.
    pub(crate) fn prepared(&self, py: Python<'_>) -> PyResult<Prepared<'_>> {
        let prepared = work::run(py, None, None, |workers| {
            let options = plan::PlanOptions {
                workers,
                ..plan::PlanOptions::default()
            };
            Prepared::new(self.valid(), &options, Memory::default())
        })?;
        prepared.map_err(|error| self.unprepared(py, error))
    }

    /// Returns the pixel `asked` if it is on the film; the middle one for `None`.
    pub(crate) fn pixel(&self, py: Python<'_>, asked: Option<[u32; 2]>) -> PyResult<[u32; 2]> {
        let film = self.valid().scene().film;
        let [x, y] = asked.unwrap_or([film.width / 2, film.height / 2]);
        if x < film.width && y < film.height {
            return Ok([x, y]);
        }
        let (width, height) = (film.width, film.height);
        let message = format!("there is no pixel ({x}, {y}) on a film of {width} x {height}");
        Err(errors::request(py, message))
    }

    /// Returns the scene's files with their contents.
    pub(crate) fn files(&self) -> PyResult<Held> {
        if let Some(held) = &self.held {
            return Ok(held.clone());
        }
        let files = self.valid().files().iter().map(|path| {
            let name = path.strip_prefix(&self.folder).unwrap_or(path);
            Ok((name.to_string_lossy().into_owned(), fs::read(path)?))
        });
        files.collect()
    }
}
