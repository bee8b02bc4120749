//! Placeholder of the branch: the OBJ reader replaces it.
use crate::scene::Rgb;
use glam::DVec3;
use std::fmt;

/// A mesh.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct ObjMesh {
    pub faces: Vec<ObjFace>,
    pub materials: Vec<ObjMaterial>,
}
/// A triangle.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct ObjFace {
    pub vertices: [DVec3; 3],
    pub material: Option<usize>,
}
/// A material.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct ObjMaterial {
    pub name: String,
    pub radiance: Rgb,
    pub albedo: Rgb,
}
/// An error.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct ObjError {
    pub code: &'static str,
    pub message: String,
    pub help: Option<String>,
}
impl fmt::Display for ObjError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}
/// Reads triangles only.
pub fn load(path: &std::path::Path, _: bool) -> Result<ObjMesh, ObjError> {
    let fail = |message: String| ObjError {
        code: "QRT0320",
        message,
        help: None,
    };
    let text = std::fs::read_to_string(path).map_err(|error| fail(error.to_string()))?;
    let numbers = |line: &str| -> Vec<f64> {
        line.split_whitespace()
            .skip(1)
            .filter_map(|w| w.split('/').next().and_then(|w| w.parse().ok()))
            .collect()
    };
    let of = |tag: &'static str| text.lines().filter(move |line| line.starts_with(tag));
    let points: Vec<DVec3> = of("v ")
        .map(|line| numbers(line))
        .filter(|v| v.len() >= 3)
        .map(|v| DVec3::new(v[0], v[1], v[2]))
        .collect();
    let mut faces = Vec::new();
    for line in of("f ") {
        let ids = numbers(line);
        let at = |i: usize| {
            ids.get(i)
                .and_then(|id| points.get((*id as usize).checked_sub(1)?))
                .copied()
        };
        let (Some(a), Some(b), Some(c)) = (at(0), at(1), at(2)) else {
            return Err(fail("bad index".into()));
        };
        faces.push(ObjFace {
            vertices: [a, b, c],
            material: None,
        });
    }
    Ok(ObjMesh {
        faces,
        materials: Vec::new(),
    })
}
