//! Tests of budgets.

use super::*;
use crate::oracle::{Oracle, OracleName, OracleOptions, Oracles, call_cost};
use qrt_circuit::lower;
use qrt_scene::front::{Loaded, parse};
use qrt_syntax::codes;
use qrt_tracer::PixelClass;

fn loaded(more: &str) -> Loaded {
    let text = format!(
        "\
name: furnace
camera: {{ perspective: {{ eye: [0, 0, 1], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ sky: {{ emitter: {{ radiance: [1, 1, 1] }} }} }}
geometry: [quad: {{ vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], material: sky }}]
{more}"
    );
    parse(&text, "furnace.yaml", &[], "".as_ref()).unwrap()
}

const fn cost(channel: usize, qubits: u64, toffoli: u64) -> OracleCost {
    OracleCost {
        name: OracleName {
            channel,
            class: PixelClass::MayMeetLamp,
            of_all_pixels: true,
        },
        call: CallCost { qubits, toffoli },
    }
}

/// The oracle with the most Toffolis does not have the most qubits.
const SPENT: [OracleCost; 2] = [cost(0, 900, 12_345), cost(1, 1000, 12_000)];

#[test]
fn a_scene_without_a_budget_may_spend_anything() {
    for more in ["", "budget: {}", "budget: { qubits: 1000, toffoli: 12345 }"] {
        assert_eq!(check_budget(&loaded(more).valid, &SPENT), Ok(()), "{more}");
    }
}

#[test]
fn advice_names_a_parameter_that_is_not_yet_changed() {
    for (more, advice) in [
        ("", ["circuit.uncompute: auto", "sampling.depths"]),
        (
            "circuit: { uncompute: scoped }",
            ["circuit.uncompute: auto", "circuit.uncompute: keep"],
        ),
        (
            "circuit: { uncompute: auto }",
            ["no way to lay it out", "sampling.depths"],
        ),
        (
            "circuit: { nearest: paper }",
            ["circuit.uncompute: auto", "circuit.nearest: running"],
        ),
    ] {
        let loaded = loaded(&format!(
            "{more}\nbudget: {{ qubits: 999, toffoli: 10000 }}"
        ));
        let problems = check_budget(&loaded.valid, &SPENT).unwrap_err();
        let codes: Vec<_> = problems.iter().map(Problem::code).collect();
        assert_eq!(codes, [codes::BUDGET_QUBITS, codes::BUDGET_TOFFOLI]);
        for (problem, advice) in problems.iter().zip(advice) {
            assert!(
                problem.description().help.unwrap().contains(advice),
                "{problem:?}"
            );
        }
        let text = loaded.report(problems).to_string();
        assert!(
            text.contains("the circuit has 12,345 Toffoli gates, 2,345 more"),
            "{text}"
        );
        assert!(text.contains("--> furnace.yaml:7:19"), "{text}");
    }
}

#[test]
fn each_limit_holds_for_every_oracle() {
    for (more, found) in [
        ("budget: { qubits: 999 }", codes::BUDGET_QUBITS),
        ("budget: { toffoli: 12344 }", codes::BUDGET_TOFFOLI),
    ] {
        let problems = check_budget(&loaded(more).valid, &SPENT).unwrap_err();
        let codes: Vec<_> = problems.iter().map(Problem::code).collect();
        assert_eq!(codes, [found]);
    }
}

/// A tilted floor of one material under a lamp. The material is on line 5.
fn tilted(material: &str) -> Loaded {
    let text = format!(
        "\
name: tilted
camera: {{ perspective: {{ eye: [0, 1, 5], target: [0, 1, 0], vfov: 40 }} }}
film: {{ width: 2, height: 2 }}
materials:
  steep: {{ {material} }}
  lamp: {{ emitter: {{ radiance: [3, 2, 1] }} }}
geometry:
  - triangle: {{ vertices: [[-2, 0, 0], [2, 1.5, 0.4], [2, 0.7, 2]], material: steep }}
  - quad: {{ vertices: [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]], material: lamp }}
sampling:
  path_bits: 4
  lights: none
  depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4], map: uniform-hemisphere }}, {{ bits: [4, 4], map: uniform-hemisphere }}]
"
    );
    parse(&text, "tilted.yaml", &[], "".as_ref()).unwrap_or_else(|report| panic!("{report}"))
}

#[test]
fn what_is_found_on_all_cores_is_what_is_found_on_one() {
    let loaded =
        tilted("phong: { diffuse: [0.2, 0.3, 0.4], specular: [0.5, 0.5, 0.1], exponent: 12 }");
    for uncompute in [Uncompute::Keep, Uncompute::Scoped] {
        let mut scene = loaded.valid.scene().clone();
        scene.circuit.uncompute = uncompute;
        let scene = scene.validate("".as_ref()).unwrap();
        let (channels, rgb) = Oracle::all(&scene).unwrap();
        let oracles = Oracles::new(&scene);
        let sooner = oracles.all_channels(PixelClass::default()).unwrap();
        assert_eq!(rgb.program, sooner.program);
        // No lamp is sampled: there is one class.
        let costs = oracles.costs_of(PixelClass::default()).unwrap();
        assert_eq!(oracles.costs().unwrap(), costs);
        let cost = OracleCost::most_expensive(costs).unwrap().call;
        assert_eq!(call_cost(&channels), cost);
        let toffoli = |oracle: &Oracle| lower::toffoli(&oracle.whole(0));
        assert_eq!(channels.iter().map(toffoli).max(), Some(cost.toffoli));
        let mut of_most = channels
            .iter()
            .filter(|oracle| toffoli(oracle) == cost.toffoli);
        let qubits = of_most.next().map(|oracle| u64::from(oracle.qubits()));
        assert_eq!(qubits, Some(cost.qubits));
    }
}

#[test]
fn classes_that_are_compiled_alone_cost_what_they_cost_among_all() {
    let path = "{ bits: [4, 4], map: uniform-hemisphere }";
    let text = tilted("lambertian: { albedo: [0.2, 0.3, 0.4] }")
        .source
        .text;
    let text = text.replace(
        &format!("{path}, {path}"),
        "{ bits: [4, 4], light: [4, 4] }",
    );
    let text = text.replace("  lights: none\n", "");
    let scene = parse(&text, "tilted.yaml", &[], "".as_ref()).unwrap().valid;
    let costs = Oracles::new(&scene).costs().unwrap();
    assert_eq!(costs.len(), 6);
    let alone = PixelClass::ALL.map(|class| Oracles::new(&scene).costs_of(class).unwrap());
    assert_eq!(alone.concat(), costs);
}

/// A cosine is at most 1, and so are its powers.
#[test]
fn a_phong_lobe_of_any_exponent_fits_under_a_uniform_map() {
    for exponent in ["12", "40", "12.5", "2000"] {
        let material = format!(
            "phong: {{ diffuse: [0.2, 0.2, 0.2], specular: [0.5, 0.5, 0.5], exponent: {exponent} }}"
        );
        let loaded = tilted(&material);
        let oracle = Oracle::rgb(&loaded.valid, OracleOptions::default());
        assert!(oracle.is_ok(), "{exponent}: {:?}", oracle.err());
    }
}

/// The error names the value and its material, at the value, and its advice helps.
#[test]
fn a_value_that_takes_too_wide_a_number_is_named() {
    let bsdf = |part: &str| {
        let map = r#"["sqrt(1-u^2)*cos(2*pi*v)", "sqrt(1-u^2)*sin(2*pi*v)", "u"]"#;
        tilted(&format!(
            r#"bsdf: {{ map: {map}, jacobian: auto, value: ["0.1/pi*({part})^8/(1 + ({part})^8)"] }}"#
        ))
    };
    let wide = bsdf("1e6*cos_i*cos_o");
    let oracle = Oracle::rgb(&wide.valid, OracleOptions::default());
    let error = oracle.err().unwrap();
    let text = wide.report(vec![error.problem()]).to_string();
    for expected in [
        "error[QRT0611]: a number that `value` of the material `steep` takes on the way needs ",
        "--> tilted.yaml:5:",
        "help: keep every part of it below 2^46, as in `min(1 / x, 100)`",
    ] {
        assert!(text.contains(expected), "{text}");
    }
    let narrow = bsdf("min(1e6*cos_i*cos_o, 3)");
    let oracle = Oracle::rgb(&narrow.valid, OracleOptions::default());
    assert!(oracle.is_ok(), "{:?}", oracle.err());
}

#[test]
fn what_fits_no_register_is_an_error_at_its_parameter() {
    let wide = OracleError::Build(BuildError::TooWide {
        what: "a constant of the scene",
        bits: 70,
        fraction: 30,
        value: None,
    });
    let text = loaded("precision: { fraction: 30 }").report(vec![wide.problem()]);
    let text = text.to_string();
    for expected in [
        "error[QRT0611]: a constant of the scene needs 70 bits",
        "--> furnace.yaml:6:24",
        "help: choose a smaller `precision.fraction`",
    ] {
        assert!(text.contains(expected), "{text}");
    }
    let quotient = OracleError::Build(BuildError::UnboundedQuotient);
    let text = loaded("").report(vec![quotient.problem()]).to_string();
    assert!(
        text.contains("error[QRT0610]: ") && text.contains("help: keep the divisor away"),
        "{text}"
    );
}
