//! Scenes in which searches are compared. Each is for an error that occurred, or could occur.

use super::*;

/// All kinds of scenes, by name.
pub(super) fn scenes() -> Vec<(&'static str, Stage<3>)> {
    let front = perspective(FRONT, MIDDLE, 45.0);
    let mut scenes = Vec::new();
    let mut with = |name: &'static str, camera: &str, shapes: &[&[Shape]]| {
        scenes.push((name, stage(camera, &shapes.concat())));
    };
    let room = &room()[..];
    let floor = &[level(1.5, 0.0)][..];
    let small = |x: f64, z: f64| {
        cuboid([-0.3, 0.0, -0.3], [0.3, 0.8, 0.3])
            .turned(0.4)
            .at(x, 0.0, z)
    };
    let standing = |shape: &Shape| {
        [
            shape.clone().turned(0.3).at(-0.7, 0.0, -0.2),
            shape
                .clone()
                .turned(2.0)
                .at(0.8, 0.0, 0.6)
                .without(&[BOTTOM]),
        ]
    };
    let axis = cuboid([-0.3, 0.0, -0.3], [0.3, 0.8, 0.3]);
    with("empty room", &front, &[room]);
    let ring = || ring().at(0.1, 0.6, 0.2).turned(0.3);
    with("a ring", &front, &[room, &[ring()]]);
    with(
        "a ring of glass",
        &front,
        &[room, &[ring().made_of("glass")]],
    );
    with(
        "a ring on a floor",
        &front,
        &[floor, &[lamp(0.4, 2.99), ring()]],
    );
    with(
        "half a ring",
        &front,
        &[room, &[ring().without(&[0, 1, 2, 3, 40, 41, 42, 43])]],
    );
    with(
        "from within a ring",
        &perspective([0.1, 0.6, 0.8], MIDDLE, 45.0),
        &[room, &[ring()]],
    );
    let hall = || cuboid([-1.0, 0.0, -1.0], [1.0, 1.0, 1.0]);
    let within = perspective([0.3, 0.5, 0.2], [-0.4, 0.3, -0.6], 70.0);
    let beside = |y: f64| level(0.7, y).at(2.2, 0.0, 0.0);
    with(
        "a hall beside a terrace",
        &within,
        &[&[hall(), beside(0.0), lamp(0.2, 0.9)]],
    );
    with(
        "a hall beside a roof",
        &within,
        &[&[hall(), beside(1.0), lamp(0.2, 0.9)]],
    );
    with(
        "a shining hall beside a roof",
        &within,
        &[&[hall().made_of("lamp"), beside(1.0)]],
    );
    with("boxes", &front, &[room, &standing(&axis)]);
    with(
        "boxes along the axes",
        &front,
        &[
            room,
            &[
                axis.clone().at(0.7, 0.0, 0.0),
                axis.clone().at(-0.7, 0.0, 0.3).without(&[BOTTOM]),
            ],
        ],
    );
    with(
        "triangulated boxes",
        &front,
        &[room, &standing(&axis).map(Shape::triangulated)],
    );
    with(
        "a hovering box",
        &front,
        &[room, &[small(0.2, 0.1).at(0.0, 0.9, 0.0)]],
    );
    with(
        "tetrahedra",
        &front,
        &[
            room,
            &[
                tetrahedron().at(-0.6, 0.0, 0.0),
                tetrahedron().at(0.6, 0.7, 0.3),
            ],
        ],
    );
    let prism = shape(
        vec![
            vec![[-0.5, 0.0, -0.4], [0.5, 0.0, -0.3], [0.1, 0.0, 0.4]],
            vec![[-0.5, 0.9, -0.4], [0.5, 0.9, -0.3], [0.1, 0.9, 0.4]],
            vec![
                [-0.5, 0.0, -0.4],
                [0.5, 0.0, -0.3],
                [0.5, 0.9, -0.3],
                [-0.5, 0.9, -0.4],
            ],
            vec![
                [0.5, 0.0, -0.3],
                [0.1, 0.0, 0.4],
                [0.1, 0.9, 0.4],
                [0.5, 0.9, -0.3],
            ],
            vec![
                [0.1, 0.0, 0.4],
                [-0.5, 0.0, -0.4],
                [-0.5, 0.9, -0.4],
                [0.1, 0.9, 0.4],
            ],
        ],
        "grey",
    );
    with(
        "prisms",
        &front,
        &[
            room,
            &[
                prism.clone().at(-0.7, 0.0, 0.0),
                prism.clone().at(0.7, 0.0, 0.2).without(&[0]),
            ],
        ],
    );
    with(
        "a prism without its ends",
        &front,
        &[room, &[prism.at(0.0, 0.5, 0.0).without(&[0, 1])]],
    );
    with(
        "an icosahedron",
        &front,
        &[room, &[icosahedron().at(0.0, 1.0, 0.0)]],
    );
    with("a boulder", &front, &[room, &[boulder().at(0.0, 0.9, 0.0)]]);
    with(
        "a glass cube",
        &front,
        &[room, &[small(0.0, 0.0).at(0.0, 0.3, 0.0).made_of("glass")]],
    );
    with(
        "glass on the floor",
        &front,
        &[
            room,
            &[
                small(-0.6, 0.0).made_of("glass"),
                small(0.6, 0.0).made_of("glass").without(&[BOTTOM]),
            ],
        ],
    );
    let alone = perspective([1.0, 2.4, -3.0], [0.0, 0.4, 0.0], 40.0);
    with(
        "glass that nothing is above",
        &alone,
        &[
            floor,
            &[
                axis.clone().at(0.0, 0.1, 0.0).made_of("glass"),
                level(0.2, 0.5).at(1.0, 0.0, 0.0),
            ],
        ],
    );
    with(
        "a glass boulder",
        &front,
        &[room, &[boulder().at(0.0, 0.9, 0.0).made_of("glass")]],
    );
    with(
        "an open box",
        &front,
        &[room, &[small(0.0, 0.0).without(&[TOP])]],
    );
    with(
        "an open box, seen from above",
        &alone,
        &[floor, &[small(0.0, 0.0).without(&[TOP])]],
    );
    let tall = cuboid([-0.3, 0.0, -0.3], [0.3, 0.8, 0.3]);
    let towers = [
        tall.clone().at(-0.6, 0.0, 0.0),
        tall.clone().at(0.5, 0.0, 0.3),
    ];
    with("two tops on one plane", &front, &[room, &towers]);
    with(
        "two tops on one plane, seen from above",
        &alone,
        &[floor, &towers],
    );
    with(
        "two boxes that touch",
        &front,
        &[
            room,
            &[
                tall.clone().at(-0.3, 0.0, 0.0),
                tall.clone().at(0.3, 0.0, 0.2),
            ],
        ],
    );
    with(
        "two boxes that overlap",
        &front,
        &[
            room,
            &[tall.clone(), tall.clone().turned(0.5).at(0.2, 0.1, 0.1)],
        ],
    );
    with(
        "a camera inside a box",
        &perspective([0.05, 0.4, 0.0], [1.0, 0.5, 0.3], 90.0),
        &[room, std::slice::from_ref(&tall)],
    );
    with(
        "a camera on a box's plane",
        &perspective([0.3, 0.4, -1.4], [0.2, 0.5, 0.0], 90.0),
        &[room, std::slice::from_ref(&tall)],
    );
    with(
        "a camera on a box's other plane",
        &perspective([-0.3, 0.4, -1.4], [-0.2, 0.5, 0.0], 90.0),
        &[room, std::slice::from_ref(&tall)],
    );
    let closed = [lamp(0.4, 2.99), cuboid([-1.5, 0.0, -1.5], [1.5, 3.0, 1.5])];
    with(
        "a camera in a closed room",
        &perspective([1.0, 1.4, -1.2], MIDDLE, 80.0),
        &[&closed, &[small(0.0, 0.0)]],
    );
    with(
        "a camera on a wall",
        &perspective([0.1, 1.4, -1.5], MIDDLE, 80.0),
        &[&closed, &[small(0.0, 0.0)]],
    );
    with(
        "a camera on a wall that looks out",
        &perspective([0.1, 1.4, -1.5], [2.0, 1.4, -2.0], 100.0),
        &[&closed],
    );
    with(
        "a camera on the ceiling",
        &perspective([0.1, 3.0, -1.0], [1.0, 3.2, 1.0], 120.0),
        &[room, &[small(0.0, 0.0)]],
    );
    with(
        "a camera above the room",
        &perspective([0.3, 6.0, -4.0], [0.0, 3.0, 0.0], 50.0),
        &[room, &[small(0.0, 0.0)]],
    );
    with(
        "a camera below the floor",
        &perspective([0.3, -2.0, -4.0], [0.0, 0.3, 0.0], 50.0),
        &[room, &standing(&axis)],
    );
    with(
        "a camera behind the back wall",
        &perspective([3.0, 1.0, 4.0], MIDDLE, 50.0),
        &[room, &standing(&axis)],
    );
    with(
        "a parallel camera",
        "orthographic: { eye: [0.2, 1.5, -4], target: [0, 1.3, 0], height: 4 }",
        &[room, &standing(&axis)],
    );
    with(
        "a parallel camera in the room",
        "orthographic: { eye: [0.2, 1.5, -0.2], target: [0, 1.3, 0.5], height: 3.5 }",
        &[room, &standing(&axis)],
    );
    with(
        "a small floor",
        &alone,
        &[
            &[level(0.6, 0.0), lamp(0.3, 1.6).at(0.9, 0.0, 0.0)],
            &[small(1.1, 0.4)],
        ],
    );
    with(
        "a floor in pieces",
        &alone,
        &[&[
            level(0.5, 0.0).at(-0.6, 0.0, 0.0),
            level(0.5, 0.0).at(0.6, 0.0, 0.1).triangulated(),
            lamp(0.3, 1.6),
        ]],
    );
    with(
        "a floor modelled twice",
        &alone,
        &[
            &[
                level(0.5, 0.0),
                level(0.5, 0.0).triangulated(),
                lamp(0.9, 1.6),
            ],
            &[small(0.0, 0.0)],
        ],
    );
    with(
        "nested rooms",
        &perspective([0.2, 1.4, -0.8], MIDDLE, 80.0),
        &[&closed, &[cuboid([-1.0, 0.2, -1.0], [1.1, 2.0, 1.2])]],
    );
    with(
        "nested rooms, seen from between",
        &perspective([0.2, 2.6, -1.3], MIDDLE, 80.0),
        &[&closed, &[cuboid([-1.0, 0.2, -1.0], [1.1, 2.0, 1.2])]],
    );
    let walls = cuboid([-1.5, 0.0, -1.5], [1.5, 3.0, 1.5]).without(&[4]);
    with(
        "a lamp in the ceiling, listed first",
        &front,
        &[&[lamp(0.4, 3.0), walls.clone()], &[small(0.0, 0.0)]],
    );
    with(
        "a lamp in the ceiling, listed last",
        &front,
        &[&[walls.clone(), lamp(0.4, 3.0)], &[small(0.0, 0.0)]],
    );
    with(
        "a lamp beside the ceiling",
        &front,
        &[
            &[
                walls.clone().without(&[TOP]),
                lamp(0.4, 3.0),
                level(0.6, 3.0).at(0.9, 0.0, 0.9),
            ],
            &[small(0.0, 0.0)],
        ],
    );
    let mark = level(0.1, 0.8).turned(0.2).made_of("lamp");
    with(
        "a lamp on a box's top, listed first",
        &front,
        &[std::slice::from_ref(&mark), room, &[small(0.0, 0.0)]],
    );
    with(
        "a lamp on a box's top, listed last",
        &front,
        &[room, &[small(0.0, 0.0), mark.clone()]],
    );
    with(
        "a decal on a box's top",
        &front,
        &[
            &[mark.clone().made_of("grey")],
            room,
            &[small(0.0, 0.0), level(0.05, 0.8).at(0.2, 0.0, 0.0)],
        ],
    );
    with(
        "a decal beside a box's top",
        &front,
        &[
            &[mark.at(0.9, 0.0, 0.0).made_of("grey")],
            room,
            &[small(0.0, 0.0)],
        ],
    );
    with(
        "a box that emits",
        &front,
        &[
            &[small(0.4, 0.0).at(0.0, 0.6, 0.0).made_of("lamp")],
            room,
            &[small(-0.6, 0.2)],
        ],
    );
    with(
        "a box with one side that emits",
        &front,
        &[
            &[
                small(0.4, 0.0)
                    .at(0.0, 0.6, 0.0)
                    .without(&[0, 1, 2, 4, 5])
                    .made_of("lamp"),
                small(0.4, 0.0).at(0.0, 0.6, 0.0).without(&[TOP]),
            ],
            room,
        ],
    );
    let ell = shape(
        vec![
            vec![
                [0.0, 0.0, 0.0],
                [1.0, 0.0, 0.0],
                [1.0, 0.8, 0.0],
                [0.0, 0.8, 0.0],
            ],
            vec![
                [1.0, 0.0, 0.0],
                [1.0, 0.0, 0.4],
                [1.0, 0.8, 0.4],
                [1.0, 0.8, 0.0],
            ],
            vec![
                [1.0, 0.0, 0.4],
                [0.4, 0.0, 0.4],
                [0.4, 0.8, 0.4],
                [1.0, 0.8, 0.4],
            ],
            vec![
                [0.4, 0.0, 0.4],
                [0.4, 0.0, 1.0],
                [0.4, 0.8, 1.0],
                [0.4, 0.8, 0.4],
            ],
            vec![
                [0.4, 0.0, 1.0],
                [0.0, 0.0, 1.0],
                [0.0, 0.8, 1.0],
                [0.4, 0.8, 1.0],
            ],
            vec![
                [0.0, 0.0, 1.0],
                [0.0, 0.0, 0.0],
                [0.0, 0.8, 0.0],
                [0.0, 0.8, 1.0],
            ],
            vec![
                [0.0, 0.8, 0.0],
                [1.0, 0.8, 0.0],
                [1.0, 0.8, 0.4],
                [0.0, 0.8, 0.4],
            ],
            vec![
                [0.0, 0.8, 0.4],
                [0.4, 0.8, 0.4],
                [0.4, 0.8, 1.0],
                [0.0, 0.8, 1.0],
            ],
        ],
        "grey",
    );
    with(
        "an L that is not convex",
        &front,
        &[room, &[ell.turned(0.7).at(-0.4, 0.0, -0.2)]],
    );
    with(
        "a polygon through a box",
        &front,
        &[room, &[small(0.0, 0.0), level(0.5, 0.4).turned(0.3)]],
    );
    with(
        "glass windows",
        &front,
        &[room, &[level(0.9, 1.5).made_of("glass"), small(0.0, 0.0)]],
    );
    with(
        "a ceiling of glass",
        &perspective([0.3, 6.0, -4.0], [0.0, 3.0, 0.0], 50.0),
        &[
            &[
                lamp(0.3, 2.5),
                walls.clone().without(&[0, 1, 2, 4]).made_of("glass"),
                walls.clone().without(&[TOP]),
            ],
            &[small(0.0, 0.0)],
        ],
    );
    with(
        "a ceiling of glass, seen from below",
        &front,
        &[
            &[
                lamp(0.3, 2.5),
                walls.clone().without(&[0, 1, 2, 4]).made_of("glass"),
                walls.without(&[TOP]),
            ],
            &[small(0.0, 0.0)],
        ],
    );
    with("a boulder alone", &alone, &[&[boulder().at(0.0, 0.4, 0.0)]]);
    with(
        "a boulder of glass alone",
        &alone,
        &[&[boulder().at(0.0, 0.4, 0.0).made_of("glass")]],
    );
    with("a floor alone, from above", &alone, &[floor]);
    with(
        "a floor alone, from below",
        &perspective([0.3, -2.0, -1.0], [0.0, 0.0, 0.0], 50.0),
        &[floor],
    );
    scenes.push((
        "the Cornell box",
        staged(include_str!("../../../../scenes-yaml/cornell-box.yaml")),
    ));
    scenes.push((
        "the Cornell box with glass",
        staged(include_str!("../../../../scenes-yaml/cornell-glass.yaml")),
    ));
    scenes
}
