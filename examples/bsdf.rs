//! A user-defined BSDF: its map from the unit square to directions, and its value.
//!
//! ```sh
//! cargo run --release --example bsdf
//! ```
//!
//! writes `bsdf.png` and prints the cost of the scene's circuit. Try what the compiler refuses:
//! `value: 1`, with which the cloth would reflect more light than it receives.

use qrt::prelude::*;

qrt! {
    /// A sheet of cloth over two steps.
    pub scene Draped<Fixed<2, 14>> {
        camera: perspective { eye: (0, 2.4, 4.4), target: (0, 0.6, 0), vfov: 42 },
        film: 48 x 36,

        material velvet: bsdf {
            // Directions with uniform height: the sheen is low, and so are its paths.
            map: |u, v| (sqrt(1 - u^2) * cos(2 * pi * v), sqrt(1 - u^2) * sin(2 * pi * v), u),
            jacobian: auto,
            // A dull ground, and a sheen where it is seen or lit from the side.
            value: 0.0625 + 0.5 * (1 - cos_i)^2 * (1 - cos_o)^2,
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

        sampling { path_bits: 8, lights: none },
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

    let options = RenderOptions {
        model: Some(Model::Fixed),
        ..RenderOptions::default()
    };
    let rendered = render_compiled::<Draped>(&options)?;
    rendered.save("bsdf.png")?;
    println!("bsdf.png: {} queries", rendered.total_queries());
    Ok(())
}
