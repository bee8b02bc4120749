//! The example scenes of this folder, as a program holds them that has no folder.

/// Name and text.
pub(crate) const EXAMPLES: &[(&str, &str)] = &[
    ("lit-box", include_str!("lit-box.yaml")),
    ("cornell-box", include_str!("cornell-box.yaml")),
    ("cornell-mirror", include_str!("cornell-mirror.yaml")),
    ("cornell-glass", include_str!("cornell-glass.yaml")),
    ("cornell-ggx", include_str!("cornell-ggx.yaml")),
    ("terrace", include_str!("terrace.yaml")),
    ("velvet", include_str!("velvet.yaml")),
    ("knot", include_str!("knot.yaml")),
    ("floor-and-light", include_str!("floor-and-light.yaml")),
    ("furnace", include_str!("furnace.yaml")),
    ("weekend", include_str!("weekend.yaml")),
];

/// The files that they name.
pub(crate) const FILES: &[(&str, &[u8])] = &[
    ("meshes/knot.obj", include_bytes!("meshes/knot.obj")),
    ("meshes/roll.obj", include_bytes!("meshes/roll.obj")),
];
