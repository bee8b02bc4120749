//! A picture in a crate that asks for no kind of pictures: the compiler refuses its path.

use quantum::prelude::*;

quantum::qrt! {
    scene Glow {
        camera: orthographic { eye: (0, 0, 2), target: (0, 0, 0), height: 1 },
        film: 2 x 2,
        material lamp: emitter { radiance: rgb(1, 0.5, 0) },
        quad sky: lamp { (-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0) },
        sampling { path_bits: 2 },
        depth primary { bits: (2, 2) },
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    render_compiled::<Glow>(&RenderOptions::default())?.save("glow.png")?;
    Ok(())
}
