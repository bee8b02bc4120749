//! The budget of a scene's circuit, and the problems of a scene that has no circuit.

use super::{MOST_FACES, Oracle, OracleCost, OracleError};
use crate::compile::{self, BuildError};
use qrt_circuit::lower::{self, Figures};
use qrt_scene::syntax::{Circuit, Path, Problem, Problems};
use qrt_scene::valid::ValidScene;
use qrt_scene::{Nearest, Uncompute};

/// Costs of one call of an oracle: compute, compare and flip, uncompute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CallCost {
    /// Number of qubits that a call needs: the maximum in use at any time.
    pub qubits: u64,
    /// Number of Toffoli gates of a call.
    pub toffoli: u64,
}

impl CallCost {
    /// The most qubits and the most Toffolis of a call of any oracle in `costs`. The two may be of
    /// different oracles. Both are 0 if there are none.
    pub fn greatest(costs: &[OracleCost]) -> Self {
        let calls = || costs.iter().map(|cost| cost.call);
        Self {
            qubits: calls().map(|call| call.qubits).max().unwrap_or(0),
            toffoli: calls().map(|call| call.toffoli).max().unwrap_or(0),
        }
    }
}

/// The cost of a call of the most expensive oracle in `channels`, each of which is of one channel.
pub fn call_cost(channels: &[Oracle]) -> CallCost {
    let known = &mut compile::Known::default();
    let priced = channels.iter().map(|oracle| {
        let figures = figures(oracle, known);
        (toffoli(oracle, &figures), oracle, figures)
    });
    // The first of equals.
    let dearest = priced.reduce(|most, next| if most.0 < next.0 { next } else { most });
    let none = CallCost {
        qubits: 0,
        toffoli: 0,
    };
    dearest.map_or(none, |(_, oracle, figures)| cost_by(oracle, &figures))
}

/// The figures of an oracle's operations, followed by those of [`Oracle::flip`] of channel number 0.
pub(super) fn figures(oracle: &Oracle, known: &mut compile::Known) -> Vec<Figures> {
    let program = &oracle.program;
    let mut figures = known.figures(program.ops.iter(), &program.registers);
    // Each channel compares a number of its own, into the same flag.
    let flip = oracle.flip_steps(0);
    let width = |register| program.width(register);
    figures.extend(flip.ops.iter().map(|op| known.alike.figures(op, width)));
    figures
}

/// The cost of a call, by the figures of its operations.
pub(super) fn cost_by(oracle: &Oracle, figures: &[Figures]) -> CallCost {
    let qubits = lower::most_qubits_by(&oracle.upto_flip(), |op| figures[op].borrowed);
    CallCost {
        qubits: u64::from(qubits),
        toffoli: toffoli(oracle, figures),
    }
}

fn toffoli(oracle: &Oracle, figures: &[Figures]) -> u64 {
    let program = &oracle.program;
    let toffoli = |op: usize| figures[op].costs[0].toffoli;
    let once = program.instructions.iter();
    let once: u64 = once
        .map(|instruction| toffoli(instruction.op as usize))
        .sum();
    let flip = oracle.flip_steps(0);
    let steps = flip.order.iter();
    let steps = steps.map(|(step, _)| toffoli(program.ops.len() + *step as usize));
    2 * once + steps.sum::<u64>()
}

/// Reports the limits of the scene's `budget` that `costs` exceed, each with advice. `costs` are those
/// of [`oracle_costs`](super::oracle_costs), or of the oracles that are run. Each limit holds for every
/// oracle. [`qrt_scene::front::Loaded::report`] shows the problems in the scene.
///
/// # Errors
/// At least one limit is exceeded.
pub fn check_budget(scene: &ValidScene, costs: &[OracleCost]) -> Result<(), Vec<Problem>> {
    let written = scene.scene();
    let Some(budget) = written.budget else {
        return Ok(());
    };
    let spent = CallCost::greatest(costs);
    let uncompute = written.circuit.uncompute;
    let scoped = !matches!(uncompute, Uncompute::Keep | Uncompute::Auto);
    let path = Path::root().key("budget");
    let mut problems = Problems::default();
    let used = spent.qubits;
    if let Some(most) = budget.qubits.filter(|&most| most < used) {
        let what = Circuit::Qubits {
            used,
            most,
            auto: uncompute == Uncompute::Auto,
        };
        problems.add(path.key("qubits"), what);
    }
    let used = spent.toffoli;
    if let Some(most) = budget.toffoli.filter(|&most| most < used) {
        let what = Circuit::Toffolis {
            used,
            most,
            scoped,
            running: written.circuit.nearest == Nearest::Running,
        };
        problems.add(path.key("toffoli"), what);
    }
    problems.result(())
}

impl OracleError {
    /// Converts this error to a problem of the scene, for [`qrt_scene::front::Loaded::report`].
    pub fn problem(&self) -> Problem {
        let root = Path::root();
        match self {
            Self::Build(error) => {
                let path = match error {
                    BuildError::UnboundedQuotient | BuildError::UnboundedFunction => {
                        root.key("materials")
                    }
                    BuildError::TooWide {
                        value: Some(value), ..
                    } => {
                        let material = root.key("materials").key(&value.material);
                        material.key(value.kind).key(value.key)
                    }
                    BuildError::TooWide { .. } => root.key("precision").key("fraction"),
                };
                Problem::new(path, error.problem())
            }
            Self::Sampling(error) => Problem::new(root.key("sampling"), error.problem()),
            &Self::TooManyFaces { faces } => {
                let most = MOST_FACES;
                let what = Circuit::TooManyFaces { faces, most };
                Problem::new(root.key("geometry"), what)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::{
        Options, Oracle, OracleName, oracle_costs, oracle_costs_knowing, oracle_costs_of_class,
    };
    use crate::tracer::PixelClass;
    use qrt_scene::front::{Loaded, parse};
    use qrt_scene::syntax::codes;

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
            let (sooner, costs) = Oracle::rgb_and_costs(&scene).unwrap();
            assert_eq!(rgb.program, sooner.program);
            // No lamp is sampled: there is one class.
            assert_eq!(oracle_costs(&scene).unwrap(), costs);
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
        let scene = parse(&text, "tilted.yaml", &[], "".as_ref()).unwrap().valid;
        let costs = oracle_costs(&scene).unwrap();
        assert_eq!(costs.len(), 6);
        let alone = PixelClass::ALL.map(|class| oracle_costs_of_class(&scene, class).unwrap());
        assert_eq!(alone.concat(), costs);
        let (_, known) = Oracle::rgb_and_costs(&scene).unwrap();
        assert_eq!(costs[..3], known);
        assert_eq!(oracle_costs_knowing(&scene, &known).unwrap(), costs);
    }

    /// A cosine is at most 1, and so are its powers.
    #[test]
    fn a_phong_lobe_of_any_exponent_fits_under_a_uniform_map() {
        for exponent in ["12", "40", "12.5", "2000"] {
            let material = format!(
                "phong: {{ diffuse: [0.2, 0.2, 0.2], specular: [0.5, 0.5, 0.5], exponent: {exponent} }}"
            );
            let loaded = tilted(&material);
            let oracle = Oracle::rgb(&loaded.valid, Options::default());
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
        let oracle = Oracle::rgb(&wide.valid, Options::default());
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
        let oracle = Oracle::rgb(&narrow.valid, Options::default());
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
}
