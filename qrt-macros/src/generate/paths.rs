//! The registers of a path, with their formats as types, and the names of its faces and materials:
//! the vocabulary of predicates.

use super::names::{beside, identifiers};
use qrt_core::oracle::paths::{PathFormats, PathNumber, RayNumber};
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
pub(super) fn write(out: &mut String, scene: &str, public: &str, valid: &ValidScene) {
    let Some(formats) = PathFormats::new(valid) else {
        return;
    };
    let text = |number| format!("::qrt::circuit::format::{}", name(&formats, number));
    let colour = text(PathNumber::Colour(0));
    let [point, unit, distance, face, material] =
        KINDS.map(|number| text(PathNumber::Ray(0, number)));
    let path = beside(scene, "PATH");
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
        "/// The registers of a ray of [`{scene}`]: points and distances in the scene's units, unit
        /// vectors, and the numbers of faces and materials from 1 on.
        #[allow(dead_code, reason = \"an author reads some of them only\")]
        {public} type {scene}PathRay =
            {PATHS}::RayRegisters<{point}, {unit}, {distance}, {face}, {material}>;

        /// The registers of a path of [`{scene}`], which predicates read.
        #[::core::prelude::v1::derive(::core::fmt::Debug)]
        #[allow(non_camel_case_types, reason = \"messages show a name of this case without its module\")]
        #[allow(dead_code, reason = \"an author reads some of them only\")]
        {public} struct {path} {{
            {fields}
            /// The path's radiance.
            pub colour: {PATHS}::ColourRegisters<{colour}>,
        }}

        impl {PATHS}::PathScene for {scene} {{
            type Path = {path};

            fn scene() -> &'static ::qrt::scene::valid::ValidScene {{
                {scene}::scene()
            }}

            fn path(inputs: &mut {PATHS}::PathInputs<'_>) -> {path} {{
                {path} {{ {made} colour: inputs.colour() }}
            }}
        }}"
    );
}

/// Returns the documentation of a path's registers as predicates read them, with their formats.
/// Empty for a scene that is too large.
pub(crate) fn about(valid: &ValidScene) -> String {
    let Some(formats) = PathFormats::new(valid) else {
        return String::new();
    };
    let [point, unit, distance, face, material] =
        KINDS.map(|number| name(&formats, PathNumber::Ray(0, number)));
    let colour = name(&formats, PathNumber::Colour(0));
    let rays = match formats.rays {
        1 => "`path.ray0`".to_owned(),
        rays => format!("`path.ray0` to `path.ray{}`", rays - 1),
    };
    format!(
        "The registers of a path that predicates read, for {rays}:\n\n\
         | register | format |\n|---|---|\n\
         | `path.ray0.origin.x`, `.y`, `.z` | `{point}` |\n\
         | `path.ray0.direction.x`, `.y`, `.z` | `{unit}` |\n\
         | `path.ray0.found` | `Bool` |\n\
         | `path.ray0.distance` | `{distance}` |\n\
         | `path.ray0.face` | `{face}` |\n\
         | `path.ray0.material` | `{material}` |\n\
         | `path.ray0.front` | `Bool` |\n\
         | `path.ray0.normal.x`, `.y`, `.z` | `{unit}` |\n\
         | `path.colour.r`, `.g`, `.b` | `{colour}` |"
    )
}

/// One number of a ray for each format of its numbers.
const KINDS: [RayNumber; 5] = [
    RayNumber::Origin(0),
    RayNumber::Direction(0),
    RayNumber::Distance,
    RayNumber::Face,
    RayNumber::Material,
];

/// Returns the format of a number as Rust writes it.
fn name(formats: &PathFormats, number: PathNumber) -> String {
    let format = formats.format(number);
    format.ty.name(format.width)
}

/// Writes the numbers of materials and of labelled faces as constants.
pub(super) fn numbers(
    out: &mut String,
    scene: &str,
    public: &str,
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
    table(out, (scene, public), ("MATERIALS", "material", &materials));
    table(out, (scene, public), ("FACES", "face", &faces));
}

/// Writes a struct with a field for each name, and a constant of that struct.
fn table(
    out: &mut String,
    (scene, public): (&str, &str),
    (constant, noun, named): (&str, &str, &[Named]),
) {
    let ty = beside(scene, constant);
    let names = identifiers(named.iter().map(|(name, _)| name.as_str()));
    let mut fields = String::new();
    let mut values = String::new();
    for (field, (name, numbers)) in names.iter().zip(named) {
        let name = name.replace('`', "'");
        let (number, value) = match &numbers[..] {
            [one] => ("::core::primitive::u32".to_owned(), one.to_string()),
            several => (
                "&'static [::core::primitive::u32]".to_owned(),
                format!("&{several:?}"),
            ),
        };
        let _ = writeln!(fields, "/// `{name}`\npub {field}: {number},");
        let _ = write!(values, "{field}: {value}, ");
    }
    let _ = writeln!(
        out,
        "/// The number of each {noun} of [`{scene}`] that has a name, by name; all of them where
        /// several have one.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug,
        )]
        #[allow(non_camel_case_types, reason = \"messages show a name of this case without its module\")]
        #[allow(dead_code, non_snake_case, reason = \"an author's names, of which some are read\")]
        {public} struct {ty} {{ {fields} }}

        #[allow(dead_code, reason = \"an author asks for some of them only\")]
        impl {scene} {{
            /// The number that each {noun} with a name has in the registers of a path.
            {public} const {constant}: {ty} = {ty} {{ {values} }};
        }}"
    );
}
