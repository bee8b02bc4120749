use super::*;
use glam::{DQuat, DVec2};
use proptest::prelude::*;

const CORNELL_RED: [DVec3; 4] = [
    DVec3::new(552.8, 0.0, 0.0),
    DVec3::new(549.6, 0.0, 559.2),
    DVec3::new(556.0, 548.8, 559.2),
    DVec3::new(556.0, 548.8, 0.0),
];

const SQUARE: [DVec3; 4] = [
    DVec3::new(0.0, 0.0, 0.0),
    DVec3::new(1.0, 0.0, 0.0),
    DVec3::new(1.0, 1.0, 0.0),
    DVec3::new(0.0, 1.0, 0.0),
];

fn built(vertices: &[DVec3; 4]) -> Vec<Polygon> {
    let scene = crate::scene::Scene::from_yaml(
        "{ name: a, film: { width: 1, height: 1 }, materials: {}, geometry: [], \
         camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 40 } } }",
        "built.yaml",
    )
    .unwrap();
    let (mut surfaces, mut problems) = (Vec::new(), Problems::default());
    let mut build = Build {
        scene: &scene,
        meshes: &Meshes::default(),
        surfaces: &mut surfaces,
        problems: &mut problems,
        names: HashMap::new(),
        out: vec![],
        smooth: vec![],
        coloured: vec![],
        pairs_left: MOST_PAIRS,
        balls: vec![],
        spheres: HashSet::new(),
        files: BTreeSet::new(),
        unknown: 0,
        own_materials: HashMap::new(),
        is_full: false,
        warnings: &mut Vec::new(),
    };
    build.quad(vertices, 0, &Path::root());
    let out = build.out;
    assert_eq!(problems.count(), 0, "{problems:?}");
    out
}

#[test]
fn a_quad_that_is_not_planar_splits_along_its_first_diagonal() {
    let [a, b, c, d] = CORNELL_RED;
    let parts = built(&CORNELL_RED);
    assert_eq!(parts.len(), 2);
    assert_eq!((parts[0].vertices, parts[0].corners), ([a, b, c, c], 3));
    assert_eq!((parts[1].vertices, parts[1].corners), ([a, c, d, d], 3));
    assert_eq!(built(&SQUARE).len(), 1);
}

#[test]
fn the_first_of_spheres_in_one_place_hides_the_others() {
    let text = "{ name: a, film: { width: 1, height: 1 }, sky: { radiance: 1 }, materials: { \
        red: { lambertian: { albedo: 1 } }, glass: { dielectric: { ior: 1.5 } } }, geometry: [ \
        sphere: { center: [0, 0, 1], radius: 1, material: red }, \
        sphere: { center: [-0, 0, 1], radius: 1, material: glass }, \
        sphere: { center: [0, 0, 1], radius: 2, material: glass } ], \
        camera: { perspective: { eye: [0, 0, 9], target: [0, 0, 0], vfov: 40 } } }";
    let scene = crate::scene::Scene::from_yaml(text, "spheres.yaml").unwrap();
    let valid = crate::valid::validate(scene, &Meshes::default()).unwrap();
    let kept: Vec<usize> = valid.balls().iter().map(|ball| ball.primitive).collect();
    assert_eq!(kept, [0, 2]);
}

#[test]
fn size_and_distance_do_not_matter() {
    for size in [1e-12, 1e-6, 1.0, 1e9, 1e29] {
        let quad = SQUARE.map(|vertex| vertex * size);
        assert_eq!(built(&quad).len(), 1, "{size}");
        let wall = CORNELL_RED.map(|vertex| vertex * size / 1000.0);
        assert_eq!(built(&wall).len(), 2, "{size}");
        let [a, b, _, c] = quad;
        assert!(triangle_fault(&[a, b, c]).is_none());
        assert!(matches!(triangle_fault(&[a, b, b + b]), Some(Fault::Flat)));
    }
    // 1e9 from the origin a unit is 2^23 roundings long: planar quads are planar to that, and a
    // split along the diagonal would still be right.
    let far = SQUARE.map(|vertex| vertex + DVec3::splat(1e9));
    assert_eq!(built(&far).len(), 1);
    // A lamp of 1e-4 of the scene, and one of a hundred roundings.
    assert_eq!(
        built(&SQUARE.map(|vertex| vertex * 1e-4 + DVec3::splat(1.0))).len(),
        1
    );
    let tiny = SQUARE.map(|vertex| vertex * 2f64.powi(-45) + DVec3::splat(1.0));
    assert!(!built(&tiny).is_empty());
}

#[test]
fn slivers_have_an_area_until_rounding_takes_it() {
    let sliver = |height: f64| [DVec3::ZERO, DVec3::X, DVec3::new(0.5, height, 0.0)];
    assert!(triangle_fault(&sliver(1e-9)).is_none());
    assert!(triangle_fault(&sliver(1e-11)).is_none());
    assert!(matches!(triangle_fault(&sliver(1e-13)), Some(Fault::Flat)));
    assert!(matches!(triangle_fault(&sliver(0.0)), Some(Fault::Flat)));
    let same = [DVec3::X, DVec3::ZERO, DVec3::X];
    assert!(matches!(
        triangle_fault(&same),
        Some(Fault::Coincident {
            first: 0,
            second: 2
        })
    ));
}

fn rotations() -> impl Strategy<Value = DQuat> {
    [-1.0..1.0f64, -1.0..1.0, -1.0..1.0, 0.1..1.0]
        .prop_map(|[x, y, z, w]| DQuat::from_xyzw(x, y, z, w).normalize())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, ..ProptestConfig::default() })]

    /// Compares with whole numbers, for which the sign of every turn is exact.
    #[test]
    fn convexity_is_that_of_exact_arithmetic(
        grid in [[0i64..7, 0i64..7], [0i64..7, 0i64..7], [0i64..7, 0i64..7], [0i64..7, 0i64..7]],
        turn in rotations(),
    ) {
        let sign = |at: usize| {
            let [a, b, c] = [(at + 3) % 4, at, (at + 1) % 4].map(|i| grid[i]);
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
            (u[0] * v[1] - u[1] * v[0]).signum()
        };
        let signs: Vec<i64> = (0..4).map(sign).collect();
        let convex = signs.iter().all(|&s| s == 1) || signs.iter().all(|&s| s == -1);
        let point = |[x, y]: [i64; 2]| turn * DVec2::new(x as f64, y as f64).extend(2.0);
        let vertices = grid.map(point);
        let fault = quad_fault(&vertices);
        prop_assert_eq!(fault.is_none(), convex, "{:?}", grid);
        if convex {
            prop_assert!(is_planar(&vertices));
        }
        let plus = signs.iter().filter(|&&s| s == 1).count();
        let minus = signs.iter().filter(|&&s| s == -1).count();
        match fault {
            Some(Fault::Reflex { at }) => {
                prop_assert_eq!(plus.min(minus), 1);
                let odd = if plus == 1 { 1 } else { -1 };
                prop_assert_eq!(signs[at], odd);
            }
            Some(Fault::Crossing) => prop_assert_eq!((plus, minus), (2, 2)),
            Some(Fault::Straight { at }) => prop_assert_eq!(signs[at], 0),
            Some(Fault::Coincident { first, second }) => {
 prop_assert_eq!(grid[first], grid[second]);
},
            _ => {}
        }
    }

    /// Compares with quaternions.
    #[test]
    fn meshes_turn_about_x_then_y_then_z(
        degrees in [-720.0..720.0f64, -720.0..720.0, -720.0..720.0],
        scale in 0.01..100.0f64,
        point in [-5.0..5.0f64, -5.0..5.0, -5.0..5.0],
    ) {
        let [x, y, z] = degrees.map(f64::to_radians);
        let turn = DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
        let translate = DVec3::new(3.0, -4.0, 5.0);
        let expected = turn * (DVec3::from(point) * scale) + translate;
        let found = Transform::new(scale, degrees.into(), translate).apply(point.into());
        prop_assert!(found.distance(expected) < 1e-11 * (1.0 + expected.length()));
    }
}

#[test]
fn quarter_turns_are_exact() {
    for (degrees, sine, cosine) in [
        (0.0, 0.0, 1.0),
        (90.0, 1.0, 0.0),
        (-90.0, -1.0, 0.0),
        (540.0, 0.0, -1.0),
        (630.0, -1.0, 0.0),
    ] {
        assert_eq!(sin_cos_degrees(degrees), (sine, cosine), "{degrees}");
    }
    let (sine, cosine) = sin_cos_degrees(30.0);
    assert!((sine - 0.5).abs() < 1e-15 && (cosine - 0.75f64.sqrt()).abs() < 1e-15);
}

/// A scene that is built in Rust can give a mesh no file, or several.
#[test]
fn a_mesh_has_one_file() {
    let yaml = "{ name: a, film: { width: 1, height: 1 }, materials: {}, \
         camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 40 } }, \
         geometry: [mesh: { obj: a.obj }] }";
    let scene = crate::scene::Scene::from_yaml(yaml, "built.yaml").unwrap();
    for ([obj, ply, gltf], expected, file, other) in [
        ([false; 3], "QRT0121", None, None),
        ([true, true, false], "QRT0124", Some("ply"), Some("obj")),
        ([false, true, true], "QRT0124", Some("gltf"), Some("ply")),
    ] {
        let mut scene = scene.clone();
        let Some(Geometry::Mesh(mesh)) = scene.geometry.first_mut() else {
            panic!("the scene has no mesh");
        };
        let named = |is_named: bool| is_named.then(|| "a".to_owned());
        [mesh.obj, mesh.ply, mesh.gltf] = [obj, ply, gltf].map(named);
        let problems = crate::valid::validate(scene, &Meshes::default()).unwrap_err();
        let [problem] = &problems[..] else {
            panic!("{problems:?}");
        };
        assert_eq!(problem.code(), expected);
        let place = Path::root().key("geometry").item(0).key("mesh");
        let place_of = |key: Option<&str>| key.map_or_else(|| place.clone(), |key| place.name(key));
        assert_eq!(problem.path(), Some(&place_of(file)));
        assert_eq!(problem.also, other.map(|key| place.name(key).into()));
    }
}

/// The smooth faces of a mesh under a `key` of the scene.
fn smooth_faces(obj: &str, key: &str) -> Vec<SmoothFace> {
    let folder = std::env::temp_dir().join(format!("qrt-smooth-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("ridge.obj");
    std::fs::write(&file, obj).unwrap();
    let text = format!(
        "{{ name: a, film: {{ width: 1, height: 1 }}, sky: {{ radiance: 1 }}, \
         materials: {{ red: {{ lambertian: {{ albedo: 1 }} }} }}, \
         geometry: [mesh: {{ obj: {}, material: red, scale: 2, rotate: [90, 0, 0]{key} }}], \
         camera: {{ perspective: {{ eye: [0, 0, 9], target: [0, 0, 0], vfov: 40 }} }} }}",
        file.file_name().unwrap().display()
    );
    let parsed = crate::front::parse(&text, "smooth.yaml", &[], &folder).unwrap();
    parsed.valid.smooth_faces().to_vec()
}

/// A ridge with an angle of 90 degrees, and a flat triangle beyond it.
const RIDGE: &str = "v 0 0 0\nv 0 2 0\nv 1 0 1\nv 1 2 1\nv 2 0 0\nv 3 0 -1\nv 2 2 0\n";

#[test]
fn an_angle_decides_which_faces_are_smooth() {
    let mesh = format!("{RIDGE}f 1 3 4 2\nf 3 5 7 4\nf 5 6 7\n");
    for (key, smooth) in [
        ("", vec![]),
        (", smooth: auto", vec![]),
        (", smooth: 0", vec![]),
        (", smooth: 89", vec![]),
        (", smooth: 90", vec![0, 1, 2, 3]),
        (", smooth: 180", vec![0, 1, 2, 3]),
    ] {
        let faces = smooth_faces(&mesh, key);
        let polygons: Vec<usize> = faces.iter().map(|face| face.polygon).collect();
        assert_eq!(polygons, smooth, "{key}");
        for face in &faces {
            for normal in face.normals {
                assert!((normal.length() - 1.0).abs() < 1e-12);
                // The mesh was turned: its z is the scene's -y.
                assert!(normal.y < -0.7 && normal.z.abs() < 1e-12, "{normal}");
            }
        }
    }
}

#[test]
fn normals_are_on_the_side_of_the_front_and_not_along_the_face() {
    let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
    assert_eq!(shading_normals(&triangle, [DVec3::Z; 3]), None);
    assert_eq!(shading_normals(&triangle, [-DVec3::Z; 3]), None);
    // Four decimals are no shading.
    let rounded = DVec3::new(5e-4, -5e-4, 1.0).normalize();
    assert_eq!(shading_normals(&triangle, [rounded; 3]), None);
    let slanted = DVec3::new(0.6, 0.0, 0.8);
    let along = DVec3::new(-1.0, 0.0, 0.0);
    let found = shading_normals(&triangle, [slanted, slanted, along]).unwrap();
    assert_eq!(found[..2], [slanted; 2]);
    let turned = shading_normals(&triangle, [-slanted, -slanted, -along]).unwrap();
    assert_eq!(turned, found);
    assert!((found[2] - DVec3::new(-0.9375_f64.sqrt(), 0.0, LEAST_COSINE)).length() < 1e-12);
}

/// A quarter turn about z, and a factor of 2, keep every coordinate exact.
#[test]
fn every_shape_is_scaled_then_turned_then_moved() {
    let shapes = |geometry: &str| {
        let text = format!(
            "name: n\ncamera: {{ perspective: {{ eye: [0, 0, 30], target: [0, 0, 0], vfov: 40 }} }}\n\
             film: {{ width: 1, height: 1 }}\nsky: {{ radiance: 1 }}\n\
             materials: {{ m: {{ lambertian: {{ albedo: 0.5 }} }} }}\ngeometry:\n{geometry}"
        );
        let parsed = crate::front::parse(&text, "n.yaml", &[], "".as_ref());
        parsed.unwrap_or_else(|report| panic!("{report}")).valid
    };
    let moved = "scale: 2, rotate: [0, 0, 90], translate: [1, 2, 3], material: m }\n";
    let written = shapes(&format!(
        "- quad: {{ vertices: [[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 1]], {moved}\
         - triangle: {{ vertices: [[5, 0, 0], [6, 0, 0], [5, 1, 0]], {moved}\
         - sphere: {{ center: [1, 2, 3], radius: 0.5, {moved}\
         - box: {{ min: [0, 0, 5], max: [1, 2, 6], {moved}"
    ));
    let expected = shapes(
        "- quad: { vertices: [[1, 2, 3], [1, 6, 3], [-1, 6, 3], [-1, 2, 5]], material: m }\n\
         - triangle: { vertices: [[1, 12, 3], [1, 14, 3], [-1, 12, 3]], material: m }\n\
         - sphere: { center: [-3, 4, 9], radius: 1, material: m }\n\
         - box: { min: [0, 0, 10], max: [2, 4, 12], rotate: [0, 0, 90], translate: [1, 2, 3], material: m }\n",
    );
    let outlines = |valid: &crate::valid::ValidScene| -> Vec<Vec<DVec3>> {
        let polygons = valid.polygons.iter();
        polygons.map(|polygon| polygon.outline().to_vec()).collect()
    };
    assert_eq!(outlines(&written), outlines(&expected));
    let balls = |valid: &crate::valid::ValidScene| {
        let [ball] = valid.balls[..] else {
            panic!("{} spheres", valid.balls.len());
        };
        (ball.centre, ball.radius)
    };
    assert_eq!(balls(&written), balls(&expected));
    let again = written.scene().to_string();
    let again = crate::front::parse(&again, "again.yaml", &[], "".as_ref()).unwrap();
    assert_eq!(again.valid.scene(), written.scene());
}
