//! Extremes of spheres under a sky, under all three models.
//!
//! Each is a furnace: spheres glow and reflect, and the sky glows as they do. A ray that meets a sphere brings
//! `Le (1 + albedo)`, whatever its second ray meets, and one that meets none brings `Le`.

use super::Extreme;
use super::rooms::picture;
use qrt::runtime::render::Model;
use std::fmt::Write as _;

type Point = [f64; 3];

const ALBEDO: f64 = 0.5;
const MODELS: [Model; 3] = [Model::Real, Model::Fixed, Model::Gates];

/// A view of spheres.
struct View {
    /// Centres and radii.
    spheres: Vec<(Point, f64)>,
    eye: Point,
    target: Point,
    vfov: f64,
    /// The camera's `lens`, or nothing.
    lens: &'static str,
    radiance: f64,
}

impl View {
    /// A sphere around the origin, seen from `eye` under a narrow angle.
    fn of_ball(radius: f64, eye: Point) -> Self {
        Self {
            spheres: vec![([0.0; 3], radius)],
            eye,
            target: [0.0; 3],
            vfov: 1.0,
            lens: "",
            radiance: 1.0,
        }
    }

    fn text(&self) -> String {
        let Self {
            eye,
            target,
            vfov,
            lens,
            radiance,
            ..
        } = self;
        let mut text = format!(
            "name: spheres
camera: {{ perspective: {{ eye: {eye:?}, target: {target:?}, vfov: {vfov:?}{lens} }} }}
film: {{ width: 2, height: 2 }}
sky: {{ radiance: {radiance:?} }}
materials: {{ ball: {{ emitter: {{ radiance: {radiance:?}, albedo: {ALBEDO:?} }} }} }}
sampling: {{ path_bits: 4, depths: 2, lights: none }}
comparator: {{ bits: 10 }}
geometry:
"
        );
        for (center, radius) in &self.spheres {
            writeln!(
                text,
                "  - sphere: {{ center: {center:?}, radius: {radius:?}, material: ball }}"
            )
            .unwrap();
        }
        text
    }

    /// Returns by model the largest relative error of a pixel, if all rays meet a sphere, and none if `misses`.
    fn errors(&self, misses: bool) -> [f64; 3] {
        let exact = self.radiance * if misses { 1.0 } else { 1.0 + ALBEDO };
        let text = self.text();
        MODELS.map(|model| {
            let pixels = picture(&text, model).unwrap_or_else(|report| panic!("{report}"));
            let values = pixels.into_iter().flatten();
            let values = values.inspect(|value| assert!(value.is_finite()));
            values
                .map(|value| (value / exact - 1.0).abs())
                .fold(0.0, f64::max)
        })
    }
}

/// Returns the errors of views whose rays all meet a sphere, each within the models' precision.
fn met(views: &[View]) -> String {
    let [real, fixed, gates] = views
        .iter()
        .map(|view| view.errors(false))
        .fold([0.0; 3], |most: [f64; 3], errors| {
            [0, 1, 2].map(|model| most[model].max(errors[model]))
        });
    assert!(
        real <= 2e-5 && fixed <= 1e-3 && gates == fixed,
        "{real} {fixed} {gates}"
    );
    format!("real {real:.0e}, fixed and gates {fixed:.0e}, relative")
}

fn sizes() -> Extreme {
    let views = [1e-6, 1.0, 1e6].map(|radius| View::of_ball(radius, [0.0, 0.0, 3.0 * radius]));
    Extreme::new(
        "a sphere of radius 1e-6, and of 1e6",
        "the sphere glows as the sky does, and reflects the sky",
        met(&views),
    )
}

fn sky() -> Extreme {
    let bright = View {
        radiance: 1e12,
        ..View::of_ball(1.0, [0.0, 0.0, 3.0])
    };
    Extreme::new(
        "a sky of radiance 1e12",
        "a sphere reflects the sky, to the models' precision",
        met(&[bright]),
    )
}

/// Tests rays to the point where two spheres touch, and past it.
fn tangent() -> Extreme {
    let views = [[0.0, 0.0, 4.0], [0.3, 2.0, 3.0], [-0.1, -0.7, 0.9]].map(|eye| View {
        spheres: vec![([-1.0, 0.0, 0.0], 1.0), ([1.0, 0.0, 0.0], 1.0)],
        target: [0.01, 0.0, 0.0],
        vfov: 1e-3,
        ..View::of_ball(1.0, eye)
    });
    Extreme::new(
        "rays to where two spheres touch",
        "the ray meets one of the spheres, and no sphere twice",
        met(&views),
    )
}

fn focus() -> Extreme {
    let views = ["2", "3", "1000"].map(|focus| View {
        lens: match focus {
            "2" => ", lens: { aperture: 0.2, focus: 2 }",
            "3" => ", lens: { aperture: 0.2, focus: 3 }",
            _ => ", lens: { aperture: 0.2, focus: 1000 }",
        },
        ..View::of_ball(1.0, [0.0, 0.0, 3.0])
    });
    Extreme::new(
        "a lens in focus on a sphere, at its centre, and far behind it",
        "all rays of the lens meet the sphere",
        met(&views),
    )
}

/// Tests rays that pass a sphere of radius 1 at 1 - 1e-9 and at 1 + 1e-9 from its centre.
fn grazing() -> Extreme {
    let at = |height: f64| View {
        eye: [height, 0.0, 3.0],
        target: [height, 0.0, 0.0],
        vfov: 1e-12,
        ..View::of_ball(1.0, [0.0; 3])
    };
    let [inside, outside] = [(1.0 - 1e-9, false), (1.0 + 1e-9, true)].map(|(height, misses)| {
        let [real, fixed, gates] = at(height).errors(misses);
        assert!(real <= 2e-5, "{height}: {real}");
        // 16 bits do not tell: the sphere or the sky, and nothing else.
        let other = if misses {
            ALBEDO
        } else {
            1.0 - 1.0 / (1.0 + ALBEDO)
        };
        assert!(
            fixed <= 1e-3 || (fixed - other).abs() <= 1e-3,
            "{height}: {fixed}"
        );
        assert_eq!(fixed, gates);
        if (fixed <= 1e-3) == misses {
            "the sky"
        } else {
            "the sphere"
        }
    });
    let met = if inside == outside {
        format!("{inside} in both")
    } else {
        format!("{inside} within and {outside} without")
    };
    Extreme::new(
        "rays that pass a sphere's edge at 1e-9 of its radius, within and without",
        "`real` meets the sphere within and the sky without; circuits may meet either",
        format!("`real` is right in both cases; `fixed` and `gates` meet {met}"),
    )
}

pub(super) fn all() -> Vec<Extreme> {
    let all: [fn() -> Extreme; 5] = [sizes, grazing, tangent, focus, sky];
    all.map(|extreme| extreme()).into()
}
