//! The figure `map`: a lattice in the unit square, and its image under a map on the sphere.
//!
//! The code that checks a scene also reads, differentiates and checks the reader's own map.

use qrt_lab::playground::Answer;
use qrt_scene::sampling::{ProductLattice, SamplingError, cell_centre, maps};
use qrt_scene::valid::bsdf;
use qrt_scene::{Bsdf, Jacobian, Map};
use qrt_syntax::expr::{Expr, Variables};
use qrt_syntax::{Problem, Step};
use std::fmt::Write;

/// Most bits of each of the two coordinates that the figure offers.
pub const MOST_BITS: u32 = 6;
/// Longest formula of a Jacobian that is shown, in bytes.
const LONGEST_FORMULA: usize = 160;

/// The source of directions.
#[derive(Clone, Debug, PartialEq)]
pub enum Chosen {
    /// One of qrt's own maps.
    Builtin(Map),
    /// Expressions in u and v for x, y and z, one on each line.
    Own(String),
}

/// Returns points of the square, their directions and Jacobians, and the integral of the cosine over
/// the hemisphere with the Jacobians as factors and as divisors; or a text with all errors.
///
/// # Errors
/// Bits out of range.
pub fn answer(chosen: &Chosen, bits: u32) -> Result<Answer, SamplingError> {
    let map = match chosen {
        Chosen::Builtin(map) => maps::builtin(*map),
        Chosen::Own(text) => match own(text) {
            Ok(map) => *map,
            Err(problems) => return Ok(Answer::default().text("error", problems)),
        },
    };
    let projected = maps::projected_jacobian(&map);
    let jacobian = maps::jacobian(&map);
    let lattice = ProductLattice::new(&[[bits, bits]])?;
    let paths = 1_u64 << lattice.path_bits();

    let mut columns: [Vec<f64>; 6] = [const { Vec::new() }; 6];
    let (mut multiplied, mut divided) = (0.0, 0.0);
    let mut room = Vec::new();
    for id in 0..paths {
        let coordinate = |dimension| cell_centre(lattice.index(dimension, id) as u32, bits);
        let at = Variables {
            u: coordinate(0),
            v: coordinate(1),
            ..Variables::default()
        };
        let [x, y, z] = map
            .each_ref()
            .map(|component| component.eval_in(&at, &mut room));
        let area = jacobian.eval_in(&at, &mut room);
        multiplied += projected.eval_in(&at, &mut room) / paths as f64;
        divided += z.abs() / area / paths as f64;
        for (column, value) in columns.iter_mut().zip([at.u, at.v, x, y, z, area]) {
            column.push(value);
        }
    }
    let [u, v, x, y, z, area] = columns;
    let formulas = map.each_ref().map(formula);
    Ok(Answer::default()
        .number("points", paths as f64)
        .number("multiplied", multiplied)
        .number("divided", divided)
        .list("u", u)
        .list("v", v)
        .list("x", x)
        .list("y", y)
        .list("z", z)
        .list("jacobian", area)
        .lines("formulas", &formulas)
        .text("jacobian_formula", formula(&jacobian)))
}

/// Returns the text of a formula, unless it is too long to read.
fn formula(expression: &Expr) -> String {
    let text = expression.to_string();
    if text.len() > LONGEST_FORMULA {
        "a long formula".to_owned()
    } else {
        text
    }
}

/// Parses the map from three lines of text, or returns all errors.
fn own(text: &str) -> Result<Box<[Expr; 3]>, String> {
    let mut lines = text.split('\n');
    let bsdf = Bsdf {
        map: [(); 3].map(|()| lines.next().unwrap_or_default().to_owned()),
        jacobian: Jacobian::Auto,
        // The figure needs only the map, so the value is 0: a BSDF without reflection is valid.
        value: vec!["0".to_owned()],
        pdf: None,
    };
    match bsdf::compile(&bsdf, &bsdf::Faces::NONE) {
        Ok(compiled) => Ok(Box::new(compiled.map)),
        Err(problems) => {
            let told: Vec<String> = problems.iter().map(|p| message(&bsdf.map, p)).collect();
            Err(told.join("\n\n"))
        }
    }
}

/// Formats a problem as qrt does: its code and message, its place, and its remedy.
fn message(map: &[String; 3], problem: &Problem) -> String {
    let words = problem.description();
    let mut out = format!("error[{}]: {}", words.code, words.message);
    let mut steps = problem.path().into_iter().flat_map(|path| &path.0);
    let component = steps.find_map(|step| match step {
        Step::Item(place) => map.get(*place).map(|text| (["x", "y", "z"][*place], text)),
        _ => None,
    });
    if let Some((name, text)) = component {
        let within = problem.within.clone().unwrap_or(0..text.len());
        let before = text.get(..within.start).unwrap_or(text).chars().count();
        let marked = text.get(within).map_or(0, |part| part.chars().count());
        let marks = "^".repeat(marked.max(1));
        let _ = write!(out, "\n  |\n{name} | {text}\n  | {:before$}{marks}", "");
    }
    if let Some(help) = words.help {
        let _ = write!(out, "\n  = help: {help}");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const COSINE: &str = "sqrt(u)*cos(2*pi*v)\nsqrt(u)*sin(2*pi*v)\nsqrt(1-u)";

    fn found(chosen: &Chosen, name: &str) -> f64 {
        answer(chosen, 5).unwrap().number_of(name).unwrap()
    }

    /// The projected hemisphere has the area pi. 1/J is 1/(2 pi) under the uniform map, z/pi under
    /// the cosine map, of which the mean of z/J is 1/(4 pi) and 1/(2 pi).
    #[test]
    fn a_change_of_variables_multiplies() {
        let uniform = Chosen::Builtin(Map::UniformHemisphere);
        let cosine = Chosen::Builtin(Map::CosineHemisphere);
        for chosen in [&uniform, &cosine] {
            assert!((found(chosen, "multiplied") - PI).abs() < 1e-12);
        }
        assert!((found(&uniform, "divided") - 1.0 / (4.0 * PI)).abs() < 1e-12);
        assert!((found(&cosine, "divided") - 1.0 / (2.0 * PI)).abs() < 1e-12);
    }

    #[test]
    fn a_map_of_ones_own_is_the_built_in_one_if_it_says_the_same() {
        let own = answer(&Chosen::Own(COSINE.to_owned()), 3).unwrap();
        assert_eq!(
            own,
            answer(&Chosen::Builtin(Map::CosineHemisphere), 3).unwrap()
        );
        assert_eq!(own.number_of("points"), Some(64.0));
        let lengths = own.list_of("z").unwrap();
        assert!(lengths.iter().all(|&z| z > 0.0 && z < 1.0));
    }

    #[test]
    fn what_is_wrong_is_said_as_of_a_scene() {
        let error = |text: &str| {
            let answer = answer(&Chosen::Own(text.to_owned()), 3).unwrap();
            answer.text_of("error").unwrap().to_owned()
        };
        let unknown = error(&COSINE.replace("pi*v)\nsqrt(1", "pi*w)\nsqrt(1"));
        assert_eq!(
            unknown,
            "error[QRT0401]: unknown name `w`\n  |\ny | sqrt(u)*sin(2*pi*w)\n  |                  ^\n  \
             = help: this may depend on u, v, pi"
        );
        let off = error("u\nv\n1");
        assert!(off.contains("QRT0411"), "{off}");
        let empty = error("");
        assert!(empty.matches("QRT0406").count() >= 1, "{empty}");
    }
}
