//! Both macros, under another name of the crate.

use quantum::prelude::*;

quantum::qrt! {
    scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 2 x 2,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        material lamp: emitter { radiance: rgb(3, 2, 1) },
        quad floor: white { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        sampling { path_bits: 4, lights: none },
        depth primary { bits: (2, 2) },
        depth secondary { bits: (2, 2) },
    }
}

const LIGHT: u32 = Room::FACES.light;

/// good ^= the second ray meets the lamp.
#[quantum::reversible]
fn lit(face: &UInt<2>, good: &mut Bool) {
    good ^= face == LIGHT;
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let options = RenderOptions {
        model: Some(Model::Fixed),
        ..RenderOptions::default()
    };
    let picture = render_compiled::<Room>(&options)?;
    let counted = count_where::<Room>(&options, |m, path, good| lit(m, &path.ray1.face, good))?;
    let (low, high) = counted.interval();
    println!(
        "renamed: {} pixels, {low:.2} to {high:.2} of the paths on the lamp",
        picture.image.pixels.len()
    );
    Ok(())
}
