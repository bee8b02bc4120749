//! Pixels by class: a pixel whose camera rays may meet a lamp has another colour scale than others.

use super::parts::Parts;
use super::pixel::Pixels;
use super::stop::Stop;
use super::totals::Totals;
use super::{RenderError, Request, Searched};
use crate::workers::Workers;
use qrt_core::tracer::{PixelClass, PixelClasses};

/// For each class, the machine that traces its pixels and the estimator that counts them.
pub(super) struct Classes {
    of: PixelClasses,
    pixels: Vec<(PixelClass, Pixels)>,
}

impl Classes {
    /// Creates an entry for each class of the scene. Also returns the search for primary hits, if
    /// any.
    pub(super) fn new(request: &Request<'_>) -> Result<(Self, Option<Searched>), RenderError> {
        let of = PixelClasses::new(request.scene);
        let mut pixels = Vec::new();
        let mut searched = None;
        for &class in of.present() {
            let (source, found) = request.source(class)?;
            pixels.push((class, request.pixels(source)?));
            searched = found;
        }
        Ok((Self { of, pixels }, searched))
    }

    /// Creates a single entry for all pixels.
    pub(super) fn one(pixels: Pixels) -> Self {
        Self {
            of: PixelClasses::one(),
            pixels: vec![(PixelClass::default(), pixels)],
        }
    }

    /// Returns the entry for the class of a pixel.
    pub(super) fn at(&self, pixel: [u32; 2]) -> &Pixels {
        let class = self.of.class(pixel);
        let mut pixels = self.pixels.iter();
        let found = pixels.find(|(of, _)| *of == class);
        // There is an entry for each class of the scene's pixels.
        &found.unwrap_or(&self.pixels[0]).1
    }

    /// Returns the colour scale of each pixel.
    pub(super) fn scales(&self) -> Scales {
        let of = |(class, pixels): &(PixelClass, Pixels)| (*class, pixels.bound());
        Scales {
            of: self.of.clone(),
            bounds: self.pixels.iter().map(of).collect(),
        }
    }

    /// Returns whether pixels are traced one by one: see [`Pixels::splits`].
    pub(super) fn splits(&self) -> bool {
        self.pixels.iter().any(|(_, pixels)| pixels.splits())
    }

    /// Adds the totals of all paths of `places`, pixels of few paths: see [`Pixels::trace_group`].
    pub(super) fn trace_group(
        &self,
        places: &[[u32; 2]],
        totals: &mut [Option<Totals>],
        workers: &Workers<'_>,
        kept: &Parts<'_>,
    ) -> Result<(), Stop> {
        self.pixels.iter().try_for_each(|(class, pixels)| {
            let mine = (0..places.len()).filter(|&n| self.of.class(places[n]) == *class);
            let mine: Vec<usize> = mine.collect();
            pixels.trace_group(places, &mine, totals, workers, kept)
        })
    }
}

/// The proven bounds on a path's colour, by pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Scales {
    pub(super) of: PixelClasses,
    pub(super) bounds: Vec<(PixelClass, [f64; 3])>,
}

impl Scales {
    /// The proven bound on a path's colour in pixel (column, row) per channel: the radiance of
    /// S = N.
    pub fn at(&self, pixel: [u32; 2]) -> [f64; 3] {
        let class = self.of.class(pixel);
        let mut bounds = self.bounds.iter();
        let found = bounds.find(|(of, _)| *of == class);
        found.unwrap_or(&self.bounds[0]).1
    }

    /// Returns the largest bound of each channel.
    pub fn greatest(&self) -> [f64; 3] {
        let bounds = self.bounds.iter().map(|(_, bounds)| *bounds);
        bounds.fold([0.0; 3], |most, bounds| {
            std::array::from_fn(|c| f64::max(most[c], bounds[c]))
        })
    }
}
