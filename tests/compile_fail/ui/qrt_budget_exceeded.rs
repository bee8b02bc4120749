use qrt::prelude::*;

qrt! {
    pub scene Room<Fixed<2, 8>> {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 8 x 8,
        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },
        material lamp: emitter { radiance: rgb(1, 1, 1) },
        quad floor: white { (-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1) },
        quad light: lamp { (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1) },
        budget { qubits: 1_000_000, toffoli: 500 },
        sampling { path_bits: 4, lights: none }, depth primary { bits: (2, 2) }, depth secondary { bits: (2, 2) },
    }
}

fn main() {
    println!("{} Toffolis", Room::TOFFOLI);
}
