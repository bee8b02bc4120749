//! One path of a scene, in the scene's units.

use crate::models::{Model, oracle_machine};
use crate::path_machines::Real;
use crate::render::RenderError;
use qrt_circuit::Word;
use qrt_core::oracle::paths::{PathFormats, PathNumber, PathScene, RayNumber};
use qrt_core::oracle::{Oracle, PredicateError};
use qrt_scene::valid::ValidScene;
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

/// A path as traced by a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct TracedPath<'a> {
    /// The rays of the path. Only the last one may meet nothing.
    pub rays: Vec<TracedRay<'a>>,
    /// The path's colour, in radiance: red, green, blue.
    pub colour: [f64; 3],
}

/// A ray of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TracedRay<'a> {
    /// The point of the scene at which the ray starts.
    pub origin: [f64; 3],
    /// The direction of the ray: of length 1, up to rounding.
    pub direction: [f64; 3],
    /// The face that the ray meets, if any.
    pub hit: Option<TracedHit<'a>>,
}

/// A face that a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TracedHit<'a> {
    /// The distance from the ray's origin, in units of the scene.
    pub distance: f64,
    /// The number of the face, from 1 on, in the order of the scene's polygons.
    pub face: u32,
    /// The number of the face's material, from 1 on.
    pub material: u32,
    /// The material's name.
    pub name: &'a str,
    /// True if the ray meets the front of the face.
    pub front: bool,
    /// The unit normal of the face's front.
    pub normal: [f64; 3],
}

impl fmt::Display for TracedHit<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = if self.front { "front" } else { "back" };
        write!(f, "the {side} of face {} (`{}`)", self.face, self.name)
    }
}

/// Formats the face that each ray meets, in one line.
impl fmt::Display for TracedPath<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, ray) in self.rays.iter().enumerate() {
            let comma = if number > 0 { ", " } else { "" };
            match &ray.hit {
                Some(hit) => write!(f, "{comma}ray {number} meets {hit}")?,
                None => write!(f, "{comma}ray {number} meets nothing")?,
            }
        }
        Ok(())
    }
}

/// Traces path `id` of pixel (column, row) of a scene of `qrt!`, and returns every number of it
/// that has a register, in the scene's units. `seed` keys the shifts of the digital net, as in
/// [`crate::render::RenderOptions`].
///
/// Under [`Model::Fixed`] and [`Model::Gates`], the numbers are the contents of their registers.
/// Under [`Model::Real`], they are the tracer's, before rounding to these registers.
///
/// # Errors
/// If the pixel is outside the film, the path index is beyond the last, or the scene has no
/// circuit.
pub fn trace_path<S: PathScene>(
    model: Model,
    seed: u64,
    pixel: [u32; 2],
    id: u64,
) -> Result<TracedPath<'static>, RenderError> {
    trace_path_of(S::scene(), model, seed, pixel, id)
}

/// As [`trace_path`], for any scene.
///
/// # Errors
/// As [`trace_path`].
pub fn trace_path_of(
    scene: &ValidScene,
    model: Model,
    seed: u64,
    pixel: [u32; 2],
    id: u64,
) -> Result<TracedPath<'_>, RenderError> {
    let film = scene.scene().film;
    if pixel[0] >= film.width || pixel[1] >= film.height {
        return Err(RenderError::Crop {
            crop: [pixel[0], pixel[1], 1, 1],
            film: [film.width, film.height],
        });
    }
    let path_bits = scene.scene().sampling.path_bits;
    if id >> path_bits != 0 {
        return Err(RenderError::PathIndex { id, path_bits });
    }
    let formats = PathFormats::new(scene).ok_or(PredicateError::TooLarge)?;
    let numbers = formats.numbers();
    let values = if model == Model::Real {
        Real::path(scene, &formats, &numbers, seed, pixel, id)?
    } else {
        let (oracle, registers) = Oracle::of_numbers(scene, &formats, &numbers)?;
        let words: Vec<Word> = registers
            .iter()
            .map(|&register| Word::unsigned(register, 0, oracle.program.width(register)))
            .collect();
        let machine = oracle_machine(model, Arc::new(oracle), seed, false)?;
        let read = machine.read(&words, pixel, id)?.into_iter();
        let of = numbers.iter().map(|&number| formats.format(number));
        of.zip(read)
            .map(|(format, bits)| format.value(bits.cast_unsigned()))
            .collect()
    };
    let values = numbers.into_iter().zip(values).collect();
    Ok(path(scene, &formats, &values))
}

fn path<'a>(
    scene: &'a ValidScene,
    formats: &PathFormats,
    values: &HashMap<PathNumber, f64>,
) -> TracedPath<'a> {
    let value = |number: PathNumber| values.get(&number).copied().unwrap_or(0.0);
    let mut rays = Vec::new();
    for depth in 0..formats.rays {
        let of = |number| value(PathNumber::Ray(depth, number));
        let vector = |number: fn(usize) -> RayNumber| [0, 1, 2].map(|axis| of(number(axis)));
        // A direction of 0 marks a ray that the path does not have.
        let direction = vector(RayNumber::Direction);
        if direction == [0.0; 3] {
            break;
        }
        let hit = (of(RayNumber::Found) == 1.0).then(|| {
            let material = of(RayNumber::Material) as u32;
            let surface = scene.surfaces().get(material.wrapping_sub(1) as usize);
            TracedHit {
                distance: of(RayNumber::Distance),
                face: of(RayNumber::Face) as u32,
                material,
                name: surface.map_or("", |surface| surface.name.as_str()),
                front: of(RayNumber::Front) == 1.0,
                normal: vector(RayNumber::Normal),
            }
        });
        let origin = vector(RayNumber::Origin);
        rays.push(TracedRay {
            origin,
            direction,
            hit,
        });
    }
    TracedPath {
        rays,
        colour: [0, 1, 2].map(|channel| value(PathNumber::Colour(channel))),
    }
}
