//! Compares values with tables of an independent renderer.

use super::*;

/// Rows of a table of the independent renderer, without its head.
fn table(name: &str) -> Vec<Vec<String>> {
    let root = env!("CARGO_MANIFEST_DIR");
    let path = format!("{root}/../tests/references/{name}");
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().skip(1);
    rows.map(|row| row.split(',').map(str::to_owned).collect())
        .collect()
}

#[test]
fn values_are_those_of_an_independent_renderer() {
    let phong = Phong {
        diffuse: [0.3, 0.2, 0.1],
        specular: [0.5; 3],
        exponent: 20.0,
    };
    let bsdf = PhongLobe::new(&phong, |rgb| rgb, &Specimen::new(PHONG, "auto", 8).square());
    let cx = &mut Scalar::default();
    let rows = table("bsdf.csv");
    assert_eq!(rows.len(), 90);
    for row in rows {
        let [theta_i, theta_o, phi, red, green, blue]: [f64; 6] =
            std::array::from_fn(|k| row[k + 1].parse().unwrap());
        let (viewer, light) = (at(theta_i, 0.0), at(theta_o, phi));
        let value = match row[0].as_str() {
            "ggx" => [ggx::value(cx, 0.2, &viewer, &light, 0.2); 3],
            _ => bsdf.value(cx, cos_a(light, viewer)),
        };
        for (ours, theirs) in value.iter().zip([red, green, blue]) {
            // Theirs are 32-bit floats.
            let ours = ours * light[2];
            assert!(
                (ours - theirs).abs() < 2e-6 * theirs.max(0.1),
                "{row:?}: {ours}"
            );
        }
    }
}

#[test]
fn glass_reflects_as_fresnel_says_and_refracts_as_snell_says() {
    const BITS: u32 = 12;
    let specimen = Specimen::new("{ dielectric: { ior: 1.5 } }", "auto", BITS);
    let cells = 1_u32 << BITS;
    for row in table("fresnel.csv") {
        let [cos, reflectance]: [f64; 2] = std::array::from_fn(|k| row[k].parse().unwrap());
        // From outside (the front) where cos > 0, from inside where cos < 0.
        let sin = (1.0 - cos * cos).sqrt();
        let o = [sin * 0.6, sin * 0.8, cos];
        let eta: f64 = if cos > 0.0 { 1.0 / 1.5 } else { 1.5 };
        let mut reflected = 0;
        for u in 0..cells {
            let (i, weight) = specimen.scatter(o, [u, 0]);
            assert!((dot(i, i) - 1.0).abs() < 1e-12);
            // Both ways stay in the plane of incidence, on the other side of the normal.
            let across = (0.8 * i[0] - 0.6 * i[1]).abs();
            let along = -(0.6 * i[0] + 0.8 * i[1]);
            assert!(across < 1e-12);
            if i[2] * cos > 0.0 {
                reflected += 1;
                assert!((along - sin).abs() < 1e-12 && (i[2] - cos).abs() < 1e-12);
                assert_eq!(weight, [1.0; 3]);
            } else {
                assert!((along - eta * sin).abs() < 1e-12);
                assert!(weight.iter().all(|w| (w - eta * eta).abs() < 1e-12));
            }
        }
        let share = f64::from(reflected) / f64::from(cells);
        assert!(
            (share - reflectance).abs() < 1.0 / f64::from(cells) + 1e-6,
            "{cos}: {share} {reflectance}"
        );
    }
}
