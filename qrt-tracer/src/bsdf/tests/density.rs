//! Compares densities with quadrature, and with the Jacobians of their maps.

use super::*;

/// The integral over the sphere, by the midpoint rule over heights and azimuths.
fn over_sphere(density: impl Fn(Direction) -> f64) -> f64 {
    const N: usize = 1200;
    let mut sum = 0.0;
    for a in 0..N {
        let cos = (2.0 * a as f64 + 1.0) / N as f64 - 1.0;
        let sin = (1.0 - cos * cos).sqrt();
        for b in 0..N / 2 {
            let (y, x) = (TAU * (b as f64 + 0.5) / (N / 2) as f64).sin_cos();
            sum += density([sin * x, sin * y, cos]);
        }
    }
    sum * 4.0 * PI / (N * N / 2) as f64
}

/// Materials and maps whose density has a formula.
const DENSE: [(&str, &str); 10] = [
    (LAMBERTIAN, "auto"),
    (LAMBERTIAN, "uniform-hemisphere"),
    (GGX, "auto"),
    (GGX, "cosine-hemisphere"),
    (METAL, "auto"),
    (METAL, "uniform-hemisphere"),
    (PHONG, "auto"),
    (PHONG, "uniform-hemisphere"),
    (LOBE, "auto"),
    (MOON, "uniform-hemisphere"),
];

#[test]
fn every_density_integrates_to_one() {
    assert_all_that_scatter(DENSE.map(|(material, _)| material));
    for (material, map) in DENSE {
        let specimen = Specimen::new(material, map, 8);
        for (theta, phi) in VIEWERS {
            let o = at(theta, phi);
            let integral = over_sphere(|i| specimen.density(i, o).unwrap());
            // A map to the hemisphere has no direction below the surface. A lobe may reach there;
            // the weight is then 0.
            assert!(
                (integral - 1.0).abs() < 5e-4,
                "{material} {map} {theta}: {integral}"
            );
        }
    }
}

#[test]
fn every_density_is_one_over_the_jacobian_of_its_map() {
    for (material, map) in DENSE {
        let specimen = Specimen::new(material, map, 20);
        let divided = material == PHONG && map == "auto";
        let phong = match specimen.stage.scatters[0].lobe(0) {
            Some(Lobe::Phong(phong)) if divided => Some(phong),
            _ => None,
        };
        let mut checked = 0;
        for (theta, phi) in VIEWERS {
            let o = at(theta, phi);
            for u in [0.04, 0.2, 0.37, 0.5, 0.71, 0.93] {
                for v in [0.1, 0.33, 0.52, 0.8] {
                    let cell = specimen.cell(u, v);
                    let (i, _) = specimen.scatter(o, cell);
                    let density = match phong {
                        // Two maps, one for each part of the square. By energy, the base has 0.6 of
                        // 2.1.
                        Some(phong) => phong.densities(&mut Scalar::default(), &o, &i)
                            [usize::from(u > 0.6 / 2.1)],
                        None => specimen.density(i, o).unwrap(),
                    };
                    let product = density * specimen.jacobian(o, cell);
                    assert!(
                        (product - 1.0).abs() < 1e-6,
                        "{material} {map} {theta} {u} {v}: {product}"
                    );
                    checked += 1;
                }
            }
        }
        assert_eq!(checked, 96);
    }
}

#[test]
fn directions_that_no_formula_weighs_have_no_density() {
    let mirror = "{ mirror: { reflectance: [0.9, 0.8, 0.7] } }";
    for material in [mirror, "{ dielectric: { ior: 1.5 } }", MOON] {
        let specimen = Specimen::new(material, "auto", 4);
        assert_eq!(
            specimen.density(at(30.0, 0.0), at(30.0, 180.0)),
            None,
            "{material}"
        );
    }
    let matte = Specimen::new(LAMBERTIAN, "auto", 4);
    let up = [0.0, 0.0, 1.0];
    for depth in [0, 2] {
        assert_eq!(
            matte
                .stage
                .density(&mut Scalar::default(), depth, 0, &up, &up),
            None
        );
    }
}
