//! Tests of the grammar of `qrt!`, and that no input makes it panic.

use super::{code, read_text};
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use qrt_scene::{Disc, Geometry, Scene, Sun};
use std::path::Path;

const CAMERA: &str = "camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },";

/// Returns the scene of a camera and `rest`.
fn scene(rest: &str) -> Scene {
    let text = format!("scene Room {{ {CAMERA} {rest} }}");
    let (scenes, faults) = read_text(&text, Path::new(""));
    assert!(faults.is_empty(), "{faults:#?}");
    scenes[0].1.as_ref().unwrap().scene().clone()
}

/// Returns the codes of the errors in a camera and `rest`.
fn codes(rest: &str) -> Vec<String> {
    let text = format!("scene Room {{ {CAMERA} {rest} }}");
    let (_, faults) = read_text(&text, Path::new(""));
    faults.iter().map(|fault| code(fault).to_owned()).collect()
}

#[test]
fn a_film_may_be_one_token_or_many() {
    for film in [
        "64x48",
        "64 x 48",
        "64x 48",
        "64 x48",
        "8 * 8 x 2 * 24",
        "W x (W - 16)",
        "{ width: 64, height: 48 }",
        "6_4x4_8",
    ] {
        let scene = scene(&format!("const W: f64 = 64; film: {film}"));
        assert_eq!((scene.film.width, scene.film.height), (64, 48), "{film}");
    }
}

#[test]
fn an_undefined_name_makes_one_error() {
    let quad = |corner: &str| {
        format!(
            "film: 8x8, material white: mirror {{ reflectance: rgb(1, 1, 1) }},
             quad: white {{ ({corner}, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0) }}"
        )
    };
    assert_eq!(codes(&quad("1")), ["QRT0301"]);
    assert_eq!(codes(&quad("SIZE")), ["QRT0712"]);
}

#[test]
fn a_disc_is_written_as_a_sphere_is() {
    let white = "film: 8x8, material white: mirror { reflectance: rgb(1, 1, 1) },";
    let disc = "disc pond: white { center: (1, 2, 3), normal: (0, 2, 0), radius: 0.5, scale: 2 }";
    let scene = scene(&format!("{white} {disc}"));
    let expected = Disc {
        scale: 2.0,
        ..Disc::new([1.0, 2.0, 3.0].into(), [0.0, 2.0, 0.0].into(), 0.5, "white")
    };
    assert_eq!(scene.geometry, [Geometry::Disc(expected)]);
    assert_eq!(
        codes(&format!(
            "{white} {}",
            disc.replace("(0, 2, 0)", "(0, 0, 0)")
        )),
        ["QRT0310"]
    );
    let other = disc.replace("disc", "disk");
    let text = format!("scene Room {{ {CAMERA} {white} {other} }}");
    let (_, faults) = read_text(&text, Path::new(""));
    let told = format!("{faults:?}");
    assert!(told.contains("`disk` is called `disc` here"), "{told}");
}

#[test]
fn a_sun_is_written_as_a_sky_is() {
    let entry = "film: 8x8, sun { direction: (1, 2, 3), radiance: rgb(3, 2, 1) }";
    let expected = Sun {
        direction: [1.0, 2.0, 3.0].into(),
        angle: 0.53,
        radiance: [3.0, 2.0, 1.0],
    };
    assert_eq!(scene(entry).sun, Some(expected));
    assert_eq!(codes(&entry.replace("(1, 2, 3)", "(0, 0, 0)")), ["QRT0213"]);
    let text = format!(
        "scene Room {{ {CAMERA} {} }}",
        entry.replace("sun", "directional")
    );
    let (_, faults) = read_text(&text, Path::new(""));
    let told = format!("{faults:?}");
    assert!(
        told.contains("write `sun`, whose `direction` points towards it"),
        "{told}"
    );
}

#[test]
fn loops_repeat_primitives_and_rays() {
    let scene = scene(
        "film: 8x8, material white: mirror { reflectance: rgb(1, 1, 1) },
         const SIZE: f64 = 2;
         for i in -1..=1 {
             const LEFT: f64 = i * SIZE;
             for z in [0, 0.5] {
                 triangle step: white { (LEFT, 0, z), (LEFT + 1, 0, z), (LEFT, 1, z) },
             }
         }
         for _ in 0..4 { depth { bits: (4, 4) } },
         for i in 3..0 { depth never { bits: (0, 0) } }",
    );
    let corners: Vec<[f64; 2]> = scene
        .geometry
        .iter()
        .map(|primitive| match primitive {
            Geometry::Triangle(triangle) => [triangle.vertices[0].x, triangle.vertices[0].z],
            _ => panic!("{primitive:?}"),
        })
        .collect();
    let expected = [
        [-2., 0.],
        [-2., 0.5],
        [0., 0.],
        [0., 0.5],
        [2., 0.],
        [2., 0.5],
    ];
    assert_eq!(corners, expected);
    assert_eq!(scene.sampling.depths.len(), 4);
}

#[test]
fn numbers_are_expressions_of_constants() {
    let scene = scene(
        "const HALF: f64 = sqrt(0.25); const DOWN: f64 = -HALF;
         film: { width: (1 + HALF) * 4, height: 2^3, },
         material white: lambertian { albedo: (HALF, HALF ^ 2, -DOWN / 2) },
         sampling { path_bits: 1_0, },
         material cloth: bsdf {
             map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u)),
             value: HALF / pi * (1 + DOWN * cos_i),
         }",
    );
    assert_eq!((scene.film.width, scene.film.height), (6, 8));
    let text = scene.to_yaml();
    assert!(text.contains("albedo: [0.5, 0.25, 0.25]"), "{text}");
    assert!(text.contains("0.5/pi*(1+(-0.5)*cos_i)"), "{text}");
    assert_eq!(scene.name, "room");
}

#[test]
fn one_macro_holds_several_scenes() {
    let text = format!(
        "pub scene One {{ {CAMERA} film: 8x8 }}
         #[derive(Debug)] pub(crate) scene Two<Fixed<2, 12>> {{ name: \"second\", film: 8x8 }}
         scene Three<Fixed<2, 12>> {{ {CAMERA} film: 8x8 }}"
    );
    let (scenes, faults) = read_text(&text, Path::new(""));
    let names: Vec<_> = scenes
        .iter()
        .map(|(parsed, _)| parsed.header.name.to_string())
        .collect();
    assert_eq!(names, ["One", "Two", "Three"]);
    assert_eq!(faults.len(), 1, "{faults:#?}");
    assert_eq!(code(&faults[0]), "QRT0121");
    assert!(scenes[0].1.is_some() && scenes[1].1.is_none());
    let third = scenes[2].1.as_ref().unwrap();
    assert_eq!(third.scene().precision.fraction, Some(12));
}

#[test]
fn an_error_hides_no_other_and_draws_none_after_it() {
    assert_eq!(codes("film: 8 by 8"), ["QRT0705"]);
    // Errors that depend on a faulty constant are not reported.
    assert_eq!(
        codes("const W: f64 = 2 * ; film: W x W, material m: dielectric { ior: W - 1 }"),
        ["QRT0400"]
    );
    assert_eq!(
        codes("const W: f64 = 8 +; film: W x W, material m: dielectric { ior: 0 }"),
        ["QRT0400", "QRT0201"]
    );
    // A material that cannot be read counts as present.
    let rest = "film: 8x8, material m: , triangle: m { (0, 0, 0), (1, 0, 0), (0, 1, 0) },
                triangle: n { (0, 0, 0), (1, 0, 0), (2, 0, 0) }";
    assert_eq!(codes(rest), ["QRT0705", "QRT0206", "QRT0302"]);
    assert_eq!(
        codes("film: 8x8, comparator { bits 8 }, depth { bits; (2, 2) }"),
        ["QRT0707", "QRT0707"]
    );
}

#[test]
fn points_stand_first_and_keys_behind_them() {
    let triangle = |inner: &str| {
        codes(&format!(
            "film: 8 x 8, material m: mirror {{ reflectance: rgb(1, 1, 1) }}, triangle: m {{ {inner} }}"
        ))
    };
    let points = "(0, 0, 0), (1, 0, 0), (0, 1, 0)";
    assert!(triangle(&format!("{points}, scale: 2, translate: (0, 0, 1)")).is_empty());
    for wrong in [
        format!("vertices: [{points}]"),
        format!("scale: 2, {points}"),
        format!("{points}, vertices: [{points}]"),
    ] {
        assert_eq!(triangle(&wrong), ["QRT0705"], "{wrong}");
    }
    assert_eq!(triangle(&format!("{points}, material: m")), ["QRT0721"]);
    assert_eq!(triangle(&format!("{points} scale: 2")), ["QRT0706"]);
}

#[test]
fn loops_tell_each_error_once() {
    let rest = "film: 8x8, for i in 0..1000 {
        triangle: whit { (0, 0, 0), (1, 0, 0), (0, 1, 0) },
        triangle { (0, 0, 0), (1, 0, 0), (0, 1, K) },
    }";
    assert_eq!(codes(rest), ["QRT0206", "QRT0121", "QRT0712"]);
}

#[test]
fn another_macros_variables_keep_their_precedence() {
    let two = Group::new(Delimiter::None, "1 + 1".parse().unwrap());
    let product: TokenStream = [TokenTree::from(two)].into_iter().collect();
    let film = quote::quote!(scene Room {
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 },
        film: 3 * #product x 8,
    });
    let mut table = crate::scene::Table::default();
    let mut faults = crate::scene::Faults::default();
    let scenes = crate::scene::read(film, Path::new(""), &mut table, &mut faults);
    assert_eq!(scenes[0].1.as_ref().unwrap().scene().film.width, 6);
}

#[test]
fn an_expansion_holds_the_scene_and_its_files() {
    let text = "pub scene Knot from \"scenes-yaml/knot.yaml\"";
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let out = crate::scene::expand(text.parse().unwrap(), &root).to_string();
    assert!(syn::parse_str::<syn::File>(&out).is_ok(), "{out}");
    for part in [
        "pub struct Knot",
        "include_bytes",
        "knot.yaml",
        "(\"meshes/knot.obj\" ,",
    ] {
        assert!(out.contains(part), "{part}: {out}");
    }
    // With errors, the expansion has the type, and the errors.
    let out = crate::scene::expand("scene Room { film: 0x8 }".parse().unwrap(), &root).to_string();
    assert!(syn::parse_str::<syn::File>(&out).is_ok(), "{out}");
    for part in ["type Room", "compile_error"] {
        assert!(out.contains(part), "{part}: {out}");
    }
}

/// Collects all tokens of a stream, brackets separately, as texts that can be joined again.
fn pieces(stream: TokenStream, out: &mut Vec<String>) {
    for tree in stream {
        let TokenTree::Group(group) = &tree else {
            out.push(tree.to_string());
            continue;
        };
        let (open, close) = match group.delimiter() {
            Delimiter::Parenthesis => ("(", ")"),
            Delimiter::Brace => ("{", "}"),
            Delimiter::Bracket => ("[", "]"),
            Delimiter::None => ("", ""),
        };
        out.push(open.to_owned());
        pieces(group.stream(), out);
        out.push(close.to_owned());
    }
}

#[test]
fn no_missing_or_repeated_token_makes_it_panic() {
    let text = "pub scene Room<Fixed<2, 14>> {
        name: \"room\", const GREY: f64 = 0.5;
        camera: perspective { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 }, film: 8 x 8,
        material white: lambertian { albedo: rgb(GREY, GREY, GREY) },
        material cloth: bsdf { map: |u, v| (u, v, 1 - u), value: rgb(u, 1, GREY), },
        for i in 0..2 { quad floor: white { (i, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0) }, }
        mesh knot: white { obj: \"none.obj\", scale: -1 },
        sampling { sequence: digital_net }, depth primary { bits: (2, 2), map: auto },
    } scene Other from \"none.yaml\"";
    let mut all = Vec::new();
    pieces(text.parse().unwrap(), &mut all);
    for at in 0..all.len() {
        for put in [
            None,
            Some(","),
            Some(":"),
            Some("x"),
            Some("1"),
            Some("{}"),
            Some("(,)"),
        ] {
            let mut some = all.clone();
            match put {
                None => drop(some.remove(at)),
                Some(put) => some[at] = put.to_owned(),
            }
            // Brackets that do not match never reach the macro.
            let Ok(stream) = some.join(" ").parse::<TokenStream>() else {
                continue;
            };
            let out = crate::scene::expand(stream, Path::new("")).to_string();
            assert!(out.contains("compile_error"), "{}", some.join(" "));
        }
    }
}
