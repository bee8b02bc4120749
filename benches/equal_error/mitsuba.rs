//! Runs Mitsuba 3 through `benches/peers/path_tracing.py`.

use super::curve::{Curve, Point};
use qrt_lab::mitsuba;
use qrt_scene::front;
use qrt_scene::valid::ValidScene;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Pictures of the reference data, with the scenes whose exports Mitsuba renders to compare with them.
const REFERENCES: [(&str, &str); 2] = [
    ("cornell_D3_16", "cornell"),
    ("torusknot8k_D3_16", "torusknot8k"),
];
const REFERENCE: [&str; 3] = [
    "sampling.depths=[{bits: [8, 8]}, {bits: [8, 8]}, {bits: [8, 8]}]",
    "film.width=16",
    "film.height=16",
];

/// The measurements of Mitsuba.
pub(crate) struct Mitsuba {
    pub(crate) version: String,
    pub(crate) variant: String,
    pub(crate) truth: Truth,
    /// The truth's standard error, as a fraction of its mean.
    pub(crate) truth_error: f64,
    /// Curves by sampler.
    pub(crate) curves: Vec<Curve>,
}

/// The reference picture.
pub(crate) struct Truth {
    /// Pixels from the top left, row by row.
    picture: Vec<[f64; 3]>,
    /// Indices of the pixels that count.
    judged: Vec<usize>,
    /// Mean square of its own error.
    variance: f64,
}

impl Truth {
    /// Returns the mean over the pixels that count.
    pub(crate) fn mean(&self) -> f64 {
        self.average(|pixel, channel| self.picture[pixel][channel])
    }

    /// Returns the mean square of a picture's differences, less the variance of the truth itself.
    pub(crate) fn squared_error(&self, picture: &[[f64; 3]]) -> f64 {
        let square = |pixel: usize, channel: usize| {
            let difference = picture[pixel][channel] - self.picture[pixel][channel];
            difference * difference
        };
        self.average(square) - self.variance
    }

    fn average(&self, value: impl Fn(usize, usize) -> f64) -> f64 {
        let pixels = self.judged.iter();
        let sum: f64 = pixels
            .flat_map(|&p| (0..3).map(move |c| (p, c)))
            .map(|(p, c)| value(p, c))
            .sum();
        sum / (3 * self.judged.len()) as f64
    }
}

/// Compares Mitsuba's pictures of reference scenes with the data; distances in standard errors.
pub(crate) fn references() -> Result<Vec<(&'static str, f64)>, String> {
    let compare = |(name, scene): (&'static str, &str)| {
        let folder = root().join("tests/references");
        let sets = REFERENCE.map(str::to_owned);
        let file = exported(&folder.join(format!("{scene}.yaml")), &sets)?;
        let found = run(&["--reference".as_ref(), &folder.join(name), &file])?;
        let errors = number(&found, "standard_errors")?;
        Ok((name, errors))
    };
    REFERENCES.into_iter().map(compare).collect()
}

/// Measures Mitsuba on a scene of `scenes-yaml`.
pub(crate) fn measure(name: &str, errors: &[(f64, f64)], seeds: u64) -> Result<Mitsuba, String> {
    let scene = exported(&root().join(format!("scenes-yaml/{name}.yaml")), &[])?;
    let cache = target().join("equal_error");
    let errors: Vec<String> = errors.iter().map(|(error, _)| error.to_string()).collect();
    let found = run(&[
        "--cache".as_ref(),
        &cache,
        "--errors".as_ref(),
        errors.join(",").as_ref(),
        "--seeds".as_ref(),
        seeds.to_string().as_ref(),
        &scene,
    ])?;
    let text = |key: &str| {
        let text = found[key].as_str().ok_or(format!("no {key}"))?;
        Ok::<_, String>(text.to_owned())
    };
    let array = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let numbers =
        |value: &Value| -> Vec<f64> { array(value).iter().filter_map(Value::as_f64).collect() };
    let picture = numbers(&found["truth"]).as_chunks().0.to_vec();
    let judged = array(&found["judged"]);
    let mut truth = Truth {
        picture,
        judged: judged
            .iter()
            .filter_map(Value::as_u64)
            .map(|p| p as usize)
            .collect(),
        variance: 0.0,
    };
    let truth_error = number(&found, "truth_error")?;
    truth.variance = (truth_error * truth.mean()).powi(2);
    let curves = found["curves"].as_object().ok_or("no curves")?;
    let curves = curves.iter().map(|(name, points)| {
        let points = array(points);
        let points = points.iter().map(|point| match numbers(point)[..] {
            [samples, error, seconds] => Ok(Point {
                samples: samples as u64,
                error,
                seconds,
            }),
            _ => Err(format!("a point of {name} is not three numbers")),
        });
        Ok::<_, String>(Curve {
            name: name.clone(),
            points: points.collect::<Result<_, _>>()?,
        })
    });
    Ok(Mitsuba {
        version: text("mitsuba")?,
        variant: text("variant")?,
        truth,
        truth_error,
        curves: curves.collect::<Result<_, _>>()?,
    })
}

/// Paths a second of the processor that each of Mitsuba's variants traces, by name.
pub(crate) fn speeds(scene: &ValidScene, samples: u64) -> Result<Vec<(String, f64)>, String> {
    let scene = written(scene, "speed")?;
    let found = run(&["--speed".as_ref(), samples.to_string().as_ref(), &scene])?;
    let speeds = found.as_object().ok_or("no speeds")?;
    let speeds = speeds.iter();
    let speed =
        |(name, speed): (&String, &Value)| speed.as_f64().map(|speed| (name.clone(), speed));
    Ok(speeds.filter_map(speed).collect())
}

/// Writes a scene for Mitsuba, and returns the file.
fn exported(scene: &Path, sets: &[String]) -> Result<PathBuf, String> {
    let loaded = front::load(scene, sets).map_err(|report| report.to_string())?;
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    written(&loaded.valid, &stem)
}

fn written(scene: &ValidScene, stem: &str) -> Result<PathBuf, String> {
    let exported = mitsuba::export(scene, stem).map_err(|error| error.to_string())?;
    // Each scene has its own folder, as one scene may be exported in two ways.
    let folder = target().join(format!("mitsuba-{}", scene.fingerprint()));
    let written = || {
        fs::create_dir_all(&folder)?;
        for mesh in &exported.meshes {
            fs::write(folder.join(&mesh.file), &mesh.bytes)?;
        }
        let file = folder.join(format!("{stem}.xml"));
        fs::write(&file, exported.text).map(|()| file)
    };
    written().map_err(|error| format!("{}: {error}", folder.display()))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn target() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
}

fn number(found: &Value, key: &str) -> Result<f64, String> {
    found[key].as_f64().ok_or(format!("no {key}"))
}

/// Runs the script and returns its output; if it fails, the last line of its errors.
fn run(arguments: &[&Path]) -> Result<Value, String> {
    let output = Command::new("python3")
        .arg(root().join("benches/peers/path_tracing.py"))
        .arg("--venv")
        .arg(target().join("mitsuba"))
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .map_err(|error| format!("no python3: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("it failed");
        return Err(last.to_owned());
    }
    serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())
}
