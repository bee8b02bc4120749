//! Normals of corners: as the file has them, by smoothing groups, and without either.

use super::*;

/// A roof: two quads that meet at a ridge.
const ROOF: &str = "v 0 0 0\nv 0 2 0\nv 1 0 1\nv 1 2 1\nv 2 0 0\nv 2 2 0\n";

fn normals(faces: &str) -> Vec<[[f64; 3]; 3]> {
    let read = read(&format!("{ROOF}{faces}")).unwrap();
    // Rounding is not tested.
    let rounded = |x: f64| {
        let known = [0.0, SLANT, 1.0];
        let near = known.iter().find(|known| (x.abs() - **known).abs() < 1e-12);
        near.map_or(x, |near| near.copysign(x) + 0.0)
    };
    let normals = read.normals.iter();
    normals
        .map(|corners| corners.map(|normal| normal.to_array().map(rounded)))
        .collect()
}

const SLANT: f64 = std::f64::consts::FRAC_1_SQRT_2;
const LEFT: [f64; 3] = [-SLANT, 0.0, SLANT];
const RIGHT: [f64; 3] = [SLANT, 0.0, SLANT];
const UP: [f64; 3] = [0.0, 0.0, 1.0];

#[test]
fn a_mesh_without_normals_and_groups_is_flat() {
    for faces in [
        "f 1 3 4 2\nf 3 5 6 4\n",
        "s off\nf 1 3 4 2\ns 0\nf 3 5 6 4\n",
        "s 1\ns 0 # off\nf 1 3 4 2\nf 3 5 6 4\n",
        "vn 0 0 1\nvt 0 0\nf 1/1 3/1 4/1 2/1\nf 3/1 5/1 6/1 4/1\n",
    ] {
        assert!(normals(faces).is_empty(), "{faces}");
    }
}

#[test]
fn corners_have_the_normals_that_they_name() {
    // A normal may follow its face, may be counted from the end, and need not have unit length.
    let read = normals("f 1//1 3//2 4//2 2//1\nvn 0 0 3\nvn -1 0 1\nf 3//-2 5//-1 6//-1 4//-2\n");
    assert_eq!(
        read,
        [
            [UP, LEFT, LEFT],
            [UP, LEFT, UP],
            [UP, LEFT, LEFT],
            [UP, LEFT, UP]
        ]
    );
}

#[test]
fn a_corner_without_a_usable_normal_has_its_faces_own() {
    let read = normals("vn 0 0 1\nvn nan 0 0\nvn 0 0 0\nvn\nf 1//1 3//2 4//3 2//4\nf 3 5 6 4\n");
    let flat = [RIGHT; 3];
    assert_eq!(read, [[UP, LEFT, LEFT], [UP, LEFT, LEFT], flat, flat]);
}

#[test]
fn faces_of_one_group_share_the_mean_at_their_corners() {
    let joined = normals("s 1\nf 1 3 4 2\nf 3 5 6 4\n");
    assert_eq!(joined[0], [LEFT, UP, UP]);
    assert_eq!(joined[2], [UP, RIGHT, RIGHT]);
    // A group may have a name.
    assert_eq!(normals("s on\nf 1 3 4 2\nf 3 5 6 4\n"), joined);
    // Another group, none, or another object does not take part.
    for second in ["s 2", "s off", "o other"] {
        let apart = normals(&format!("s 1\nf 1 3 4 2\n{second}\nf 3 5 6 4\n"));
        assert_eq!(apart, [[LEFT; 3], [LEFT; 3], [RIGHT; 3], [RIGHT; 3]]);
    }
    // Normals take precedence.
    let named = normals("vn 0 0 1\ns 1\nf 1//1 3//1 4//1 2//1\nf 3 5 6 4\n");
    assert_eq!(named, [[UP; 3], [UP; 3], [RIGHT; 3], [RIGHT; 3]]);
}

#[test]
fn normals_stay_with_their_faces_where_others_are_left_out() {
    // A copy, a face without area, and a repeated corner.
    let faces = "vn 0 0 1\nvn 1 0 0\nf 1//1 3//2 4//1 2//2\nf 1//2 1//2 3//2\n\
        f 4//2 2//2 1//2 3//2\nf 3//2 3//1 5//2 6//1\nf 1//1 3//2 4//1\n";
    let right = [1.0, 0.0, 0.0];
    assert_eq!(
        normals(faces),
        [[UP, right, UP], [UP, UP, right], [right, right, UP]]
    );
}
