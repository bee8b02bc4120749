//! Programs with `qrt!`, and the texts that their helps replace.

use super::Applied;

pub(super) const APPLIED: &[Applied] = &[
    (
        "accuracy_beside_a_knob",
        &[("        comparator { bits: 10 },\n", "")],
    ),
    ("albedo_above_one", &[("2 * BRIGHT", "BRIGHT")]),
    ("attribute_in_a_scene", &[("        #[cfg(test)]\n", "")]),
    (
        "attribute_without_brackets",
        &[("#pub scene Room", "pub scene Name")],
    ),
    (
        "block_without_braces",
        &[("comparator: 10", "comparator { bits: 10 }")],
    ),
    (
        "bsdf_that_makes_light",
        &[(
            "rgb(0.5 / pi, 1.5 / pi, 0.5 / pi)",
            "rgb(0.33 / pi, 1.5 * 0.6666 / pi, 0.33 / pi)",
        )],
    ),
    ("budget_exceeded", &[("toffoli: 500", "toffoli: 100_000")]),
    (
        "camera_without_a_kind",
        &[(
            "camera: { eye: (0, 1, 5), target: (0, 1, 0), vfov: 40 }",
            "camera: perspective { eye: (0, 1, 5), target: (0, 0, 0), vfov: 40 }",
        )],
    ),
    (
        "camera_without_a_value",
        &[(
            "camera:,",
            "camera: perspective { eye: (0, 1, 5), target: (0, 0, 0), vfov: 40 },",
        )],
    ),
    (
        "colon_missing_behind_an_entry",
        &[(
            "camera perspective { eye: (0, 1, 5), target: (0, 1, 0)",
            "camera: perspective { eye: (0, 1, 5), target: (0, 0, 0)",
        )],
    ),
    (
        "colon_without_a_material",
        &[("triangle roof: {", "triangle: white {")],
    ),
    ("comma_missing_between_entries", &[("8 x 8\n", "8 x 8,\n")]),
    (
        "comma_missing_between_keys",
        &[("(0, 1, 5) target", "(0, 1, 5), target")],
    ),
    (
        "comma_missing_between_points",
        &[("(-1, 0, -1) (-1", "(-1, 0, -1), (-1")],
    ),
    (
        "constant_before_its_definition",
        &[
            ("        const GREY: f64 = 0.73;\n", ""),
            (
                "pub scene Room {",
                "pub scene Room {\n        const GREY: f64 = 0.73;",
            ),
        ],
    ),
    (
        "constant_defined_twice",
        &[("const GREY: f64 = 0.5;", "const DARK: f64 = 0.5;")],
    ),
    ("constant_ends_in_a_comma", &[("0.73,", "0.73;")]),
    ("constant_misspelt", &[("WITE", "WHITE")]),
    ("constant_of_another_type", &[("f32", "f64")]),
    ("constant_that_is_infinite", &[("1 / 0", "1 / 2")]),
    (
        "constant_with_the_name_of_a_variable",
        &[("const cos_i", "const COS_I")],
    ),
    (
        "constant_without_a_definition",
        &[(
            "pub scene Room {",
            "pub scene Room {\n        const ANGLE: f64 = 1.0;",
        )],
    ),
    (
        "constant_without_a_name",
        &[("const: f64 = 2;", "const NAME: f64 = 1.0;")],
    ),
    (
        "constant_without_a_type",
        &[("const GREY = ", "const GREY: f64 = ")],
    ),
    (
        "depth_without_braces",
        &[("depth primary,", "depth primary { bits: (8, 8) },")],
    ),
    (
        "depths_in_two_places",
        &[("        sampling { depths: [{ bits: (8, 8) }] },\n", "")],
    ),
    (
        "empty",
        &[(
            "qrt! {}",
            "qrt! { pub scene Name from \"scenes/lit.yaml\" }",
        )],
    ),
    ("entry_in_quotes", &[("\"name\":", "name:")]),
    ("entry_misspelt", &[("camra", "camera")]),
    (
        "entry_unknown",
        &[("        atmosphere { density: 1 },\n", "")],
    ),
    (
        "everything_at_once",
        &[
            ("vfov: 400", "vfov: 40"),
            ("8 by 8", "64 x 64"),
            ("1.7", "0.7"),
            ("whit {", "white {"),
            ("(2, 2, 0)", "(2, 3, 0)"),
        ],
    ),
    ("expression_in_quotes", &[("\"0.5 / pi\"", "0.5 / pi")]),
    (
        "expression_that_does_not_parse",
        &[("1 + * cos_i", "1 + cos_i")],
    ),
    (
        "expression_with_a_method",
        &[
            ("u.sqrt()", "sqrt(u)"),
            ("(1 - u).sqrt()", "sqrt(1 - u)"),
            ("(1 - cos_i).powi(2)", "(1 - cos_i)^2"),
        ],
    ),
    (
        "expression_with_a_misspelt_constant",
        &[("SHEN ", "SHEEN ")],
    ),
    ("expression_with_an_unknown_name", &[("cosi)", "cos_i)")]),
    (
        "expression_with_brackets",
        &[("2 * [3]", "pi / sqrt(1 - u)")],
    ),
    (
        "file_outside_the_crate",
        &[("../room.yaml", "scenes/lit.yaml")],
    ),
    (
        "film_missing",
        &[(
            "        material",
            "        film: 64 x 64,\n        material",
        )],
    ),
    ("film_without_a_value", &[("film:,", "film: 64 x 64,")]),
    ("film_without_height", &[("film: 64,", "film: 64 x 64,")]),
    (
        "fraction_bits_out_of_range",
        &[
            ("<Fixed<2, 60>>", ""),
            (
                "film: 8 x 8,",
                "film: 8 x 8,\n        precision { fraction: auto },",
            ),
        ],
    ),
    ("from_a_file_that_is_missing", &[("lti", "lit")]),
    ("from_nothing", &[("Room from", "Room from \"scene.yaml\"")]),
    (
        "jacobian_of_another_map",
        &[("jacobian: pi", "jacobian: pi / sqrt(1 - u)")],
    ),
    ("jacobian_with_variables", &[("|u, v| pi", "pi")]),
    ("key_in_quotes", &[("\"bits\"", "bits")]),
    (
        "key_missing",
        &[("vfov: 40", "target: (0, 0, 0), vfov: 40")],
    ),
    ("key_misspelt", &[("fvov", "vfov")]),
    ("key_with_a_hyphen", &[("phase-bits", "phase_bits")]),
    ("key_with_an_equals_sign", &[("vfov = 40", "vfov: 40")]),
    (
        "key_without_a_name",
        &[("comparator { 8 }", "comparator { bits: 10 }")],
    ),
    ("key_written_twice", &[(", eye: (0, 1, 6)", "")]),
    ("kind_misspelt", &[("lambertan", "lambertian")]),
    ("label_given_twice", &[("triangle floor", "triangle roof")]),
    (
        "light_without_a_lamp",
        &[("film: 8 x 8,", "film: 8 x 8,\n        sky { radiance: 1 },")],
    ),
    (
        "loop_over_a_material",
        &[(
            "for i in 0..2 {\n            material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },\n        }",
            "material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },",
        )],
    ),
    (
        "loop_to_a_fraction",
        &[("for i in 0..2.5", "for i in [0, 0.5, 1]")],
    ),
    (
        "loop_too_long",
        &[(
            "for i in 0..1000 {\n            for j in 0..1000 {\n                quad floor: white { (-1, 0, -1), \
             (-1, 0, 1), (1, 0, 1), (1, 0, -1) },\n            }\n        }",
            "mesh: white { obj: \"scenes/triangle.obj\" },",
        )],
    ),
    (
        "loop_variable_called_pi",
        &[(
            "for pi in 0..2 {\n            quad floor: white { (-1, pi, -1), (-1, pi, 1), (1, pi, 1), (1, pi, -1) }",
            "for PI in 0..2 {\n            quad floor: white { (-1, PI, -1), (-1, PI, 1), (1, PI, 1), (1, PI, -1) }",
        )],
    ),
    ("loop_with_a_faulty_pass", &[("2 - i", "4 - i")]),
    (
        "loop_without_a_range",
        &[("for i in 4 {", "for i in 0..4 {")],
    ),
    ("loop_without_a_variable", &[("for {", "for i in 0..4 {")]),
    (
        "loop_without_an_end",
        &[("for i in 0.. {", "for i in 0..4 {")],
    ),
    (
        "loop_without_braces",
        &[
            ("for i in 0..2,", "for i in 0..4 {"),
            ("(1, 0, -1) },", "(1, 0, -1) }, }"),
        ],
    ),
    ("loop_without_in", &[("for i = 0..2", "for i in 0..4")]),
    ("map_below_the_surface", &[("-sqrt(1 - u)", "sqrt(1 - u)")]),
    (
        "map_of_half_the_hemisphere",
        &[
            ("cos(pi * v)", "cos(2 * pi * v)"),
            ("sin(pi * v)", "sin(2 * pi * v)"),
        ],
    ),
    (
        "map_of_other_variables",
        &[(
            "|a, b| (sqrt(a) * cos(2 * pi * b), sqrt(a) * sin(2 * pi * b), sqrt(1 - a))",
            "|u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u))",
        )],
    ),
    (
        "map_of_the_primary_ray",
        &[(", map: cosine_hemisphere", "")],
    ),
    (
        "map_that_goes_around_twice",
        &[
            ("cos(4 * pi * v)", "cos(2 * pi * v)"),
            ("sin(4 * pi * v)", "sin(2 * pi * v)"),
        ],
    ),
    (
        "map_that_leaves_the_sphere",
        &[
            ("(u * cos", "(sqrt(u) * cos"),
            (", u * sin", ", sqrt(u) * sin"),
        ],
    ),
    ("map_with_types", &[("|u: f64, v: f64|", "|u, v|")]),
    ("map_without_variables", &[("map: (", "map: |u, v| (")]),
    (
        "material_called_by_a_number",
        &[("material 3:", "material third:")],
    ),
    (
        "material_defined_twice",
        &[(
            "        material white: mirror { reflectance: rgb(1, 1, 1) },\n",
            "",
        )],
    ),
    (
        "material_missing",
        &[("triangle roof {", "triangle roof: white {")],
    ),
    (
        "material_of_a_mesh_within_the_braces",
        &[(
            "mesh { obj: \"scenes/triangle.obj\", material: white }",
            "mesh: white { obj: \"mesh.obj\" }",
        )],
    ),
    ("material_unknown", &[("whit {", "white {")]),
    (
        "material_unknown_in_two_places",
        &[
            (
                "pub scene Room {",
                "pub scene Room {\n        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },",
            ),
            (
                "pub scene Hall {",
                "pub scene Hall {\n        material white: lambertian { albedo: rgb(0.7, 0.7, 0.7) },",
            ),
        ],
    ),
    (
        "material_within_the_braces",
        &[("triangle roof { material: white, ", "triangle: white { ")],
    ),
    (
        "material_without_a_definition",
        &[(
            "pub scene Room {",
            "pub scene Room {\n        material velvet: lambertian { albedo: rgb(0.7, 0.7, 0.7) },",
        )],
    ),
    (
        "material_without_a_kind",
        &[("material white {", "material white: lambertian {")],
    ),
    ("material_without_a_name", &[("        material,\n", "")]),
    (
        "mesh_outside_the_crate",
        &[
            ("scenes/../../room.obj", "scenes/triangle.obj"),
            ("/etc/passwd", "scenes/triangle.obj"),
            (
                "mesh of_library { obj: \"scenes/outside.obj\"",
                "mesh of_library: white { obj: \"mesh.obj\"",
            ),
        ],
    ),
    (
        "mesh_that_is_missing",
        &[("meshes/no-such-mesh.obj", "scenes/triangle.obj")],
    ),
    (
        "not_a_scene",
        &[(
            "pub struct Room {",
            "pub scene Name {\n        camera: perspective { eye: (0, 1, 5), target: (0, 0, 0), vfov: 40 },",
        )],
    ),
    ("number_format", &[("<f64>", "<Fixed<2, 14>>")]),
    ("number_with_a_suffix", &[("40f64", "40")]),
    ("number_with_a_suffix_in_a_sum", &[("20f64", "20")]),
    ("path_without_quotes", &[("scenes_yaml", "\"scene.yaml\"")]),
    ("point_of_one_number", &[("eye: 5", "eye: (0, 1, 5)")]),
    ("point_with_two_coordinates", &[("(1, 0),", "(1, 0, 0),")]),
    (
        "points_with_a_key",
        &[(
            "vertices: [(0, 0, 0), (1, 0, 0), (0, 1, 0)]",
            "(0, 0, 0), (1, 0, 0), (0, 1, 0)",
        )],
    ),
    (
        "precision_in_two_places",
        &[("        precision { fraction: 12 },\n", "")],
    ),
    ("quad_of_three_points", &[("quad floor", "triangle floor")]),
    (
        "quad_that_is_not_convex",
        &[(
            "quad roof: white { (0, 0, 0), (4, 0, 0), (1, 1, 0), (0, 4, 0) }",
            "triangle: white { (0, 0, 0), (4, 0, 0), (1, 1, 0) },\n        \
             triangle: white { (0, 0, 0), (1, 1, 0), (0, 4, 0) }",
        )],
    ),
    (
        "scene_without_a_name",
        &[("pub scene {", "pub scene Name {")],
    ),
    (
        "scene_without_braces",
        &[
            ("Room: Scene;", "Name from \"scene.yaml\""),
            ("Room::", "Name::"),
        ],
    ),
    ("semicolon_after_an_entry", &[("8 x 8;", "8 x 8,")]),
    ("something_behind_the_braces", &[(" 5,", ",")]),
    ("text_without_quotes", &[("obj: knot", "obj: \"knot\"")]),
    (
        "two_commas_between_coordinates",
        &[("(0,, 5)", "(0, 1, 5)")],
    ),
    ("two_commas_between_entries", &[(",,", ",")]),
    ("two_commas_between_keys", &[(",,", ",")]),
    (
        "two_macros_with_one_name",
        &[("Room<Fixed<2, 12>>", "Attic<Fixed<2, 12>>")],
    ),
    (
        "two_scenes_of_one_name",
        &[("scene Room from", "scene Attic from")],
    ),
    (
        "unit_numbers_have_two_integer_bits",
        &[("Fixed<3, 14>", "Fixed<2, 14>")],
    ),
    ("value_missing", &[("eye: ,", "eye: (0, 1, 5),")]),
    ("value_of_two_channels", &[("(0.2, 0.3)", "0.2")]),
    (
        "value_takes_too_wide_a_number",
        &[(
            "(1e6 * cos_i * cos_o)^8 / (1 + (1e6 * cos_i * cos_o)^8)",
            "(cos_i * cos_o)^8 / (1 + (cos_i * cos_o)^8)",
        )],
    ),
    (
        "value_that_is_not_reciprocal",
        &[("(1 + 0.3 * cos_i)", "(1 + 0.3 * cos_i) * (1 + 0.3 * cos_o)")],
    ),
    (
        "value_with_rgb_in_it",
        &[(
            "rgb(0.5, 0.25 + 0.25, 0.5) / pi",
            "rgb(0.5 / pi, (0.25 + 0.25) / pi, 0.5 / pi)",
        )],
    ),
    ("variable_outside_of_a_bsdf", &[("40 * u", "40")]),
    (
        "vertices_at_one_point",
        &[("(1, 0, 0), (0, 0, 0)", "(1, 0, 0), (0, 1, 0)")],
    ),
    ("word_unknown", &[("monte_carl", "monte_carlo")]),
    ("word_with_a_hyphen", &[("digital-net", "digital_net")]),
    (
        "words_of_others",
        &[
            ("lookfrom", "eye"),
            ("fov: 40", "vfov: 40"),
            ("background", "sky"),
            ("        spp: 64,\n", ""),
            ("diffuse", "lambertian"),
            (
                "box: grey { min: (-1, 0, -1), max: (1, 0, 1) }",
                "quad: grey { (-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1) }",
            ),
            ("cube", "box"),
            ("sobol", "digital_net"),
            ("nee", "next_event"),
        ],
    ),
];

/// Programs whose help is about another file, each with the reason.
pub(super) const NOT_APPLIED: [(&str, &str); 3] = [
    ("errors_of_a_yaml_file", "the faults are in a YAML file"),
    (
        "number_format_of_a_file",
        "the format is written in the YAML file",
    ),
    (
        "use_of_a_faulty_scene",
        "the faults of one of its scenes are in a YAML file",
    ),
];
