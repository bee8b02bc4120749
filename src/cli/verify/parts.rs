//! Puts the answers of all portions of a check together.

use super::super::failure::Failure;
use super::Found;
use qrt_core::oracle::{CallCost, OracleCost, OracleName, Oracles};
use qrt_lab::verify::{Mismatch, VerifyOptions, VerifyReport, pixels};
use qrt_runtime::disk::read_regular;
use qrt_runtime::render::Portion;
use qrt_scene::valid::ValidScene;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Most missing portions that an error names.
const NAMED: usize = 16;

/// Returns the joint result of the portions in `files`, of this scene, these pixels and this seed.
///
/// # Errors
/// A file that can't be read, is not an answer or belongs to another check; a portion that is missing or
/// there twice.
pub(super) fn put_together(
    files: &[PathBuf],
    scene: &ValidScene,
    options: &VerifyOptions<'_>,
) -> Result<Found, Failure> {
    let mut parts: BTreeMap<u32, (&Path, Found)> = BTreeMap::new();
    let mut first: Option<(&Path, Portion)> = None;
    for file in files {
        let bytes = read_regular(file).map_err(|error| Failure::file(file, &error))?;
        let (portion, found) = part(file, &bytes, scene, options)?;
        let shown = file.display();
        let (other, expected) = *first.get_or_insert((file, portion));
        if expected.count() != portion.count() {
            return Err(Failure::Usage(format!(
                "`{shown}` is portion {portion}, and `{}` is portion {expected}",
                other.display()
            )));
        }
        if let Some((other, _)) = parts.insert(portion.index(), (file, found)) {
            return Err(Failure::Usage(format!(
                "`{shown}` and `{}` are both portion {portion}: leave one of them out",
                other.display()
            )));
        }
    }
    let count = first.map_or(1, |(_, portion)| portion.count());
    let missing = count as usize - parts.len();
    if missing > 0 {
        let names = (0..count).filter(|index| !parts.contains_key(index));
        let names: Vec<String> = names.take(NAMED).map(|k| format!("{k}/{count}")).collect();
        let (names, more) = (names.join(", "), if missing > NAMED { ", ..." } else { "" });
        let are = if missing == 1 { "is" } else { "are" };
        let message = format!("{missing} of {count} portions {are} missing: {names}{more}");
        return Err(Failure::Usage(message));
    }
    let mut defect = None;
    let mut seconds = 0.0;
    let reports = parts.into_values().map(|(_, found)| {
        defect = defect.take().or(found.defect);
        seconds += found.seconds;
        found.report
    });
    let report = VerifyReport::pooled(reports);
    Ok(Found {
        report,
        defect,
        seconds,
    })
}

/// Returns the portion of a file, and its result.
fn part(
    file: &Path,
    bytes: &[u8],
    scene: &ValidScene,
    options: &VerifyOptions<'_>,
) -> Result<(Portion, Found), Failure> {
    let none = || {
        let words =
            "is no answer of `qrt verify --portion K/N --json`, or of another version of qrt";
        Failure::Usage(format!("`{}` {words}", file.display()))
    };
    let answer: Value = serde_json::from_slice(bytes).map_err(|_| none())?;
    if answer["version"] != 1 || answer["qrt"] != env!("CARGO_PKG_VERSION") {
        return Err(none());
    }
    let [index, count] = pixel(&answer["portion"]).ok_or_else(none)?;
    let portion = Portion::new(index, count).map_err(|_| none())?;
    let found = found(&answer, scene).ok_or_else(none)?;
    let differs = |what: &str| {
        let file = file.display();
        Failure::Usage(format!("`{file}` is of another {what} than is asked for"))
    };
    if answer["scene_hash"] != scene.fingerprint().to_string() {
        return Err(differs("scene"));
    }
    if answer["seed"] != options.seed {
        return Err(differs("seed"));
    }
    let mut asked = pixels(
        scene,
        &VerifyOptions {
            portion,
            ..*options
        },
    )?;
    // The check visits the pixels by class, so both lists are sorted before they are compared.
    let mut there = found.report.pixels.clone();
    asked.sort_unstable();
    there.sort_unstable();
    if asked != there {
        return Err(differs("number of --pixels"));
    }
    Ok((portion, found))
}

/// Parses an answer; `None` if it lacks something.
fn found(answer: &Value, scene: &ValidScene) -> Option<Found> {
    let pixels = answer["pixels"].as_array()?.iter().map(pixel);
    let mismatches = answer["mismatches"].as_array()?.iter().map(mismatch);
    let measured = answer["defect"].is_null();
    let of = |value: &Value| {
        if measured {
            floats(value)
        } else {
            Some([0.0; 3])
        }
    };
    let names = Oracles::new(scene).names();
    let errors = &answer["width_error"];
    let report = VerifyReport {
        pixels: pixels.collect::<Option<_>>()?,
        paths: answer["paths"].as_u64()?,
        oracles: (answer["oracles"].as_array()?.iter())
            .map(|oracle| oracle_cost(oracle, &names))
            .collect::<Option<_>>()?,
        qubits: answer["qubits"].as_u64()?.try_into().ok()?,
        gates: answer["gates"].as_u64()?.try_into().ok()?,
        fraction: answer["fraction_bits"].as_u64()?.try_into().ok()?,
        mismatched: answer["mismatched"].as_u64()?,
        mismatches: mismatches.collect::<Option<_>>()?,
        defect: None,
        defect_model: None,
        mean: of(&answer["mean_rgb"])?,
        width_error: of(&errors["rmse_rgb"])?,
        greatest: of(&errors["greatest_rgb"])?,
        parted: if measured {
            answer["parted"].as_f64()?
        } else {
            0.0
        },
    };
    Some(Found {
        report,
        defect: (!measured).then(|| answer["defect"].clone()),
        seconds: answer["seconds"].as_f64()?,
    })
}

/// Parses one of the scene's oracles `names` and its cost.
fn oracle_cost(value: &Value, names: &[OracleName]) -> Option<OracleCost> {
    let mut names = names.iter();
    let name = names.find(|name| {
        value["channel"] == name.channel_name() && value["class"] == name.class_name()
    })?;
    let call = CallCost {
        qubits: value["qubits"].as_u64()?,
        toffoli: value["toffoli"].as_u64()?,
    };
    Some(OracleCost { name: *name, call })
}

fn mismatch(value: &Value) -> Option<Mismatch> {
    let pair = |name: &str| {
        let [colour, count] = [&value["colour"][name], &value["count"][name]];
        Some([colour.as_i64()?, count.as_i64()?])
    };
    Some(Mismatch {
        pixel: pixel(&value["pixel"])?,
        id: value["id"].as_u64()?,
        channel: (value["channel"].as_u64()?.try_into().ok()).filter(|channel| *channel < 3)?,
        fixed: pair("fixed")?,
        gates: pair("gates")?,
        thresholds: value["count"]["thresholds"].as_i64()?,
    })
}

pub(super) fn pixel(value: &Value) -> Option<[u32; 2]> {
    let words = value.as_array()?.iter();
    let words = words.map(|word| word.as_u64()?.try_into().ok());
    words.collect::<Option<Vec<u32>>>()?.try_into().ok()
}

fn floats(value: &Value) -> Option<[f64; 3]> {
    let floats = value.as_array()?.iter().map(Value::as_f64);
    floats.collect::<Option<Vec<f64>>>()?.try_into().ok()
}
