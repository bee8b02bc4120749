//! Classes of pixels: those that may see a lamp directly, and those that provably do not.
//!
//! A lamp's radiance is many times that of the surfaces that it lights. If no primary ray of a pixel
//! meets a lamp first, the colour scale need not include the lamp's radiance.

use super::camera;
use glam::DVec2;
use qrt_scene::valid::ValidScene;

/// The margin outside a pixel's square that its rays are assumed to reach, in pixels: far above
/// rounding.
const MARGIN: f64 = 1e-6;

/// The most outlines that are compared with parts of the film, in search of a pixel that meets none.
const MOST_COMPARED: usize = 1 << 20;

/// The class of a pixel, by the lamps that its primary rays may meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PixelClass {
    /// A camera ray of the pixel may meet a lamp, or nothing is proven.
    #[default]
    MayMeetLamp,
    /// A camera ray of the pixel meets no lamp, or a lamp's back.
    MeetsNoLamp,
}

impl PixelClass {
    /// All classes, the one that any pixel may be of first.
    pub const ALL: [Self; 2] = [Self::MayMeetLamp, Self::MeetsNoLamp];
}

/// The class of each pixel of a scene's film.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelClasses {
    /// The outlines of those lamps that some pixel may see, in pixels; none if all pixels may see one.
    outlines: Option<Vec<Vec<DVec2>>>,
}

impl PixelClasses {
    /// The classes of `scene`'s pixels. If no lamp is sampled, all pixels are of the class that may
    /// meet one: the scale is then that of the light that their paths meet by chance.
    ///
    /// A search of bounded effort determines if the lamps together cover the film, or leave a pixel
    /// free. If the search ends without an answer, a pixel is assumed to be free.
    pub fn new(scene: &ValidScene) -> Self {
        let written = scene.scene();
        let sampling = &written.sampling;
        let lit = (0..sampling.depths.len()).any(|depth| sampling.light(depth).is_some());
        // Rays of a lens go beside the pixel.
        if !lit || written.lens().is_some() {
            return Self::one();
        }
        let view = camera::View::new(&written.camera, written.film);
        let emits = |surface: u32| scene.surfaces()[surface as usize].emits();
        let lamps = scene.polygons().iter().filter(|p| emits(p.surface));
        let seen = lamps.map(|lamp| view.outline(lamp.outline()));
        let balls = scene.balls().iter().filter(|ball| emits(ball.surface));
        let seen = seen.chain(balls.map(|ball| view.box_outline(ball.corners())));
        let sun = scene.sun().map(|(cone, _)| view.cone_outline(&cone));
        let seen = seen.chain(sun);
        let film = [written.film.width, written.film.height];
        let mut outlines = Vec::new();
        for seen in seen {
            match seen {
                camera::Seen::Not => {}
                camera::Seen::Within(outline) => {
                    // A lamp beside the film makes no difference to a pixel's class.
                    if meets_pixels(&outline, [0, 0], film) {
                        outlines.push(outline);
                    }
                }
                camera::Seen::Anywhere => return Self::one(),
            }
        }
        let all: Vec<&[DVec2]> = outlines.iter().map(Vec::as_slice).collect();
        let mut effort = MOST_COMPARED;
        if !may_be_free(&all, [0, 0], film, &mut effort) {
            return Self::one();
        }
        Self {
            outlines: Some(outlines),
        }
    }

    /// True if a camera ray of some pixel may meet the sun.
    pub(crate) fn see_sun(scene: &ValidScene) -> bool {
        let written = scene.scene();
        let Some((cone, _)) = scene.sun() else {
            return false;
        };
        let film = [written.film.width, written.film.height];
        match camera::View::new(&written.camera, written.film).cone_outline(&cone) {
            camera::Seen::Not => false,
            // Rays of a lens go beside the pixel.
            camera::Seen::Within(outline) => {
                written.lens().is_some() || meets_pixels(&outline, [0, 0], film)
            }
            camera::Seen::Anywhere => true,
        }
    }

    /// The classes if all pixels may meet a lamp.
    pub fn one() -> Self {
        Self { outlines: None }
    }

    /// The lamps' outlines on the film, as points (x, y) in pixels from its top left corner; none if
    /// every pixel may meet one.
    fn outlines(&self) -> Option<Vec<Vec<[f64; 2]>>> {
        let points = |outline: &Vec<DVec2>| outline.iter().map(DVec2::to_array).collect();
        let outlines = self.outlines.as_ref()?;
        Some(outlines.iter().map(points).collect())
    }

    /// The classes with these `outlines`, as [`PixelClasses::outlines`] returns them.
    fn of_outlines(outlines: Option<Vec<Vec<[f64; 2]>>>) -> Self {
        let points = |outline: Vec<[f64; 2]>| outline.into_iter().map(DVec2::from).collect();
        Self {
            outlines: outlines.map(|outlines| outlines.into_iter().map(points).collect()),
        }
    }

    /// The class of pixel (column, row).
    pub fn class(&self, [x, y]: [u32; 2]) -> PixelClass {
        let Some(outlines) = &self.outlines else {
            return PixelClass::MayMeetLamp;
        };
        let may_meet = |outline: &Vec<DVec2>| meets_pixels(outline, [x, y], [x + 1, y + 1]);
        if outlines.iter().any(may_meet) {
            PixelClass::MayMeetLamp
        } else {
            PixelClass::MeetsNoLamp
        }
    }

    /// The classes that pixels of the film have; both if that is not known: see [`PixelClasses::new`].
    pub fn present(&self) -> &'static [PixelClass] {
        match &self.outlines {
            None => &PixelClass::ALL[..1],
            Some(outlines) if outlines.is_empty() => &PixelClass::ALL[1..],
            Some(_) => &PixelClass::ALL,
        }
    }
}

/// A value for each class of a film's pixels, such as the machine that traces them.
#[derive(Clone, Debug, PartialEq)]
pub struct ByClass<T> {
    classes: PixelClasses,
    /// An entry for each class of the film's pixels.
    values: Vec<(PixelClass, T)>,
}

impl<T> ByClass<T> {
    /// Calls `make` for each class that pixels of the film have.
    ///
    /// # Errors
    /// The first error of `make`.
    pub fn try_new<E>(
        classes: &PixelClasses,
        mut make: impl FnMut(PixelClass) -> Result<T, E>,
    ) -> Result<Self, E> {
        let present = classes.present().iter();
        let values = present.map(|&class| Ok((class, make(class)?)));
        Ok(Self {
            classes: classes.clone(),
            values: values.collect::<Result<_, E>>()?,
        })
    }

    /// Calls `make` once, for a value that serves all pixels.
    ///
    /// # Errors
    /// That of `make`.
    pub fn try_one<E>(make: impl FnOnce(PixelClass) -> Result<T, E>) -> Result<Self, E> {
        make(PixelClass::default()).map(Self::one)
    }

    /// A default value for each class that pixels of the film have.
    pub fn defaults(classes: &PixelClasses) -> Self
    where
        T: Default,
    {
        let present = classes.present().iter();
        Self {
            values: present.map(|&class| (class, T::default())).collect(),
            classes: classes.clone(),
        }
    }

    /// The value that all pixels have.
    pub fn one(value: T) -> Self {
        Self {
            classes: PixelClasses::one(),
            values: vec![(PixelClass::default(), value)],
        }
    }

    /// The value of pixel (column, row).
    pub fn at(&self, pixel: [u32; 2]) -> &T {
        let class = self.classes.class(pixel);
        let mut values = self.values.iter();
        let found = values.find(|(of, _)| *of == class);
        // There is an entry for each class of the film's pixels.
        &found.unwrap_or(&self.values[0]).1
    }

    /// The values of all classes.
    pub fn values(&self) -> impl Iterator<Item = &T> {
        self.values.iter().map(|(_, value)| value)
    }

    /// The lamps' outlines on the film, as points (x, y) in pixels from its top left corner; none if
    /// every pixel may meet one.
    pub fn outlines(&self) -> Option<Vec<Vec<[f64; 2]>>> {
        self.classes.outlines()
    }

    /// The value of each class.
    pub fn entries(&self) -> &[(PixelClass, T)] {
        &self.values
    }

    /// The values with these [`ByClass::outlines`] and [`ByClass::entries`]; `None` without a value.
    pub fn of_parts(
        outlines: Option<Vec<Vec<[f64; 2]>>>,
        values: Vec<(PixelClass, T)>,
    ) -> Option<Self> {
        let classes = PixelClasses::of_outlines(outlines);
        (!values.is_empty()).then_some(Self { classes, values })
    }

    /// The results of `change` for each value.
    pub fn map<U>(&self, mut change: impl FnMut(&T) -> U) -> ByClass<U> {
        let values = self.values.iter();
        ByClass {
            values: values
                .map(|(class, value)| (*class, change(value)))
                .collect(),
            classes: self.classes.clone(),
        }
    }

    /// Replaces each value by the result of `change`.
    ///
    /// # Errors
    /// The first error of `change`.
    pub fn try_map<U, E>(self, mut change: impl FnMut(T) -> Result<U, E>) -> Result<ByClass<U>, E> {
        let values = self.values.into_iter();
        let values = values.map(|(class, value)| Ok((class, change(value)?)));
        Ok(ByClass {
            values: values.collect::<Result<_, E>>()?,
            classes: self.classes,
        })
    }

    /// For each value, the places in `pixels` of the pixels that have it.
    pub fn places(&self, pixels: &[[u32; 2]]) -> impl Iterator<Item = (&T, Vec<usize>)> {
        self.values.iter().map(move |(class, value)| {
            let mine = |place: &usize| self.classes.class(pixels[*place]) == *class;
            (value, (0..pixels.len()).filter(mine).collect())
        })
    }

    /// Calls `run` with each value and its pixels, unless there are none, and returns the results in
    /// the order of `pixels`.
    ///
    /// # Errors
    /// The first error of `run`.
    pub fn apart<R, E>(
        &self,
        pixels: &[[u32; 2]],
        mut run: impl FnMut(&T, &[[u32; 2]]) -> Result<Vec<R>, E>,
    ) -> Result<Vec<R>, E> {
        let mut all: Vec<Option<R>> = pixels.iter().map(|_| None).collect();
        for (value, places) in self.places(pixels) {
            let mine: Vec<[u32; 2]> = places.iter().map(|&place| pixels[place]).collect();
            if mine.is_empty() {
                continue;
            }
            for (place, found) in places.into_iter().zip(run(value, &mine)?) {
                all[place] = Some(found);
            }
        }
        // Every pixel is of one class.
        Ok(all.into_iter().flatten().collect())
    }
}

/// True if a ray of some pixel from `first` up to but not including `end` may meet the outline.
fn meets_pixels(outline: &[DVec2], first: [u32; 2], end: [u32; 2]) -> bool {
    let corner = |[x, y]: [u32; 2]| DVec2::new(f64::from(x), f64::from(y));
    meets(outline, corner(first) - MARGIN, corner(end) + MARGIN)
}

/// True if rays of every pixel from `first` up to but not including `end` may meet the outline, which
/// is convex: it then has a point in each corner pixel, and with them points in all rows and columns
/// between.
fn covers(outline: &[DVec2], first: [u32; 2], end: [u32; 2]) -> bool {
    let corners = [first[0], end[0] - 1].into_iter();
    let mut corners = corners.flat_map(|x| [[x, first[1]], [x, end[1] - 1]]);
    corners.all(|[x, y]| meets_pixels(outline, [x, y], [x + 1, y + 1]))
}

/// False if every pixel from `first` up to but not including `end` meets one of the outlines; true if
/// one meets none, or `effort` ends before that is known.
fn may_be_free(outlines: &[&[DVec2]], first: [u32; 2], end: [u32; 2], effort: &mut usize) -> bool {
    let near = outlines.iter().copied();
    let near: Vec<&[DVec2]> = near.filter(|o| meets_pixels(o, first, end)).collect();
    if near.is_empty() {
        return true;
    }
    // A single pixel is covered by any outline that it meets.
    if near.iter().any(|outline| covers(outline, first, end)) {
        return false;
    }
    *effort = effort.saturating_sub(4 * near.len());
    *effort == 0 || quarters(first, end).any(|[first, end]| may_be_free(&near, first, end, effort))
}

/// Divides a box of several pixels into parts, each with its first pixel and its end.
fn quarters(first: [u32; 2], end: [u32; 2]) -> impl Iterator<Item = [[u32; 2]; 2]> {
    let halves = [0, 1].map(|axis| {
        let middle = first[axis].midpoint(end[axis]);
        [[first[axis], middle], [middle, end[axis]]]
    });
    let parts = halves[0].into_iter().flat_map(move |[left, right]| {
        halves[1].map(|[top, bottom]| [[left, top], [right, bottom]])
    });
    parts.filter(|[first, end]| first[0] < end[0] && first[1] < end[1])
}

/// True if a convex outline and a box of the film have a point in common.
fn meets(outline: &[DVec2], low: DVec2, high: DVec2) -> bool {
    let least = outline.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
    let most = outline
        .iter()
        .fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
    if least.cmpgt(high).any() || most.cmplt(low).any() {
        return false;
    }
    let corners = [
        low,
        DVec2::new(high.x, low.y),
        high,
        DVec2::new(low.x, high.y),
    ];
    let centre = outline.iter().sum::<DVec2>() / outline.len() as f64;
    // They have none if a line along an edge has the outline on one side and the box on the other.
    !(0..outline.len()).any(|k| {
        let (start, end) = (outline[k], outline[(k + 1) % outline.len()]);
        let across = (end - start).perp();
        let inside = across.dot(centre - start);
        inside != 0.0
            && corners
                .iter()
                .all(|c| across.dot(*c - start) * inside < 0.0)
    })
}
