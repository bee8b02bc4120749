//! The registers of a path, with their formats as types, and the names of its faces and materials:
//! the vocabulary of predicates.

use super::names::identifiers;
use qrt_core::oracle::paths::{PathFormat, PathFormats, PathNumber, RayNumber};
use qrt_scene::valid::ValidScene;
use std::fmt::Write as _;

/// The most faces of a label with a list of them. A label of more faces has no list, since its
/// material distinguishes them as well.
const MOST_FACES: usize = 1_000;

/// An author's name, and the numbers that it stands for.
type Named = (String, Vec<usize>);

/// The module of the items used here.
const PATHS: &str = "::qrt::core::oracle::paths";

/// Writes a struct of a path's registers and its construction; nothing for a scene that is too
/// large.
pub(super) fn write(
    out: &mut String,
    scene: &str,
    public: &str,
    conditions: &str,
    valid: &ValidScene,
) {
    let Some(formats) = PathFormats::new(valid) else {
        return;
    };
    let text = |format: PathFormat| {
        let name = format.ty.name(format.width);
        format!("::qrt::circuit::format::{name}")
    };
    let of = |number| text(formats.format(PathNumber::Ray(0, number)));
    let colour = text(formats.format(PathNumber::Colour(0)));
    let [point, unit, distance, face, material] = [
        RayNumber::Origin(0),
        RayNumber::Direction(0),
        RayNumber::Distance,
        RayNumber::Face,
        RayNumber::Material,
    ]
    .map(of);
    let mut fields = String::new();
    let mut made = String::new();
    for ray in 0..formats.rays {
        let what = match ray {
            0 => "The primary ray".to_owned(),
            ray => format!("Ray {ray}"),
        };
        let _ = writeln!(
            fields,
            "/// {what}, and what it meets.\npub ray{ray}: {scene}PathRay,"
        );
        let _ = write!(made, "ray{ray}: inputs.ray({ray}), ");
    }
    let _ = writeln!(
        out,
        "{conditions}
        /// The registers of a ray of [`{scene}`]: points and distances in the scene's units, unit
        /// vectors, and the numbers of faces and materials from 1 on.
        #[allow(dead_code, reason = \"an author reads some of them only\")]
        {public} type {scene}PathRay =
            {PATHS}::RayRegisters<{point}, {unit}, {distance}, {face}, {material}>;

        {conditions}
        /// The registers of a path of [`{scene}`], which predicates read.
        #[derive(Debug)]
        #[allow(dead_code, reason = \"an author reads some of them only\")]
        {public} struct {scene}Path {{
            {fields}
            /// The path's radiance.
            pub colour: {PATHS}::ColourRegisters<{colour}>,
        }}

        {conditions}
        impl {PATHS}::PathScene for {scene} {{
            type Path = {scene}Path;

            fn scene() -> &'static ::qrt::scene::valid::ValidScene {{
                {scene}::scene()
            }}

            fn path(inputs: &mut {PATHS}::PathInputs<'_>) -> {scene}Path {{
                {scene}Path {{ {made} colour: inputs.colour() }}
            }}
        }}"
    );
}

/// Writes the numbers of materials and of labelled faces as constants.
pub(super) fn numbers(
    out: &mut String,
    scene: &str,
    public: &str,
    conditions: &str,
    (labels, valid): (&[Option<String>], &ValidScene),
) {
    let surfaces = valid.surfaces().iter().map(|surface| surface.name.clone());
    let materials: Vec<Named> = surfaces.zip((1..).map(|n| vec![n])).collect();
    // By label, in the order of the text: the faces of all primitives with that label.
    let mut faces: Vec<Named> = Vec::new();
    for (primitive, label) in labels.iter().enumerate() {
        let Some(label) = label else {
            continue;
        };
        let own = valid.polygons_of(primitive).map(|face| face + 1);
        match faces.iter_mut().find(|(known, _)| known == label) {
            Some((_, faces)) => faces.extend(own),
            None => faces.push((label.clone(), own.collect())),
        }
    }
    faces.retain(|(_, faces)| faces.len() <= MOST_FACES);
    table(
        out,
        (scene, public, conditions),
        ("Materials", "MATERIALS", "material", &materials),
    );
    table(
        out,
        (scene, public, conditions),
        ("Faces", "FACES", "face", &faces),
    );
}

/// Writes a struct with a field for each name, and a constant of that struct.
fn table(
    out: &mut String,
    (scene, public, conditions): (&str, &str, &str),
    (plural, constant, noun, named): (&str, &str, &str, &[Named]),
) {
    let names = identifiers(named.iter().map(|(name, _)| name.as_str()));
    let mut fields = String::new();
    let mut values = String::new();
    for (field, (name, numbers)) in names.iter().zip(named) {
        let name = name.replace('`', "'");
        let (ty, value) = match &numbers[..] {
            [one] => ("u32".to_owned(), one.to_string()),
            several => ("&'static [u32]".to_owned(), format!("&{several:?}")),
        };
        let _ = writeln!(fields, "/// `{name}`\npub {field}: {ty},");
        let _ = write!(values, "{field}: {value}, ");
    }
    let _ = writeln!(
        out,
        "{conditions}
        /// The number of each {noun} of [`{scene}`] that has a name, by name; all of them where
        /// several have one.
        #[derive(Clone, Copy, Debug)]
        #[allow(dead_code, non_snake_case, reason = \"an author's names, of which some are read\")]
        {public} struct {scene}{plural} {{ {fields} }}

        {conditions}
        #[allow(dead_code, reason = \"an author asks for some of them only\")]
        impl {scene} {{
            /// The number that each {noun} with a name has in the registers of a path.
            {public} const {constant}: {scene}{plural} = {scene}{plural} {{ {values} }};
        }}"
    );
}
