//! A small picture of the scene, for the page.

use super::TradeOptions;
use super::bench::{Bench, Effort};
use super::error::TradeError;
use qrt_runtime::image::{Encoding, Image, Metadata, write_to};
use qrt_runtime::sample;
use qrt_scene::valid::ValidScene;

/// The largest length of the picture's longer side, in pixels.
const SIDE: u32 = 96;
/// Number of paths of all the picture's pixels together, which take about a second.
const PATHS: u64 = 1 << 19;
/// The mean of the exposed picture: middle grey.
const GREY: f64 = 0.18;

/// A picture of the scene.
pub(super) struct Preview {
    pub(super) width: u32,
    pub(super) height: u32,
    /// The picture has the film's pixels whose column and row are multiples of `step`.
    pub(super) step: u32,
    pub(super) path_bits: u32,
    /// The exposure, in stops.
    pub(super) exposure: f64,
    pub(super) png: Vec<u8>,
}

impl Preview {
    /// Renders the exact mean of some of the film's pixels, over few paths that sample lamps.
    ///
    /// The result is `None` if no PNG can be made.
    pub(super) fn render(
        scene: &ValidScene,
        options: &TradeOptions<'_>,
    ) -> Result<Option<Self>, TradeError> {
        if !cfg!(feature = "png") {
            return Ok(None);
        }
        let film = scene.scene().film;
        let step = film.width.max(film.height).div_ceil(SIDE).max(1);
        let [width, height] = [film.width, film.height].map(|side| side.div_ceil(step));
        let row = |y: u32| (0..width).map(move |x| [step * x, step * y]);
        let pixels: Vec<[u32; 2]> = (0..height).flat_map(row).collect();
        let path_bits = (PATHS / pixels.len().max(1) as u64).max(1).ilog2().min(10);
        let effort = Effort {
            reference_bits: path_bits,
            depth_bits: path_bits,
            draws: 1,
            most_toffoli: None,
        };
        let mut bench = Bench::new(scene, options.seed, effort, options.workers);
        bench.pixels = pixels;
        let rays = scene.scene().sampling.depths.len();
        let pixels = bench.means(&bench.lit_net(rays, path_bits)?, 0)?;
        let mean = sample::radiance(&pixels);
        let exposure = if mean > 0.0 {
            libm::round(libm::log2(GREY / mean))
        } else {
            0.0
        };
        let image = Image {
            width,
            height,
            pixels,
            window: None,
        };
        let mut png = Vec::new();
        let encoding = Encoding::Png { exposure };
        let written = write_to(&mut png, &image, &[], &Metadata::new(), encoding);
        Ok(written.is_ok().then_some(Self {
            width,
            height,
            step,
            path_bits,
            exposure,
            png,
        }))
    }

    /// The picture as an address that contains it, so that the page needs no other file.
    pub(super) fn address(&self) -> String {
        format!("data:image/png;base64,{}", base64(&self.png))
    }
}

/// Encodes bytes in base 64 (RFC 4648), as addresses hold them.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let at = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for k in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * k) & 63) as usize];
            out.push(if k <= three.len() { letter.into() } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the examples of RFC 4648, section 10.
    #[test]
    fn bytes_are_letters_as_the_standard_says() {
        for (bytes, letters) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), letters);
        }
        assert_eq!(base64(&[0xff, 0xfe, 0xfb]), "//77");
    }
}
