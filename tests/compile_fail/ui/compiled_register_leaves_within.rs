use qrt::prelude::*;

qrt! {
    pub scene Room<Fixed<2, 8>> {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        material lamp: emitter { radiance: rgb(1, 1, 1) },
        quad floor: white { (-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        sampling { path_bits: 4, lights: none }, depth primary { bits: (2, 2) }, depth secondary { bits: (2, 2) },
    }
}

fn main() {
    let (mut state, id) = State::path::<Room>(0, [4, 4], 3).unwrap();
    let kept = Room::within(&mut state, &id, |_, path| path);
    println!("{:?}", state.operand(kept.counts()[0]));
}
