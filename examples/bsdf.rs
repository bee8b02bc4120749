//! A user-defined BSDF: its map from the unit square to directions, and its value as a reversible
//! function.
//!
//! ```sh
//! cargo run --release --example bsdf
//! ```
//!
//! writes `bsdf.png`, prints the cost of the scene's circuit, and runs the function on its own. Try
//! what the compiler refuses: `slant_i += cos_i - 1`, which is below 0, or `out += 1`, with which
//! the cloth would reflect more light than it receives.

use qrt::prelude::*;

/// The format of the function's numbers.
type Number = UFixed<1, 14>;

/// Cloth: a dull ground, and a sheen where it is seen or lit from the side.
///
/// `0.0625 + 0.5 (1 - cos_i)^2 (1 - cos_o)^2`
#[reversible]
fn cloth(cos_i: &UFixed<1, 14>, cos_o: &UFixed<1, 14>, out: &mut UFixed<1, 14>) {
    let mut slant_i: UFixed<1, 14> = 0;
    let mut slant_o: UFixed<1, 14> = 0;
    let mut both: UFixed<1, 14> = 0;
    within! {
        slant_i += 1 - cos_i;
        slant_o += 1 - cos_o;
        both += wrapping(slant_i * slant_o);
    }
    apply! {
        out += 0.0625 + wrapping(both * both >> 1);
    }
}

qrt! {
    /// A sheet of cloth over two steps.
    pub scene Draped<Fixed<2, 14>> {
        camera: perspective { eye: (0, 2.4, 4.4), target: (0, 0.6, 0), vfov: 42 },
        film: 48 x 36,

        material velvet: bsdf {
            // Directions with uniform height: the sheen is low, and so are its paths.
            map: |u, v| (sqrt(1 - u^2) * cos(2 * pi * v), sqrt(1 - u^2) * sin(2 * pi * v), u),
            jacobian: auto,
            value: fn cloth,
        },
        material lamp: emitter { radiance: rgb(30, 24, 18) },

        for i in 0..2 {
            quad fall: velvet {
                (-2, i * 0.6, 1 - i), (2, i * 0.6, 1 - i),
                (2, (i + 1) * 0.6, 1 - i), (-2, (i + 1) * 0.6, 1 - i),
            },
            quad fold: velvet {
                (-2, (i + 1) * 0.6, 1 - i), (2, (i + 1) * 0.6, 1 - i),
                (2, (i + 1) * 0.6, -i), (-2, (i + 1) * 0.6, -i),
            },
        }
        quad floor: velvet { (-3, 0, 3), (3, 0, 3), (3, 0, 1), (-3, 0, 1) },
        quad light: lamp { (-2, 3, -1.5), (2, 3, -1.5), (2, 3, 0.5), (-2, 3, 0.5) },

        sampling { path_bits: 8 },
        depth primary { bits: (8, 8) },
        depth secondary { bits: (8, 8) },
        comparator { bits: 8 },
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "the scene: {} qubits, {} Toffolis, {} operations from a path's index to its colours",
        Draped::QUBITS,
        Draped::TOFFOLI,
        Draped::OPERATIONS
    );

    // Runs the function on its own: its own gates, on every machine.
    let program = cloth_program(Style::InPlace);
    let inputs = [(1.0, 1.0), (0.5, 0.5), (0.25, 0.125), (0.0, 0.0)];
    let states: Option<Vec<[u64; 3]>> = inputs
        .iter()
        .map(|(cos_i, cos_o)| Some([Number::bits(*cos_i)?, Number::bits(*cos_o)?, 0]))
        .collect();
    let states = states.ok_or("a number that its format does not have")?;
    let results = run::on_definition(&program, &states)?;
    assert_eq!(results, run::on_fixed(&program, &states)?);
    assert_eq!(results, run::on_gates(&program, &states)?);
    for ((cos_i, cos_o), result) in inputs.iter().zip(&results) {
        let value = Number::value(result[2]);
        println!("cloth({cos_i}, {cos_o}) = {value} by definition, operations and gates");
    }

    // In the scene, the compiler gives the function the scene's width.
    let options = Options {
        model: Model::Fixed,
        ..Options::default()
    };
    let rendered = render_compiled::<Draped>(&options)?;
    let file = std::path::Path::new("bsdf.png");
    let metadata = rendered.metadata()?;
    save(
        file,
        &rendered.image,
        &metadata,
        Encoding::for_path(file, None)?,
    )?;
    println!("bsdf.png: {} queries", rendered.total_queries());
    Ok(())
}
