//! Pixels by class: a pixel whose camera rays may meet a lamp has another colour scale than others.

use super::parts::Parts;
use super::pixel::Pixels;
use super::stop::Stop;
use super::totals::Totals;
use crate::workers::Workers;
use qrt_tracer::ByClass;

/// For each class, the machine that traces its pixels and the estimator that counts them.
pub(super) struct Classes(ByClass<Pixels>);

impl Classes {
    pub(super) fn new(pixels: ByClass<Pixels>) -> Self {
        Self(pixels)
    }

    /// Returns the entry for the class of a pixel.
    pub(super) fn at(&self, pixel: [u32; 2]) -> &Pixels {
        self.0.at(pixel)
    }

    /// Returns the colour scale of each pixel.
    pub(super) fn scales(&self) -> Scales {
        Scales(self.0.map(Pixels::bound))
    }

    /// Returns whether pixels are traced one by one: see [`Pixels::splits`].
    pub(super) fn splits(&self) -> bool {
        self.0.values().any(Pixels::splits)
    }

    /// Adds the totals of all paths of `places`, pixels of few paths: see [`Pixels::trace_group`].
    pub(super) fn trace_group(
        &self,
        places: &[[u32; 2]],
        totals: &mut [Option<Totals>],
        workers: &Workers<'_>,
        kept: &Parts<'_>,
    ) -> Result<(), Stop> {
        let mut of_classes = self.0.places(places);
        of_classes
            .try_for_each(|(pixels, mine)| pixels.trace_group(places, &mine, totals, workers, kept))
    }
}

/// The proven bounds on a path's colour, by pixel.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "parts", derive(serde::Serialize, serde::Deserialize))]
pub struct Scales(
    #[cfg_attr(feature = "parts", serde(with = "crate::serialized::bounds"))]
    pub(super)  ByClass<[f64; 3]>,
);

impl Scales {
    /// The proven bound on a path's colour in pixel (column, row) per channel: the radiance of
    /// S = N.
    pub fn at(&self, pixel: [u32; 2]) -> [f64; 3] {
        *self.0.at(pixel)
    }

    /// Returns the largest bound of each channel.
    pub fn greatest(&self) -> [f64; 3] {
        self.0.values().fold([0.0; 3], |most, bounds| {
            std::array::from_fn(|c| f64::max(most[c], bounds[c]))
        })
    }
}
