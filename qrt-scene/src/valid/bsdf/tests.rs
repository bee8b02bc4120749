//! Tests of the checks: valid BSDFs pass with the weights of closed forms, wrong ones are refused
//! at their place with their reason.

mod parts;

use super::*;
use qrt_syntax::expr::Variables;

const COSINE: [&str; 3] = ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"];
const UNIFORM: [&str; 3] = [
    "sqrt(u*(2-u))*cos(2*pi*v)",
    "sqrt(u*(2-u))*sin(2*pi*v)",
    "1-u",
];
const SPHERE: [&str; 3] = [
    "2*sqrt(u*(1-u))*cos(2*pi*v)",
    "2*sqrt(u*(1-u))*sin(2*pi*v)",
    "1-2*u",
];

fn bsdf(map: [&str; 3], jacobian: &str, value: &[&str]) -> Bsdf {
    Bsdf {
        map: map.map(str::to_owned),
        jacobian: match jacobian {
            "auto" => Jacobian::Auto,
            stated => Jacobian::Stated(stated.to_owned()),
        },
        value: value.iter().map(|v| (*v).to_owned()).collect(),
        pdf: None,
    }
}

fn right(map: [&str; 3], jacobian: &str, value: &[&str]) -> CustomBsdf {
    compile(&bsdf(map, jacobian, value), &Faces::NONE).unwrap_or_else(|p| panic!("{p:?}"))
}

#[track_caller]
fn refused(map: [&str; 3], jacobian: &str, value: &[&str], code: &str, path: &str, words: &str) {
    let problems = compile(&bsdf(map, jacobian, value), &Faces::NONE).expect_err("a faulty BSDF");
    let found = problems
        .iter()
        .find(|p| p.code() == code && p.path().unwrap().to_string() == path);
    let what = &found.unwrap_or_else(|| panic!("{problems:?}")).what;
    let text = what.to_string();
    assert!(text.contains(words), "{text}");
}

#[test]
fn a_lambertian_under_the_cosine_map_weighs_its_albedo() {
    for jacobian in ["auto", "pi/sqrt(1-u)"] {
        let b = right(COSINE, jacobian, &["0.5/pi", "0.25/pi", "0"]);
        assert_eq!(
            b.projected_jacobian.constant(),
            Some(std::f64::consts::PI),
            "{jacobian}"
        );
        for (bound, albedo) in b.weight_bound.iter().zip([0.5, 0.25, 0.0]) {
            assert!(*bound >= albedo && *bound <= albedo * (1.0 + 1e-8));
        }
    }
    let uniform = right(UNIFORM, "auto", &["0.5/pi"]);
    assert_eq!(
        uniform.projected_jacobian.to_string(),
        "6.283185307179586*(1 - u)"
    );
    assert!(uniform.weight_bound[2] >= 1.0 && uniform.weight_bound[2] < 1.0001);
    let sphere = right(SPHERE, "4*pi", &["0.1"]);
    let at = Variables {
        u: 0.75,
        ..Variables::default()
    };
    let weight = 4.0 * std::f64::consts::PI * 0.5;
    assert!((sphere.projected_jacobian.eval(&at) - weight).abs() < 1e-14);
}

#[test]
fn a_division_by_the_cosine_cancels_against_the_uniform_map() {
    let b = right(UNIFORM, "auto", &["0.1/cos_i"]);
    let constant = 0.2 * std::f64::consts::PI;
    assert!(b.weight_bound[0] >= constant && b.weight_bound[0] < constant * 1.000_001);
}

#[test]
fn lobes_have_tight_bounds() {
    // (n + 2)/(2 pi) cos_a^n under the cosine map: at most (n + 2)/2.
    let b = right(COSINE, "auto", &["0.4*(20+2)/(2*pi)*max(0,cos_a)^20"]);
    assert!(
        b.weight_bound[0] >= 4.4 && b.weight_bound[0] < 4.4 * 1.001,
        "{:?}",
        b.weight_bound
    );
    // z (1 - z) is at most 1/4; intervals alone would say 1.
    let b = right(UNIFORM, "auto", &["0.3*(1-cos_i)"]);
    let most = 0.3 * std::f64::consts::TAU / 4.0;
    assert!(b.weight_bound[0] >= most && b.weight_bound[0] < most * 1.001);
}

#[test]
fn maps_that_crowd_their_points_pass() {
    // Lobes about the normal with the density of cos^n, and a map that favours the horizon.
    for n in ["3", "50", "2000"] {
        let z = format!("u^(1/({n}+1))");
        let r = format!("sqrt(1-u^(2/({n}+1)))");
        let (x, y) = (format!("{r}*cos(2*pi*v)"), format!("{r}*sin(2*pi*v)"));
        right(
            [&x, &y, &z],
            "auto",
            &[&format!("0.9*({n}+1)/(2*pi)*cos_i^{n}/cos_i")],
        );
    }
    let polar = [
        "sin(0.5*pi*u^2)*cos(2*pi*v)",
        "sin(0.5*pi*u^2)*sin(2*pi*v)",
        "cos(0.5*pi*u^2)",
    ];
    right(polar, "2*pi^2*u*sin(0.5*pi*u^2)", &["1/pi"]);
    // A whole sphere, an axis that lies in the surface.
    right(SPHERE, "auto", &["0.1"]);
    right([SPHERE[2], SPHERE[1], SPHERE[0]], "auto", &["0.1"]);
}

#[test]
fn faulty_maps_are_refused() {
    let grey = &["0.1"];
    let [x, y, z] = COSINE;
    refused(
        [x, y, "sqrt(1+u)"],
        "auto",
        grey,
        "QRT0411",
        "map",
        "leaves the unit sphere",
    );
    refused(
        [x, y, "sqrt(u-1)"],
        "auto",
        grey,
        "QRT0412",
        "map[2]",
        "no value",
    );
    refused(
        [x, y, "-sqrt(1-u)"],
        "auto",
        grey,
        "QRT0421",
        "map",
        "below the surface alone",
    );
    refused(["0", "0", "1"], "auto", grey, "QRT0413", "map", "point");
    refused(
        ["sin(u+v)", "0", "cos(u+v)"],
        "auto",
        grey,
        "QRT0413",
        "map",
        "line",
    );
    refused(
        [x, "cosi", z],
        "auto",
        grey,
        "QRT0401",
        "map[1]",
        "unknown name",
    );
    refused(
        [x, "cos_i", z],
        "auto",
        grey,
        "QRT0402",
        "map[1]",
        "no value here",
    );
}

#[test]
fn wrong_jacobians_are_refused_with_the_likely_mistake() {
    let wrong = |stated, words| {
        refused(COSINE, stated, &["0.1"], "QRT0414", "jacobian", words);
    };
    wrong("sqrt(1-u)/pi", "a change of variables multiplies");
    wrong("pi", "the cosine is multiplied in already");
    wrong("-pi/sqrt(1-u)", "a length, not a signed area");
    wrong("0.5/sqrt(1-u)", "multiply it by 6.283185");
    wrong("1/pi", "1/(J |z|)");
    wrong("pi*(1+u)", "write `pi/sqrt(1 - u)`, or `auto`");
}

#[test]
fn wrong_values_are_refused() {
    let wrong = |value: &[&str], code, path, words| {
        refused(COSINE, "auto", value, code, path, words);
    };
    wrong(&[], "QRT0410", "value", "not 0");
    wrong(&["0.1", "0.1"], "QRT0410", "value", "not 2");
    wrong(&["0", "0", "0", "0"], "QRT0410", "value", "not 4");
    wrong(&["cos_i-0.5"], "QRT0415", "value[0]", "negative");
    wrong(
        &["0.1", "-0.1", "0.1"],
        "QRT0415",
        "value[1]",
        "negative: -0.1",
    );
    wrong(&["sqrt(cos_a)"], "QRT0416", "value[0]", "has no value");
    wrong(&["1/0"], "QRT0416", "value[0]", "infinite");
    wrong(&["0.5"], "QRT0417", "value[0]", "1.570796 of the light");
    wrong(&["2/pi*cos_o"], "QRT0417", "value[0]", "seen at cos_o = 1");
    wrong(&["0.1/cos_i"], "QRT0418", "value[0]", "no bound");
}

#[test]
fn a_bsdf_that_keeps_all_energy_passes() {
    right(COSINE, "auto", &["1/pi"]);
    right(UNIFORM, "auto", &["1/pi"]);
    right(SPHERE, "auto", &["1/(2*pi)"]);
    let phong = "0.5/pi + 0.5*(20+2)/(2*pi)*max(0,cos_a)^20";
    right(COSINE, "auto", &[phong, phong, phong]);
    // After Lommel and Seeliger: at grazing view 1/2 (1 - 0.05 ln 21), less elsewhere.
    right(COSINE, "auto", &["1/(4*pi)/(cos_i+cos_o+0.05)"]);
}

#[test]
fn a_value_that_is_not_reciprocal_gets_a_warning() {
    let warned = |value: &[&str]| -> Vec<String> {
        let values: Vec<Expr> = value
            .iter()
            .map(|text| Expr::parse(text, &Variable::ALL).unwrap())
            .collect();
        let found = warnings(&values, &Faces::NONE);
        assert!(found.iter().all(|problem| problem.code() == "QRT0422"));
        found
            .iter()
            .map(|p| p.path().unwrap().to_string())
            .collect()
    };
    assert_eq!(warned(&["0.1*cos_i"]), ["value[0]"]);
    assert_eq!(warned(&["0.1", "0.1*(cos_i+2*cos_o)", "0.1"]), ["value[1]"]);
    for right in [
        "0.1",
        "0.1*(1+cos_i)*(1+cos_o)",
        "0.1*max(0,cos_a)^4",
        "0.1/(cos_i+cos_o+0.05)",
        "0.1*u",
    ] {
        assert_eq!(warned(&[right]), [""; 0], "{right}");
    }
}
