//! Advice: the right thing to write, in the macro's form.

use qrt_syntax::{
    Description, Expected, Material, MeshFile, Sampling, Structure, What, called, codes, listed,
    nearest,
};

/// Examples of keys and entries.
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
    ("sphere", "sphere: white { center: (0, 1, 0), radius: 1 }"),
    (
        "disc",
        "disc: white { center: (0, 1, 0), normal: (0, 1, 0), radius: 1 }",
    ),
    ("box", "box: white { min: (-1, 0, -1), max: (1, 2, 1) }"),
    ("sky", "sky { radiance: rgb(1, 1, 1) }"),
    (
        "sun",
        "sun { direction: (1, 2, 1), radiance: rgb(30000, 30000, 30000) }",
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
    ("transmittance", "transmittance: rgb(0.9, 1, 0.9)"),
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
    ("center", "center: (0, 1, 0)"),
    ("normal", "normal: (0, 1, 0)"),
    ("radius", "radius: 1"),
    ("direction", "direction: (1, 2, 1)"),
    ("angle", "angle: 0.53"),
    ("min", "min: (-1, 0, -1)"),
    ("max", "max: (1, 2, 1)"),
    ("horizon", "horizon: rgb(1, 1, 1)"),
    ("zenith", "zenith: rgb(0.5, 0.7, 1)"),
    ("lens", "lens: { aperture: 0.1, focus: 10 }"),
    ("aperture", "aperture: 0.1"),
    ("focus", "focus: 10"),
    ("obj", "obj: \"mesh.obj\""),
    ("ply", "ply: \"mesh.ply\""),
    ("gltf", "gltf: \"mesh.glb\""),
    ("colors", "colors: vertices"),
    ("bits", "bits: (8, 8)"),
    ("error", "error: 0.01"),
    ("confidence", "confidence: 0.95"),
];

/// Returns an example of a key, or of an entry of a scene.
pub(crate) fn example(key: &str) -> Option<&'static str> {
    let found = EXAMPLES.iter().find(|(name, _)| *name == key);
    found.map(|(_, example)| *example)
}

/// Returns an example of a key of the record `name`.
pub(crate) fn record(name: &str) -> String {
    let key = match name {
        "perspective" | "orthographic" => "eye",
        "lambertian" => "albedo",
        "emitter" | "sky" | "sun" => "radiance",
        "sphere" => "radius",
        "disc" => "normal",
        "box" => "max",
        "lens" => "aperture",
        "mirror" | "ggx" | "metal" => "reflectance",
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

/// Returns a problem of the checker in the words of the macro.
pub(crate) fn description(what: &What) -> Description {
    let mut words = match what {
        What::Structure(Structure::UnknownWord { word, noun, words }) => {
            let word = spelled(word);
            What::from(Structure::UnknownWord { word, noun, words }).description()
        }
        _ => what.description(),
    };
    words.help = help(what).or(words.help).or_else(|| {
        let advice = codes::lookup(words.code)?.advice;
        let (first, rest) = advice.split_at_checked(1)?;
        Some(first.to_lowercase() + rest)
    });
    words
}

/// Returns the help for a problem, if tokens are written differently from text.
fn help(what: &What) -> Option<String> {
    let help = match what {
        What::Structure(Structure::MissingKeys { keys, .. }) => {
            if keys[..] == ["material"] {
                "write the material before the braces, such as `quad: white { ... }`"
            } else {
                let examples: Vec<&str> = keys.iter().filter_map(|key| example(key)).collect();
                let written = !examples.is_empty();
                return written.then(|| format!("write `{}`", examples.join(", ")));
            }
        }
        What::Structure(Structure::NoFile) => {
            "write `obj: \"mesh.obj\"`, `ply: \"mesh.ply\"` or `gltf: \"mesh.glb\"`"
        }
        What::Structure(Structure::WrongType { expected, .. }) => match expected {
            Expected::Elements(count) => return of_length(*count),
            Expected::Record { .. } | Expected::Variant { .. } => {
                "write `key: value` pairs in braces"
            }
            Expected::List { .. } => "write `[...]`",
            Expected::Word { words, .. } => return Some(one_of(words)),
            _ => return None,
        },
        What::Structure(Structure::WrongLength { expected, .. }) => return of_length(*expected),
        What::Structure(Structure::WrongChannels { .. }) => {
            "write one expression for grey, or `rgb(r, g, b)`"
        }
        What::Structure(Structure::UnknownWord { word, noun, words }) => {
            if let Some(help) = called(noun, word, words) {
                // Names of YAML are in backticks.
                let spell = |help: String, name: &&str| {
                    help.replace(&format!("`{name}`"), &format!("`{}`", spelled(name)))
                };
                return Some(words.iter().fold(help, spell));
            }
            return Some(match nearest(word, words.iter().copied()) {
                Some(near) => format!("did you mean `{}`?", spelled(near)),
                None => one_of(words),
            });
        }
        What::Material(Material::Unknown {
            name,
            near: None,
            defined,
            ..
        }) if defined.is_empty() => {
            let is_word = syn::parse_str::<syn::Ident>(name).is_ok();
            let name = if is_word {
                name.clone()
            } else {
                format!("{name:?}")
            };
            let material = example("material").unwrap_or_default();
            return Some(format!("define it: `{}`", material.replace("white", &name)));
        }
        What::Sampling(Sampling::TooManyDepths { most, .. }) => {
            return Some(format!("use at most {most} depths, or `product_lattice`"));
        }
        What::Sampling(Sampling::NotTheSum { .. }) => {
            "under `product_lattice` leave `path_bits` out, or change the bits"
        }
        What::OfFile { what, .. } => match **what {
            What::MeshFile(
                MeshFile::Missing { is_library, .. }
                | MeshFile::Failed { is_library, .. }
                | MeshFile::Irregular { is_library, .. },
            ) if !is_library => "relative paths start at the folder of Cargo.toml",
            _ => return None,
        },
        _ => return None,
    };
    Some(help.to_owned())
}

/// Returns the form of a list of `count` elements.
fn of_length(count: usize) -> Option<String> {
    let form = match count {
        2 => "write `(a, b)`",
        3 => "write `(x, y, z)`, or `rgb(r, g, b)` for a colour",
        4 => "a quad has four points, a triangle three",
        _ => return None,
    };
    Some(form.to_owned())
}

fn one_of(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| spelled(word)).collect();
    format!("write {}", listed(&words, "or"))
}

/// Returns a word of scenes as it is spelled in tokens.
fn spelled(word: &str) -> String {
    word.replace('-', "_")
}

#[cfg(test)]
mod tests {
    use super::super::body::ENTRIES;
    use super::*;
    use qrt_scene::{Camera, Material};

    #[test]
    fn every_record_has_a_key_that_may_be_written() {
        // The values of these are no records of keys, or are records of a kind.
        let others = [
            "name", "camera", "material", "quad", "triangle", "const", "for",
        ];
        let entries = ENTRIES.iter().filter(|entry| !others.contains(entry));
        let kinds = [Camera::NAMES, Material::NAMES].concat();
        for name in kinds.iter().chain(entries) {
            assert!(record(name).contains(": "), "{name}: {}", record(name));
        }
    }
}
