//! Correct and wrong maps, judged by areas on the sphere: the square is cut into cells, whose
//! corners' directions span polygons, and the area within each region is summed. This takes neither
//! a derivative nor a value.

use super::*;
use crate::sampling::maps;
use crate::scene::Jacobian;

type Map = [String; 3];

/// Maps by their radius and their height.
const ROUND: [[&str; 2]; 5] = [
    ["sqrt(u)", "sqrt(1-u)"],
    ["sqrt(u*(2-u))", "1-u"],
    ["sqrt(1-u^2)", "u"],
    ["sin(0.5*pi*u)", "cos(0.5*pi*u)"],
    ["sqrt(1-u^(1/2))", "u^(1/4)"],
];

fn round([radius, height]: [&str; 2], angle: &str) -> Map {
    [
        format!("({radius})*cos({angle})"),
        format!("({radius})*sin({angle})"),
        height.to_owned(),
    ]
}

/// A lobe about the normal with different widths along and across.
fn brushed(along: f64, across: f64) -> Map {
    let square = format!("(1-u+u*({along}^2*cos(2*pi*v)^2+{across}^2*sin(2*pi*v)^2))");
    [
        format!("{along}*cos(2*pi*v)*sqrt(u/{square})"),
        format!("{across}*sin(2*pi*v)*sqrt(u/{square})"),
        format!("sqrt((1-u)/{square})"),
    ]
}

/// Returns the codes of all problems with a BSDF of this map and value.
fn codes(map: Map, value: &[&str]) -> Vec<&'static str> {
    let bsdf = crate::scene::Bsdf {
        map,
        jacobian: Jacobian::Auto,
        value: value.iter().map(|&value| value.to_owned()).collect(),
        pdf: None,
    };
    let problems = crate::valid::bsdf::compile(&bsdf, &crate::valid::bsdf::Faces::NONE).err();
    let problems = problems.iter().flatten().map(Problem::code);
    problems.collect()
}

/// The map with `new` in place of the variable `old`.
fn with(map: &Map, old: char, new: &str) -> Map {
    map.each_ref().map(|text| {
        let letters: Vec<char> = text.chars().collect();
        let alone = |i: usize| {
            let near = [i.wrapping_sub(1), i + 1].map(|k| letters.get(k));
            !near.iter().flatten().any(|c| c.is_ascii_alphabetic())
        };
        let written = letters.iter().enumerate().map(|(i, &c)| {
            if c == old && alone(i) {
                format!("({new})")
            } else {
                c.to_string()
            }
        });
        written.collect()
    })
}

/// The map, turned about the y axis.
fn tilted([x, y, z]: &Map, degrees: f64) -> Map {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [
        format!("{cos}*({x}) + {sin}*({z})"),
        y.clone(),
        format!("{cos}*({z}) - {sin}*({x})"),
    ]
}

fn parsed(map: &Map) -> [Expr; 3] {
    map.each_ref()
        .map(|c| Expr::parse(c, &Variable::SQUARE).unwrap())
}

fn found(map: &Map, value: &str) -> Option<Bsdf> {
    let map = parsed(map);
    let value = Expr::parse(value, &Variable::ALL).unwrap();
    let problem = check(
        &map,
        &maps::projected_jacobian(&map),
        &OnceCell::new(),
        &[value],
    )?;
    match problem.what {
        qrt_syntax::What::Bsdf(what) => Some(what),
        other => panic!("{other:?}"),
    }
}

/// Returns how often the map covers each of 64 regions of equal area above, and 64 below.
fn areas(map: &Map) -> Vec<f64> {
    const ROWS: u32 = 1024;
    const COLUMNS: u32 = 256;
    let map = parsed(map);
    let mut room = Vec::new();
    let mut at = |s: f64, v: f64| {
        // Cells are small at both ends, where maps are steep.
        let u = s * s * (3.0 - 2.0 * s);
        let at = Variables {
            u,
            v,
            ..Variables::default()
        };
        glam::DVec3::from(map.each_ref().map(|c| c.eval_in(&at, &mut room)))
    };
    let mut covered = vec![0.0; 128];
    let of = |i: u32, n: u32| f64::from(i) / f64::from(n);
    let mut row: Vec<glam::DVec3> = (0..=COLUMNS).map(|j| at(0.0, of(j, COLUMNS))).collect();
    for i in 1..=ROWS {
        let s = of(i, ROWS);
        let next: Vec<glam::DVec3> = (0..=COLUMNS).map(|j| at(s, of(j, COLUMNS))).collect();
        for j in 0..COLUMNS as usize {
            let [a, b, c, d] = [row[j], row[j + 1], next[j + 1], next[j]];
            let area = 0.5 * (c - a).cross(d - b).length();
            let middle = (a + b + c + d).normalize_or(a);
            let turn = libm::atan2(middle.y, middle.x) / TAU + 0.5;
            let turn = ((turn * 8.0) as usize).min(7);
            let height = ((middle.z.abs() * 8.0) as usize).min(7);
            let below = usize::from(middle.z < -1e-12);
            covered[64 * below + 8 * height + turn] += area / (TAU / 64.0);
        }
        row = next;
    }
    covered
}

/// True if all required regions are covered once; those below are required if the map reaches them.
fn covers_once(map: &Map, areas: &[f64]) -> bool {
    let below = areas[64..].iter().sum::<f64>() > 1e-3;
    let demanded = if below { areas } else { &areas[..64] };
    let off = |&times: &f64| (times - 1.0_f64).abs();
    let most = demanded.iter().map(off).fold(0.0, f64::max);
    // Between these limits the regions' edges would decide.
    assert!(!(0.09..0.15).contains(&most), "{map:?}: {most}");
    most < 0.1
}

#[test]
fn a_hundred_wrong_maps_are_refused() {
    let mut wrong: Vec<Map> = Vec::new();
    for kind in ROUND {
        let plain = round(kind, "2*pi*v");
        // Scaled and doubled.
        for turns in [0.3, 0.5, 0.8, 1.2, 1.5, 2.0, 3.0, 4.0] {
            wrong.push(round(kind, &format!("2*pi*{turns}*v")));
        }
        // Partial and shifted heights.
        for part in ["0.5*u", "0.8*u", "0.9*u", "0.2+0.8*u", "0.5+0.5*u"] {
            wrong.push(with(&plain, 'u', part));
        }
        // Mirrored onto themselves, whole and half, and to the other side.
        wrong.push(with(&plain, 'u', "abs(2*u-1)"));
        wrong.push(with(&plain, 'v', "abs(2*v-1)"));
        wrong.push(with(&plain, 'v', "abs(v-0.5)"));
        let [x, y, z] = plain.clone();
        wrong.push([x, y, format!("-({z})")]);
        // Turned out of the hemisphere.
        for degrees in [10.0, 30.0, 90.0] {
            wrong.push(tilted(&plain, degrees));
        }
    }
    assert_eq!(wrong.len(), 100);
    for map in wrong {
        let areas = areas(&map);
        assert!(!covers_once(&map, &areas), "{map:?} is right");
        let found = found(&map, "0.1").unwrap_or_else(|| panic!("{map:?} passed"));
        let whole = match found {
            Bsdf::CoversTwice { times, .. } => {
                assert!(
                    areas.iter().any(|area| (area - times).abs() < 0.2),
                    "{map:?}: {times}"
                );
                areas.iter().any(|area| *area > 1.15)
            }
            Bsdf::LeavesOut { times, .. } => times < 1.0 && areas.iter().any(|area| *area < 0.85),
            Bsdf::OnlyBelow => areas[..64].iter().sum::<f64>() < 1e-9,
            other => panic!("{other:?}"),
        };
        assert!(whole, "{map:?}: {found:?}");
    }
}

#[test]
fn thirty_five_right_maps_are_accepted() {
    let mut right: Vec<Map> = Vec::new();
    for kind in ROUND {
        let plain = round(kind, "2*pi*v");
        right.push(with(&plain, 'u', "1-u"));
        // Mirrored and turned azimuths, and denser ones to both sides.
        right.push(with(&plain, 'v', "1-v"));
        right.push(with(&plain, 'v', "v+0.37"));
        right.push(round(kind, "2*pi*v + 0.3*sin(4*pi*v)"));
        right.push(plain);
    }
    // Lobes about the normal, as of microfacets.
    for alpha in [0.1, 0.3, 0.6] {
        let slope = format!("(1 + ({alpha}^2-1)*u)");
        let radius = format!("sqrt({alpha}^2*u/{slope})");
        let height = format!("sqrt((1-u)/{slope})");
        right.push(round([&radius, &height], "2*pi*v"));
    }
    // And as of brushed ones.
    for [along, across] in [[0.5, 0.4], [0.8, 0.4], [0.5, 0.2], [0.3, 0.1], [0.1, 0.04]] {
        right.push(brushed(along, across));
    }
    let sphere = round(["2*sqrt(u*(1-u))", "1-2*u"], "2*pi*v");
    right.push(sphere.clone());
    // Some maps send few points to the horizon: a value that does not fall there has no bound.
    for map in &right {
        assert_eq!(codes(map.clone(), &["0.1*cos_i^2"]), [""; 0], "{map:?}");
    }
    right.push(tilted(&sphere, 90.0));
    assert_eq!(right.len(), 35);
    for map in right {
        assert!(covers_once(&map, &areas(&map)), "{map:?} is wrong");
        assert_eq!(found(&map, "0.1"), None, "{map:?}");
    }
}

/// Lobes too narrow for the areas, whose slopes cover the plane by construction.
#[test]
fn narrow_lobes_are_accepted() {
    for [along, across] in [[0.3, 0.02], [0.1, 0.02], [0.05, 0.02], [0.02, 0.3]] {
        let map = brushed(along, across);
        assert_eq!(codes(map.clone(), &["0.05"]), [""; 0], "{map:?}");
        assert_eq!(
            codes(with(&map, 'v', "2*v"), &["0.05"]),
            ["QRT0419"],
            "{map:?}"
        );
        assert_eq!(
            codes(with(&map, 'v', "0.5*v"), &["0.05"]),
            ["QRT0421"],
            "{map:?}"
        );
    }
}

#[test]
fn nothing_need_be_covered_where_the_value_is_zero() {
    let cap = with(&round(ROUND[1], "2*pi*v"), 'u', "0.5*u");
    assert_eq!(found(&cap, "max(0, cos_i-0.5)"), None);
    let wide = found(&cap, "max(0, cos_i-0.3)").unwrap();
    assert!(matches!(wide, Bsdf::LeavesOut { .. }), "{wide:?}");
    // A lobe too narrow for its map to reach the horizon in double precision.
    let lobe = round(["sqrt(1-u^(2/2001))", "u^(1/2001)"], "2*pi*v");
    assert_eq!(found(&lobe, "0.9*2001/(2*pi)*cos_i^1999"), None);
    let half = with(&lobe, 'v', "0.5*v");
    let half = found(&half, "0.9*2001/(2*pi)*cos_i^1999").unwrap();
    assert!(
        matches!(half, Bsdf::LeavesOut { whole, .. } if (whole - 0.5).abs() < 0.01),
        "{half:?}"
    );
}

#[test]
fn a_value_of_the_square_is_known_where_the_map_goes() {
    let half = round(ROUND[0], "pi*v");
    assert_eq!(found(&half, "0.1*u"), None);
    let twice = found(&round(ROUND[0], "4*pi*v"), "0.1*u").unwrap();
    assert!(matches!(twice, Bsdf::CoversTwice { times, .. } if (times - 2.0).abs() < 0.01));
}

/// Checks channels one by one: a channel that depends on u or v does not exempt the others, and
/// they do not exempt it.
#[test]
fn channels_are_looked_at_one_by_one() {
    let (half, twice) = (round(ROUND[0], "pi*v"), round(ROUND[0], "4*pi*v"));
    assert_eq!(codes(half.clone(), &["0.1*u"; 3]), [""; 0]);
    assert_eq!(codes(half, &["0.1", "0.1", "0.1*u"]), ["QRT0421"]);
    assert_eq!(codes(twice, &["0", "0", "0.1*u"]), ["QRT0419"]);
}

#[test]
fn a_stated_jacobian_excuses_nothing() {
    let map = round(ROUND[0], "4*pi*v");
    for jacobian in [
        Jacobian::Auto,
        Jacobian::Stated("2*pi/sqrt(1-u)".to_owned()),
    ] {
        let bsdf = crate::scene::Bsdf {
            map: map.clone(),
            jacobian,
            value: vec!["0.9/pi".to_owned()],
            pdf: None,
        };
        let problems =
            crate::valid::bsdf::compile(&bsdf, &crate::valid::bsdf::Faces::NONE).unwrap_err();
        let codes: Vec<_> = problems.iter().map(Problem::code).collect();
        // The energy is not reported: the value does not gain any.
        assert_eq!(codes, ["QRT0419"]);
    }
}
