//! Plans of the search of meshes.

mod shapes;

use super::Facing;
use crate::search::Search;
use crate::{PixelClass, Stage};
use glam::DVec3;
use shapes::{Triangles, knot, meshes, scene, scene_from, torus, turned, waves};

#[test]
fn meshes_are_searched_by_their_edges() {
    for (name, triangles) in &meshes() {
        let stage = Stage::<3>::rgb(&scene(triangles), PixelClass::MayMeetLamp);
        let search = Search::new(&stage, 1.0 / 65_536.0);
        let mesh = &search.surfaces.mesh;
        println!("{:?} {name}", mesh.size());
        assert_eq!(mesh.faces.len(), triangles.len(), "{name}");
        let is_open = mesh.faces[0].facing == Facing::Both;
        assert_eq!(is_open, name.starts_with("waves"), "{name}");
    }
}

#[test]
fn a_camera_on_a_face_does_not_search_it() {
    let faces = waves(14);
    let eye = faces[40].iter().sum::<DVec3>() / 3.0;
    let with_eye = |eye: DVec3| {
        let stage = Stage::<3>::rgb(&scene_from(&faces, eye), PixelClass::MayMeetLamp);
        let search = Search::new(&stage, 1.0 / 65_536.0);
        let label = 6 + 40;
        [&search.camera, &search.surfaces].map(|plan| plan.mesh.labels().any(|own| own == label))
    };
    assert_eq!(with_eye(eye), [false, true]);
    assert_eq!(with_eye(eye + 0.01 * DVec3::Y), [true, true]);
}

/// A prism over a polygon that crosses itself: closed, of a volume above 0, and met from behind first.
#[test]
fn surfaces_that_cross_themselves_have_no_outer_side() {
    let rim = [[-1.0, -0.6], [1.0, 1.0], [1.0, -1.0], [-1.0, 0.6]];
    let at = |k: usize, z: f64| DVec3::new(rim[k % 4][0], rim[k % 4][1], z);
    let mut outlines = vec![
        vec![at(0, 1.0), at(1, 1.0), at(2, 1.0)],
        vec![at(0, 1.0), at(2, 1.0), at(3, 1.0)],
        vec![at(2, -1.0), at(1, -1.0), at(0, -1.0)],
        vec![at(3, -1.0), at(2, -1.0), at(0, -1.0)],
    ];
    outlines.extend((0..4).map(|k| vec![at(k, -1.0), at(k + 1, -1.0), at(k + 1, 1.0), at(k, 1.0)]));
    let side = |outlines: &[Vec<DVec3>]| {
        let outlines: Vec<&[DVec3]> = outlines.iter().map(Vec::as_slice).collect();
        super::lines::outer_side(&outlines)
    };
    assert_eq!(side(&outlines), None);
    let of = |triangles: Triangles| {
        let outlines: Vec<Vec<DVec3>> = triangles.iter().map(|face| face.to_vec()).collect();
        side(&outlines)
    };
    assert_eq!(of(knot(48, 6)), of(torus(16, 8)));
    assert_eq!(
        of(turned(torus(16, 8))),
        of(torus(16, 8)).map(|front| !front)
    );
    assert!(of(torus(16, 8)).is_some());
}
