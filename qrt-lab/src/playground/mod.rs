//! The playground: scenes are checked, rendered and inspected while the user writes them.
//!
//! A page's scripts call a [`Playground`] with the name of a call, numbers and a text, and get an
//! [`Answer`]. In the book, the playground runs in the page, compiled to WebAssembly;
//! `qrt playground` runs it on the machine that serves the page. Both run the same code, and no
//! script repeats a computation.
//!
//! | call | numbers | text | answer |
//! |---|---|---|---|
//! | `examples` | | | the names of the examples, a line each |
//! | `example` | | the name of an example | its text |
//! | `check` | | a scene | its problems and warnings, and its properties |
//! | `open` | model (0 real, 1 fixed, 2 both), seed, part, parts | a scene | its properties |
//! | `trace` | first, count, bits | | the means of the first `2^bits` paths of these pixels |
//! | `beside` | first, count, bits | | the fixed model's means of the same paths, and their errors |
//! | `estimate` | first, count, phase bits | an estimator, or nothing | its estimates of these pixels |
//! | `cost` | | a scene | Toffolis, qubits, stages; the oracle as an SVG |
//! | `pixel` | column, row, seed, phase bits | a scene | its paths, its counts and their distribution |
//!
//! A playground has one picture, or every `parts`-th pixel of one, beginning with pixel `part`, so
//! that several playgrounds can share the work. Pixels are numbered by rows, from the top, within
//! the part. Lists of colours are linear radiance: red, green and blue of a pixel, then of the
//! next. If both models are open, the picture is the real one, and the call `beside` answers the
//! fixed one.
//!
//! A scene with an `accuracy` is shown with the parameters that it would have without it: planning
//! takes too long while the user is writing.

mod answer;
mod check;
mod cost;
mod picture;
mod pixel;
#[cfg(test)]
mod tests;

pub use answer::Answer;

use picture::Picture;
use qrt_core::oracle::{OracleError, Oracles};
use qrt_counting::CountingError;
use qrt_counting::estimators::EstimatorError;
use qrt_runtime::models::{MachineError, Model};
use qrt_runtime::render::RenderError;
use qrt_runtime::sample::SampleError;
use qrt_scene::front::{Files, Loaded, parse_with};
use qrt_scene::sampling::SamplingError;
use qrt_scene::valid::ValidScene;
use qrt_syntax::{Problem, Report};

/// The name of the scene's text in error messages.
const NAME: &str = "scene.yaml";
/// The largest number of triangles of a scene's meshes.
const MOST_FACES: usize = 20_000;
/// The largest number of pixels of a picture.
const MOST_PIXELS: u64 = 1 << 18;

/// A playground with the picture that is open.
pub struct Playground<'a> {
    examples: &'a [(&'a str, &'a str)],
    files: Files<'a>,
    picture: Option<Picture>,
    /// The picture of the fixed model, computed with the circuit's integers, if both models are
    /// open.
    beside: Option<Picture>,
}

/// An error of a call.
#[derive(Debug, thiserror::Error)]
enum Refused {
    #[error("there is no call `{0}`")]
    NoSuchCall(String),
    #[error("there is no example `{0}`")]
    NoSuchExample(String),
    #[error("`{0}` needs numbers that are not negative")]
    Numbers(&'static str),
    #[error("{0}")]
    Scene(Report),
    #[error("no picture is open")]
    NotOpen,
    #[error("the pixels are traced first")]
    NotTraced,
    #[error(
        "the playground shows pictures of at most {MOST_PIXELS} pixels: make `film` smaller, or use \
         `qrt render`"
    )]
    TooManyPixels,
    #[error("there is no estimator `{0}`")]
    NoSuchEstimator(String),
    #[error("the film has no pixel {0}, {1}")]
    Outside(u32, u32),
    #[error(transparent)]
    Sampling(#[from] SamplingError),
    #[error(transparent)]
    Sample(#[from] SampleError),
    #[error(transparent)]
    Counting(#[from] CountingError),
    #[error(transparent)]
    Estimator(#[from] EstimatorError),
    #[error(transparent)]
    Machine(#[from] MachineError),
    #[error("{0}")]
    Oracle(OracleError),
    #[error(transparent)]
    Render(#[from] RenderError),
}

impl From<OracleError> for Refused {
    fn from(error: OracleError) -> Self {
        Self::Oracle(error)
    }
}

impl<'a> Playground<'a> {
    /// Creates a playground. `examples` are scenes by name and text; `files` are the files that
    /// scenes may refer to: meshes and their material libraries.
    pub fn new(examples: &'a [(&'a str, &'a str)], files: Files<'a>) -> Self {
        Self {
            examples,
            files: files.most_faces(MOST_FACES),
            picture: None,
            beside: None,
        }
    }

    /// Answers a call. The answer to a failed call is the text `error`.
    pub fn call(&mut self, name: &str, numbers: &[f64], text: &str) -> Answer {
        let found = match name {
            "examples" => {
                let names: Vec<&str> = self.examples.iter().map(|(name, _)| *name).collect();
                Ok(Answer::default().lines("names", &names))
            }
            "example" => {
                let mut examples = self.examples.iter();
                let found = examples.find(|(name, _)| *name == text);
                let found = found.ok_or_else(|| Refused::NoSuchExample(text.to_owned()));
                found.map(|(_, scene)| Answer::default().text("text", *scene))
            }
            "check" => Ok(check::check(self.load(text))),
            "open" => self.open(numbers, text),
            "trace" => self.picture().and_then(|picture| {
                let [first, count, bits] = whole("trace", numbers)?;
                picture.trace(first as usize, count as usize, bits as u32)
            }),
            "beside" => self.beside(numbers),
            "estimate" => self.picture().and_then(|picture| {
                let [first, count, phase_bits] = whole("estimate", numbers)?;
                picture.estimate(text, phase_bits as u32, first as usize, count as usize)
            }),
            "cost" => self.scene(text).and_then(|scene| cost::cost(&scene)),
            "pixel" => self.scene(text).and_then(|scene| {
                let [x, y, seed, phase_bits] = whole("pixel", numbers)?;
                pixel::pixel(&scene, [x as u32, y as u32], seed, phase_bits as u32)
            }),
            _ => Err(Refused::NoSuchCall(name.to_owned())),
        };
        found.unwrap_or_else(|refused| Answer::default().text("error", refused.to_string()))
    }

    fn load(&self, text: &str) -> Result<Loaded, Report> {
        parse_with(text, NAME, &[], self.files)
    }

    /// Parses the scene, and drops its accuracy if it has one.
    fn scene(&self, text: &str) -> Result<ValidScene, Refused> {
        let loaded = self.load(text).map_err(Refused::Scene)?;
        let scene = &loaded.valid;
        if scene.scene().accuracy.is_none() {
            return Ok(loaded.valid);
        }
        let wrong = |problems: Vec<Problem>| Refused::Scene(loaded.report(problems));
        scene.with_parameters(scene.parameters()).map_err(wrong)
    }

    fn open(&mut self, numbers: &[f64], text: &str) -> Result<Answer, Refused> {
        let [model, seed, part, parts] = whole("open", numbers)?;
        self.picture = None;
        self.beside = None;
        let scene = self.scene(text)?;
        let film = scene.scene().film;
        if u64::from(film.width) * u64::from(film.height) > MOST_PIXELS {
            return Err(Refused::TooManyPixels);
        }
        let oracles = Oracles::new(&scene);
        let of = |model| Picture::new(&oracles, model, seed, (part, parts.max(1)));
        if model == 2 {
            self.beside = Some(of(Model::Fixed)?);
        }
        let picture = of(if model == 1 {
            Model::Fixed
        } else {
            Model::Real
        })?;
        Ok(self.picture.insert(picture).description())
    }

    fn beside(&mut self, numbers: &[f64]) -> Result<Answer, Refused> {
        let [first, count, bits] = whole("beside", numbers)?;
        let real = self.picture.as_ref().ok_or(Refused::NotOpen)?;
        let fixed = self.beside.as_mut().ok_or(Refused::NotOpen)?;
        let traced = fixed.trace(first as usize, count as usize, bits as u32)?;
        fixed.against(real, traced)
    }

    fn picture(&mut self) -> Result<&mut Picture, Refused> {
        self.picture.as_mut().ok_or(Refused::NotOpen)
    }
}

/// Converts `numbers` to `N` whole numbers, which must not be negative.
fn whole<const N: usize>(call: &'static str, numbers: &[f64]) -> Result<[u64; N], Refused> {
    let numbers: &[f64; N] = numbers.try_into().map_err(|_| Refused::Numbers(call))?;
    if numbers.iter().all(|number| (0.0..9e15).contains(number)) {
        Ok(numbers.map(|number| number as u64))
    } else {
        Err(Refused::Numbers(call))
    }
}
