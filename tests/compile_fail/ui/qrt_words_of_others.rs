//! Words of other renderers are answered by those of a scene.

qrt::qrt! {
    pub scene Words {
        name: "words",
        camera: perspective { lookfrom: (0, 1, 5), target: (0, 0, 0), fov: 40 },
        film: 4 x 4,
        background { radiance: 1 },
        spp: 64,
        material grey: diffuse { albedo: 0.5 },
        box: grey { min: (-1, 0, -1), max: (1, 0, 1) },
        cube: grey { min: (-1, 0, -1), max: (1, 1, 1) },
        sampling { path_bits: 4, depths: 3, sequence: sobol, lights: nee },
    }
}

fn main() {}
