//! The limits of pictures: far more paths, and far longer ones.

use super::band::Band;
use super::bench::Bench;
use super::error::TradeError;
use super::rivals::lit;
use super::setting::depths;
use qrt_runtime::path_machines::Real;
use qrt_runtime::sample::{Means, prefix_means};
use qrt_scene::valid::{MAX_NET_DEPTHS, Parameters, ValidScene};
use qrt_scene::{Sampling, Sequence};

/// Key of the reference's shifts, combined with the seed.
const REFERENCE: u64 = 0x5265_6665_7265_6e63;
/// Pictures by depth end if one more ray changes less than this fraction of the change since the
/// scene's own depth.
const NEGLIGIBLE: f64 = 0.02;
/// The largest number of depths beyond the scene's own.
const DEEPER: usize = 16;

impl Bench<'_> {
    /// The limit of pictures with `rays` rays: the mean of far more paths, with other shifts.
    pub(super) fn reference(&mut self, rays: usize) -> Result<&Means, TradeError> {
        let at = self.references.iter().position(|(of, _)| *of == rays);
        let at = if let Some(at) = at {
            at
        } else {
            let scene = self.lit_net(rays, self.effort.reference_bits)?;
            let means = self.means(&scene, REFERENCE)?;
            self.references.push((rays, means));
            self.references.len() - 1
        };
        Ok(&self.references[at].1)
    }

    /// Parameters of a net of `2^bits` paths of `rays` rays, without a circuit.
    fn net(&self, rays: usize, bits: u32) -> Parameters {
        let mut parameters = self.parameters.clone();
        parameters.sampling = Sampling {
            sequence: Sequence::DigitalNet,
            path_bits: bits,
            depths: depths(&self.parameters.sampling, rays),
            lights: self.parameters.sampling.lights,
        };
        // Nothing is counted here, so one comparator bit is enough.
        parameters.comparator.bits = 1;
        parameters
    }

    /// The scene of the same net with lamps sampled, even if the scene itself does not sample them.
    ///
    /// If the net lacks the dimensions, it samples lamps as the scene does.
    pub(super) fn lit_net(&self, rays: usize, bits: u32) -> Result<ValidScene, TradeError> {
        let own = self.net(rays, bits);
        let mut parameters = own.clone();
        parameters.sampling = lit(&own.sampling);
        let lit = self.scene.with_parameters(parameters);
        lit.or_else(|_| self.scene.with_parameters(own))
            .map_err(TradeError::Parameters)
    }

    /// Means over all paths of `scene`.
    pub(super) fn means(&self, scene: &ValidScene, key: u64) -> Result<Means, TradeError> {
        let real = Real::new(scene, self.seed ^ key)?;
        let bits = [scene.scene().sampling.path_bits];
        let mut means = prefix_means(&real, &self.pixels, &bits, &self.workers)?;
        Ok(means.pop().unwrap_or_default())
    }

    /// E_D: the difference from paths so long that more rays add almost nothing, on the same path
    /// indices.
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
            let net = self.net(rays, self.effort.depth_bits);
            let scene = (self.scene.with_parameters(net)).map_err(TradeError::Parameters)?;
            pictures.push(self.means(&scene, 0)?);
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
