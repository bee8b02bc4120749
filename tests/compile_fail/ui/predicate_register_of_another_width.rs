use qrt::prelude::*;

qrt! {
    scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 2 x 2,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        material lamp: emitter { radiance: rgb(3, 2, 1) },
        quad floor: white { (-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        sampling { path_bits: 2, lights: none },
        depth primary { bits: (2, 2) },
        depth secondary { bits: (2, 2) },
    }
}

#[reversible]
fn third(face: &UInt<3>, good: &mut Bool) {
    good ^= face == 3;
}

fn main() {
    let _ = count_where::<Room>(&RenderOptions::default(), |m, path, good| {
        third(m, &path.ray1.face, good);
    });
}
