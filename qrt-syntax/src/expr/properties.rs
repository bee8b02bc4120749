//! Properties of all expressions, tested on random ones: printing and reading, derivatives against
//! differences, simplification against the formula as written, bounds against values.

use super::*;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

/// Formulas as text, fully parenthesised.
fn formula() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        4 => Just("u".to_owned()),
        4 => Just("v".to_owned()),
        1 => Just("cos_o".to_owned()),
        1 => Just("x".to_owned()),
        1 => Just("y".to_owned()),
        1 => Just("z".to_owned()),
        2 => Just("cos_a".to_owned()),
        1 => Just("pi".to_owned()),
        2 => (1..5).prop_map(|n: i32| n.to_string()),
        1 => (-3.0..3.0_f64).prop_map(|x| format!("({x})")),
    ];
    leaf.prop_recursive(5, 40, 4, |part| {
        let one = prop::sample::select(vec![
            "sqrt", "sin", "cos", "tan", "exp", "log", "abs", "asin", "acos", "atan", "-",
        ]);
        let two = prop::sample::select(vec!["+", "-", "*", "/"]);
        let call = prop::sample::select(vec!["min", "max", "pow", "atan2"]);
        prop_oneof![
            4 => (part.clone(), two, part.clone()).prop_map(|(a, op, b)| format!("({a} {op} {b})")),
            3 => (one, part.clone()).prop_map(|(f, a)| format!("({f}({a}))")),
            2 => (part.clone(), -3..4).prop_map(|(a, n)| format!("({a}^{n})")),
            1 => (part.clone(), prop::sample::select(vec!["0.5", "1.5", "-0.5", "0.3"]))
                .prop_map(|(a, n)| format!("({a}^{n})")),
            1 => (call, part.clone(), part.clone()).prop_map(|(f, a, b)| format!("{f}({a}, {b})")),
            1 => (part.clone(), part.clone(), part.clone(), part)
                .prop_map(|(a, b, x, y)| format!("if_less({a}, {b}, {x}, {y})")),
        ]
    })
}

fn point() -> impl Strategy<Value = Variables> {
    let square = (0.01..0.99, 0.01..0.99);
    let angles = (0.01..0.99, 0.01..0.99, -0.99..0.99);
    let point = (-3.0..3.0, -0.1..0.1, 10.0..20.0);
    (square, angles, point).prop_map(|((u, v), (cos_i, cos_o, cos_a), (x, y, z))| Variables {
        u,
        v,
        cos_i,
        cos_o,
        cos_a,
        x,
        y,
        z,
    })
}

/// Runs `test` on random formulas at random points. `test` returns true for a conclusive case, and
/// fewer than `enough` of them are a failure. The seed is fixed: the tests compare floats, and rare
/// rounding failures should not depend on the run.
fn try_on_many(cases: u32, enough: u32, test: impl Fn(&Expr, &Variables) -> bool) {
    let config = Config {
        cases,
        rng_seed: RngSeed::Fixed(7),
        ..Config::default()
    };
    let mut runner = TestRunner::new(Config {
        failure_persistence: None,
        ..config
    });
    let told = std::cell::Cell::new(0);
    let result = runner.run(&(formula(), point()), |(text, at)| {
        let e = Expr::parse(&text, &Variable::ALL)
            .map_err(|p| TestCaseError::fail(format!("{text}: {p:?}")))?;
        if test(&e, &at) {
            told.set(told.get() + 1);
        }
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    assert!(
        told.get() >= enough,
        "only {} cases told anything",
        told.get()
    );
}

fn at_point(at: &Variables) -> Domain {
    let mut domain = Domain::default();
    for variable in Variable::ALL {
        *domain.get_mut(variable) = Interval::point(at.get(variable));
    }
    domain
}

/// True if the expression and all its parts have finite values with small rounding errors.
fn is_tame(e: &Expr, at: &Variables) -> bool {
    let mut values = Vec::new();
    e.eval_in(at, &mut values);
    let finite = values.iter().all(|x| x.is_finite() && x.abs() < 1e6);
    let width = e
        .range(&at_point(at))
        .map_or(f64::INFINITY, |r| r.hi - r.lo);
    finite && width <= 1e-10 * (1.0 + e.eval(at).abs())
}

#[test]
fn printing_and_reading_give_the_expression_back() {
    try_on_many(2000, 2000, |e, _| {
        let text = e.to_string();
        let again = Expr::parse(&text, &Variable::ALL);
        assert_eq!(again.as_ref(), Ok(e), "{text}");
        let short = e.simplify().to_string();
        let again = Expr::parse(&short, &Variable::ALL);
        assert_eq!(again.map(|e| e.to_string()), Ok(short));
        true
    });
}

#[test]
fn simplification_keeps_the_value() {
    try_on_many(20_000, 6_000, |e, at| {
        let short = e.simplify();
        if !is_tame(e, at) || !is_tame(&short, at) {
            return false;
        }
        let (long, short_value) = (e.eval(at), short.eval(at));
        let error = (long - short_value).abs() / (1.0 + long.abs());
        assert!(
            error < 1e-8,
            "{e} = {long}, but {short} = {short_value} at {at:?}"
        );
        true
    });
}

/// Zeros have the same signs, and what is undefined is so in both.
#[test]
fn values_on_a_grid_are_those_at_its_points() {
    try_on_many(5000, 5000, |e, at| {
        let e = [
            Variable::CosO,
            Variable::CosA,
            Variable::X,
            Variable::Y,
            Variable::Z,
        ]
        .into_iter()
        .fold(e.clone(), |e, other| {
            e.substitute(other, &Expr::number(at.get(other)).unwrap())
        });
        let (rows, columns) = ([at.u, 0.5, 0.0, at.u], [at.v, 0.25, 1.0]);
        let bits = |values: &[f64]| -> Vec<Option<u64>> {
            let of = |x: &f64| (!x.is_nan()).then_some(x.to_bits());
            values.iter().map(of).collect()
        };
        let mut grid = OnGrid::new(&e, &columns);
        let mut values = Vec::new();
        for u in rows {
            grid.set_u(u);
            for (column, v) in columns.into_iter().enumerate() {
                let at = Variables {
                    u,
                    v,
                    ..Variables::default()
                };
                let value = e.eval_in(&at, &mut values);
                assert_eq!(bits(&[grid.value(column)]), bits(&[value]), "{e} at {at:?}");
                assert_eq!(bits(grid.values()), bits(&values), "{e} at {at:?}");
            }
        }
        true
    });
}

#[test]
fn a_product_of_intervals_is_the_hull_of_the_products_of_their_ends() {
    let ends = [
        -3.5,
        -0.1,
        -0.0,
        0.0,
        1e-300,
        0.1,
        1.0 / 3.0,
        7.0,
        f64::INFINITY,
    ];
    let intervals = || {
        ends.iter().flat_map(|&lo| {
            let above = ends.into_iter().filter(move |hi| lo <= *hi);
            above.map(move |hi| Interval { lo, hi })
        })
    };
    for a in intervals() {
        for b in intervals() {
            let of = |a: f64, b: f64| Interval::point(a).times(Interval::point(b));
            let hull = of(a.lo, b.lo).hull(of(a.lo, b.hi));
            let hull = hull.hull(of(a.hi, b.lo)).hull(of(a.hi, b.hi));
            let product = a.times(b);
            let bits = |i: Interval| [i.lo.to_bits(), i.hi.to_bits()];
            assert_eq!(bits(product), bits(hull), "{a:?} times {b:?}");
        }
    }
}

#[test]
fn a_value_is_not_simplified_away() {
    try_on_many(20_000, 6_000, |e, at| {
        let short = e.simplify();
        if !is_tame(e, at) {
            return false;
        }
        assert!(
            short.eval(at).is_finite(),
            "{e} has a value, {short} has none at {at:?}"
        );
        true
    });
}

#[test]
fn derivatives_agree_with_differences() {
    try_on_many(20_000, 3_000, |e, at| {
        let mut all = is_tame(e, at);
        for variable in Variable::SQUARE.into_iter().filter(|_| is_tame(e, at)) {
            let slope = e.diff(variable);
            let value = slope.eval(at);
            let Some((difference, error)) = difference(e, variable, at) else {
                return false;
            };
            if error > 1e-5 * (1.0 + difference.abs()) || !is_tame(&slope, at) {
                all = false;
                continue;
            }
            let off = (value - difference).abs() / (1.0 + difference.abs());
            assert!(
                off < 1e-4,
                "d({e})/d{} = {slope} = {value}, not {difference}",
                variable.name()
            );
            let short = slope.simplify().eval(at);
            let off = (short - difference).abs() / (1.0 + difference.abs());
            assert!(
                off < 1e-4,
                "{slope} = {value}, but simplified {short} at {at:?}"
            );
        }
        all
    });
}

/// The derivative by central differences, extrapolated to a step of 0 (Richardson), and by how much
/// the steps disagree; `None` where the expression is not finite nearby.
fn difference(e: &Expr, variable: Variable, at: &Variables) -> Option<(f64, f64)> {
    let moved = |by: f64| {
        let mut at = *at;
        match variable {
            Variable::U => at.u += by,
            _ => at.v += by,
        }
        let value = e.eval(&at);
        value.is_finite().then_some(value)
    };
    let central = |h: f64| Some((moved(h)? - moved(-h)?) / (2.0 * h));
    let [a, b, c] = [central(8e-4)?, central(4e-4)?, central(2e-4)?];
    let (ab, bc) = ((4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0);
    let best = (16.0 * bc - ab) / 15.0;
    Some((best, (best - bc).abs() + (bc - ab).abs()))
}

#[test]
fn bounds_hold_every_value() {
    try_on_many(20_000, 8_000, |e, at| {
        let mut told = false;
        for width in [0.0, 1e-3, 0.1, 2.0] {
            let mut domain = at_point(at);
            let whole = Domain::default();
            for variable in Variable::ALL {
                let (all, x) = (whole.get(variable), at.get(variable));
                let part = Interval {
                    lo: (x - 0.3 * width).max(all.lo),
                    hi: (x + 0.7 * width).min(all.hi),
                };
                *domain.get_mut(variable) = part;
            }
            let range = e.range(&domain);
            // A quarter of the corners, the point itself and the middle.
            for corner in 0..66_u32 {
                let mut inside = *at;
                if corner < 64 {
                    let pick = |i: u32, part: Interval| {
                        if (37 * corner) >> i & 1 == 0 {
                            part.lo
                        } else {
                            part.hi
                        }
                    };
                    inside = Variables {
                        u: pick(0, domain.u),
                        v: pick(1, domain.v),
                        cos_i: pick(2, domain.cos_i),
                        cos_o: pick(3, domain.cos_o),
                        cos_a: pick(4, domain.cos_a),
                        x: pick(5, domain.x),
                        y: pick(6, domain.y),
                        z: pick(7, domain.z),
                    };
                } else if corner == 64 {
                    let middle = |part: Interval| part.lo + (part.hi - part.lo) / 2.0;
                    inside.u = middle(domain.u);
                    inside.v = middle(domain.v);
                }
                let mut values = Vec::new();
                let value = e.eval_in(&inside, &mut values);
                if values.iter().all(|x| x.is_finite()) {
                    told = true;
                    let holds = range.is_some_and(|range| range.contains(value));
                    assert!(holds, "{e} = {value} at {inside:?}, outside {range:?}");
                }
            }
        }
        told
    });
}

#[test]
fn no_text_makes_the_parser_panic() {
    let word = prop::sample::select(vec![
        "u",
        "v",
        "cos_i",
        "sin",
        "if_less",
        "pow",
        "(",
        ")",
        ",",
        "+",
        "-",
        "*",
        "/",
        "^",
        " ",
        "1",
        ".5",
        "2e",
        "e3",
        "1e400",
        ".",
        "pi",
        "π",
        "\u{1f31e}",
        "\n",
        "_",
        "=",
        "\0",
        "2.5.1",
    ]);
    let text = prop::collection::vec(word, 0..30).prop_map(|words| words.concat());
    let config = Config {
        cases: 20_000,
        rng_seed: RngSeed::Fixed(7),
        ..Config::default()
    };
    let mut runner = TestRunner::new(Config {
        failure_persistence: None,
        ..config
    });
    let read = std::cell::Cell::new(0);
    let result = runner.run(&text, |text| {
        match Expr::parse(&text, &Variable::SQUARE) {
            Ok(e) => {
                read.set(read.get() + 1);
                let again = Expr::parse(&e.to_string(), &Variable::SQUARE);
                prop_assert_eq!(again, Ok(e));
            }
            Err(problems) => {
                prop_assert!(!problems.is_empty());
                for problem in problems {
                    let range = problem.within.unwrap_or_default();
                    prop_assert!(text.get(range).is_some(), "{}", problem.what);
                }
            }
        }
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    assert!(read.get() > 100, "only {} texts were formulas", read.get());
}
