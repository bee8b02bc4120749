//! What pictures are measured against: far more paths, and far longer ones.

use super::band::Band;
use super::bench::Bench;
use super::error::TradeError;
use super::setting::depths;
use crate::machines::Real;
use crate::sample::{Means, prefix_means};
use qrt_core::scene::{Sampling, Sequence};
use qrt_core::valid::MAX_NET_DEPTHS;

/// Keys the reference's shifts, beside the seed.
const REFERENCE: u64 = 0x5265_6665_7265_6e63;
/// Where depths end: what one more ray brings, as a fraction of what all deeper rays bring.
const NEGLIGIBLE: f64 = 0.02;
/// Depths beyond the scene's own, at most.
const DEEPER: usize = 16;

impl Bench<'_> {
    /// The pictures' limit at so many rays: far more paths, with other shifts.
    pub(super) fn reference(&mut self, rays: usize) -> Result<&Means, TradeError> {
        let at = self.references.iter().position(|(of, _)| *of == rays);
        let at = if let Some(at) = at {
            at
        } else {
            let means = self.net_means(rays, self.effort.reference_bits, REFERENCE)?;
            self.references.push((rays, means));
            self.references.len() - 1
        };
        Ok(&self.references[at].1)
    }

    /// Means over `2^bits` paths of the net, of so many rays.
    fn net_means(&self, rays: usize, bits: u32, key: u64) -> Result<Means, TradeError> {
        let mut parameters = self.parameters.clone();
        parameters.sampling = Sampling {
            sequence: Sequence::DigitalNet,
            path_bits: bits,
            depths: depths(&self.parameters.sampling, rays),
            lights: self.parameters.sampling.lights,
        };
        // Nothing is counted here, so one comparator bit will do.
        parameters.comparator.bits = 1;
        let scene = self
            .scene
            .with_parameters(parameters)
            .map_err(TradeError::Parameters)?;
        let real = Real::new(&scene, self.seed ^ key)?;
        let mut means = prefix_means(&real, &self.pixels, &[bits], &self.workers)?;
        Ok(means.pop().unwrap_or_default())
    }

    /// E_D: against a length of paths beyond which almost nothing comes, on the same paths.
    pub(super) fn depth_error(&mut self, rays: usize, mean: f64) -> Result<Band, TradeError> {
        let pictures = match self.depths.take() {
            Some(pictures) => pictures,
            None => self.pictures_by_depth()?,
        };
        let band = match (pictures.get(rays - 1), pictures.last()) {
            (Some(picture), Some(limit)) => Band::of_difference(picture, limit, mean),
            _ => Band::default(),
        };
        self.depths = Some(pictures);
        Ok(band)
    }

    fn pictures_by_depth(&self) -> Result<Vec<Means>, TradeError> {
        let own = self.parameters.sampling.depths.len();
        let most = (own + DEEPER).min(MAX_NET_DEPTHS).max(own);
        let mut pictures: Vec<Means> = Vec::new();
        for rays in 1..=most {
            if rays > MAX_NET_DEPTHS {
                break;
            }
            pictures.push(self.net_means(rays, self.effort.depth_bits, 0)?);
            let [.., before, last] = &pictures[..] else {
                continue;
            };
            let step = Band::of_difference(before, last, 1.0).value;
            let own = pictures.get(own - 1);
            let all = own.map_or(0.0, |own| Band::of_difference(own, last, 1.0).value);
            if rays > self.parameters.sampling.depths.len() + 2 && step <= NEGLIGIBLE * all {
                break;
            }
        }
        Ok(pictures)
    }
}
