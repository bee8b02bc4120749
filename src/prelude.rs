//! The names to import to write or load a scene, render it, count its paths and save the picture.

/// Registers with formats as types.
///
/// ```
/// use qrt::prelude::*;
///
/// // Widths, and what bits stand for.
/// assert_eq!((UInt::<8>::WIDTH, Bool::WIDTH), (8, 1));
/// assert_eq!(Int::<4>::value(0b1111), -1.0);
/// assert_eq!(Fixed::<2, 6>::bits(-0.5), Some(0b1110_0000));
/// assert_eq!(UFixed::<1, 7>::bits(1.0 / 3.0), None);
///
/// let mut recorder = Recorder::new(Style::InPlace);
/// let a: Reg<_, UInt<4>> = Reg::input(&mut recorder, "a");
/// let mut sum: Reg<_, UInt<5>> = Reg::input(&mut recorder, "sum");
/// recorder.add_into(sum.register_mut(), a.word().into(), false, When::Always);
/// assert_eq!(run::on_gates(&recorder.finish(), &[[9, 3]])?, [[9, 12]]);
/// # fn is_a_format<F: Format>() {}
/// # is_a_format::<Bool>();
/// # Ok::<(), run::RunError>(())
/// ```
pub use qrt_circuit::format::{Bool, Fixed, Format, Int, Reg, UFixed, UInt};
/// Reversible code and programs.
///
/// ```
/// use qrt::circuit::{Declaration, Type};
/// use qrt::prelude::*;
///
/// /// t += 5 where bit 0 of a is set, on any machine.
/// fn five_where<M: Machine>(m: &mut M, a: &M::Register, t: &mut M::Register) {
///     let odd = Bit::at(a, 0);
///     m.add_into(t, Operand::Constant(5), false, When::If(odd));
/// }
///
/// let mut recorder = Recorder::new(Style::InPlace);
/// let a = recorder.input(&Declaration::work("a", Type::UInt, 3));
/// let mut t = recorder.input(&Declaration::work("t", Type::UInt, 4));
/// five_where(&mut recorder, &a, &mut t);
/// // t ^= a
/// recorder.xor_into(&mut t, Word::unsigned(&a, 0, 3).into(), None);
/// let program: Program = recorder.finish();
/// assert_eq!(run::on_gates(&program, &[[3, 1]])?, [[3, 6 ^ 3]]);
/// assert_eq!(run::on_gates(&program.inverse(), &[[3, 6 ^ 3]])?, [[3, 1]]);
/// # Ok::<(), run::RunError>(())
/// ```
pub use qrt_circuit::{Bit, Machine, Operand, Program, Recorder, Style, When, Word};
/// The circuit of a scene of `qrt!`.
///
/// ```
/// use qrt::prelude::*;
///
#[doc = include_str!("glow.txt")]
/// fn operations<C: CompiledOracle>() -> usize {
///     C::program().ops.len()
/// }
/// assert_eq!(operations::<Glow>(), Glow::OPERATIONS);
/// ```
pub use qrt_core::oracle::compiled::CompiledOracle;
/// The paths of a scene of `qrt!`, as predicates read them.
///
/// ```
/// use qrt::prelude::*;
///
#[doc = include_str!("glow.txt")]
/// fn faces<S: PathScene>() -> usize {
///     S::scene().polygons().len()
/// }
/// assert_eq!(faces::<Glow>(), 1);
/// ```
pub use qrt_core::oracle::paths::PathScene;
/// A scene's circuit, compiled at run time, and the program of one pixel.
///
/// ```
/// use qrt::core::oracle;
/// use qrt::scene::Emitter;
/// use qrt::prelude::*;
///
/// let scene = Scene::builder("glow")
///     .film(2, 2)
///     .path_bits(2)
///     .depth(1)
///     .material("lamp", Emitter { radiance: [1.0, 0.5, 0.0], albedo: [0.0; 3].into() })
///     .quad("lamp", [[0., -9., 0.], [9., -9., 0.], [9., 9., 0.], [0., 9., 0.]])
///     .build();
/// let oracle = Oracle::rgb(&scene.validate("".as_ref())?, oracle::OracleOptions::default())?;
/// // The program of the upper left pixel under the seed 1.
/// let program: BoundProgram = oracle.program_at(1, [0, 0]);
/// assert_eq!((program.pixel(), program.paths()), ([0, 0], 4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_core::oracle::{BoundProgram, Oracle};
/// A predicate of a scene's paths, and the two oracles that it makes.
///
/// ```
/// use qrt::core::oracle::OracleOptions;
/// use qrt::prelude::*;
///
#[doc = include_str!("glow.txt")]
/// #[reversible]
/// fn meets(found: &Bool, good: &mut Bool) {
///     good ^= found;
/// }
///
/// let predicate = Predicate::record::<Glow>(|m, path, good| meets(m, &path.ray0.found, good))?;
/// let paths = predicate.oracle(Marks::Paths, OracleOptions::default())?;
/// let light = predicate.oracle(Marks::Light, OracleOptions::default())?;
/// assert_eq!((paths.channels.len(), light.channels.len()), (1, 3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_core::oracle::{Marks, Predicate};
/// A user-defined estimator.
///
/// ```
/// use qrt::prelude::*;
/// use qrt::counting::estimators::{CountingProblem, Device, Estimate, EstimatorError};
/// use qrt::counting::estimators::{Exact, Noise};
/// use qrt::counting::random::Stream;
///
/// /// Counts nothing, and says so by its interval.
/// struct Half;
///
/// impl AmplitudeEstimator for Half {
///     fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
///         Ok(device.estimate(device.usage(), 0.5, (0.0, 1.0), 1.0))
///     }
/// }
///
/// let mut stream = Stream::new(1, 0, 0, 0);
/// let mut device = Device::new(CountingProblem { good: 3, total: 8 }, Noise::NONE, &mut stream)?;
/// assert_eq!(Half.estimate(&mut device)?.queries, 0);
/// assert_eq!(Exact.estimate(&mut device)?.amplitude, 3.0 / 8.0);
/// # Ok::<(), EstimatorError>(())
/// ```
pub use qrt_counting::estimators::AmplitudeEstimator;
/// Runs one path step by step.
///
/// ```
/// use qrt::prelude::*;
///
#[doc = include_str!("glow.txt")]
/// // Path 3 of the right column: red exceeds all 2^10 comparators.
/// let (mut state, id) = State::path::<Glow>(0, [1, 0], 3)?;
/// let red = Glow::within(&mut state, &id, |state, path| state.operand(path.counts()[0]));
/// assert_eq!(red, 1024);
/// state.clean()?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_machines::State;
/// Runs programs on each machine: see [the module](run).
///
/// ```
/// use qrt::prelude::*;
///
/// /// a += b
/// #[reversible]
/// fn add(a: &mut UInt<3>, b: &UInt<3>) {
///     a += wrapping(b);
/// }
///
/// let program = add_program(Style::InPlace);
/// let states = [[3, 4], [7, 7]];
/// assert_eq!(run::on_definition(&program, &states)?, [[7, 4], [6, 7]]);
/// assert_eq!(run::on_gates(&program, &states)?, run::on_fixed(&program, &states)?);
/// # Ok::<(), run::RunError>(())
/// ```
pub use qrt_machines::run;
pub use qrt_macros::{qrt, reversible};
/// Writes pictures and counts to files and to any writer.
///
/// ```
/// use qrt::prelude::*;
/// use qrt::runtime::image::Count;
///
/// let mut image = Image { width: 2, height: 1, pixels: vec![[0.5; 3]; 2], window: None };
/// let mut about = Metadata::new();
/// about.set("author", "me")?;
///
/// let path = std::env::temp_dir().join(format!("qrt-prelude-{}.png", std::process::id()));
/// save(&path, &image, &about, Encoding::for_path(&path, Some(1.0))?)?;
/// let mut bytes = Vec::new();
/// write_to(&mut bytes, &image, &[], &about, Encoding::Png { exposure: 1.0 })?;
/// assert_eq!(std::fs::read(&path)?, bytes);
///
/// let count = Count { x: 0, y: 0, channel: 0, value: 0.5, good: Some(1), total: 2, scale: 1.0 };
/// let mut text = Vec::new();
/// write_counts_to(&mut text, [count])?;
/// write_counts(&path, [count])?;
/// assert_eq!(std::fs::read(&path)?, text);
/// # std::fs::remove_file(&path)?;
///
/// image.pixels.pop();
/// let refused: ImageError = save(&path, &image, &about, Encoding::Exr).unwrap_err();
/// assert_eq!(refused.to_string(), "a picture of 2 x 1 cannot be made of 1 pixels");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_runtime::image::{
    Encoding, Image, ImageError, Metadata, save, write_counts, write_counts_to, write_to,
};
/// Creates the state at the start of a path, on which the code of `qrt!` runs.
///
/// ```
/// use qrt::prelude::*;
///
/// qrt! {
///     scene Glow {
///         camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
///         film: 2 x 2,
///         material lamp: emitter { radiance: rgb(1, 0.5, 0) },
///         quad sky: lamp { (0, -9, 0), (9, -9, 0), (9, 9, 0), (0, 9, 0) },
///         sampling { path_bits: 2 },
///         depth primary { bits: (2, 2) },
///     }
/// }
///
/// let (state, index) = <State as PathState>::path::<Glow>(0, [1, 0], 3)?;
/// assert_eq!(state.bits(&index), 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_runtime::path_machines::PathState;
/// Runs the program of one pixel on each machine: the good comparators of each path, by channel.
///
/// ```
/// use qrt::core::oracle;
/// use qrt::prelude::*;
/// use qrt::scene::Emitter;
///
/// let scene = Scene::builder("glow")
///     .film(2, 2)
///     .path_bits(2)
///     .depth(1)
///     .material("lamp", Emitter { radiance: [1.0, 0.5, 0.0], albedo: [0.0; 3].into() })
///     .quad("lamp", [[0., -9., 0.], [9., -9., 0.], [9., 9., 0.], [0., 9., 0.]])
///     .build();
/// let oracle = Oracle::rgb(&scene.validate("".as_ref())?, oracle::OracleOptions::default())?;
/// // The lamp fills the right column and leaves the left one dark.
/// assert_eq!(run_paths::on_fixed(&oracle.program_at(1, [0, 0]), 0..4)?, [[0, 0, 0]; 4]);
/// assert_eq!(run_paths::on_gates(&oracle.program_at(1, [1, 0]), 0..4)?, [[1024, 1024, 0]; 4]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_runtime::path_machines::run_paths;
/// Predicates on the paths of a scene: counts and renders those that satisfy them.
///
/// ```
/// use qrt::prelude::*;
///
#[doc = include_str!("glow.txt")]
/// #[reversible]
/// fn meets(found: &Bool, good: &mut Bool) {
///     good ^= found;
/// }
///
/// // The right half of the film.
/// let exact = RenderOptions { estimator: Some(Estimator::Exact), ..RenderOptions::default() };
/// let counted = count_where::<Glow>(&exact, |m, path, good| meets(m, &path.ray0.found, good))?;
/// assert_eq!(counted.fraction(), 0.5);
/// let light = render_where::<Glow>(&exact, |m, path, good| meets(m, &path.ray0.found, good))?;
/// assert_eq!(light.image.pixels[1], [1.0, 0.5, 0.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_runtime::predicates::{count_where, render_where};
/// Renders a scene to a picture.
///
/// ```
/// use qrt::prelude::*;
///
/// qrt! {
///     scene Glow {
///         camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
///         film: 2 x 2,
///         material lamp: emitter { radiance: rgb(1, 0.5, 0) },
///         quad sky: lamp { (0, -9, 0), (9, -9, 0), (9, 9, 0), (0, 9, 0) },
///         sampling { path_bits: 2 },
///         depth primary { bits: (2, 2) },
///     }
/// }
///
/// let fixed = RenderOptions { model: Some(Model::Fixed), ..RenderOptions::default() };
/// let built: Rendered = render(Glow::scene(), &fixed)?;
/// assert_eq!(built.image, render_compiled::<Glow>(&RenderOptions::default())?.image);
///
/// // Compiled code runs on a circuit's models alone.
/// let real = RenderOptions { model: Some(Model::Real), ..RenderOptions::default() };
/// let refused: RenderError = render_compiled::<Glow>(&real).unwrap_err();
/// assert!(matches!(refused, RenderError::Compiled(CompiledError::Model)));
///
/// // By an estimator of one's own: here a known one, under another name.
/// use qrt::counting::estimators::estimator;
/// let own = OwnEstimator::new("mine", &|settings| estimator(Estimator::Sine, settings));
/// let counted = render(Glow::scene(), &RenderOptions { own_estimator: Some(own), ..fixed })?;
/// assert_eq!(counted.own_estimator.as_deref(), Some("mine"));
/// # Ok::<(), RenderError>(())
/// ```
pub use qrt_runtime::render::{
    CompiledError, Model, OwnEstimator, RenderError, RenderOptions, Rendered, render,
    render_compiled,
};
/// One path of a scene, in the scene's units.
///
/// ```
/// use qrt::prelude::*;
///
#[doc = include_str!("glow.txt")]
/// // The left half of the film is dark.
/// let path = trace_path::<Glow>(Model::Fixed, 0, [0, 0], 3)?;
/// assert!(path.rays[0].hit.is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_runtime::traced_path::trace_path;
/// The number of threads, and their progress.
///
/// ```
/// use qrt::prelude::*;
/// use std::sync::atomic::{AtomicU64, Ordering};
///
/// let paths = AtomicU64::new(0);
/// let told = |progress: Progress| {
///     if let Progress::Finished(more) = progress {
///         paths.fetch_add(more, Ordering::Relaxed);
///     }
/// };
/// let workers = Workers { threads: std::num::NonZeroUsize::new(1), progress: Some(&told), cancel: None };
/// let scene = Scene::builder("dark").film(3, 2).path_bits(4).build().validate("".as_ref())?;
/// render(&scene, &RenderOptions { workers, ..RenderOptions::default() })?;
/// assert_eq!(paths.into_inner(), 3 * 2 << 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use qrt_runtime::workers::{Progress, Workers};
/// Reads a scene from a file or a text, and reports all of its errors at once.
///
/// ```
/// use qrt::prelude::*;
///
/// let text = "
/// name: dark
/// camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
/// film: { width: 8, height: 8 }
/// materials: {}
/// geometry: []
/// ";
/// let loaded: Loaded = parse(text, "dark.yaml", &["film.width=4".into()], "".as_ref())?;
/// assert_eq!(loaded.valid.scene().film.width, 4);
///
/// let report = load("no-such-scene.yaml".as_ref(), &[]).unwrap_err();
/// assert!(report.to_string().contains("no-such-scene.yaml"));
/// # Ok::<(), qrt::syntax::Report>(())
/// ```
pub use qrt_scene::front::{Loaded, load, parse};
/// A checked scene, or all of its errors.
///
/// ```
/// use qrt::prelude::*;
///
/// fn faces(scene: Scene) -> Result<usize, InvalidScene> {
///     let valid: ValidScene = validate(scene, &Default::default())?;
///     Ok(valid.polygons().len())
/// }
/// let faulty = Scene::builder("flat").film(64, 0).build();
/// let problems = faces(faulty).unwrap_err();
/// assert_eq!(problems[0].path().unwrap().to_string(), "film.height");
/// ```
pub use qrt_scene::valid::{InvalidScene, ValidScene, validate};
/// A scene written in Rust.
///
/// ```
/// use qrt::scene::{Counting, Lambertian};
/// use qrt::prelude::*;
///
/// let builder: SceneBuilder = Scene::builder("floor")
///     .material("floor", Lambertian { albedo: [0.5; 3].into() })
///     .triangle("floor", [[-1., 0., 1.], [1., 0., 1.], [0., 0., -1.]])
///     .counting(Counting { estimator: Some(Estimator::Sine), ..Counting::default() });
/// let mut scene: Scene = builder.build();
/// scene.film.width = 32;
/// assert!(scene.to_yaml().contains("film: { width: 32, height: 64 }"));
/// ```
pub use qrt_scene::{Estimator, Scene, SceneBuilder};
/// All problems of a scene, each at its place in the text.
///
/// ```
/// use qrt::prelude::*;
///
/// let report: Report = parse("name: 7", "seven.yaml", &[], "".as_ref()).unwrap_err();
/// assert!(report.render(false).contains("--> seven.yaml:1:7"));
/// ```
pub use qrt_syntax::Report;
