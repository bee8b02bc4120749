//! The methods of a scene in Python: renders it, and creates its paths and oracles.

use crate::oracle::Oracle;
use crate::picture::Picture;
use crate::scene::Scene;
use crate::{errors, work};
use numpy::{IntoPyArray, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use qrt_counting::estimators::{Noise, NoiseError};
use qrt_lab::mitsuba;
use qrt_runtime::memory::Memory;
use qrt_runtime::models::MachineOptions;
use qrt_runtime::render::{
    Colour, DEFAULT_FAILURE, Model, Portion, RenderError, RenderOptions, Visibility, render,
    render_part,
};
use qrt_runtime::search::Guess;
use qrt_runtime::workers::Workers;
use qrt_scene::Estimator;
use qrt_scene::valid::ValidScene;

/// Most paths that are returned at once: 24 bytes each.
const MOST_PATHS: u64 = 1 << 28;

/// The options of a render, read from Python's keyword arguments.
struct Asked {
    options: RenderOptions<'static>,
    threads: Option<std::num::NonZeroUsize>,
    progress: Option<Py<PyAny>>,
}

/// Returns the value with the name `asked`, or an error that lists the names.
fn of_name<T: Copy>(
    py: Python<'_>,
    argument: &str,
    all: &[T],
    name: impl Fn(T) -> &'static str,
    asked: &str,
) -> PyResult<T> {
    let found = all.iter().find(|value| name(**value) == asked);
    found.copied().ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|value| name(*value)).collect();
        let names = names.join(", ");
        errors::request(py, format!("{argument}={asked:?} is none of: {names}"))
    })
}

impl Asked {
    fn from_options(py: Python<'_>, options: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut asked = Self {
            options: RenderOptions::default(),
            threads: None,
            progress: None,
        };
        let mut visibility = "classical".to_owned();
        let (mut failure, mut guess) = (None, None);
        for (key, value) in options.into_iter().flatten() {
            let key: String = key.extract()?;
            let own = &mut asked.options;
            match key.as_str() {
                "progress" => asked.progress = Some(value.unbind()),
                // None is the same as a missing option.
                _ if value.is_none() => {}
                "model" => {
                    let name = Model::name;
                    own.model = Some(of_name(py, &key, &Model::ALL, name, value.extract()?)?);
                }
                "estimator" => {
                    let name = Estimator::name;
                    own.estimator =
                        Some(of_name(py, &key, Estimator::ALL, name, value.extract()?)?);
                }
                "colour" => {
                    own.colour = of_name(py, &key, &Colour::ALL, Colour::name, value.extract()?)?;
                }
                "seed" => own.seed = value.extract()?,
                "crop" => own.crop = Some(value.extract()?),
                "noise" => {
                    let text: String = value.extract()?;
                    let noise = text.parse::<Noise>();
                    own.noise = noise.map_err(|error: NoiseError| errors::request(py, error))?;
                }
                "visibility" => visibility = value.extract()?,
                "search_failure" => failure = Some(value.extract()?),
                "first_guess" => {
                    guess = Some(of_name(
                        py,
                        &key,
                        &Guess::ALL,
                        Guess::name,
                        value.extract()?,
                    )?);
                }
                "max_memory" => own.memory = Memory::new(Some(value.extract()?)),
                "threads" => asked.threads = work::threads(py, Some(value.extract()?))?,
                "checkpoint" => own.checkpoint = Some(value.extract()?),
                "resume" => own.resume = value.extract()?,
                _ => {
                    let message = format!("render() got an unexpected keyword argument {key:?}");
                    return Err(pyo3::exceptions::PyTypeError::new_err(message));
                }
            }
        }
        let all = [
            Visibility::Classical,
            Visibility::Exhaustive,
            Visibility::GROVER,
        ];
        let found = of_name(py, "visibility", &all, Visibility::name, &visibility)?;
        asked.options.visibility = match found {
            Visibility::Grover { .. } => Visibility::Grover {
                failure: failure.unwrap_or(DEFAULT_FAILURE),
                guess: guess.unwrap_or_default(),
            },
            other if failure.is_none() && guess.is_none() => other,
            _ => {
                let message = "search_failure and first_guess are of a search: they need \
                               visibility=\"grover\"";
                return Err(errors::request(py, message));
            }
        };
        Ok(asked)
    }
}

impl Scene {
    /// Runs `make` on the scene with the options, on a thread of its own.
    fn work<T: Send>(
        &self,
        py: Python<'_>,
        options: Option<&Bound<'_, PyDict>>,
        make: impl FnOnce(&ValidScene, &RenderOptions<'_>) -> Result<T, RenderError> + Send,
    ) -> PyResult<T> {
        let Asked {
            options,
            threads,
            progress,
        } = Asked::from_options(py, options)?;
        let work = |workers: Workers<'_>| make(self.valid(), &RenderOptions { workers, ..options });
        work::listened(py, threads, progress, work, |error| self.failure(py, error))
    }
}

#[pymethods]
impl Scene {
    /// The scene's name.
    #[getter]
    fn name(&self) -> &str {
        &self.valid().scene().name
    }

    /// Columns of its film, in pixels.
    #[getter]
    fn width(&self) -> u32 {
        self.valid().scene().film.width
    }

    /// Rows of its film, in pixels.
    #[getter]
    fn height(&self) -> u32 {
        self.valid().scene().film.height
    }

    /// A hash of the scene and of every file it refers to, as 32 hexadecimal digits.
    #[getter]
    fn fingerprint(&self) -> String {
        self.valid().fingerprint().to_string()
    }

    /// The scene with more overrides, as texts `KEY=VALUE`.
    fn _with(&self, py: Python<'_>, sets: Vec<String>) -> PyResult<Self> {
        self.with_sets(py, sets)
    }

    /// The scene as YAML, overrides included; read again, it is the same scene.
    fn to_yaml(&self) -> String {
        self.valid().scene().to_yaml()
    }

    fn __repr__(&self) -> String {
        let (width, height) = (self.width(), self.height());
        format!("<qrt.Scene {:?}, {width} x {height} pixels>", self.name())
    }

    /// Pickles the scene with its files, so that other machines need none of them.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let restore = py.import("qrt._qrt")?.getattr("restore")?;
        let files: Vec<(String, Bound<'py, PyBytes>)> = (self.files()?.into_iter())
            .map(|(name, bytes)| (name, PyBytes::new(py, &bytes)))
            .collect();
        let source = &self.loaded.source;
        let arguments = (
            &source.text,
            &source.name,
            &self.sets,
            files,
            self.fingerprint(),
        );
        Ok((restore, arguments.into_pyobject(py)?.into_any()))
    }

    /// Render the scene, and return a Picture.
    ///
    /// Options that are missing take their values from the scene:
    ///
    /// model: "real" (64-bit floating point), "fixed" (the oracle's program, on integers) or "gates" (its
    ///     circuit, every gate).
    /// estimator: the name of an amplitude estimator, in place of the scene's; "exact" counts all paths,
    ///     without noise.
    /// seed: keys the paths' shifts and every draw, 0 to 2**64 - 1.
    /// crop: (x, y, width, height) in pixels, from the film's top left corner.
    /// colour: "three-runs", a count for each channel, or "one-run", of the luminance alone.
    /// noise: of the device that counts, such as "depolarising=0.001,readout=0.01".
    /// visibility: "classical", "exhaustive" or "grover", with search_failure (a probability) and
    ///     first_guess ("random" or "coherent").
    /// threads: one for each core unless given.
    /// max_memory: bytes that it may take, by an estimate; three quarters of what the machine has unless given.
    /// progress: a function of the paths done and of all paths; True for a bar of tqdm, False for none;
    ///     by default a bar in terminals and notebooks.
    /// checkpoint, resume: a file that keeps what is finished, and whether to go on from it.
    ///
    /// Other threads of Python run meanwhile, and Ctrl-C ends the work.
    ///
    /// Raises SceneError or RequestError for what can't be rendered, JobError where the work fails.
    #[pyo3(
        signature = (**options),
        text_signature = "($self, *, model='real', estimator=None, seed=0, crop=None, colour='three-runs', \
                          noise=None, visibility='classical', search_failure=None, first_guess=None, \
                          threads=None, max_memory=None, progress=None, checkpoint=None, resume=False)"
    )]
    fn render(&self, py: Python<'_>, options: Option<&Bound<'_, PyDict>>) -> PyResult<Picture> {
        let rendered = self.work(py, options, render)?;
        Ok(Picture::new(rendered))
    }

    /// Render portion `k`, from 0, of `n` of the picture, and return it as the bytes of a part: those of a
    /// file of `qrt render --portion K/N`, which `qrt.merge` and `qrt merge` put together. What
    /// else is given is as for `render`.
    ///
    /// Raises RequestError, too, where there are more portions than pixels.
    #[pyo3(
        signature = (k, n, **options),
        text_signature = "($self, k, n, *, model='real', estimator=None, seed=0, crop=None, \
                          colour='three-runs', noise=None, visibility='classical', search_failure=None, \
                          first_guess=None, threads=None, max_memory=None, progress=None, checkpoint=None, \
                          resume=False)"
    )]
    fn render_portion<'py>(
        &self,
        py: Python<'py>,
        k: u32,
        n: u32,
        options: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let portion = Portion::new(k, n).map_err(|error| errors::request(py, error))?;
        let bytes = self.work(py, options, |scene, options| {
            let (part, _) = render_part(scene, portion, options)?;
            Ok(part.encode())
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The colours of all paths of a pixel: an array of (2**path_bits, 3), float64, linear RGB radiance, in
    /// the order of path indices. Their mean is the pixel under the estimator "exact" of the model "real";
    /// colours of the models "fixed" and "gates" are those of the circuit's numbers.
    ///
    /// pixel: column and row, from 0 at the top left; the middle one unless given.
    ///
    /// Raises RequestError for a pixel that is not on the film, and for more paths than 2**28; SceneError for
    /// a scene without a circuit, or whose budget it exceeds, of the models "fixed" and "gates".
    #[pyo3(signature = (pixel=None, *, model="real", seed=0))]
    fn paths<'py>(
        &self,
        py: Python<'py>,
        pixel: Option<[u32; 2]>,
        model: &str,
        seed: u64,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pixel = self.pixel(py, pixel)?;
        let model = of_name(py, "model", &Model::ALL, Model::name, model)?;
        let prepared = self.prepared(py)?;
        let paths = 1_u64 << prepared.scene().scene().sampling.path_bits;
        if paths > MOST_PATHS {
            let message = format!("{paths} paths are more than {MOST_PATHS}: lower path_bits");
            return Err(errors::request(py, message));
        }
        let options = RenderOptions {
            model: Some(model),
            ..RenderOptions::default()
        };
        let traced = work::run(py, None, None, |workers| {
            prepared.check_render(&options)?;
            let machines = prepared.machines(&MachineOptions {
                model,
                seed,
                colours: true,
                ..MachineOptions::default()
            })?;
            let machine = &**machines.by_class.at(pixel);
            let mut colours = Vec::with_capacity(3 * paths as usize);
            for ids in work::runs(workers, paths) {
                machine.trace_paths(None, &[pixel], ids, &mut |traced| {
                    traced.each_colour(machine, |_, colour| colours.extend(colour));
                })?;
            }
            Ok::<Vec<f64>, RenderError>(colours)
        })?;
        let colours = traced.map_err(|error| self.failure(py, error))?;
        colours.into_pyarray(py).reshape([paths as usize, 3])
    }

    /// The scene for the renderer Mitsuba 3: the text of an XML file, and the files that it names, by
    /// name, which belong into its folder. Their names begin with `stem`.
    ///
    /// Raises SceneError for a material that Mitsuba lacks: a `phong` that shines, a `bsdf` of one's own.
    #[pyo3(signature = (stem="scene"))]
    fn mitsuba<'py>(&self, py: Python<'py>, stem: &str) -> PyResult<(String, Bound<'py, PyDict>)> {
        let exported = mitsuba::export(&self.loaded.valid, stem);
        let exported = exported
            .map_err(|error| errors::scene(py, &self.loaded.report(vec![error.problem()])))?;
        let files = PyDict::new(py);
        for mesh in &exported.meshes {
            files.set_item(&mesh.file, PyBytes::new(py, &mesh.bytes))?;
        }
        Ok((exported.text, files))
    }

    /// The oracle of a channel ("r", "g" or "b"; without one, that with the most Toffolis) of a pixel
    /// (column and row, from 0 at the top left; without one, the middle).
    ///
    /// Raises SceneError for a scene without a circuit, or whose budget it exceeds.
    #[pyo3(signature = (channel=None, pixel=None, *, seed=0))]
    fn oracle(
        this: &Bound<'_, Self>,
        channel: Option<&str>,
        pixel: Option<[u32; 2]>,
        seed: u64,
    ) -> PyResult<Oracle> {
        Oracle::new(
            this.py(),
            this.get(),
            this.clone().unbind(),
            channel,
            pixel,
            seed,
        )
    }
}
