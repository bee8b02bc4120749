//! Reversible routines compute what plain integers say, on every machine, and can be undone.

use qrt::prelude::*;

/// Runs a program on all machines, which must agree, and backwards, which must lead back.
fn run_all(program: &Program, states: &[Vec<u64>]) -> Vec<Vec<u64>> {
    let result = run::on_definition(program, states).unwrap();
    assert_eq!(run::on_gates(program, states).unwrap(), result);
    assert_eq!(run::on_fixed(program, states).unwrap(), result);
    let inverse = program.inverse();
    assert_eq!(run::on_definition(&inverse, &result).unwrap(), states);
    assert_eq!(run::on_gates(&inverse, &result).unwrap(), states);
    result
}

/// All contents of registers of these widths.
fn all(widths: &[u32]) -> Vec<Vec<u64>> {
    let mut states = vec![Vec::new()];
    for width in widths {
        let longer = states.iter().flat_map(|state| {
            (0..1 << width).map(move |value| {
                let mut state = state.clone();
                state.push(value);
                state
            })
        });
        states = longer.collect();
    }
    states
}

/// Of both styles: that the routine maps each state as `expected` does, that its inverse maps it
/// back, and that the two inverses agree.
fn check(
    [forward, backward]: [fn(Style) -> Program; 2],
    states: &[Vec<u64>],
    expected: impl Fn(&[u64]) -> Vec<u64>,
) {
    for style in [Style::Lean, Style::Wide] {
        let result = run_all(&forward(style), states);
        for (state, result) in states.iter().zip(&result) {
            assert_eq!(*result, expected(state), "from {state:?}");
        }
        assert_eq!(run_all(&backward(style), &result), states);
    }
}

/// out += x^2 + 3 y
#[reversible]
fn polynomial(x: &UInt<4>, y: &UInt<4>, out: &mut UInt<10>) {
    let mut square: UInt<8> = 0;
    within! { square += x * x; }
    apply! { out += square; out += 3 * y; }
}

#[reversible]
fn undo_polynomial(x: &UInt<4>, y: &UInt<4>, out: &mut UInt<10>) {
    polynomial_inverse(x, y, out);
}

#[test]
fn a_polynomial() {
    let states: Vec<_> = all(&[4, 4])
        .into_iter()
        .map(|s| vec![s[0], s[1], 1000])
        .collect();
    check(
        [polynomial_program, undo_polynomial_program],
        &states,
        |s| vec![s[0], s[1], (s[2] + s[0] * s[0] + 3 * s[1]) % 1024],
    );
}
