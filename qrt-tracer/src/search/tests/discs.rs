//! Compares searches of scenes with discs, along paths through random scenes: discs on the planes of walls
//! and of each other, lamps before a ceiling and on it, glass, with corners of other faces on the squares
//! around them.

use super::*;

/// A random scene of discs in a room without a front, with a box whose sides discs may lie on.
fn random_scene(chance: &mut Chance) -> Stage<3> {
    let mut text = String::from(
        "name: discs\nfilm: { width: 16, height: 16 }\nmaterials:\n  \
         grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } }\n  glass: { dielectric: { ior: 1.5 } }\n  \
         lamp: { emitter: { radiance: [1, 1, 1] } }\ngeometry:\n",
    );
    let walls = [
        "[[-1.5, 0, 1.5], [1.5, 0, 1.5], [1.5, 0, -1.5], [-1.5, 0, -1.5]]",
        "[[-1.5, 3, -1.5], [1.5, 3, -1.5], [1.5, 3, 1.5], [-1.5, 3, 1.5]]",
        "[[-1.5, 0, -1.5], [1.5, 0, -1.5], [1.5, 3, -1.5], [-1.5, 3, -1.5]]",
        "[[-1.5, 0, 1.5], [-1.5, 0, -1.5], [-1.5, 3, -1.5], [-1.5, 3, 1.5]]",
    ];
    let count = 2 + (chance.next() * 8.0) as usize;
    let walls_after = (chance.next() * count as f64) as usize;
    let has_box = chance.next() < 0.5;
    for number in 0..count {
        if number == walls_after {
            for wall in walls.iter().filter(|_| chance.next() < 0.8) {
                writeln!(text, "  - quad: {{ vertices: {wall}, material: grey }}").unwrap();
            }
            if has_box {
                text.push_str(
                    "  - box: { min: [-0.5, 0, -0.5], max: [0.5, 1, 0.5], material: grey }\n",
                );
            }
        }
        let mut center = [(); 3].map(|()| chance.between(-1.4, 1.4));
        center[1] += 1.5;
        let mut normal = chance.direction().to_array();
        let mut material = if chance.next() < 0.3 { "glass" } else { "grey" };
        match (chance.next() * 6.0) as usize {
            0 => (center[1], normal, material) = (0.0, [0.0, 1.0, 0.0], "grey"),
            1 => (center[1], normal, material) = (3.0, [0.0, -1.0, 0.0], "lamp"),
            2 => (center[1], normal, material) = (2.9, [0.0, -1.0, 0.0], "lamp"),
            3 => (center[1], normal, material) = (1.0, [0.0, 1.0, 0.0], "grey"),
            4 => (center[0], normal, material) = (-1.5, [1.0, 0.0, 0.0], "grey"),
            _ => {}
        }
        let radius = 2.0_f64.powf(chance.between(-4.0, 0.5));
        writeln!(
            text,
            "  - disc: {{ center: {center:?}, normal: {normal:?}, radius: {radius}, material: {material} }}"
        )
        .unwrap();
    }
    text.push_str(
        "  - disc: { center: [0.2, 2.5, 0], normal: [0, -1, 0], radius: 0.3, material: lamp }\n",
    );
    let eye = [0.1, 1.4, chance.between(-5.0, 5.0)];
    writeln!(
        text,
        "camera: {{ perspective: {{ eye: {eye:?}, target: [0.1, 1.2, 0], vfov: 60 }} }}\n\
         sampling: {{ depths: [{{ bits: [4, 4] }}, {{ bits: [4, 4] }}], lights: none }}"
    )
    .unwrap();
    staged(&text)
}

#[test]
fn searches_of_discs_find_what_asking_every_plane_finds() {
    let mut chance = Chance(11);
    let [mut hits, mut lamps, mut shadows] = [0; 3];
    for scene in 0..200 {
        let stage = random_scene(&mut chance);
        let compared = compare(&stage, 100);
        let first = compared.differ.first();
        assert_eq!(first, None, "scene {scene}: {:?}", stage.geometry());
        hits += compared.hits;
        lamps += compared.lamps;
        shadows += compared.shadows;
    }
    assert!(
        [hits, lamps, shadows].iter().all(|&count| count > 1000),
        "{hits} hits, {lamps} lamps, {shadows} shadows"
    );
}

/// Every point where a ray meets the plane of a disc is within the circle if and only if the disc is met.
#[test]
fn a_disc_is_the_points_within_a_circle() {
    let mut chance = Chance(13);
    let mut counts = [0, 0];
    for _ in 0..100 {
        let stage = random_scene(&mut chance);
        let geometry = stage.geometry();
        for _ in 0..100 {
            let ray = camera_ray(&stage, &mut chance);
            for (number, face) in geometry.faces.iter().enumerate() {
                if face.disc.is_none() {
                    continue;
                }
                let corners = &geometry.corners[face.label as usize];
                let frame = &geometry.frame(face.label as usize);
                let radius = 0.5 * corners[0].distance(corners[1]);
                let (origin, direction) = (DVec3::from(ray.origin), DVec3::from(ray.direction));
                let fall = direction.dot(frame.normal);
                let distance = (frame.centre - origin).dot(frame.normal) / fall;
                let away = (origin + direction * distance).distance(frame.centre) - radius;
                if distance <= 0.0 || away.abs() < 1e-9 {
                    continue;
                }
                let (meets, _) = geometry.meet(&mut Scalar::default(), number, &ray);
                assert_eq!(
                    meets,
                    away < 0.0,
                    "{away} {:?} {:?} {face:?}",
                    ray.origin,
                    ray.direction
                );
                counts[usize::from(meets)] += 1;
            }
        }
    }
    assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
}
