//! Tests of the language, its derivatives, its simplification and its bounds, each against an
//! independent reference.

use super::*;
use crate::Problem;

fn read(text: &str) -> Expr {
    Expr::parse(text, &Variable::ALL).unwrap_or_else(|p| panic!("{text}: {p:?}"))
}

fn value(text: &str) -> f64 {
    let at = Variables {
        u: 0.25,
        v: 0.75,
        cos_i: 0.5,
        cos_o: 0.125,
        cos_a: -0.5,
        ..Variables::default()
    };
    read(text).eval(&at)
}

#[test]
fn operators_bind_as_in_mathematics() {
    assert_eq!(value("-u^2"), -0.0625);
    assert_eq!(value("(-u)^2"), 0.0625);
    assert_eq!(value("2^3^2"), 512.0);
    assert_eq!(value("2^-1"), 0.5);
    assert_eq!(value("2^-u^2"), libm::pow(2.0, -0.0625));
    assert_eq!(value("8/4/2"), 1.0);
    assert_eq!(value("8-4-2"), 2.0);
    assert_eq!(value("2*-3"), -6.0);
    assert_eq!(value("--2"), 2.0);
    assert_eq!(value("+2 - +1"), 1.0);
    assert_eq!(value("1+2*3^2"), 19.0);
    assert_eq!(value(" ( 1 + 2 ) * 3 "), 9.0);
    assert_eq!(value("1e-3*.5*2.*1E+3"), 1.0);
    assert_eq!(
        value("if_less(u, v, 10, 20) + min(1, 2) + max(1, 2) + abs(-3)"),
        16.0
    );
    assert_eq!(value("pow(2, 10) + atan2(0, -1) - pi"), 1024.0);
    assert_eq!(value("cos_i + cos_o + cos_a"), 0.125);
}

#[test]
fn equal_parts_are_one_node() {
    let e = read("sin(u*v) + sin(u*v)*cos(u*v)");
    let products = e
        .nodes()
        .iter()
        .filter(|n| matches!(n, ExprNode::Mul(..)))
        .count();
    assert_eq!(products, 2);
    for (index, node) in e.nodes().iter().enumerate() {
        assert!(node.operands().all(|id| id.index() < index));
    }
    assert_eq!(e.root().index(), e.nodes().len() - 1);
}

#[test]
fn dependence_is_known_of_every_node() {
    let e = read("sqrt(u)*cos(2*pi*v)*cos_o");
    let sets = e.node_variables();
    assert!(sets.contains(&VariableSet::from_variable(Variable::U)));
    assert!(sets.contains(&VariableSet::from_variable(Variable::V)));
    assert!(sets.contains(&VariableSet::SQUARE));
    let all = e.variables(e.root());
    assert!(all.contains(Variable::CosO) && !all.contains(Variable::CosI));
    assert!(VariableSet::SQUARE.is_subset(all) && !all.is_subset(VariableSet::SQUARE));
}

/// Code, bytes, message and help of the first problem.
fn wrong(text: &str) -> (&'static str, std::ops::Range<usize>, String, String) {
    let mut problems = Expr::parse(text, &Variable::SQUARE).expect_err(text);
    let p = problems.remove(0);
    let words = p.description();
    (
        words.code,
        p.within.expect("a place"),
        words.message,
        words.help.unwrap_or_default(),
    )
}

#[test]
fn problems_name_their_bytes() {
    let cases: [(&str, &str, std::ops::Range<usize>, &str, &str); 20] = [
        ("", "QRT0406", 0..0, "empty", ""),
        ("  ", "QRT0406", 0..2, "empty", ""),
        (
            "1 +",
            "QRT0400",
            3..3,
            "expected a value, found the end",
            "",
        ),
        ("2u", "QRT0400", 1..2, "unexpected `u`", "`*`"),
        ("(u + 1", "QRT0400", 0..1, "never closed", ""),
        ("u)", "QRT0400", 1..2, "unexpected `)`", "no `(`"),
        ("u**2", "QRT0400", 1..3, "unexpected `**`", "`^`"),
        ("u & v", "QRT0400", 2..3, "unexpected `&`", ""),
        ("u × v", "QRT0400", 2..4, "unexpected `×`", "`*`"),
        (
            "sni(u)",
            "QRT0401",
            0..3,
            "unknown function `sni`",
            "did you mean `sin`?",
        ),
        ("ln(u)", "QRT0401", 0..2, "unknown function `ln`", "`log`"),
        ("1 + w", "QRT0401", 4..5, "unknown name `w`", ""),
        (
            "cos_i",
            "QRT0402",
            0..5,
            "`cos_i` has no value here",
            "u, v",
        ),
        ("sin", "QRT0403", 0..3, "`sin` has no operands", "sin(u)"),
        (
            "1 + sin(u, v)",
            "QRT0403",
            4..13,
            "takes 1 operand, not 2",
            "",
        ),
        ("min(u)", "QRT0403", 0..6, "takes 2 operands, not 1", ""),
        ("pi(2)", "QRT0403", 0..2, "`pi` is not a function", "`*`"),
        ("1.2.3", "QRT0404", 0..5, "`1.2.3` is not a number", ""),
        ("u + 1e999", "QRT0404", 4..9, "too large", ""),
        (
            "max(u, )",
            "QRT0400",
            7..8,
            "expected a value, found `)`",
            "",
        ),
    ];
    for (text, code, range, message, help) in cases {
        let found = wrong(text);
        assert_eq!((found.0, &found.1), (code, &range), "{text}: {}", found.2);
        assert!(found.2.contains(message), "{text}: {}", found.2);
        assert!(found.3.contains(help), "{text}: {}", found.3);
    }
}

#[test]
fn all_unknown_names_are_told_at_once() {
    let problems = Expr::parse("a1 + b1*cos_i", &Variable::SQUARE).expect_err("three");
    assert_eq!(
        problems.iter().map(Problem::code).collect::<Vec<_>>(),
        ["QRT0401", "QRT0401", "QRT0402"]
    );
}

#[test]
fn depth_and_length_have_limits_instead_of_crashes() {
    let deep = |open: &str, n: usize, close: &str| {
        let text = open.repeat(n) + "u" + &close.repeat(n);
        Expr::parse(&text, &Variable::SQUARE).map_err(|p| p[0].code())
    };
    assert!(deep("(", MAX_DEPTH, ")").is_ok());
    for (open, close) in [("(", ")"), ("-", ""), ("2^", ""), ("sin(", ")")] {
        assert_eq!(deep(open, MAX_DEPTH + 1, close), Err("QRT0405"));
        assert_eq!(deep(open, 100_000, close), Err("QRT0405"));
    }
    // The longest sum is as deep as it is long; printing and all other operations support it.
    let long = "u+v*".repeat(MAX_LENGTH / 6 - 1) + "u";
    let e = read(&long);
    assert_eq!(read(&e.to_string()), e);
    let at = Variables {
        u: 0.5,
        v: 0.5,
        ..Variables::default()
    };
    let difference = e.simplify().eval(&at) - e.eval(&at);
    assert!(difference.abs() < 1e-9);
    assert!(e.diff(Variable::U).simplify().eval(&at).is_finite());
}

#[test]
fn what_cancels_on_paper_cancels() {
    let cases = [
        ("sqrt(u)*(1/(2*sqrt(u)))", "0.5"),
        ("sin(v)^2 + cos(v)^2", "1"),
        ("2*u*sin(3*v)^2 + 2*u*cos(3*v)^2", "2*u"),
        ("u - u*sin(v)^2", "u*cos(v)^2"),
        ("0*u + v*0", "0"),
        ("u/u", "1"),
        ("u - u", "0"),
        ("u*v - v*u", "0"),
        ("u*u*u/u^2", "u"),
        ("(u+v)^3/(v+u)^2", "u + v"),
        ("(2-2*u)/(1-u)", "2"),
        ("sqrt(2-2*u)/sqrt(2-2*u)", "1"),
        ("sqrt(u*(2-u))/sqrt(2-u)*sqrt(u)", "u"),
        ("sqrt(u^2)", "u"),
        ("sqrt(cos_a^2)", "abs(cos_a)"),
        ("abs(cos_a)^2", "cos_a^2"),
        ("abs(u-1)", "1 - u"),
        ("sqrt(1-u)*sqrt(1-u)", "1 - u"),
        ("max(u, -1) + min(v, 2) - v", "u"),
        ("if_less(u, 2, v, log(v))", "v"),
        ("log(exp(u)) + exp(log(v)) - v", "u"),
        ("cos(acos(u)) + sin(asin(v)) - v", "u"),
        ("sin(acos(u))", "sqrt(1 - u^2)"),
        ("tan(v)*cos(v)", "sin(v)"),
        ("sin(-v) + sin(v) + cos(-v)", "cos(v)"),
        ("(u^0.3)*(u^0.7)", "u"),
        ("2*3 + 4/8 - 6.5", "0"),
        ("sqrt(4) + 2^0.5*2^0.5 + 8^(1/3)*0", "4"),
        ("4^1.5 + 2", "10"),
        ("u^(4^1.5)", "u^8"),
        ("u^(1/51)*u^(49/51)*(u^(1/51))", "u"),
        ("u^(1/3)*u^(-1/3)*v", "v"),
        ("-(-u)", "u"),
        ("u - (u - v)", "v"),
    ];
    for (text, short) in cases {
        assert_eq!(read(text).simplify().to_string(), short, "{text}");
    }
}

#[test]
fn a_root_of_what_may_be_negative_keeps_its_domain() {
    let at = |u| Variables {
        u,
        v: 0.7,
        ..Variables::default()
    };
    for text in [
        "sqrt((u-v)^2)",
        "sqrt((u-v)*(u-v)*v)",
        "((u-v)^4)^0.25",
        "sqrt((u-v)*(v-u)*-1)",
    ] {
        let (whole, short) = (read(text), read(text).simplify());
        for u in [0.1, 0.5, 0.9] {
            let (a, b) = (whole.eval(&at(u)), short.eval(&at(u)));
            assert!((a - b).abs() < 1e-14, "{text} = {short}: {a} {b}");
        }
    }
}

#[test]
fn bounds_are_tight_where_they_are_easy_and_infinite_where_there_is_none() {
    let whole = Domain::default();
    let range = |text| read(text).range(&whole).map(|r| (r.lo, r.hi));
    assert_eq!(range("1 - u"), Some((0.0, 1.0)));
    assert_eq!(range("2*u - 1"), Some((-1.0, 1.0)));
    assert_eq!(range("(2*u - 1)^2"), Some((0.0, 1.0)));
    assert_eq!(range("sqrt(1 - u)"), Some((0.0, 1.0)));
    assert_eq!(range("cos(2*pi*u)"), Some((-1.0, 1.0)));
    assert_eq!(range("abs(cos_a)"), Some((0.0, 1.0)));
    assert_eq!(range("1/u"), Some((1.0, f64::INFINITY)));
    assert_eq!(range("1/cos_a"), Some((f64::NEG_INFINITY, f64::INFINITY)));
    assert_eq!(range("sqrt(-1 - u)"), None);
    assert_eq!(range("if_less(u, 2, v, 1/cos_a)"), Some((0.0, 1.0)));
    // The base's least value is -0, whose odd powers are negative.
    assert_eq!(
        range("pow(abs(cos_o - 1), cos_a)").map(|r| r.1),
        Some(f64::INFINITY)
    );
}

#[test]
fn hostile_formulas_take_little_time() {
    let fill = |part: &str| part.repeat((MAX_LENGTH - 200) / part.len());
    let texts = [
        fill("(u+v)*") + "u",
        fill("(u+2*v)/") + "u",
        fill("sin(u)^2+cos(v)*") + "u",
        fill("sin(u)*cos(v)+") + "u",
        (0..300)
            .map(|i| format!("sin(u*{i})^2+"))
            .collect::<Vec<_>>()
            .concat()
            + "u",
        (0..90)
            .map(|i| format!("sqrt(u*{i}+v)*"))
            .collect::<Vec<_>>()
            .concat()
            + "u",
        "(".repeat(100) + "u" + &"^2+v)".repeat(100),
        "sqrt(".repeat(100) + "u" + &"+v)*u".repeat(100),
        "abs(".repeat(100) + "u" + &"-v)/u".repeat(100),
        "if_less(u,v,".repeat(100) + "u,v)" + &"*u,v)".repeat(99),
        "2^".repeat(100) + "u",
        "exp(".repeat(100) + "u" + &")".repeat(100),
    ];
    let at = Variables {
        u: 0.3,
        v: 0.6,
        ..Variables::default()
    };
    for text in texts {
        let e = read(&text);
        let slope = e.diff(Variable::U);
        for e in [&e, &slope] {
            let started = std::time::Instant::now();
            let short = e.simplify();
            let _ = (
                short.eval(&at),
                short.range(&Domain::default()),
                short.written_nodes(),
            );
            assert!(started.elapsed().as_secs() < 5, "{text}");
        }
    }
}
