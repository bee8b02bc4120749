//! Predicates on a scene's paths: written as reversible functions, counted by quantum counting.
//!
//! ```sh
//! cargo run --release --example predicates
//! ```
//!
//! writes `mirror.png`, the light that arrives by the mirror alone, and prints how many paths see
//! the red wall in it. A face or a material that the scene lacks is an error of the compiler, and
//! so is a register of another width: try `MATERIALS.rde`, `path.ray9`, or `UInt<5>`.

use qrt::prelude::*;

qrt! {
    /// A corner: a red wall, a mirror, a floor and a lamp.
    pub scene Corner<Fixed<2, 12>> {
        camera: perspective { eye: (1.6, 1.1, 2.4), target: (0.2, 0.8, 0), vfov: 55 },
        film: 48 x 32,

        material red: lambertian { albedo: (0.8, 0.15, 0.1) },
        material grey: lambertian { albedo: (0.7, 0.7, 0.7) },
        material silver: mirror { reflectance: (0.9, 0.9, 0.9) },
        material lamp: emitter { radiance: (8, 8, 7) },

        quad floor: grey { (-1, 0, 2), (2, 0, 2), (2, 0, -1), (-1, 0, -1) },
        quad wall: red { (-1, 0, 2), (-1, 0, -1), (-1, 2, -1), (-1, 2, 2) },
        quad glass: silver { (-0.8, 0.2, -1), (1.8, 0.2, -1), (1.8, 1.8, -1), (-0.8, 1.8, -1) },
        quad light: lamp { (0, 2, 0), (1, 2, 0), (1, 2, 1), (0, 2, 1) },

        sampling { path_bits: 8, lights: none },
        depth primary { bits: (8, 8) },
        depth secondary { bits: (8, 8) },
        depth tertiary { bits: (8, 8) },
        comparator { bits: 8 },
        counting { phase_bits: 10 },
    }
}

const SILVER: u32 = Corner::MATERIALS.silver;
const RED: u32 = Corner::MATERIALS.red;

/// Flips `good` if a ray meets the mirror, and the next one the red wall.
#[reversible]
fn sees_red(first: &UInt<3>, second: &UInt<3>, good: &mut Bool) {
    good ^= first == SILVER && second == RED;
}

/// Flips `good` if a ray meets the mirror.
#[reversible]
fn is_mirrored(material: &UInt<3>, good: &mut Bool) {
    good ^= material == SILVER;
}

/// Flips `good` if the first two rays together are at most four units long, and both meet a face.
#[reversible]
fn near(first: &UFixed<4, 11>, second: &UFixed<4, 11>, on: &Bool, good: &mut Bool) {
    let mut way: UFixed<5, 11> = 0;
    within! {
        way += first;
        way += second;
    }
    apply! { good ^= on & (way <= 4); }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // One pixel, at the edge of the wall's reflection in the mirror: how many of its paths go on to
    // the red wall?
    let pixel = [28, 12];
    let [x, y] = pixel;
    let one = RenderOptions {
        model: Some(Model::Gates),
        crop: Some([x, y, 1, 1]),
        ..RenderOptions::default()
    };
    let counted = count_where::<Corner>(&one, |m, path, good| {
        sees_red(m, &path.ray0.material, &path.ray1.material, good);
    })?;
    let (low, high) = counted.interval();
    println!(
        "pixel {pixel:?}: {:.3} of its paths see the red wall in the mirror ({low:.3} to {high:.3}, \
         {} queries)",
        counted.fraction(),
        counted.queries(),
    );
    if let Some(cost) = counted.cost {
        println!(
            "a query has {} Toffolis on {} qubits",
            cost.toffoli, cost.qubits
        );
    }

    // One of these paths, in the scene's units.
    for ray in trace_path::<Corner>(Model::Fixed, one.seed, pixel, 5)?.rays {
        match ray.hit {
            Some(hit) => println!("  {:.2} units to `{}`", hit.distance, hit.name),
            None => println!("  into the void"),
        }
    }

    // The same for the whole film, in floating point and by counting.
    let film = RenderOptions {
        model: Some(Model::Real),
        ..RenderOptions::default()
    };
    let counted = count_where::<Corner>(&film, |m, path, good| {
        near(
            m,
            &path.ray0.distance,
            &path.ray1.distance,
            &path.ray1.found,
            good,
        );
    })?;
    println!(
        "{:.3} of all paths meet two faces within four units",
        counted.fraction()
    );

    // A picture of the light that arrives by the mirror.
    let rendered = render_where::<Corner>(&film, |m, path, good| {
        is_mirrored(m, &path.ray0.material, good);
    })?;
    rendered.save("mirror.png")?;
    println!("mirror.png: {} queries", rendered.total_queries());
    Ok(())
}
