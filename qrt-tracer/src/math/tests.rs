//! Compares formulas with Rust's own, and the order of calls with the order of operands. Each
//! grouping of the numbers gives a different result.

use crate::Arith;
use crate::scalar::Scalar;

#[test]
fn operators_bind_and_group_as_in_rust() {
    let cx = &mut Scalar::default();
    let (a, b, c, d) = (3.0_f64, 5.0_f64, 0.7_f64, 11.0_f64);
    let cases = [
        (math!(cx, a + b * c), a + b * c),
        (math!(cx, a * b + c), a * b + c),
        (math!(cx, a - b - c), a - b - c),
        (math!(cx, a - b + c), a - b + c),
        (math!(cx, a - (b + c)), a - (b + c)),
        (math!(cx, a / b / c), a / b / c),
        (math!(cx, a / b * c), a / b * c),
        (math!(cx, a / (b * c)), a / (b * c)),
        (math!(cx, a * b - c * d / a + b), a * b - c * d / a + b),
        (math!(cx, (a + b) * (c - d)), (a + b) * (c - d)),
        (math!(cx, -a * b), -a * b),
        (math!(cx, a * -b), a * -b),
        (math!(cx, a - -b - c), a - -b - c),
        (math!(cx, -(a - b) / c), -(a - b) / c),
        (math!(cx, --a), a),
        (math!(cx, 1.0 - a * 2.5), 1.0 - a * 2.5),
        (math!(cx, real(f64::from(7)) - a), 7.0 - a),
    ];
    for (number, (ours, rusts)) in cases.into_iter().enumerate() {
        assert_eq!(ours, rusts, "case {number}");
    }
}

#[test]
fn truth_values_bind_as_in_rust() {
    let cx = &mut Scalar::default();
    let (a, b) = (3.0_f64, 5.0_f64);
    assert!(math!(cx, a * 2.0 - 1.0 <= b && a < b + -1.0));
    assert!(math!(cx, a <= 3.0 && !(b <= a) || b < a));
    for [x, y, z] in (0..8).map(|bits| [0, 1, 2].map(|k| bits >> k & 1 == 1)) {
        assert_eq!(math!(cx, x || y && z), x || y && z);
        assert_eq!(math!(cx, x && y || z), x && y || z);
        assert_eq!(math!(cx, !x && y || !z), !x && y || !z);
        assert_eq!(math!(cx, !(x || y) && z), !(x || y) && z);
    }
}

#[test]
fn calls_take_formulas_and_plain_bounds() {
    let cx = &mut Scalar::default();
    let (a, b, v) = (3.0_f64, 5.0_f64, [1.0, -2.0, 0.5]);
    assert_eq!(math!(cx, sqrt(a * a + 16.0) - max(a, b - 1.0)), 1.0);
    assert_eq!(math!(cx, min(a, b) / abs(a - b)), 1.5);
    assert_eq!(math!(cx, select(a < b, a + 1.0, b)), 4.0);
    assert_eq!(math!(cx, div(a + b, 2.0 * b, 1.0)), 0.8);
    assert_eq!(math!(cx, scale(a - b, 0.25) + known(a, -1.0, 4.0)), 2.5);
    assert_eq!(math!(cx, v[0] - dot(v, v * 2.0)), 1.0 - 10.5);
    assert_eq!(math!(cx, length(v - [1.0, 1.0, 4.5])), 5.0);
}

#[test]
fn vectors_are_scaled_before_they_are_added() {
    let cx = &mut Scalar::default();
    let (v, w, s) = ([1.0, 2.0, 3.0], [0.5, -1.0, 4.0], 2.0_f64);
    assert_eq!(vector!(cx, v + w * s), [2.0, 0.0, 11.0]);
    assert_eq!(vector!(cx, v - w - [1.0, 1.0, 1.0]), [-0.5, 2.0, -2.0]);
    assert_eq!(vector!(cx, -v * (s - 1.0) + w), [-0.5, -3.0, 1.0]);
    assert_eq!(vector!(cx, (v + w) * dot(v, w) * s), [31.5, 21.0, 147.0]);
    assert_eq!(vector!(cx, mirror(v, [0.0, 0.0, 1.0])), [-1.0, -2.0, 3.0]);
    assert_eq!(vector!(cx, constant([1.0; 3]) - v), [0.0, -1.0, -2.0]);
}

#[test]
fn operands_are_computed_from_left_to_right() {
    let cx = &mut Scalar::default();
    let (a, b, c, d) = (1.0, 2.0, 4.0, 8.0);
    let _ = math!(cx, sqrt(a - b) * (c + d) < max(a * c, -d));
    assert_eq!(
        cx.calls,
        ["sub", "sqrt", "add", "mul", "mul", "neg", "max", "less"]
    );
}
