//! The faces that are found to bound a convex body.

use super::*;
use qrt_scene::valid::Polygon;

const TOLERANCE: f64 = 1.0 / (1_u64 << 22) as f64;

/// For each body among these polygons, the number of bounds with faces, and of bounds without.
fn found(outlines: &[Vec<[f64; 3]>]) -> Vec<[usize; 2]> {
    let polygon = |outline: &Vec<[f64; 3]>| {
        let mut vertices = [DVec3::ZERO; 4];
        for (vertex, corner) in vertices.iter_mut().zip(outline) {
            *vertex = DVec3::from_array(*corner);
        }
        Polygon {
            vertices,
            corners: outline.len() as u8,
            disc: false,
            surface: 0,
        }
    };
    let polygons: Vec<Polygon> = outlines.iter().map(polygon).collect();
    let geometry = StageGeometry::new(&polygons, &[], |_| false, &[]);
    let edges = Edges::new(&geometry);
    let bodies = bodies(&geometry, &edges, &components(&edges), TOLERANCE);
    let bounds = bodies.iter().map(|body| {
        let with = body.bounds.iter().filter(|bound| !bound.faces.is_empty());
        let with = with.count();
        [with, body.bounds.len() - with]
    });
    bounds.collect()
}

/// The sides of a box at low and high x, y, z.
pub(crate) fn cuboid([ax, ay, az]: [f64; 3], [bx, by, bz]: [f64; 3]) -> Vec<Vec<[f64; 3]>> {
    vec![
        vec![[ax, ay, az], [ax, ay, bz], [ax, by, bz], [ax, by, az]],
        vec![[bx, ay, az], [bx, by, az], [bx, by, bz], [bx, ay, bz]],
        vec![[ax, ay, az], [bx, ay, az], [bx, ay, bz], [ax, ay, bz]],
        vec![[ax, by, az], [ax, by, bz], [bx, by, bz], [bx, by, az]],
        vec![[ax, ay, az], [ax, by, az], [bx, by, az], [bx, ay, az]],
        vec![[ax, ay, bz], [bx, ay, bz], [bx, by, bz], [ax, by, bz]],
    ]
}

fn unit() -> Vec<Vec<[f64; 3]>> {
    cuboid([0.0; 3], [1.0; 3])
}

fn without(mut outlines: Vec<Vec<[f64; 3]>>, sides: &[usize]) -> Vec<Vec<[f64; 3]>> {
    let mut number = 0;
    outlines.retain(|_| {
        number += 1;
        !sides.contains(&(number - 1))
    });
    outlines
}

#[test]
fn a_box_is_a_body_and_its_missing_sides_are_planes_without_faces() {
    assert_eq!(found(&unit()), [[6, 0]]);
    assert_eq!(found(&without(unit(), &[2])), [[5, 1]]);
    assert_eq!(found(&without(unit(), &[0, 1])), [[4, 2]]);
    // The hole of two sides that meet is not flat.
    assert_eq!(found(&without(unit(), &[0, 2])), [] as [[usize; 2]; 0]);
}

#[test]
fn boxes_apart_are_bodies_each() {
    let other = cuboid([2.0, 0.0, 0.0], [3.0, 1.0, 1.0]);
    assert_eq!(found(&[unit(), other].concat()), [[6, 0], [6, 0]]);
    // Four faces meet at an edge of both.
    let beside = cuboid([1.0, 0.0, 0.0], [2.0, 1.0, 1.0]);
    assert_eq!(found(&[unit(), beside].concat()), [] as [[usize; 2]; 0]);
}

#[test]
fn triangles_of_one_side_are_one_bound() {
    let cut = |outline: &Vec<[f64; 3]>| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| outline[k]);
        [vec![a, b, c], vec![a, c, d]]
    };
    let triangles: Vec<Vec<[f64; 3]>> = unit().iter().flat_map(cut).collect();
    assert_eq!(found(&triangles), [[6, 0]]);
    // Half of a side is missing.
    assert_eq!(found(&without(triangles, &[7])), [] as [[usize; 2]; 0]);
}

#[test]
fn a_surface_that_is_bent_inwards_is_no_body() {
    let mut dented = unit();
    for corner in dented.iter_mut().flatten() {
        if *corner == [1.0; 3] {
            *corner = [0.4; 3];
        }
    }
    let dented: Vec<Vec<[f64; 3]>> = dented
        .into_iter()
        .flat_map(|outline| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| outline[k]);
            [vec![a, b, c], vec![a, c, d]]
        })
        .collect();
    assert_eq!(found(&dented), [] as [[usize; 2]; 0]);
}

#[test]
fn fewer_than_three_planes_bound_nothing() {
    let bent = without(unit(), &[1, 2, 4, 5]);
    assert_eq!(found(&bent), [] as [[usize; 2]; 0]);
    assert_eq!(found(&unit()[..1]), [] as [[usize; 2]; 0]);
}

#[test]
fn a_flap_that_folds_back_upon_a_side_is_no_side() {
    let mut folded = without(unit(), &[3]);
    // Instead of the top: a triangle that stands on the edge of a side and lies upon it.
    folded.push(vec![[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.5, 0.5, 0.0]]);
    assert_eq!(found(&folded), [] as [[usize; 2]; 0]);
    // A side modelled twice has four faces at each edge with its neighbours, or three.
    let mut twice = unit();
    twice.push(vec![[0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]]);
    assert_eq!(found(&twice), [] as [[usize; 2]; 0]);
}

#[test]
fn corners_may_be_off_their_plane_by_less_than_its_thickness() {
    let moved = |by: f64| {
        let mut moved = unit();
        for corner in moved.iter_mut().flatten() {
            if *corner == [1.0; 3] {
                *corner = [1.0, 1.0 + by, 1.0];
            }
        }
        found(&moved)
    };
    assert_eq!(moved(1e-8), [[6, 0]]);
    assert_eq!(moved(-1e-3), [] as [[usize; 2]; 0]);
}

#[test]
fn a_polygon_is_inside_a_body_by_more_than_the_tolerance() {
    let outlines = unit();
    let polygons: Vec<Polygon> = outlines
        .iter()
        .map(|outline| Polygon {
            vertices: [0, 1, 2, 3].map(|k| DVec3::from_array(outline[k])),
            corners: 4,
            disc: false,
            surface: 0,
        })
        .collect();
    let geometry = StageGeometry::new(&polygons, &[], |_| false, &[]);
    let edges = Edges::new(&geometry);
    let bodies = bodies(&geometry, &edges, &components(&edges), TOLERANCE);
    // In stage units the box is from -0.5 to 0.5.
    let square = |half: f64, y: f64| {
        [[-half, -half], [half, -half], [half, half], [-half, half]]
            .map(|[x, z]| DVec3::new(x, y, z))
    };
    let entered = |outline: &[DVec3]| bodies[0].is_entered_by(outline, 1e-6);
    assert!(entered(&square(0.2, 0.1)));
    assert!(entered(&square(3.0, 0.1)));
    assert!(!entered(&square(0.2, 0.5)));
    assert!(!entered(&square(0.2, 0.6)));
    assert!(!entered(&square(0.2, 0.5 - 1e-7)));
}
