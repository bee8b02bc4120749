use super::*;
use crate::scene::{Accuracy, Camera, Counting, Estimator, Lambertian, Material};
use qrt_syntax::codes;

fn scene() -> Scene {
    let text = "{ name: a, film: { width: 1, height: 1 }, materials: {}, geometry: [], \
         camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 40 } } }";
    Scene::from_yaml(text, "scene.yaml").unwrap()
}

fn codes_of(scene: Scene) -> Vec<&'static str> {
    match validate(scene, &Meshes::default()) {
        Ok(_) => vec![],
        Err(problems) => problems.iter().map(Problem::code).collect(),
    }
}

#[test]
fn scenes_built_in_rust_are_checked_like_others() {
    assert_eq!(codes_of(scene()), [""; 0]);
    let matte = |albedo| {
        Material::Lambertian(Lambertian {
            albedo: [albedo; 3].into(),
        })
    };
    let mut doubled = scene();
    doubled.materials = vec![("m".into(), matte(0.5)), ("m".into(), matte(0.25))];
    assert_eq!(codes_of(doubled), [codes::DUPLICATE_NAME]);

    let mut faulty = scene();
    faulty.name.clear();
    faulty.film.width = 0;
    faulty.counting.phase_bits = 41;
    faulty.sampling.depths[1].bits = [25, 3];
    faulty.materials = vec![("m".into(), matte(f64::NAN)), ("n".into(), matte(-0.5))];
    let found = codes_of(faulty);
    let mut expected = vec![codes::EMPTY_NAME, codes::OUT_OF_RANGE];
    expected.extend([codes::NOT_FINITE; 3]);
    expected.extend([codes::ALBEDO; 3]);
    expected.extend([codes::OUT_OF_RANGE; 2]);
    assert_eq!(found, expected);
}

#[test]
fn parameters_beside_an_accuracy_are_seen_without_their_text() {
    let mut accurate = scene();
    accurate.accuracy = Some(Accuracy {
        error: 0.01,
        confidence: 0.9,
    });
    assert_eq!(codes_of(accurate.clone()), [""; 0]);
    accurate.counting.estimator = Some(Estimator::Paper);
    accurate.sampling.path_bits = 13;
    assert_eq!(codes_of(accurate), [codes::ACCURACY_CONFLICT; 2]);
}

#[test]
fn large_pictures_without_an_estimator_are_counted_by_sine() {
    let counted = |change: fn(&mut Scene), film: [u32; 2]| {
        let mut scene = scene();
        [scene.film.width, scene.film.height] = film;
        change(&mut scene);
        let valid = validate(scene, &Meshes::default()).unwrap();
        let counting = valid.parameters().counting;
        (counting.estimator(), valid.is_counted_by_size())
    };
    let (small, large) = ([64, 64], [4097, 1]);
    assert_eq!(counted(|_| (), small), (Estimator::Auto, false));
    assert_eq!(counted(|_| (), large), (Estimator::Sine, true));
    let written: [fn(&mut Scene); 4] = [
        |scene| scene.counting.estimator = Some(Estimator::Auto),
        |scene| scene.counting.strata = Some(2),
        |scene| scene.counting.error = Some(0.1),
        |scene| {
            scene.accuracy = Some(Accuracy {
                error: 0.1,
                confidence: 0.9,
            });
        },
    ];
    for change in written {
        assert_eq!(counted(change, large), (Estimator::Auto, false));
    }
    let one_stratum = |scene: &mut Scene| scene.counting.strata = Some(1);
    assert_eq!(counted(one_stratum, large), (Estimator::Sine, true));
}

#[test]
fn other_parameters_choose_the_estimator_of_a_large_picture_anew() {
    let mut large = scene();
    [large.film.width, large.film.height] = [4097, 1];
    let valid = validate(large, &Meshes::default()).unwrap();
    let counted = |change: fn(&mut Counting)| {
        let mut parameters = valid.parameters();
        change(&mut parameters.counting);
        let changed = valid.with_parameters(parameters).unwrap();
        let estimator = changed.scene().counting.estimator();
        (estimator, changed.is_counted_by_size())
    };
    assert_eq!(counted(|_| ()), (Estimator::Sine, true));
    let unwritten = |counting: &mut Counting| *counting = Counting::default();
    assert_eq!(counted(unwritten), (Estimator::Sine, true));
    let with_error = |counting: &mut Counting| counting.error = Some(0.1);
    assert_eq!(counted(with_error), (Estimator::Auto, false));
    let paper = |counting: &mut Counting| counting.estimator = Some(Estimator::Paper);
    assert_eq!(counted(paper), (Estimator::Paper, false));
}

#[test]
fn other_parameters_change_a_fingerprint_that_has_been_read() {
    let valid = validate(scene(), &Meshes::default()).unwrap();
    let first = valid.fingerprint();
    let mut parameters = valid.parameters();
    parameters.sampling.path_bits += 1;
    let changed = valid.with_parameters(parameters).unwrap();
    assert_ne!(changed.fingerprint(), first);
    assert_eq!(valid.fingerprint(), first);
}

#[test]
fn cameras_of_any_size_have_a_direction() {
    for size in [1e-140, 1e-6, 1.0, 1e29] {
        let mut scaled = scene();
        if let Camera::Perspective(camera) = &mut scaled.camera {
            camera.eye *= size;
            camera.up *= size;
        }
        assert_eq!(codes_of(scaled), [""; 0], "{size}");
    }
    let tiny = [1.0, 1e-200, 1e-310].map(|size| {
        let mut scaled = scene();
        if let Camera::Perspective(camera) = &mut scaled.camera {
            camera.up = DVec3::Y * size;
        }
        let sky = crate::scene::Sky {
            radiance: Some([1.0; 3]),
            horizon: None,
            zenith: None,
            up: DVec3::new(0.0, 2.0, 0.0) * size,
        };
        scaled.sky = Some(sky);
        assert_eq!(codes_of(scaled.clone()), [""; 0], "{size}");
        assert_eq!(sky.upwards(), DVec3::Y, "{size}");
        let basis = crate::scene::Basis::new(&scaled.camera);
        [basis.right, basis.up, basis.forward]
    });
    assert_eq!(tiny, [tiny[0]; 3]);
    let mut far = scene();
    if let Camera::Perspective(camera) = &mut far.camera {
        camera.target = camera.eye + DVec3::splat(1e-200);
        camera.up = DVec3::ONE;
    }
    assert_eq!(codes_of(far), [codes::CAMERA_TARGET]);
}

#[test]
fn a_sum_of_one_is_no_gain_whatever_its_rounding() {
    for (kd, ks) in [(0.7, 0.3), (0.9, 0.1), (0.8, 0.2), (0.6, 0.4), (0.34, 0.66)] {
        let mut glossy = scene();
        let phong = crate::scene::Phong {
            diffuse: [kd; 3],
            specular: [ks; 3],
            exponent: 8.0,
        };
        glossy.materials = vec![("m".into(), Material::Phong(phong))];
        assert_eq!(codes_of(glossy.clone()), [""; 0], "{kd} {ks}");
        let more = crate::scene::Phong {
            specular: [ks + 1e-9; 3],
            ..phong
        };
        glossy.materials = vec![("m".into(), Material::Phong(more))];
        assert_eq!(codes_of(glossy), [codes::PHONG_ENERGY]);
    }
}

/// The albedo of a Phong lobe by quadrature: at most 1, and 1 at normal incidence.
#[test]
fn phong_lobes_reflect_at_most_what_arrives() {
    for exponent in [0.0, 1.0, 20.0, 100.0] {
        for degrees in [0.0f64, 20.0, 45.0, 70.0, 89.0] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let mirrored = DVec3::new(sine, 0.0, cosine);
            let (rings, steps) = (800, 400);
            let mut albedo = 0.0;
            for ring in 0..rings {
                // Directions of equal projected area: mean of f pi.
                let u = (f64::from(ring) + 0.5) / f64::from(rings);
                for step in 0..steps {
                    let angle = std::f64::consts::TAU * (f64::from(step) + 0.5) / f64::from(steps);
                    let out = DVec3::new(
                        u.sqrt() * angle.cos(),
                        u.sqrt() * angle.sin(),
                        (1.0 - u).sqrt(),
                    );
                    let lobe = out.dot(mirrored).max(0.0).powf(exponent) * (exponent + 2.0) / 2.0;
                    albedo += lobe / f64::from(rings * steps);
                }
            }
            assert!(albedo < 1.001, "{exponent} {degrees} {albedo}");
            if degrees == 0.0 {
                assert!((albedo - 1.0).abs() < 1e-3, "{exponent} {albedo}");
            }
        }
    }
}

/// Checks that parameters are refused for the same problems as a scene's text.
#[test]
fn lamps_are_looked_at_when_parameters_begin_to_sample_them() {
    let text = "
name: a
film: { width: 1, height: 1 }
camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 40 } }
materials: { m: { lambertian: { albedo: [0.5, 0.5, 0.5] } }, l: { emitter: { radiance: [1, 1, 1] } } }
geometry:
  - triangle: { vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], material: m }
  - triangle: { vertices: [[0, 0, 2], [0, 1, 2], [1, 0, 2]], material: l }
  # No parallelogram.
  - quad: { vertices: [[0, 0, 3], [0, 1, 3], [1, 2, 3], [1, 0, 3]], material: l }
sampling: { depths: [{ bits: [8, 8] }, { bits: [8, 8], light: none }] }
";
    let scene = crate::front::parse(text, "scene.yaml", &[], "".as_ref());
    let scene = scene.unwrap().valid;
    let with = |light: [u32; 2]| {
        let mut parameters = scene.parameters();
        parameters.sampling.depths[1].light = light.into();
        scene.with_parameters(parameters)
    };
    assert_eq!(with([8, 8]).unwrap().polygons().len(), 4);
    let problems = with([1, 8]).unwrap_err();
    assert_eq!(problems[0].code(), codes::FEW_LIGHT_BITS);
}

/// A lamp to sample that is no parallelogram is cut in two: what follows it in the list keeps its own faces.
#[test]
fn faces_belong_to_their_primitives_after_a_lamp_is_cut() {
    let text = "{ name: a, film: { width: 1, height: 1 }, \
         materials: { lamp: { emitter: { radiance: [1, 1, 1] } }, white: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }, \
         geometry: [ \
           { triangle: { vertices: [[4, 0, 0], [5, 0, 0], [4, 1, 0]], material: white } }, \
           { quad: { vertices: [[-1, 3, 1], [-2, 3, -1], [2, 3, -1], [1, 3, 1]], material: lamp } }, \
           { quad: { vertices: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: white } } ], \
         sampling: { path_bits: 4, depths: [{ bits: [4, 4] }, { bits: [4, 4], light: [4, 4] }] }, \
         camera: { perspective: { eye: [0, 1, 4], target: [0, 1, 0], vfov: 40 } } }";
    let valid = crate::front::parse(text, "scene.yaml", &[], "".as_ref()).unwrap();
    let valid = valid.valid;
    let parts: Vec<_> = (0..4)
        .map(|primitive| valid.polygons_of(primitive))
        .collect();
    assert_eq!(parts, [0..1, 1..3, 3..4, 4..4]);
    let owners: Vec<_> = (0..4).map(|polygon| valid.primitive_of(polygon)).collect();
    assert_eq!(owners, [0, 1, 1, 2]);
}

/// Nearer than 1e-4 of the radius, rounding would decide if the eye is inside; a lens of a hundredth of the
/// radius sees from many distances.
#[test]
fn an_eye_may_be_near_a_sphere_and_not_on_it() {
    let on = |height: f64, lens: &str| {
        let text = format!(
            "{{ name: a, film: {{ width: 1, height: 1 }}, materials: {{ m: {{ lambertian: {{ albedo: 0.5 }} }} }}, \
             geometry: [{{ sphere: {{ center: [0, 0, 0], radius: 2, material: m }} }}], camera: {{ perspective: \
             {{ eye: [0, 0, {}], target: [9, 0, 0], vfov: 40{lens} }} }} }}",
            2.0 + height
        );
        codes_of(Scene::from_yaml(&text, "scene.yaml").unwrap()) == [codes::CAMERA_ON_SPHERE]
    };
    let lens = |aperture: f64| format!(", lens: {{ aperture: {aperture}, focus: 3 }}");
    for side in [1.0, -1.0] {
        assert!(on(0.0, "") && on(side * 1.9e-4, ""));
        assert!(!on(side * 2.1e-4, ""));
        assert!(on(side * 1e-4, &lens(0.019)) && !on(side * 1e-4, &lens(0.021)));
    }
}
