//! Writes the scene on the cover of Peter Shirley's "Ray Tracing in One Weekend": some 480 spheres, a
//! lens and a sky.
//!
//! ```text
//! cargo run --example weekend > scenes-yaml/weekend.yaml
//! ```
//!
//! The ground is a quad in place of a sphere of radius 1000, beside which small spheres would have few
//! bits. Metal is smooth.

use qrt::scene::{
    Counting, DepthSampling, Dielectric, Estimator, Lambertian, Lens, Mirror, Perspective,
    Sampling, Scene, Sky,
};

/// Random numbers in 0..1, the same on every run (Knuth's MMIX).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        // Two digits keep the file short.
        ((self.0 >> 33) as f64 / (1_u64 << 31) as f64 * 100.0).floor() / 100.0
    }
}

fn main() {
    print!("{}", text());
}

/// Returns the text of the scene's file.
pub(crate) fn text() -> String {
    let ground = [
        [-30., 0., 30.],
        [30., 0., 30.],
        [30., 0., -30.],
        [-30., 0., -30.],
    ];
    let mut scene = Scene::builder("weekend")
        .camera(Perspective {
            eye: [13.0, 2.0, 3.0].into(),
            target: [0.0, 0.0, 0.0].into(),
            vfov: 20.0,
            lens: Some(Lens {
                aperture: 0.1,
                focus: 10.0,
            }),
            ..Perspective::default()
        })
        .film(400, 225)
        .sky(Sky {
            radiance: None,
            horizon: Some([0.75, 0.85, 1.0]),
            zenith: Some([0.5, 0.7, 1.0]),
            up: [0.0, 1.0, 0.0].into(),
        })
        .material(
            "ground",
            Lambertian {
                albedo: [0.5; 3].into(),
            },
        )
        .material("glass", Dielectric::clear(1.5))
        .quad("ground", ground);
    let mut random = Random(1);
    for place in 0..22 * 22 {
        let (a, b) = (f64::from(place / 22 - 11), f64::from(place % 22 - 11));
        let kind = random.next();
        let round = |c: f64| (c * 100.0).round() / 100.0;
        let center = [
            round(a + 0.9 * random.next()),
            0.2,
            round(b + 0.9 * random.next()),
        ];
        if (center[0] - 4.0).hypot(center[2]) <= 0.9 {
            continue;
        }
        let name = format!("m{place}");
        let mut colour = || [random.next(), random.next(), random.next()];
        if kind < 0.8 {
            let (first, second) = (colour(), colour());
            let albedo = [0, 1, 2].map(|c| round(first[c] * second[c]));
            let albedo = albedo.into();
            scene = scene.material(&name, Lambertian { albedo });
        } else if kind < 0.95 {
            let reflectance = colour().map(|c| round(0.5 + 0.5 * c)).into();
            scene = scene.material(&name, Mirror { reflectance });
        } else {
            scene = scene.sphere("glass", center, 0.2);
            continue;
        }
        scene = scene.sphere(&name, center, 0.2);
    }
    let brown = Lambertian {
        albedo: [0.4, 0.2, 0.1].into(),
    };
    let bronze = Mirror {
        reflectance: [0.7, 0.6, 0.5].into(),
    };
    let scene = scene
        .material("brown", brown)
        .material("bronze", bronze)
        .sphere("glass", [0.0, 1.0, 0.0], 1.0)
        .sphere("brown", [-4.0, 1.0, 0.0], 1.0)
        .sphere("bronze", [4.0, 1.0, 0.0], 1.0)
        .sampling(Sampling {
            path_bits: 10,
            depths: vec![DepthSampling::of_bits([8, 8]); 4],
            ..Sampling::default()
        })
        .counting(Counting {
            estimator: Some(Estimator::AdaptiveBayes),
            ..Counting::default()
        })
        .build();
    format!(
        "# The cover of \"Ray Tracing in One Weekend\": spheres, a sky, and a lens.\n\
         # This file is written by `cargo run --example weekend`.\n\
         {scene}"
    )
}
