//! The right thing to write, in the macro's form.

use qrt_core::codes;
use qrt_core::report::Problem;
use qrt_core::scene::{Estimator, Map, Sequence};

/// Keys and entries as they may be written.
const EXAMPLES: &[(&str, &str)] = &[
    ("name", "name: \"cornell-box\""),
    (
        "camera",
        "camera: perspective { eye: (0, 1, 5), target: (0, 0, 0), vfov: 40 }",
    ),
    ("film", "film: 64 x 64"),
    (
        "material",
        "material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) }",
    ),
    (
        "quad",
        "quad: white { (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0) }",
    ),
    (
        "triangle",
        "triangle: white { (0, 0, 0), (1, 0, 0), (0, 1, 0) }",
    ),
    ("mesh", "mesh: white { obj: \"mesh.obj\" }"),
    ("depth", "depth primary { bits: (8, 8) }"),
    ("sampling", "sampling { path_bits: 12 }"),
    ("precision", "precision { fraction: 14 }"),
    ("comparator", "comparator { bits: 10 }"),
    ("counting", "counting { phase_bits: 8 }"),
    ("circuit", "circuit { uncompute: scoped }"),
    ("accuracy", "accuracy { error: 0.01, confidence: 0.95 }"),
    ("budget", "budget { qubits: 2000, toffoli: 1_000_000 }"),
    ("eye", "eye: (0, 1, 5)"),
    ("target", "target: (0, 0, 0)"),
    ("up", "up: (0, 1, 0)"),
    ("vfov", "vfov: 40"),
    ("width", "width: 64"),
    ("height", "height: 64"),
    ("albedo", "albedo: rgb(0.7, 0.7, 0.7)"),
    ("radiance", "radiance: rgb(10, 10, 10)"),
    ("reflectance", "reflectance: rgb(0.9, 0.9, 0.9)"),
    ("ior", "ior: 1.5"),
    ("alpha", "alpha: 0.2"),
    ("diffuse", "diffuse: rgb(0.5, 0.5, 0.5)"),
    ("specular", "specular: rgb(0.2, 0.2, 0.2)"),
    ("exponent", "exponent: 20"),
    (
        "map",
        "map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u))",
    ),
    ("jacobian", "jacobian: auto"),
    ("value", "value: 0.5 / pi"),
    ("obj", "obj: \"mesh.obj\""),
    ("bits", "bits: (8, 8)"),
    ("error", "error: 0.01"),
    ("confidence", "confidence: 0.95"),
];

/// A key, or an entry of a scene, as it may be written.
pub(crate) fn example(key: &str) -> Option<&'static str> {
    let found = EXAMPLES.iter().find(|(name, _)| *name == key);
    found.map(|(_, example)| *example)
}

/// A key of the record `name`, as it may be written.
pub(crate) fn record(name: &str) -> String {
    let key = match name {
        "perspective" | "orthographic" => "eye",
        "lambertian" => "albedo",
        "emitter" => "radiance",
        "mirror" | "ggx" => "reflectance",
        "dielectric" => "ior",
        "phong" => "exponent",
        "bsdf" => "value",
        "mesh" => "obj",
        "film" => "width",
        "accuracy" => "error",
        "depth" | "depths" => "bits",
        "sampling" => return "`path_bits: 12`".to_owned(),
        "budget" => return "`qubits: 2000`".to_owned(),
        "counting" => return "`phase_bits: 8`".to_owned(),
        "comparator" => return "`bits: 10`".to_owned(),
        "precision" => return "`fraction: 14`".to_owned(),
        "circuit" => return "`uncompute: scoped`".to_owned(),
        _ => return "a name, `:` and a value".to_owned(),
    };
    format!("`{}`", example(key).unwrap_or(key))
}

/// What a problem of the checker says, with the words of the macro.
pub(crate) fn message(problem: &Problem) -> String {
    spelled(&problem.message, problem.code == codes::UNKNOWN_WORD)
}

/// What to do about a problem of the checker.
pub(crate) fn help(problem: &Problem) -> String {
    let message = problem.message.as_str();
    match problem.code {
        codes::MISSING_KEY => {
            let missing = message.rsplit(" lacks ").next().unwrap_or_default();
            if missing == "`material`" {
                return "write the material before the braces: `quad: white { ... }`".to_owned();
            }
            let keys = missing.split('`').skip(1).step_by(2);
            let examples: Vec<&str> = keys.filter_map(example).collect();
            if !examples.is_empty() {
                return format!("write `{}`", examples.join(", "));
            }
        }
        codes::UNKNOWN_MATERIAL if problem.help.as_deref().is_some_and(|h| h.contains("under")) => {
            let name = message.split('`').nth(1).unwrap_or_default();
            let is_word = syn::parse_str::<syn::Ident>(name).is_ok();
            let name = if is_word {
                name.to_owned()
            } else {
                format!("{name:?}")
            };
            let material = example("material").unwrap_or_default();
            return format!("define it: `{}`", material.replace("white", &name));
        }
        codes::OBJ_UNREADABLE => {
            return "relative paths start at the folder of Cargo.toml".to_owned();
        }
        codes::WRONG_TYPE | codes::WRONG_LENGTH => {
            let forms = [
                ("a list of 2", "write `(a, b)`"),
                (
                    "a list of 3",
                    "write `(x, y, z)`, or `rgb(r, g, b)` for a colour",
                ),
                ("a list of 4", "a quad has four points, a triangle three"),
                (
                    "one expression or three",
                    "write one expression for grey, or `rgb(r, g, b)`",
                ),
                ("(a map)", "write `key: value` pairs in braces"),
                ("a map", "write `key: value` pairs in braces"),
                ("a list", "write `[...]`"),
            ];
            let expected = message.split(", found").next().unwrap_or_default();
            if let Some((_, form)) = forms.iter().find(|(what, _)| expected.ends_with(what)) {
                return (*form).to_owned();
            }
        }
        _ => {}
    }
    if let Some(help) = &problem.help {
        return spelled(help, problem.code == codes::UNKNOWN_WORD);
    }
    let advice = codes::lookup(problem.code).map_or("", |row| row.advice);
    let mut letters = advice.chars();
    let first = letters.next().map(|first| first.to_lowercase().to_string());
    spelled(&(first.unwrap_or_default() + letters.as_str()), false)
}

/// A text whose words of scenes, between backticks, are written with `_`; with `all`, whatever
/// stands between backticks.
fn spelled(text: &str, all: bool) -> String {
    let is_word = |part: &str| {
        all || [Sequence::NAMES, Map::NAMES, Estimator::NAMES]
            .iter()
            .any(|names| names.contains(&part))
    };
    let parts = text.split('`').enumerate().map(|(number, part)| {
        if number % 2 == 1 && is_word(part) {
            part.replace('-', "_")
        } else {
            part.to_owned()
        }
    });
    parts.collect::<Vec<_>>().join("`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_spelled_with_underscores() {
        assert_eq!(
            spelled("did you mean `monte-carlo` or `a-b`?", false),
            "did you mean `monte_carlo` or `a-b`?"
        );
        assert_eq!(spelled("no `a-b`", true), "no `a_b`");
    }
}
