//! Meshes shaded by interpolated normals, against the sphere that they stand for and in a furnace, in
//! floating point and as circuits.

use super::spheres::seen;
use qrt::prelude::*;
use qrt::scene::front::parse;
use std::collections::HashMap;

type Point = [f64; 3];

/// The corners and faces of an icosphere: the faces of an icosahedron, each cut into four `cuts` times.
fn icosphere(cuts: u32) -> (Vec<Point>, Vec<[usize; 3]>) {
    let unit = |p: Point| {
        let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
        p.map(|x| x / length)
    };
    let golden = f64::midpoint(1.0, 5_f64.sqrt());
    let mut corners = Vec::new();
    for axis in 0..3 {
        for (a, b) in [
            (-1.0, golden),
            (1.0, golden),
            (-1.0, -golden),
            (1.0, -golden),
        ] {
            let mut corner = [0.0; 3];
            corner[axis] = a;
            corner[(axis + 1) % 3] = b;
            corners.push(unit(corner));
        }
    }
    let squared = |a: Point, b: Point| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>();
    // The edges of the icosahedron are its shortest distances.
    let edge = |a: usize, b: usize| squared(corners[a], corners[b]) < 1.2;
    let mut faces = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if edge(a, b) && edge(b, c) && edge(a, c) {
                    let [p, q, r] = [a, b, c].map(|corner| corners[corner]);
                    let cross = [
                        q[1] * r[2] - q[2] * r[1],
                        q[2] * r[0] - q[0] * r[2],
                        q[0] * r[1] - q[1] * r[0],
                    ];
                    let outwards = (0..3).map(|k| p[k] * cross[k]).sum::<f64>() > 0.0;
                    faces.push(if outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..cuts {
        let mut middles = HashMap::new();
        let mut middle = |a: usize, b: usize| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = std::array::from_fn(|k| corners[a][k] + corners[b][k]);
                corners.push(unit(sum));
                corners.len() - 1
            })
        };
        let cut = faces.iter().flat_map(|&[a, b, c]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        });
        faces = cut.collect();
    }
    (corners, faces)
}

/// Writes an icosphere as an OBJ file, with the normals of the sphere if `has_normals`. Returns the name of
/// the file, which is in the folder of temporary files.
fn ball(cuts: u32, has_normals: bool) -> String {
    let name = format!("qrt-ball-{}-{cuts}-{has_normals}.obj", std::process::id());
    let path = std::env::temp_dir().join(&name);
    let (corners, faces) = icosphere(cuts);
    let line = |keyword: &str, [x, y, z]: Point| format!("{keyword} {x} {y} {z}\n");
    let mut text: String = corners.iter().map(|&corner| line("v", corner)).collect();
    if has_normals {
        text.extend(corners.iter().map(|&corner| line("vn", corner)));
    }
    for face in faces {
        let corners = face.map(|corner| {
            let number = corner + 1;
            if has_normals {
                format!("{number}//{number}")
            } else {
                number.to_string()
            }
        });
        text += "f ";
        text += &corners.join(" ");
        text.push('\n');
    }
    // Tests of one process write the same bytes; a rename leaves no partial file to the others.
    let partial = path.with_extension(format!("{:?}", std::thread::current().id()));
    std::fs::write(&partial, text).unwrap();
    std::fs::rename(&partial, &path).unwrap();
    name
}

/// The scene of a text that names meshes which [`ball`] has written.
fn read(text: &str, sets: &[&str]) -> ValidScene {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let parsed = parse(text, "test.yaml", &sets, &std::env::temp_dir());
    parsed.unwrap_or_else(|report| panic!("{report}")).valid
}

/// A ball of `material` on a floor below a lamp. `shape` is its primitive without the material.
fn room(shape: &str, material: &str, depths: &str, sets: &[&str]) -> ValidScene {
    let text = format!(
        "name: ball
camera: {{ perspective: {{ eye: [0, 1.2, 5], target: [0, 0, 0], vfov: 40 }} }}
film: {{ width: 24, height: 24 }}
materials:
  floor: {{ lambertian: {{ albedo: 0.6 }} }}
  ball: {{ {material} }}
  lamp: {{ emitter: {{ radiance: 8 }} }}
geometry:
  - quad: {{ vertices: [[-4, -1, -4], [-4, -1, 4], [4, -1, 4], [4, -1, -4]], material: floor }}
  - quad: {{ vertices: [[-1, 4, -1], [1, 4, -1], [1, 4, 1], [-1, 4, 1]], material: lamp }}
  - {shape}, material: ball }}
sampling: {{ path_bits: 10, depths: {depths} }}
"
    );
    read(&text, sets)
}

fn mesh(cuts: u32, has_normals: bool, smooth: &str) -> String {
    let file = ball(cuts, has_normals);
    format!("mesh: {{ obj: {file}, smooth: {smooth}")
}

const LIT: &str =
    "[{ bits: [10, 10] }, { bits: [10, 10], light: [8, 8] }, { bits: [10, 10], light: [8, 8] }]";
const UNLIT: &str = "[{ bits: [10, 10] }, { bits: [10, 10] }, { bits: [10, 10] }]";

fn mean(picture: &[[f64; 3]]) -> f64 {
    let sum: f64 = picture.as_flattened().iter().sum();
    sum / (3 * picture.len()) as f64
}

fn distance(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    (pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / (3 * a.len()) as f64).sqrt()
}

/// The pixels that see the ball away from its outline, which a mesh changes.
fn within(picture: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let from_centre = |place: usize| place as f64 + 0.5 - 12.0;
    let seen = (0..24 * 24).filter(|pixel| {
        let [x, y] = [pixel % 24, pixel / 24].map(from_centre);
        x.hypot(y) < 5.0
    });
    seen.map(|pixel| picture[pixel]).collect()
}

#[test]
fn a_smooth_icosphere_looks_like_its_sphere() {
    let sphere = "sphere: { center: [0, 0, 0], radius: 1";
    for material in [
        "lambertian: { albedo: [0.7, 0.4, 0.3] }",
        "mirror: { reflectance: 0.9 }",
    ] {
        let picture = |shape: &str| seen(&room(shape, material, LIT, &[]), Model::Real);
        let sphere = picture(sphere);
        let fine = picture(&mesh(3, true, "auto"));
        let shift = mean(&fine) / mean(&sphere) - 1.0;
        assert!(shift.abs() < 0.01, "{material}: mean {shift:+.4}");
        // Of 80 faces each is seen, unless they are smooth.
        let flat = picture(&mesh(1, false, "auto"));
        assert_eq!(flat, picture(&mesh(1, true, "0")));
        let facets = distance(&within(&flat), &within(&sphere));
        for smooth in [mesh(1, true, "auto"), mesh(1, false, "60")] {
            let near = distance(&within(&picture(&smooth)), &within(&sphere));
            assert!(2.0 * near < facets, "{material}: {near} {facets}");
        }
    }
}

/// Light that leaves a smooth mesh is no more than that which arrives, and is lost only where the
/// interpolated normal and the face disagree about a direction.
#[test]
fn a_white_smooth_thing_under_a_white_sky_gains_nothing() {
    for (material, rays) in [
        ("lambertian: { albedo: 1 }", 2),
        ("mirror: { reflectance: 1 }", 2),
        ("dielectric: { ior: 1.5 }", 12),
        ("ggx: { alpha: 0.1, reflectance: 1 }", 2),
    ] {
        let depths = format!(
            "[{{ bits: [10, 10] }}{}]",
            ", { bits: [10, 10] }".repeat(rays - 1)
        );
        let text = format!(
            "name: ball
camera: {{ perspective: {{ eye: [0, 0, 5], target: [0, 0, 0], vfov: 20 }} }}
film: {{ width: 8, height: 8 }}
sky: {{ radiance: 1 }}
materials: {{ ball: {{ {material} }} }}
geometry: [{}, material: ball }}]
sampling: {{ path_bits: 10, depths: {depths} }}
",
            mesh(1, true, "auto")
        );
        let picture = seen(&read(&text, &[]), Model::Real);
        let brightest = picture.as_flattened().iter().copied().fold(0.0, f64::max);
        // GGX of Fresnel 1 loses what its masking hides.
        assert!(brightest <= 1.0 + 1e-9, "{material}: {brightest}");
        let mean = mean(&picture);
        assert!(mean > 0.95, "{material}: {mean}");
    }
}

/// The three ways to sample lamps give one picture, though a path may end where its direction is on
/// different sides of face and normal.
#[test]
fn lamps_light_smooth_meshes_as_rays_that_meet_them_do() {
    let shape = mesh(1, true, "auto");
    let material = "lambertian: { albedo: 0.8 }";
    let picture = |depths, lights: &str, bits: &str| {
        let scene = room(&shape, material, depths, &[lights, bits]);
        seen(&scene, Model::Real)
    };
    let found = picture(UNLIT, "sampling.lights=none", "sampling.path_bits=14");
    for lights in ["auto", "mis", "next-event"] {
        let lights = format!("sampling.lights={lights}");
        let lit = picture(LIT, &lights, "sampling.path_bits=10");
        let shift = mean(&lit) / mean(&found) - 1.0;
        assert!(shift.abs() < 0.01, "{lights}: {shift:+.4}");
    }
}

/// The circuit of a smooth mesh computes the picture of floating point, up to its registers' width.
#[test]
fn circuits_shade_smoothly() {
    for material in [
        "lambertian: { albedo: 0.8 }",
        "mirror: { reflectance: 0.9 }",
        "dielectric: { ior: 1.5 }",
    ] {
        let few = ["film={ width: 4, height: 4 }", "sampling.path_bits=6"];
        let scene = room(&mesh(1, true, "auto"), material, LIT, &few);
        let [real, fixed, gates] =
            [Model::Real, Model::Fixed, Model::Gates].map(|model| seen(&scene, model));
        assert_eq!(fixed, gates, "{material}");
        let error = distance(&real, &fixed) / mean(&real);
        assert!(error < 0.02, "{material}: {error}");
    }
}

fn text(camera: &str, materials: &str, geometry: &str, sampling: &str) -> String {
    format!(
        "name: smooth\ncamera: {{ perspective: {{ {camera} }} }}\nfilm: {{ width: 16, height: 16 }}\n\
         materials: {{ {materials} }}\ngeometry: [{geometry}]\nsampling: {{ {sampling} }}\n"
    )
}

/// Rays to the corners of a wide film are much longer than those along its axis, and interpolated normals
/// and mirrors read their angles.
#[test]
fn wide_views_are_shaded_as_narrow_ones() {
    let quad = "quad: { vertices: [[-9, 0.5, 9], [9, 0.5, 9], [9, 0.5, -9], [-9, 0.5, -9]]";
    let lamp = "quad: { vertices: [[-0.4, 0.3, -0.2], [0.4, 0.3, -0.2], [0.4, 0.3, 0.4], \
                [-0.4, 0.3, 0.4]], material: lamp }";
    for (shape, material) in [
        (mesh(0, true, "auto"), "lambertian: { albedo: 0.8 }"),
        (mesh(0, true, "auto"), "mirror: { reflectance: 0.9 }"),
        (quad.to_owned(), "mirror: { reflectance: 0.9 }"),
    ] {
        let scene = text(
            "eye: [0, 0, 0.3], target: [0, 0, 5], vfov: 150",
            &format!("ball: {{ {material} }}, lamp: {{ emitter: {{ radiance: 3 }} }}"),
            &format!("{lamp}, {shape}, material: ball }}"),
            "path_bits: 8, lights: none, depths: [{ bits: [8, 8] }, { bits: [8, 8] }]",
        );
        let scene = read(&scene, &["sampling.lights=none", "precision.fraction=20"]);
        let [real, fixed] = [Model::Real, Model::Fixed].map(|model| seen(&scene, model));
        let error = distance(&real, &fixed) / mean(&real);
        assert!(error < 0.02, "{shape} {material}: {error}");
    }
}

/// At grazing angles the rounded direction of a reflection may be behind the surface. Glass of a high index
/// would then refract a path once and not twice, beyond its bound.
#[test]
fn reflections_in_glass_do_not_enter_it() {
    let scene = text(
        "eye: [0, 0, 5], target: [0, 0, 0], vfov: 24",
        "ball: { dielectric: { ior: 2 } }",
        &format!("{}, material: ball }}", mesh(1, true, "auto")),
        "path_bits: 9, lights: none, depths: [{ bits: [8, 8] }, { bits: [8, 8] }, { bits: [8, 8] }, { bits: [8, 8] }]",
    );
    for fraction in [8, 12, 16] {
        let few = [
            format!("precision.fraction={fraction}"),
            "sky={ radiance: 1 }".to_owned(),
            "film={ width: 24, height: 24 }".to_owned(),
        ];
        let scene = read(&scene, &few.each_ref().map(String::as_str));
        let brightest = seen(&scene, Model::Fixed).into_iter().flatten();
        assert!(brightest.fold(0.0, f64::max) <= 1.01, "{fraction}");
    }
}

/// The lamp of each face is in the plane of the others, up to rounding: none lights another.
#[test]
fn faces_of_one_plane_do_not_light_each_other() {
    let name = format!("qrt-cushion-{}.obj", std::process::id());
    let mut cushion = String::new();
    for corner in 0..16 {
        let [x, y] = [corner % 4, corner / 4].map(f64::from);
        let normal = format!("vn {} {} 0.6\n", 0.8 * x - 1.2, 0.8 * y - 1.2);
        cushion += &[format!("v {} {} 0\n", x / 3.0, y / 3.0), normal].concat();
    }
    for cell in [1, 2, 3, 5, 6, 7, 9, 10, 11] {
        for [b, c] in [[cell + 1, cell + 5], [cell + 5, cell + 4]] {
            cushion += &[
                "f ".to_owned(),
                format!("{cell}//{cell} {b}//{b} {c}//{c}\n"),
            ]
            .concat();
        }
    }
    std::fs::write(std::env::temp_dir().join(&name), cushion).unwrap();
    let far = "rotate: [11, 17, 13.7], translate: [3000, 3000, 0]";
    let scene = text(
        "eye: [3000.5, 3000.4, 3], target: [3000.5, 3000.4, 0], vfov: 30",
        "lamp: { emitter: { radiance: 1, albedo: 0.9 } }",
        &format!("mesh: {{ obj: {name}, material: lamp, {far} }}"),
        "path_bits: 14, depths: [{ bits: [12, 12] }, { bits: [12, 12], light: [12, 12] }]",
    );
    for lights in ["auto", "mis"] {
        let lights = format!("sampling.lights={lights}");
        let lit = seen(&read(&scene, &[&lights]), Model::Real);
        let unlit = seen(&read(&scene, &["sampling.lights=none"]), Model::Real);
        assert!(distance(&lit, &unlit) < 1e-6, "{lights}");
    }
}

/// A strip of 1e-5 of the scene whose normal turns across it: its circuit would have the wrong normals.
#[test]
fn normals_of_too_thin_faces_are_refused() {
    let name = format!("qrt-strip-{}.obj", std::process::id());
    let strip =
        "v 0 0 0\nv 1 0 0\nv 0 1e-5 0\nvn 0.5 0 1\nvn -0.5 0 1\nvn 0 0.5 1\nf 1//1 2//2 3//3\n";
    std::fs::write(std::env::temp_dir().join(&name), strip).unwrap();
    let scene = |smooth: &str| {
        let scene = text(
            "eye: [0, 0, 3], target: [0, 0, 0], vfov: 30",
            "ball: { mirror: { reflectance: 1 } }",
            &format!("mesh: {{ obj: {name}, material: ball, smooth: {smooth} }}"),
            "path_bits: 2, lights: none, depths: [{ bits: [4, 4] }, { bits: [4, 4] }]",
        );
        read(&scene, &["sky={ radiance: 1 }"])
    };
    let fixed = RenderOptions {
        model: Some(Model::Fixed),
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    };
    let error = render(&scene("auto"), &fixed).err().unwrap().to_string();
    let expected =
        "the normals of this mesh change over widths that have too few of 16 fraction bits";
    assert!(error.contains(expected), "{error}");
    assert!(render(&scene("0"), &fixed).is_ok());
    // Floating point has enough bits.
    seen(&scene("auto"), Model::Real);
}
