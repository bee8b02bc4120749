//! Tests of circuits against their definitions, by a plain state vector.

use super::Window;
use super::*;
use crate::{Gate, GateCircuit, Qubit};
use proptest::prelude::*;
use std::convert::Infallible;
use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

type Amplitude = [f64; 2];

fn times(a: Amplitude, b: Amplitude) -> Amplitude {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// All amplitudes; each gate changes them by its definition.
struct Plain(Vec<Amplitude>);

impl Plain {
    fn basis(qubits: u32, state: usize) -> Self {
        let mut all = vec![[0.0; 2]; 1 << qubits];
        all[state] = [1.0, 0.0];
        Self(all)
    }

    fn apply(&mut self, gate: QuantumGate<'_>) {
        let permute = |all: &[Amplitude], to: &dyn Fn(usize) -> usize| {
            let mut new = vec![[0.0; 2]; all.len()];
            for (state, amplitude) in all.iter().enumerate() {
                new[to(state)] = *amplitude;
            }
            new
        };
        let rotate = |all: &mut [Amplitude], target: Qubit, m: [[f64; 2]; 2]| {
            for low in (0..all.len()).filter(|state| state >> target & 1 == 0) {
                let high = low | 1 << target;
                let (a, b) = (all[low], all[high]);
                for part in 0..2 {
                    all[low][part] = m[0][0] * a[part] + m[0][1] * b[part];
                    all[high][part] = m[1][0] * a[part] + m[1][1] * b[part];
                }
            }
        };
        match gate {
            QuantumGate::X(t) => self.0 = permute(&self.0, &|s| s ^ 1 << t),
            QuantumGate::Cx(a, t) => self.0 = permute(&self.0, &|s| s ^ (s >> a & 1) << t),
            QuantumGate::Ccx(a, b, t) => {
                self.0 = permute(&self.0, &|s| s ^ (s >> a & s >> b & 1) << t);
            }
            QuantumGate::H(t) => {
                let r = FRAC_1_SQRT_2;
                rotate(&mut self.0, t, [[r, r], [r, -r]]);
            }
            QuantumGate::Ry { angle, target } => {
                let (s, c) = (angle / 2.0).sin_cos();
                rotate(&mut self.0, target, [[c, -s], [s, c]]);
            }
            QuantumGate::Phase { turns, on } => {
                let (s, c) = (TAU * turns.as_f64()).sin_cos();
                for (state, amplitude) in self.0.iter_mut().enumerate() {
                    if on.iter().all(|qubit| state >> qubit & 1 == 1) {
                        *amplitude = times(*amplitude, [c, s]);
                    }
                }
            }
        }
    }

    fn sink(&mut self) -> impl FnMut(QuantumGate<'_>) -> Result<(), Infallible> + '_ {
        |gate| {
            self.apply(gate);
            Ok(())
        }
    }

    fn is(&self, expected: &[Amplitude], what: &str) {
        for (state, (is, must)) in self.0.iter().zip(expected).enumerate() {
            let off = (is[0] - must[0]).hypot(is[1] - must[1]);
            assert!(off < 1e-14, "{what}: {state}: {is:?}, not {must:?}");
        }
    }
}

#[test]
fn phases_are_exact_at_quarters_and_right_elsewhere() {
    assert_eq!(Turns::new(0, 7).factor(), [1.0, 0.0]);
    assert_eq!(Turns::new(1, 2).factor(), [0.0, 1.0]);
    for bits in [1, 3, 5, 20, 52] {
        let size = 1_i64 << bits;
        for numerator in [
            1,
            3,
            5,
            size / 3,
            size / 2,
            size / 2 + 1,
            size - 1,
            -7,
            9 * size + 1,
        ] {
            let turns = Turns::new(numerator, bits);
            let exact = numerator.rem_euclid(size) as f64 / size as f64;
            let [cosine, sine] = turns.factor();
            assert!((cosine - (TAU * exact).cos()).abs() < 1e-15);
            assert!((sine - (TAU * exact).sin()).abs() < 1e-15);
            assert_eq!(turns.inverse().factor(), [cosine, -sine]);
            assert!(turns.as_f64() > -0.5 && turns.as_f64() <= 0.5);
        }
    }
}

#[test]
fn the_sine_window_is_what_its_formula_says() {
    for bits in 1..=10 {
        let size = 1_usize << bits;
        let register: Vec<Qubit> = (0..bits).collect();
        let mut state = Plain::basis(bits + 1, 0);
        let mut gates = 0;
        let mut sink = state.sink();
        let Ok(()) = window::prepare(Window::Sine, &register, bits, &mut |gate| {
            gates += 1;
            sink(gate)
        });
        drop(sink);
        assert_eq!(gates, window::gates(Window::Sine, bits));
        let points = size as f64 + 1.0;
        // The bond is the highest qubit, and zero.
        let expected: Vec<Amplitude> = (0..2 * size)
            .map(|j| {
                let inside = if j < size { 1.0 } else { 0.0 };
                let sine = (PI * (j as f64 + 1.0) / points).sin();
                [inside * (2.0 / points).sqrt() * sine, 0.0]
            })
            .collect();
        state.is(&expected, &format!("{bits} bits"));
    }
}

/// Checks that `1 - D_m` keeps its precision where a is tiny. The last bits' rotations differ
/// little from a quarter turn, by angles that the sum of the amplitudes' squares is sensitive to.
#[test]
fn the_sine_window_of_many_bits_has_the_right_first_amplitudes() {
    // Amplitude of |j> along the staircase, without the state: the bond's two amplitudes.
    let bits = 24;
    let register: Vec<Qubit> = (0..bits).collect();
    let mut rotations = Vec::new();
    let Ok(()) = window::prepare(Window::Sine, &register, bits, &mut |gate| {
        if let QuantumGate::Ry { angle, .. } = gate {
            rotations.push(angle);
        }
        Ok::<(), Infallible>(())
    });
    for j in [0_usize, 1, 2, 77, (1 << 23) + 5, (1 << 24) - 1] {
        let mut bond = [0.0, 1.0];
        for (bit, pair) in (0..bits).rev().zip(rotations.chunks(2)) {
            let [zero, one] = [pair[0] + pair[1], pair[0] - pair[1]].map(|a| (a / 2.0).sin_cos());
            // Rotated where the bond selects it, added to the bond, seen in the basis |+>, |->.
            let plus = [bond[0] * zero.1, bond[1] * one.1];
            let minus = [bond[1] * one.0, bond[0] * zero.0];
            let sign = if j >> bit & 1 == 1 { -1.0 } else { 1.0 };
            bond = [0, 1].map(|k| FRAC_1_SQRT_2 * (plus[k] + sign * minus[k]));
        }
        let points = (1_u64 << bits) as f64 + 1.0;
        let most = (2.0 / points).sqrt();
        let expected = most * (PI * (j as f64 + 1.0) / points).sin();
        assert!(bond[0].abs() < 1e-14 * most, "{j}: {bond:?}");
        assert!((bond[1] - expected).abs() < 1e-14 * most, "{j}: {bond:?}");
    }
}

#[test]
fn the_fourier_transform_is_its_matrix() {
    for bits in 1..=6 {
        let size = 1_usize << bits;
        let register: Vec<Qubit> = (0..bits).collect();
        for j in 0..size {
            let mut state = Plain::basis(bits, j);
            let mut gates = 0;
            let mut sink = state.sink();
            let Ok(()) = fourier::inverse(&register, &mut |gate| {
                gates += 1;
                sink(gate)
            });
            drop(sink);
            assert_eq!(gates, fourier::gates(bits));
            let expected: Vec<Amplitude> = (0..size)
                .map(|y| {
                    let angle = -TAU * (j * y % size) as f64 / size as f64;
                    [angle.cos(), angle.sin()].map(|part| part / (size as f64).sqrt())
                })
                .collect();
            state.is(&expected, "a column");
        }
    }
}

/// Returns two oracles of a truth table: one that looks it up, and one in its algebraic normal
/// form.
fn oracles(good: &[bool]) -> [PhaseOracle; 2] {
    let bits = good.len().ilog2();
    // Moebius' transform of the truth table.
    let mut form: Vec<bool> = good.to_vec();
    for bit in 0..bits {
        for id in (0..good.len()).filter(|id| id >> bit & 1 == 1) {
            form[id] ^= form[id ^ 1 << bit];
        }
    }
    let monomials = (0..good.len()).filter(|id| form[*id]);
    let monomials = monomials.map(|id| (0..bits).filter(|bit| id >> bit & 1 == 1).collect());
    [
        PhaseOracle::table(bits, |id| good[id as usize]).unwrap(),
        PhaseOracle::polynomial(bits, monomials.collect()).unwrap(),
    ]
}

/// Returns column `id` of `H O_0 H O_f`: after the sign, twice the mean less the amplitude itself.
fn iterated(good: &[bool], id: usize) -> Vec<Amplitude> {
    let sign = if good[id] { -1.0 } else { 1.0 };
    let mean = sign / good.len() as f64;
    let own = |other| if other == id { sign } else { 0.0 };
    (0..good.len())
        .map(|other| [2.0 * mean - own(other), 0.0])
        .collect()
}

fn is_the_iterate(good: &[bool], oracle: &PhaseOracle, conjunction: Conjunction) {
    let iterate = GroverIterate::with(oracle, conjunction);
    let control = iterate.qubits();
    for (id, held) in (0..good.len()).flat_map(|id| [(id, 0), (id, 1)]) {
        let mut state = Plain::basis(control + 1, id | held << control);
        let Ok(()) = iterate.apply(Some(control), &mut state.sink());
        let mut expected = vec![[0.0; 2]; state.0.len()];
        if held == 1 {
            for (other, amplitude) in iterated(good, id).into_iter().enumerate() {
                expected[other | 1 << control] = amplitude;
            }
        } else {
            expected[id] = [1.0, 0.0];
        }
        state.is(&expected, "controlled");
        let mut state = Plain::basis(control, id);
        let mut gates = 0;
        let mut sink = state.sink();
        let Ok(()) = iterate.apply(None, &mut |gate| {
            gates += 1;
            sink(gate)
        });
        drop(sink);
        assert_eq!(gates, iterate.gates(false));
        let mut expected = iterated(good, id);
        expected.resize(state.0.len(), [0.0; 2]);
        state.is(&expected, "alone");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn the_iterate_is_its_matrix(good in (1..=3_u32).prop_flat_map(|bits| {
        proptest::collection::vec(any::<bool>(), 1 << bits)
    })) {
        for oracle in oracles(&good) {
            for conjunction in [Conjunction::Whole, Conjunction::Toffolis] {
                is_the_iterate(&good, &oracle, conjunction);
            }
        }
    }
}

#[test]
fn a_part_has_as_many_gates_and_qubits_as_it_says() {
    let oracle = PhaseOracle::table(4, |id| id % 3 == 1).unwrap();
    for window in [Window::Rect, Window::Sine] {
        for conjunction in [Conjunction::Whole, Conjunction::Toffolis] {
            let counting = CountingCircuit::with(&oracle, 3, window, conjunction).unwrap();
            for part in [
                CircuitPart::Oracle,
                CircuitPart::Grover,
                CircuitPart::Counting,
            ] {
                let (mut gates, mut most) = (0, 0);
                let Ok(()) = counting.part(part, &mut |gate| {
                    gates += 1;
                    gate.qubits(|qubit| most = most.max(qubit + 1));
                    if conjunction == Conjunction::Toffolis
                        && let QuantumGate::Phase { on, .. } = gate
                    {
                        assert!(on.len() <= 2);
                    }
                    Ok::<(), Infallible>(())
                });
                assert_eq!(gates, counting.gates(part));
                assert_eq!(most, counting.qubits_of(part));
            }
        }
    }
}

#[test]
fn a_sink_that_refuses_ends_it() {
    let oracle = PhaseOracle::table(2, |id| id == 1).unwrap();
    let counting = CountingCircuit::new(&oracle, 5, Window::Sine).unwrap();
    for end in [0, 1, 17, counting.gates(CircuitPart::Counting) - 1] {
        let mut gates = 0;
        let ended = counting.part(CircuitPart::Counting, &mut |_| {
            gates += 1;
            if gates > end { Err(gates) } else { Ok(()) }
        });
        assert_eq!(ended, Err(end + 1));
    }
}

#[test]
fn words_are_built_in() {
    let load = |bit, target| Gate::Load {
        parameter: 0,
        bit,
        target,
    };
    let circuit = |gates: &[Gate]| GateCircuit {
        gates: gates.to_vec(),
        qubits: 3,
        ..GateCircuit::default()
    };
    let [compute, flip] = [circuit(&[load(0, 1), load(1, 2)]), circuit(&[Gate::Z(2)])];
    let oracle = PhaseOracle::new(&compute, &flip, &compute, vec![0], &[2]).unwrap();
    let mut gates = Vec::new();
    let Ok(()) = oracle.apply(None, &mut |gate| {
        gates.push(format!("{gate:?}"));
        Ok::<(), Infallible>(())
    });
    let sign = "Phase { turns: Turns { numerator: 1, bits: 1 }, on: [2] }";
    assert_eq!(gates, ["X(2)", sign, "X(2)"]);
    assert_eq!(oracle.ancillas(), [1, 2]);

    let refused = |compute: &[Gate], flip: &[Gate], ids: &[Qubit], words: &[u64]| {
        let [compute, flip] = [circuit(compute), circuit(flip)];
        PhaseOracle::new(&compute, &flip, &compute, ids.to_vec(), words).unwrap_err()
    };
    let missing = QuantumError::MissingWord {
        parameter: 0,
        bit: 1,
    };
    assert_eq!(refused(&[load(1, 1)], &[], &[0], &[]), missing);
    assert_eq!(refused(&[], &[], &[], &[]), QuantumError::NoIndex);
    let invalid = QuantumError::InvalidQubit;
    assert_eq!(refused(&[], &[], &[0, 0], &[]), invalid(0));
    assert_eq!(refused(&[Gate::X(3)], &[], &[0], &[]), invalid(3));
    assert_eq!(refused(&[Gate::Cx(1, 1)], &[], &[0], &[]), invalid(1));
    let outside = QuantumError::SignOutsideFlip(1);
    assert_eq!(refused(&[Gate::Z(1)], &[], &[0], &[]), outside);
    let bits = |bits| CountingCircuit::new(&oracle, bits, Window::Rect).map(|_| ());
    assert_eq!(bits(0), Err(QuantumError::PhaseBitsOutOfRange(0)));
    assert_eq!(bits(41), Err(QuantumError::PhaseBitsOutOfRange(41)));
    assert_eq!(bits(40), Ok(()));
    assert_eq!(PhaseOracle::table(0, |_| true), Err(QuantumError::NoIndex));
    assert!(PhaseOracle::table(21, |_| true).is_err());
    assert!(PhaseOracle::polynomial(2, vec![vec![0, 0]]).is_err());
}
