//! A scene in Rust: written with `qrt!`, compiled with the program, rendered by its own circuit.
//!
//! ```sh
//! cargo run --release --example scene
//! ```
//!
//! writes `scene.png` and prints the circuit's cost. The Rust compiler reports an error in the
//! scene at the wrong word: try `material: wite`, or a budget of 1,000 qubits.

use qrt::prelude::*;

qrt! {
    /// Three steps up to a lamp.
    pub scene Steps<Fixed<2, 14>> {
        const WIDTH: f64 = 4;
        const RISE: f64 = 0.5;

        camera: perspective { eye: (0, 3.2, 6.5), target: (0, 1, 0), vfov: 40 },
        film: 64 x 48,

        material stone: lambertian { albedo: (0.7, 0.65, 0.6) },
        material lamp: emitter { radiance: (9, 8, 6) },
        material wet: mirror { reflectance: (0.6, 0.7, 0.8) },

        quad pool: wet { (-WIDTH, 0, 5), (WIDTH, 0, 5), (WIDTH, 0, 2), (-WIDTH, 0, 2) },
        for i in 0..3 {
            quad riser: stone {
                (-WIDTH, i * RISE, 2 - i), (WIDTH, i * RISE, 2 - i),
                (WIDTH, (i + 1) * RISE, 2 - i), (-WIDTH, (i + 1) * RISE, 2 - i),
            },
            quad tread: stone {
                (-WIDTH, (i + 1) * RISE, 2 - i), (WIDTH, (i + 1) * RISE, 2 - i),
                (WIDTH, (i + 1) * RISE, 1 - i), (-WIDTH, (i + 1) * RISE, 1 - i),
            },
        }
        quad wall: stone { (-WIDTH, 0, -1), (WIDTH, 0, -1), (WIDTH, 5, -1), (-WIDTH, 5, -1) },
        quad light: lamp { (-1, 4, 0), (1, 4, 0), (1, 4, 2), (-1, 4, 2) },

        sampling { path_bits: 10, lights: none },
        depth primary { bits: (8, 8) },
        depth secondary { bits: (8, 8), map: cosine_hemisphere },
        depth tertiary { bits: (8, 8), map: cosine_hemisphere },
        comparator { bits: 10 },
        counting { phase_bits: 8 },
        budget { qubits: 100_000, toffoli: 200_000 },
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "{} qubits, {} Toffolis, {} operations from a path's index to its colours",
        Steps::QUBITS,
        Steps::TOFFOLI,
        Steps::OPERATIONS
    );

    // One path, and the values of its registers while it is computed.
    let pixel = [32, 30];
    let (mut state, id) = State::path::<Steps>(0, pixel, 5)?;
    Steps::within(&mut state, &id, |state, path| {
        let distance = Steps::LAYOUT.ray0.distance;
        let bits = state.bits(path.word(&distance).register);
        println!(
            "path 5 of pixel {pixel:?} meets something {} ahead; its colours exceed {:?} of {} thresholds",
            distance.value(bits, pixel),
            path.counts().map(|count| state.operand(count)),
            1 << Steps::COMPARATOR_BITS,
        );
    });
    state.clean()?;

    // All paths of all pixels, by the code compiled from the circuit.
    let options = RenderOptions {
        model: Some(Model::Fixed),
        ..RenderOptions::default()
    };
    let rendered = render_compiled::<Steps>(&options)?;
    rendered.save("scene.png")?;
    println!("scene.png: {} queries", rendered.total_queries());
    Ok(())
}
