use super::*;
use qrt_runtime::render::{RenderOptions, render};
use qrt_scene::Estimator;
use qrt_scene::front::parse;

/// A floor under a lamp. Some pixels see the lamp itself, others its light reflected by the floor.
const FLOOR: &str = "
name: floor
camera: { perspective: { eye: [0, 2, 4], target: [0, 0.4, 0], vfov: 40 } }
film: { width: 9, height: 7 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.5, 0] } }
  lamp: { emitter: { radiance: [4, 3, 0] } }
geometry:
  - quad: { vertices: [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]], material: floor }
  - quad: { vertices: [[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]], material: lamp }
sampling: { path_bits: 6, depths: [{ bits: [5, 5] }, { bits: [5, 5], light: [5, 5] }] }
";

fn list(answer: &Answer, name: &str) -> Vec<f64> {
    let error = answer.text_of("error");
    answer
        .list_of(name)
        .unwrap_or_else(|| panic!("{error:?}"))
        .to_vec()
}

/// The pictures of a scene, traced in steps by `parts` playgrounds: exact, and estimated.
fn shown(model: f64, parts: usize, estimator: &str) -> [Vec<f64>; 2] {
    let mut pictures = [vec![0.0; 9 * 7 * 3], vec![0.0; 9 * 7 * 3]];
    for part in 0..parts {
        let mut playground = Playground::new(&[], Files::held(&[]));
        let numbers = [model, 3.0, part as f64, parts as f64];
        let about = playground.call("open", &numbers, FLOOR);
        let pixels = about.number_of("pixels").unwrap() as usize;
        for bits in [0.0, 2.0, 3.0, 9.0] {
            for first in (0..pixels).step_by(5) {
                playground.call("trace", &[first as f64, 5.0, bits], "");
            }
        }
        let all = [0.0, pixels as f64];
        let traced = playground.call("trace", &[all[0], all[1], 6.0], "");
        let counted = playground.call("estimate", &[all[0], all[1], 7.0], estimator);
        for (picture, answer) in pictures.iter_mut().zip([&traced, &counted]) {
            for (place, colour) in list(answer, "radiance").chunks(3).enumerate() {
                let pixel = part + place * parts;
                picture[3 * pixel..3 * pixel + 3].copy_from_slice(colour);
            }
        }
        let (sum, squares) = (counted.number_of("sum"), counted.number_of("squares"));
        assert!(sum > Some(0.0) && squares > Some(0.0));
        assert!(counted.number_of("queries") > Some(0.0));
    }
    pictures
}

fn rendered(model: Model, estimator: &str) -> Vec<f64> {
    let sets = ["counting.phase_bits=7".to_owned()];
    let scene = parse(FLOOR, "floor.yaml", &sets, "".as_ref())
        .unwrap()
        .valid;
    let options = RenderOptions {
        model: Some(model),
        seed: 3,
        estimator: Estimator::from_name(estimator),
        ..RenderOptions::default()
    };
    render(&scene, &options).unwrap().image.pixels.concat()
}

#[test]
fn pictures_are_those_that_are_rendered_whoever_shares_them() {
    for (number, model) in [(0.0, Model::Real), (1.0, Model::Fixed)] {
        for (parts, estimator) in [(1, "adaptive-bayes"), (3, "sine"), (2, "auto")] {
            let [exact, counted] = shown(number, parts, estimator);
            for (found, expected) in exact.iter().zip(rendered(model, "exact")) {
                assert!(
                    (found - expected).abs() < 1e-12,
                    "{}: {found} {expected}",
                    model.name()
                );
            }
            assert_eq!(
                counted,
                rendered(model, estimator),
                "{} {estimator}",
                model.name()
            );
        }
    }
}

#[test]
fn both_pictures_lie_side_by_side_with_their_distance() {
    let mut playground = Playground::new(&[], Files::held(&[]));
    let open = playground.call("open", &[2.0, 3.0, 0.0, 1.0], FLOOR);
    let pixels = open.number_of("pixels").unwrap();
    let early = playground.call("beside", &[0.0, 5.0, 6.0], "");
    assert!(early.text_of("error").unwrap().contains("traced first"));
    let real = list(
        &playground.call("trace", &[0.0, pixels, 6.0], ""),
        "radiance",
    );
    // The refused call had traced some pixels: an answer covers only pixels with equally many
    // paths.
    let (mut fixed, mut sum, mut squares) = (Vec::new(), 0.0, 0.0);
    while fixed.len() < real.len() {
        let first = (fixed.len() / 3) as f64;
        let answer = playground.call("beside", &[first, pixels, 6.0], "");
        fixed.extend(list(&answer, "radiance"));
        sum += answer.number_of("sum").unwrap();
        squares += answer.number_of("squares").unwrap();
    }
    for (model, found) in [(Model::Real, &real), (Model::Fixed, &fixed)] {
        for (found, expected) in found.iter().zip(rendered(model, "exact")) {
            assert!((found - expected).abs() < 1e-12, "{}", model.name());
        }
    }
    let off = real.iter().zip(&fixed).map(|(a, b)| (a - b) * (a - b));
    let off: f64 = off.sum();
    assert!(off > 0.0 && (squares - off).abs() < 1e-12 * off);
    assert!((sum - real.iter().sum::<f64>()).abs() < 1e-9);
    // The estimate is that of the real model.
    let counted = playground.call("estimate", &[0.0, pixels, 7.0], "sine");
    assert_eq!(list(&counted, "radiance"), rendered(Model::Real, "sine"));
    // With one model, there is no second picture.
    playground.call("open", &[1.0, 3.0, 0.0, 1.0], FLOOR);
    let alone = playground.call("beside", &[0.0, 5.0, 6.0], "");
    assert!(alone.text_of("error").unwrap().contains("no picture"));
}

#[test]
fn problems_are_at_their_places_as_scripts_count() {
    let text = FLOOR.replace("name: floor", "name: \"\u{1f308} über\"");
    let wrong = text.replace("albedo: [0.8", "albdo: [0.8");
    let mut playground = Playground::new(&[], Files::held(&[]));
    let fine = playground.call("check", &[], &text);
    assert_eq!(fine.number_of("valid"), Some(1.0));
    assert_eq!(fine.number_of("width"), Some(9.0));
    let answer = playground.call("check", &[], &wrong);
    assert_eq!(answer.number_of("valid"), Some(0.0));
    assert_eq!(answer.number_of("problems"), Some(1.0));
    let units: Vec<u16> = wrong.encode_utf16().collect();
    let [from, to] = ["from", "to"].map(|name| list(&answer, name)[0] as usize);
    assert_eq!(String::from_utf16_lossy(&units[from..to]), "albdo");
    assert_eq!(list(&answer, "line"), [6.0]);
    let code = answer.text_of("codes").unwrap();
    assert!(code.starts_with("QRT0"), "{code}");
    assert!(answer.text_of("helps").is_some_and(|help| !help.is_empty()));
    // Checks warnings, and meshes that exist or don't.
    let dark = text.replace("radiance: [4, 3, 0]", "radiance: [0, 0, 0]");
    let answer = playground.call("check", &[], &dark);
    let told = (answer.number_of("valid"), answer.number_of("problems"));
    assert!(told.0 == Some(0.0) || told.1 > Some(0.0), "{told:?}");
    let mesh = text.replace(
        "sampling:",
        "  - mesh: { obj: a.obj, material: floor }\nsampling:",
    );
    let missing = playground.call("check", &[], &mesh);
    assert_eq!(missing.number_of("valid"), Some(0.0));
    let files: &[(&str, &[u8])] = &[("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")];
    let found = Playground::new(&[], Files::held(files)).call("check", &[], &mesh);
    assert_eq!(found.number_of("polygons"), Some(3.0));
}

#[test]
fn costs_are_those_that_are_inspected() {
    use qrt_core::inspect::Inspection;
    let scene = parse(FLOOR, "floor.yaml", &[], "".as_ref()).unwrap().valid;
    let inspection = Inspection::most_expensive(&Oracles::new(&scene), None).unwrap();
    let answer = Playground::new(&[], Files::held(&[])).call("cost", &[], FLOOR);
    let toffoli = inspection.total().toffoli as f64;
    assert_eq!(answer.number_of("toffoli"), Some(toffoli));
    assert_eq!(answer.number_of("qubits"), Some(inspection.qubits.into()));
    let stages = list(&answer, "toffolis");
    assert_eq!(
        answer.text_of("stages").unwrap().lines().count(),
        stages.len()
    );
    assert!(stages.iter().sum::<f64>() < toffoli / 1.9);
    assert!(
        answer
            .text_of("svg")
            .is_some_and(|svg| svg.contains("<svg"))
    );
}

#[test]
fn a_pixel_is_that_of_the_picture() {
    let [exact, _] = shown(0.0, 1, "");
    let mut playground = Playground::new(&[], Files::held(&[]));
    for [x, y] in [[4, 1], [4, 5], [0, 0]] {
        let numbers = [f64::from(x), f64::from(y), 3.0, 8.0];
        let answer = playground.call("pixel", &numbers, FLOOR);
        let place = 3 * (9 * y + x) as usize;
        for (found, expected) in list(&answer, "mean").iter().zip(&exact[place..]) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert_eq!(list(&answer, "histogram").iter().sum::<f64>(), 64.0);
        let probability: f64 = list(&answer, "probability").iter().sum();
        assert!((probability - 1.0).abs() < 1e-12);
        let told = answer.text_of("brightest").unwrap();
        let lit = exact[place] > 0.0;
        assert_eq!(told.is_empty(), !lit, "{told}");
        if lit {
            assert!(told.contains("floor") || told.contains("lamp"), "{told}");
        }
    }
}

#[test]
fn what_cannot_be_answered_says_why() {
    let mut playground = Playground::new(&[], Files::held(&[]));
    let mut refused = |name: &str, numbers: &[f64], text: &str| -> String {
        let answer = playground.call(name, numbers, text);
        answer.text_of("error").unwrap_or_default().to_owned()
    };
    assert!(refused("example", &[], "box").contains("no example `box`"));
    assert!(refused("nothing", &[], "").contains("no call `nothing`"));
    assert!(refused("trace", &[0.0, 1.0, 1.0], "").contains("no picture"));
    assert!(refused("open", &[0.0], FLOOR).contains("`open` needs"));
    assert!(refused("open", &[0.0, f64::NAN, 0.0, 1.0], FLOOR).contains("`open` needs"));
    assert!(refused("open", &[0.0, 0.0, 0.0, 1.0], "name: 7").contains("scene.yaml:1:7"));
    let huge = FLOOR.replace("width: 9", "width: 60000");
    assert!(refused("open", &[0.0, 0.0, 0.0, 1.0], &huge).contains("qrt render"));
    assert_eq!(refused("open", &[0.0, 0.0, 0.0, 1.0], FLOOR), "");
    assert!(refused("estimate", &[0.0, 1.0, 7.0], "").contains("traced first"));
    for nothing in [[1.0, 0.0, 7.0], [1e6, 1.0, 7.0]] {
        assert_eq!(refused("estimate", &nothing, ""), "");
        assert_eq!(refused("trace", &nothing, ""), "");
    }
    assert_eq!(refused("trace", &[0.0, 1.0, 40.0], ""), "");
    assert!(refused("estimate", &[0.0, 1.0, 41.0], "").contains("phase"));
    assert!(refused("estimate", &[0.0, 1.0, 7.0], "exact").contains("no estimator"));
    assert_eq!(refused("estimate", &[0.0, 1.0, 7.0], "iqae"), "");
    assert!(refused("pixel", &[9.0, 0.0, 0.0, 1.0], FLOOR).contains("no pixel 9, 0"));
    // The playground ignores an accuracy.
    let asked = FLOOR.replace(
        "sampling: { path_bits: 6, ",
        "accuracy: { error: 0.1, confidence: 0.9 }\nsampling: { ",
    );
    assert_eq!(refused("open", &[0.0, 0.0, 0.0, 1.0], &asked), "");
}
