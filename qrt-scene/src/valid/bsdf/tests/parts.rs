//! Infinities within an expression that the rest of it makes finite: floating point computes with them,
//! registers cannot, so the models would differ.

use super::*;

#[test]
fn an_infinity_that_a_value_hides_is_refused() {
    for (value, part) in [
        ("abs(atan2(cos_o/0, 1))*0.05", "`cos_o/0`, is infinite"),
        ("0.1*atan(1/0)", "`1/0`, is infinite"),
        ("0.1/(1+1/0)", "`1/0`, is infinite"),
        ("min(0.1, 1/(cos_o-cos_o))", "is infinite"),
        ("max(0.1, -1/(u-u))", "is infinite"),
        ("0.1*exp(log(0))", "`log(0)`, is infinite"),
        ("0.1*exp(-1/(1-cos_o))", "is infinite at cos_o = 1"),
        // A power of a lobe, written by logarithms.
        ("0.1*exp(20*log(max(0, cos_a)))", "is infinite at cos_a = -"),
        ("min(0.1, exp(1000*cos_o))", "is infinite"),
        ("0.1*atan(10^400*cos_o)", "`10^400`, is infinite"),
        ("min(0.1, (1 + cos_i)^5000)", "is infinite"),
        ("if_less(1/0, 1, 0, 0.1)", "`1/0`, is infinite"),
        ("0.1*cos(atan(tan(pi/2)/0))^2", "is infinite"),
    ] {
        let at = "value[0]";
        refused(COSINE, "auto", &[value], "QRT0416", at, part);
        refused(
            COSINE,
            "auto",
            &["0.1", "0.1", value],
            "QRT0416",
            "value[2]",
            part,
        );
    }
}

#[test]
fn an_infinity_that_a_map_a_jacobian_or_a_density_hides_is_refused() {
    let [x, y, z] = COSINE;
    let hidden = format!("{z} + 1/(1/0)");
    refused(
        [x, y, &hidden],
        "auto",
        &["0.1"],
        "QRT0416",
        "map[2]",
        "`1/0`",
    );
    let hidden = format!("{x} + 0*atan(1/(v-v))");
    refused(
        [&hidden, y, z],
        "auto",
        &["0.1"],
        "QRT0416",
        "map[0]",
        "is infinite at u = ",
    );
    refused(
        COSINE,
        "pi/sqrt(1-u) + exp(log(0))",
        &["0.1"],
        "QRT0416",
        "jacobian",
        "`log(0)`",
    );
    let mut dense = bsdf(COSINE, "auto", &["0.1"]);
    dense.pdf = Some("cos_i/pi + 1/(1/0)".to_owned());
    let problems = compile(&dense, &Faces::NONE).unwrap_err();
    let found = problems
        .iter()
        .map(|p| (p.code(), p.path().unwrap().to_string()));
    assert_eq!(found.collect::<Vec<_>>(), [("QRT0416", "pdf".to_owned())]);
}

#[test]
fn what_is_finite_wherever_it_is_asked_for_is_accepted() {
    for (map, value) in [
        (UNIFORM, "0.1/cos_i"),
        (COSINE, "0.1*cos_i/cos_i"),
        (COSINE, "min(0.1, 0.01/cos_o)"),
        (COSINE, "0.1*exp(-20*(1-cos_o))"),
        // It is the constant 0.1, and e^500 is a finite number.
        (COSINE, "min(0.1, exp(500*cos_o))"),
        // It is simplified to 0.1 cos_o.
        (COSINE, "0.1*exp(log(cos_o))"),
        (COSINE, "0.1*abs(atan2(cos_o, cos_i))/pi"),
        // The branch that is not taken may be anything.
        (COSINE, "if_less(cos_i, 2, 0.1, 1/0)"),
        (COSINE, "if_less(0, cos_a, 0.1*cos_a^0.5, 0)"),
        (COSINE, "if_less(0, cos_a, 0.1*exp(3*log(cos_a)), 0)"),
        (COSINE, "if_less(cos_o, 1, 0.1*exp(-1/(1-cos_o)), 0)"),
    ] {
        right(map, "auto", &[value]);
    }
}
