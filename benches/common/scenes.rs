//! The example scenes whose circuits are measured as they are; a mesh has few triangles there.

pub(crate) const CIRCUITS: [&str; 7] = [
    "furnace",
    "floor-and-light",
    "cornell-box",
    "cornell-mirror",
    "cornell-glass",
    "cornell-ggx",
    "velvet",
];
