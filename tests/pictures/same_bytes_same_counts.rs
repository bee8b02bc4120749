//! Tests that a scene without light sampling keeps the bytes of its picture and the gates of its circuit, from commit to
//! commit.
//!
//! A change here is one of the kind that the changelog lists. The failing test prints the new rows.

use crate::common::scene::from_file;
use qrt::core::inspect::Inspection;
use qrt::core::oracle::Oracles;
use qrt::runtime::path_machines::Real;
use qrt::scene::Lights;
use qrt::scene::valid::ValidScene;
use qrt::tracer::PixelClass;
use std::path::Path;

/// Scenes with `lights: none`: the checksum of a small picture by the model `real`, and the Toffolis of an oracle: that of
/// the most expensive channel, for pixels of the most general class.
const KNOWN: &[(&str, u64, u64)] = &[
    ("cornell-box", 0x1898_f5fd_eb47_01e9, 69_124),
    ("cornell-ggx", 0x47c9_c1e5_da6c_ac77, 276_880),
    ("cornell-glass", 0xc8d0_b0a0_2e18_1a68, 251_576),
    ("cornell-mirror", 0x0e98_1448_6a0a_0d6a, 115_528),
    ("floor-and-light", 0xd962_41c3_e924_742b, 7852),
    ("furnace", 0xf515_ccf0_7a9b_b3e5, 38_964),
    ("knot", 0x3836_c4ec_38b5_8590, 2_207_606),
    ("small/corner", 0x09d4_5962_3a74_f2a5, 3790),
    ("small/lit-wall", 0x2fc5_6bc7_25a1_7625, 94),
    ("small/mirror", 0xa5a8_ad36_db7f_8525, 94),
    ("velvet", 0x7c68_8b56_7fea_213e, 575_766),
];

/// The FNV-1a hash of the bits of all pixels.
fn checksum(pixels: &[[f64; 3]]) -> u64 {
    let bytes = pixels
        .iter()
        .flatten()
        .flat_map(|value| value.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

fn scene(name: &str, sets: &[&str]) -> ValidScene {
    from_file(&format!("scenes-yaml/{name}.yaml"), sets)
}

/// Returns the colours that the model `real` sums over 2^6 paths of 8 x 6 pixels.
fn picture(name: &str) -> Vec<[f64; 3]> {
    let few = ["film.width=8", "film.height=6", "sampling.path_bits=6"];
    let real = Real::new(&scene(name, &few), 1).unwrap();
    let pixels: Vec<[u32; 2]> = (0..48).map(|i| [i % 8, i / 8]).collect();
    real.sums(&pixels).iter().map(|sum| sum.colour).collect()
}

fn toffolis(scene: &ValidScene) -> u64 {
    let oracles = Oracles::new(scene);
    let inspection = Inspection::of_class(&oracles, None, PixelClass::default());
    inspection.unwrap().total().toffoli
}

#[test]
fn of_every_scene_without_light_sampling() {
    let mut names = Vec::new();
    for folder in ["", "small/"] {
        let whole = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("scenes-yaml")
            .join(folder);
        for entry in whole.read_dir().unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if let Some(name) = name.strip_suffix(".yaml") {
                names.push(format!("{folder}{name}"));
            }
        }
    }
    names.sort();
    let mut rows = Vec::new();
    for name in &names {
        let whole = scene(name, &[]);
        if whole.scene().sampling.lights == Lights::None {
            // The knot's own strategy, `scoped`, takes four times as long as all else here.
            let toffolis = match name.as_str() {
                "knot" => toffolis(&scene(name, &["circuit.uncompute=keep"])),
                _ => toffolis(&whole),
            };
            rows.push((name.as_str(), checksum(&picture(name)), toffolis));
        }
    }
    let line = |(name, sum, toffolis): &(&str, u64, u64)| {
        format!("    ({name:?}, {sum:#018x}, {toffolis}),\n")
    };
    let lines: String = rows.iter().map(line).collect();
    assert!(rows == KNOWN, "now:\n{lines}");
}
