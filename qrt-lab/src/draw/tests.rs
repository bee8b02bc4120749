//! Tests of the drawings of a small scene's oracle.

use super::*;
use qrt_core::inspect::{CallDiagram, CallPart, Inspection, grouped};
use qrt_core::oracle::Oracles;
use qrt_drawing::escaped;
use qrt_scene::front::parse;
use qrt_tracer::PixelClass;

/// A lamp over a floor: two rays for each path.
const SCENE: &str = "
name: lit-floor
camera: { perspective: { eye: [0, 1, 2], target: [0, 0, 0], vfov: 45 } }
film: { width: 4, height: 4 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
  sky: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor }
  - quad: { vertices: [[-9, 5, -9], [9, 5, -9], [9, 5, 9], [-9, 5, 9]], material: sky }
sampling: { path_bits: 6, depths: [{ bits: [3, 3] }, { bits: [3, 3] }], lights: none }
precision: { fraction: 10 }
comparator: { bits: 5 }
";

fn inspection(sets: &[&str]) -> Inspection {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    let scene = parse(SCENE, "lit-floor.yaml", &sets, "".as_ref()).unwrap();
    let oracles = Oracles::new(&scene.valid);
    Inspection::of_class(&oracles, None, PixelClass::default()).unwrap()
}

fn both() -> [Inspection; 2] {
    ["keep", "scoped"].map(|how| inspection(&[&format!("circuit.uncompute={how}")]))
}

#[test]
fn the_drawing_for_terminals_has_a_line_for_each_box_and_fits() {
    for inspection in both() {
        let frame = CallDiagram::new(&inspection);
        let text = frame_text(&frame);
        assert!(
            text.lines().all(|line| line.chars().count() <= 100),
            "{text}"
        );
        let boxes: Vec<&str> = text.lines().skip(frame.wires.len() + 1).collect();
        assert_eq!(boxes.len(), frame.boxes.len());
        for (line, item) in boxes.iter().zip(&frame.boxes) {
            let mark = if item.inverse { "\u{2020}" } else { "" };
            assert!(line.starts_with(&format!("{}{mark} ", item.name)), "{line}");
            assert!(line.ends_with(&grouped(item.cost.toffoli)), "{line}");
            let signs = |sign| line.matches(sign).count();
            assert_eq!(signs('\u{2588}'), item.writes.len(), "{line}");
            assert_eq!(signs('\u{25cf}'), item.reads.len(), "{line}");
        }
    }
}

#[test]
fn wires_of_a_depth_are_drawn_as_one_where_they_are_too_many() {
    let depths = ["{ bits: [1, 1] }"; 8].join(", ");
    let inspection = inspection(&[&format!("sampling.depths=[{depths}]")]);
    let text = frame_text(&CallDiagram::new(&inspection));
    assert!(text.contains(" depth 7: "), "{text}");
    assert!(
        text.lines().all(|line| line.chars().count() <= 100),
        "{text}"
    );
}

#[test]
fn each_register_is_in_the_map_where_its_layout_has_it() {
    for inspection in both() {
        let map = registers(&inspection, "lit-floor").svg();
        for lifetime in &inspection.layout.lifetimes {
            let register = &inspection.whole.registers[lifetime.register.index()];
            let ty = register.ty.name(register.width);
            let name = format!("<title>{}, ", escaped(&format!("{}: {ty}", register.name)));
            assert!(map.contains(&name), "{name}");
        }
        let rectangles = map.matches("</title></rect>").count();
        let bars = inspection.stages().len() + CallPart::ALL.len();
        assert_eq!(rectangles, inspection.layout.lifetimes.len() + bars);
    }
}

#[test]
fn drawings_are_self_contained_and_know_the_dark() {
    let inspection = inspection(&[]);
    for drawing in [
        registers(&inspection, "a <&\"> b\u{7}").svg(),
        frame(&inspection, "a <&\"> b\u{7}").svg(),
    ] {
        assert!(drawing.contains("a &lt;&amp;&quot;&gt; b\u{fffd}"));
        assert!(drawing.contains("prefers-color-scheme:dark"));
        for foreign in ["<script", "href", "url(", "@import", "NaN", "inf"] {
            assert!(!drawing.contains(foreign), "{foreign}");
        }
    }
}

#[test]
fn a_call_without_a_search_has_a_drawing_too() {
    let inspection = inspection(&["geometry=[]"]);
    assert!(
        registers(&inspection, "empty")
            .svg()
            .contains(">comparator<")
    );
    assert!(frame(&inspection, "empty").svg().contains(">Z<"));
}
