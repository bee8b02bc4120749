//! `qrt diff`: the error of a picture against a reference.

mod read;

use super::failure::Failure;
use super::files::{Output, keep_apart};
use super::{memory, terminal};
use clap::Args;
use qrt_lab::compare::{
    ErrorMap, PIXELS_PER_DEGREE, PictureDifference, SizesDiffer, difference, flip_of_display,
    flip_of_radiance,
};
use qrt_runtime::image::{Encoding, Image, Metadata, save};
use qrt_runtime::memory::Memory;
use read::PlaceInFrame;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Compare two pictures: RMSE, relative MSE and FLIP
///
/// Two .exr files are compared as linear radiance, two .png files as a display shows them, linear light
/// from 0 to 1. They must have the same size. Any program may have written them.
///
/// A .png may have any bit depth; its chunks cICP, sRGB and gAMA say how its levels become light, and
/// without them it is sRGB. A .png with an ICC profile or with transparent pixels is refused, as is a .png
/// or .exr with primaries other than those of Rec. 709, and as are two .exr of different windows. The
/// colours of an .exr with an alpha channel are compared as in front of black, with a note.
///
/// RMSE is the root of the mean squared difference over pixels and channels; relative MSE the mean of
/// (PICTURE - REFERENCE)^2 / (REFERENCE^2 + 0.01); FLIP the mean of what someone notices who flips
/// between the two, from 0 to 1, and for radiance the most noticeable of all exposures (Andersson et
/// al., 2020 and 2021).
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt diff exact.exr counted.exr                  how much noise counting has left
  qrt diff mitsuba.exr qrt.exr -o error.png       where two renderers differ
  qrt diff before.png after.png --json")]
pub(crate) struct DiffArgs {
    /// The picture to be compared with: .png or .exr
    #[arg(value_name = "REFERENCE")]
    reference: PathBuf,
    /// The picture that is compared
    #[arg(value_name = "PICTURE")]
    picture: PathBuf,
    /// Write FLIP's error of every pixel, from black (0) by purple to yellow (1): .png
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Pixels within a degree of sight, for FLIP [default: 67, a display of 3,840 pixels and 0.7 m seen
    /// from 0.7 m]
    #[arg(long, value_name = "N", value_parser = pixels_per_degree)]
    pixels_per_degree: Option<f64>,
    /// JSON instead of text
    #[arg(long)]
    json: bool,
    /// The memory that the work may take, such as 500M or 4G: what would take more is refused before it
    /// begins [default: three quarters of what the machine has]
    #[arg(long, value_name = "SIZE", value_parser = memory::size)]
    max_memory: Option<u64>,
}

/// Parses pixels per degree; the bound of 1,000 keeps filters smaller than most pictures.
fn pixels_per_degree(text: &str) -> Result<f64, String> {
    let asked: Option<f64> = text.parse().ok();
    asked
        .filter(|asked| (1.0..=1000.0).contains(asked))
        .ok_or_else(|| "a number from 1 to 1000, such as 67".to_owned())
}

pub(crate) fn run(args: &DiffArgs) -> Result<(), Failure> {
    let output = args.output.as_deref().map(Output::new).transpose()?;
    if let Some(output) = &output {
        let asked = args.output.as_deref().unwrap_or(Path::new(""));
        if Encoding::for_path(asked, None)? == Encoding::Exr {
            let message = "a map of errors is shown in colours: end its name in `.png`";
            return Err(Failure::Usage(message.to_owned()));
        }
        keep_apart([&*args.reference, &*args.picture], &[output])?;
        output.try_writing()?;
    }
    let kinds = [&args.reference, &args.picture].map(|path| Encoding::for_path(path, None));
    let [of_reference, of_picture] = kinds;
    let radiance = of_reference? == Encoding::Exr;
    if (of_picture? == Encoding::Exr) != radiance {
        let message = "a .png holds what a display shows, a .exr radiance: compare two of a kind";
        return Err(Failure::Usage(message.to_owned()));
    }
    let read = if radiance { read::exr } else { read::png };
    let memory = Memory::new(args.max_memory);
    let [of_reference, of_picture] = [read(&args.reference, memory)?, read(&args.picture, memory)?];
    let (reference, picture) = (of_reference.image, of_picture.image);
    let refused = |error: SizesDiffer| Failure::Usage(error.to_string());
    let found = difference(&reference, &picture).map_err(refused)?;
    same_place(of_reference.place, of_picture.place)?;
    let flip = if radiance {
        flip_of_radiance
    } else {
        flip_of_display
    };
    let density = args.pixels_per_degree.unwrap_or(PIXELS_PER_DEGREE);
    let flip = flip(&reference, &picture, density).map_err(refused)?;
    if let Some(output) = &output {
        let mut metadata = Metadata::new();
        metadata.set("flip", flip.mean().to_string())?;
        let encoding = Encoding::Png { exposure: 0.0 };
        save(output.path()?, &flip.picture(), &metadata, encoding)?;
    }
    let told = if args.json {
        format!("{:#}\n", to_json(args, radiance, &found, &flip))
    } else {
        text(args, &reference, &found, &flip)
    };
    terminal::print(&told)
}

/// Refuses pictures that are cut out of different places, or of frames of different sizes.
fn same_place(one: Option<PlaceInFrame>, other: Option<PlaceInFrame>) -> Result<(), Failure> {
    let (Some(one), Some(other)) = (one, other) else {
        return Ok(());
    };
    if one == other {
        return Ok(());
    }
    let told = |place: PlaceInFrame| {
        let ([x, y], [width, height]) = (place.origin, place.frame);
        format!("at ({x}, {y}) of {width} x {height} pixels")
    };
    Err(Failure::Usage(format!(
        "the pictures are cut out of different frames (OpenEXR's `dataWindow` in `displayWindow`): one \
         lies {}, the other {}; write both with the same windows",
        told(one),
        told(other)
    )))
}

fn text(args: &DiffArgs, reference: &Image, found: &PictureDifference, flip: &ErrorMap) -> String {
    let mean = found.reference_mean.iter().sum::<f64>() / 3.0;
    let of_mean = match found.rmse / mean {
        share if share.is_finite() => {
            format!(", {} % of the reference's mean", short(100.0 * share))
        }
        _ => String::new(),
    };
    let rgb = |values: [f64; 3]| {
        let [r, g, b] = values.map(short);
        format!("red {r}, green {g}, blue {b}")
    };
    format!(
        "{} against {}: {} x {} pixels\n  \
         RMSE           {}{of_mean}\n                 \
         {}\n  \
         bias           {}\n  \
         relative MSE   {}\n  \
         FLIP           {}\n",
        args.picture.display(),
        args.reference.display(),
        reference.width,
        reference.height,
        short(found.rmse),
        rgb(found.rmse_rgb),
        rgb(found.bias_rgb),
        short(found.relative_mse),
        short(flip.mean()),
    )
}

/// Formats `value` with three significant digits.
fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e4).contains(&size) {
        let digits = 2 - libm::floor(libm::log10(size)) as i32;
        format!("{value:.0$}", digits.max(0) as usize)
    } else {
        format!("{value:.2e}")
    }
}

fn to_json(
    args: &DiffArgs,
    radiance: bool,
    found: &PictureDifference,
    flip: &ErrorMap,
) -> serde_json::Value {
    json!({
        "version": 1,
        "qrt": env!("CARGO_PKG_VERSION"),
        "reference": args.reference.display().to_string(),
        "picture": args.picture.display().to_string(),
        "of": if radiance { "radiance" } else { "display" },
        "pixels": [flip.width, flip.height],
        "rmse": found.rmse,
        "rmse_rgb": found.rmse_rgb,
        "relative_mse": found.relative_mse,
        "bias_rgb": found.bias_rgb,
        "reference_mean_rgb": found.reference_mean,
        "greatest": found.greatest,
        "flip": flip.mean(),
        "pixels_per_degree": args.pixels_per_degree.unwrap_or(PIXELS_PER_DEGREE),
    })
}
