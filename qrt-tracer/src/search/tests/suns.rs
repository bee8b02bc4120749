//! Rays to a sun, which leave the scene.

use super::*;
use crate::sun::{DISTANCE, SunStage};
use qrt_scene::lights::Cone;

impl Comparison<'_> {
    /// Compares if something stands between the start of a surface's ray and a point of the sun, on the side of
    /// `towards`.
    pub(super) fn sunlight(&mut self, ray: &Ray<Scalar>, towards: DVec3, cone: &Cone) {
        let spread = [(); 2].map(|()| self.chance.between(-cone.sin, cone.sin));
        let [x, y] = [0, 1].map(|k| cone.across[k] * spread[k]);
        let direction = (cone.axis + x + y).normalize() * DISTANCE;
        if direction.dot(towards) <= 1e-3 {
            return;
        }
        let ray = Ray {
            direction: direction.to_array(),
            t_max: 1.0,
            ..*ray
        };
        let geometry = self.stage.geometry();
        let sun = geometry.sun.unwrap();
        let cx = &mut Scalar::default();
        let asked = geometry.occluded(cx, &ray, sun, true);
        let found = self.search.occluded(cx, &ray, sun, true);
        self.judge("occluded from the sun", &ray, asked, found);
        self.compared.shadows += usize::from(asked);
        self.compared.lit += usize::from(!asked);
        // It is the nearest face that hides the sun.
        let hit = geometry.nearest(cx, &Ray { t_max: 4.0, ..ray }, true);
        self.judge("the nearest face", &ray, hit.found, asked);
    }
}

#[test]
fn suns_are_hidden_by_what_asking_every_plane_finds() {
    let mut wrong = String::new();
    let [mut shadows, mut lit] = [0; 2];
    for direction in [[0.0, 1.0, 0.0], [0.3, 0.5, -0.8], [-0.9, -0.1, 0.2]] {
        let cone = Cone::new(direction.into(), 40.0).unwrap();
        for (name, mut stage) in scenes() {
            stage.geometry.add_sun();
            stage.sun = Some(SunStage::new((cone, [1.0; 3]), [0, 1, 2], true));
            let compared = compare(&stage, 700);
            if let Some(first) = compared.differ.first() {
                let count = compared.differ.len();
                let _ = writeln!(wrong, "{name}: {count} of {}: {first}", compared.rays);
            }
            shadows += compared.shadows;
            lit += compared.lit;
        }
    }
    assert_eq!(wrong, "");
    assert!(shadows > 1000 && lit > 1000, "{shadows} shadows, {lit} lit");
}
