//! The plans of scenes: outer planes, bodies, and the remaining planes.

use super::*;

/// Numbers of outer planes, of planes tested one by one, and of bodies, for rays with this start.
fn counts(stage: &Stage<3>, start: Start) -> [usize; 3] {
    counts_of(&Search::new(stage, ULP), start)
}

fn counts_of(search: &Search<'_>, start: Start) -> [usize; 3] {
    let plan = match start {
        Start::Camera => &search.camera,
        Start::Surface => &search.surfaces,
    };
    let outer = plan
        .outer
        .iter()
        .flat_map(|outer| outer.sides.iter().flatten());
    [outer.count(), plan.planes.len(), plan.bodies.len()]
}

fn both(camera: &str, shapes: &[&[Shape]]) -> [[usize; 3]; 2] {
    let stage = stage(camera, &shapes.concat());
    [Start::Camera, Start::Surface].map(|start| counts(&stage, start))
}

fn in_front() -> String {
    perspective(FRONT, MIDDLE, 45.0)
}

fn small() -> Shape {
    cuboid([-0.3, 0.0, -0.3], [0.3, 0.8, 0.3]).turned(0.4)
}

#[test]
fn the_cornell_box_is_a_room_with_two_bodies() {
    let stage = staged(include_str!("../../../../scenes-yaml/cornell-box.yaml"));
    let fine = Search::new(&stage, 1.0 / 65_536.0);
    // Five walls, one of them two triangles askew; the lamp hangs below the ceiling.
    for start in [Start::Camera, Start::Surface] {
        assert_eq!(counts_of(&fine, start), [6, 1, 2]);
    }
}

/// The lamp hangs half a unit of 560 below the ceiling. Numbers of 8 fraction bits cannot
/// distinguish the planes.
#[test]
fn a_ceiling_is_not_outer_where_numbers_cannot_tell_it_from_a_lamp_below() {
    let stage = staged(include_str!("../../../../scenes-yaml/cornell-box.yaml"));
    let coarse = Search::new(&stage, 1.0 / 256.0);
    for start in [Start::Camera, Start::Surface] {
        assert_eq!(counts_of(&coarse, start), [5, 2, 2]);
    }
}

#[test]
fn a_wall_whose_edges_are_corners_of_the_room_has_no_tests() {
    let closed = cuboid([-1.5, 0.0, -1.5], [1.5, 3.0, 1.5]);
    let inside = perspective([1.0, 1.4, -1.2], MIDDLE, 80.0);
    let stage = stage(&inside, &[closed, lamp(0.4, 2.9)]);
    let search = Search::new(&stage, ULP);
    for plan in [&search.camera, &search.surfaces] {
        // Walls that face each other are tested together.
        assert_eq!(plan.outer.len(), 3);
        let sides = plan
            .outer
            .iter()
            .flat_map(|outer| outer.sides.iter().flatten());
        assert!(sides.map(|side| &side.facet).all(Facet::is_plain));
    }
    // The edge at the opening is tested, once: the wall's other edges are corners of the room.
    let stage = super::stage(&in_front(), &room());
    let search = Search::new(&stage, ULP);
    let outer = search
        .surfaces
        .outer
        .iter()
        .flat_map(|outer| outer.sides.iter().flatten());
    let mut tests: Vec<usize> = outer
        .map(|side| side.facet.faces[0].1.edge_tests.len())
        .collect();
    tests.sort_unstable();
    assert_eq!(tests, [0, 1, 1, 1, 1]);
}

#[test]
fn a_plane_is_outer_only_for_a_camera_on_its_inner_side() {
    let shapes: &[&[Shape]] = &[&room()];
    // Without the front: 5 walls and the lamp.
    assert_eq!(both(&in_front(), shapes), [[5, 1, 0]; 2]);
    let above = perspective([0.3, 6.0, -4.0], [0.0, 3.0, 0.0], 50.0);
    // The walls are then a body that is open at the front.
    assert_eq!(both(&above, shapes), [[0, 1, 1], [5, 1, 0]]);
    // A camera on the ceiling's plane may look out, too.
    let on_ceiling = perspective([0.3, 3.0, -1.0], [0.0, 3.1, 0.0], 50.0);
    assert_eq!(both(&on_ceiling, shapes)[0], [0, 1, 1]);
    // The corners of a parallel camera's film count: some are beyond the side walls.
    let parallel = "orthographic: { eye: [0, 1.5, -4], target: [0, 1.5, 0], height: 4 }";
    assert_eq!(both(parallel, shapes)[0], [0, 1, 1]);
}

#[test]
fn only_rays_that_a_viewer_outside_sees_leave_the_scene_outwards() {
    let outwards = |camera: &str, shapes: &[Shape]| {
        let stage = stage(camera, shapes);
        let search = Search::new(&stage, ULP);
        let outer = search
            .surfaces
            .outer
            .iter()
            .flat_map(|outer| outer.sides.iter().flatten());
        outer.filter(|side| side.outwards).count()
    };
    assert_eq!(outwards(&in_front(), &room()), 0);
    assert_eq!(
        outwards(&perspective([0.3, 6.0, -4.0], MIDDLE, 50.0), &room()),
        1
    );
    let [lamp, walls] = [0, 1].map(|k| room()[k].clone());
    assert_eq!(outwards(&in_front(), &[lamp, walls.made_of("glass")]), 5);
}

#[test]
fn a_lamp_in_the_ceiling_is_a_face_of_an_outer_plane() {
    let walls = cuboid([-1.5, 0.0, -1.5], [1.5, 3.0, 1.5]).without(&[4]);
    for shapes in [[lamp(0.4, 3.0), walls.clone()], [walls, lamp(0.4, 3.0)]] {
        let stage = stage(&in_front(), &shapes);
        assert_eq!(counts(&stage, Start::Surface), [5, 0, 0]);
        let search = Search::new(&stage, ULP);
        assert_eq!(search.surfaces.emitting.len(), 1);
        // Faces on that plane may cover the lamp, and nothing else stands between.
        assert_eq!(search.surfaces.before_lamps.len(), 1);
    }
}

#[test]
fn faces_that_others_cover_are_asked_one_by_one() {
    let room = &room()[..];
    let solid = [small()];
    assert_eq!(both(&in_front(), &[room, &solid])[1], [5, 1, 1]);
    let decal = [level(0.1, 0.8)];
    assert_eq!(both(&in_front(), &[room, &solid, &decal])[1], [5, 6, 0]);
    // On the same plane, but beside it.
    let beside = [level(0.1, 0.8).at(0.9, 0.0, 0.0)];
    assert_eq!(both(&in_front(), &[room, &solid, &beside])[1], [5, 2, 1]);
    // The floor covers the underside, which no ray meets.
    let below = perspective([0.3, -2.0, -4.0], [0.0, 0.3, 0.0], 50.0);
    assert_eq!(both(&below, &[room, &solid])[0][2], 0);
}

#[test]
fn bodies_that_rays_may_be_in_are_met_where_they_leave() {
    let inside = |camera: &str, shapes: &[&[Shape]]| {
        let stage = stage(camera, &shapes.concat());
        let search = Search::new(&stage, ULP);
        let plans = [&search.camera, &search.surfaces];
        plans.map(|plan| {
            plan.bodies
                .iter()
                .map(|body| body.from_inside)
                .collect::<Vec<_>>()
        })
    };
    let room = &room()[..];
    let in_front = in_front();
    assert_eq!(inside(&in_front, &[room, &[small()]]), [[false], [false]]);
    // A floor would cover the underside, which rays from inside meet.
    let hovering = small().at(0.0, 0.3, 0.0);
    // Rays through the hole would come from below the floor, where nothing is.
    assert_eq!(
        inside(&in_front, &[room, &[small().without(&[BOTTOM])]]),
        [[false], [false]]
    );
    assert_eq!(
        inside(&in_front, &[room, &[hovering.clone().without(&[TOP])]]),
        [[true], [true]]
    );
    let glass = small().at(0.0, 0.5, 0.0).made_of("glass");
    assert_eq!(inside(&in_front, &[room, &[glass]]), [[true], [true]]);
    let within = perspective([0.05, 0.7, 0.0], [1.0, 0.8, 0.3], 90.0);
    assert_eq!(
        inside(&within, &[room, std::slice::from_ref(&hovering)]),
        [[true], [true]]
    );
    // Rays start on the polygon inside, if any get there.
    let through = [hovering, level(0.5, 0.7)];
    assert_eq!(inside(&in_front, &[room, &through]), [[false], [true]]);
}

#[test]
fn a_box_that_emits_stands_before_lamps_as_faces() {
    let solid = small().at(0.0, 0.6, 0.0);
    let shapes = [
        &room()[1..],
        &[solid.made_of("lamp"), small().at(0.9, 0.0, 0.0)],
    ]
    .concat();
    let stage = stage(&in_front(), &shapes);
    let search = Search::new(&stage, ULP);
    let at_lamps: Vec<bool> = search
        .surfaces
        .bodies
        .iter()
        .map(|body| body.at_lamps)
        .collect();
    assert_eq!(at_lamps, [true, false]);
    assert_eq!(search.surfaces.emitting.len(), 6);
    assert_eq!(search.surfaces.before_lamps.len(), 6);
}

#[test]
fn nearly_equal_planes_are_told_apart_where_it_matters() {
    // One triangle of the top is lower by less than circuits can distinguish.
    let mut dented = small().at(0.0, 0.3, 0.0).triangulated();
    let corner = dented.outlines[2 * TOP][1];
    for other in dented.outlines.iter_mut().flatten() {
        if other.distance(corner) < 1e-9 {
            other.y -= 2e-8;
        }
    }
    let room = &room()[..];
    assert_eq!(
        both(&in_front(), &[room, std::slice::from_ref(&dented)])[1][2],
        1
    );
    let glass = dented.clone().made_of("glass");
    assert_eq!(both(&in_front(), &[room, &[glass]])[1][2], 0);
    let one = |k: usize| Shape {
        outlines: vec![dented.outlines[k].clone()],
        material: if k == 2 * TOP { "lamp" } else { "grey" },
    };
    let painted: Vec<Shape> = (0..dented.outlines.len()).map(one).collect();
    assert_eq!(both(&in_front(), &[room, &painted])[1][2], 0);
}
