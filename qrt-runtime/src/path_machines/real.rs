//! The real machine: every path of a pixel, in `f64`.

use super::bvh::{Bvh, FEW_FACES, Faces, Indexed};
use super::lanes::{BLOCK, Inputs, Lanes, Watched, lanes};
use super::path_numbers::{Marker, PathNumbers};
#[cfg(not(any(test, target_arch = "wasm32")))]
use qrt_machines::InstructionSet;

/// Registers per value: two give the processor independent work while a division is under way.
pub(super) const WIDTH: usize = 2;

use pulp::WithSimd;
use qrt_core::oracle::paths::{PathFormats, PathNumber};
use qrt_scene::sampling::{Coordinate, PathPoints};
use qrt_scene::valid::ValidScene;
use qrt_tracer::{PixelClass, PixelClasses, Stage, trace};
use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

/// The lanes to use. All choices give the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Simd {
    /// The lanes of [`InstructionSet::widest`].
    #[default]
    Widest,
    /// One path at a time.
    Scalar,
}

/// Source of a path's sample coordinates.
#[derive(Clone, Debug)]
pub enum Points {
    /// The scene's sequence, as the circuit computes it.
    Sequence(PathPoints),
    /// Independent numbers for every path and coordinate: classical Monte Carlo, for comparison.
    Independent {
        /// The scene's sequence, which defines the coordinates and their bits.
        like: PathPoints,
        /// The paths of a pixel.
        paths: u64,
    },
}

impl Points {
    /// R, the paths of a pixel.
    pub fn paths(&self) -> u64 {
        match self {
            Self::Sequence(points) => 1 << points.path_bits(),
            Self::Independent { paths, .. } => *paths,
        }
    }

    fn sequence(&self) -> &PathPoints {
        match self {
            Self::Sequence(points) | Self::Independent { like: points, .. } => points,
        }
    }

    fn fill(
        &self,
        seed: u64,
        [x, y]: [u32; 2],
        coordinate: Coordinate,
        first: u64,
        out: &mut [u32],
    ) {
        match self {
            Self::Sequence(points) => {
                let shift = points.shift(seed, x, y, coordinate);
                points.indices(coordinate, first, shift, out);
            }
            Self::Independent { like, .. } => {
                let (bits, dimension) = (like.bits(coordinate), like.dimension(coordinate));
                for (id, slot) in (first..).zip(out) {
                    let word = qrt_scene::sampling::pixel_shift(seed ^ mixed(id), x, y, dimension);
                    *slot = if bits == 0 {
                        0
                    } else {
                        (word >> (64 - bits)) as u32
                    };
                }
            }
        }
    }
}

/// Spreads a path index over all 64 bits, so that it can key a hash together with a seed.
fn mixed(id: u64) -> u64 {
    (id + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29)
}

/// Sums over the paths of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelSum {
    /// Sum of the paths' colours, in radiance: red, green, blue.
    pub colour: [f64; 3],
    /// Good indices per channel: pairs of a path and a comparator that its colour exceeds. Zero
    /// unless counted.
    pub good: [u64; 3],
}

/// A block of finished paths of one pixel: their colours per channel.
#[derive(Clone, Copy, Debug)]
pub struct PathBlock<'a> {
    /// Position of the pixel in the caller's list.
    pub pixel: usize,
    /// Red, green, blue of each path, in the order of path indices.
    pub colours: [&'a [f64]; 3],
}

/// The real machine for one scene.
#[derive(Clone, Debug)]
pub struct Real {
    pub(super) stage: Stage<3>,
    bvh: Option<Bvh>,
    pub(super) points: Points,
    seed: u64,
    simd: Simd,
    /// Marks the paths that count; `None` if all paths count.
    pub(super) asked: Option<Arc<dyn Marker>>,
}

impl Real {
    /// A machine for `scene`; `seed` keys the shifts of the digital net.
    ///
    /// # Errors
    /// If the scene's sequence cannot be made; a valid scene's can.
    pub fn new(scene: &ValidScene, seed: u64) -> Result<Self, qrt_scene::sampling::SamplingError> {
        Self::of_class(scene, seed, PixelClass::default())
    }

    /// A machine for the pixels of one class of `scene`, with their scale.
    ///
    /// # Errors
    /// As [`Real::new`].
    pub fn of_class(
        scene: &ValidScene,
        seed: u64,
        class: PixelClass,
    ) -> Result<Self, qrt_scene::sampling::SamplingError> {
        let points = Points::Sequence(PathPoints::new(&scene.scene().sampling)?);
        let stage = Stage::rgb(scene, class);
        let geometry = stage.geometry();
        let many = geometry.faces.len() + geometry.balls.len() > FEW_FACES;
        Ok(Self {
            bvh: many.then(|| Bvh::new(stage.geometry())),
            stage,
            points,
            seed,
            simd: Simd::default(),
            asked: None,
        })
    }

    /// A machine for the pixel (column, row) of `scene`, with the scale of its class.
    ///
    /// # Errors
    /// As [`Real::new`].
    pub fn of_pixel(
        scene: &ValidScene,
        seed: u64,
        pixel: [u32; 2],
    ) -> Result<Self, qrt_scene::sampling::SamplingError> {
        Self::of_class(scene, seed, PixelClasses::new(scene).class(pixel))
    }

    /// Returns the values of `numbers` on one path, in scene units and in the order of `numbers`:
    /// see [`qrt_core::oracle::paths`].
    ///
    /// # Errors
    /// As [`Real::new`].
    pub fn path(
        scene: &ValidScene,
        formats: &PathFormats,
        numbers: &[PathNumber],
        seed: u64,
        pixel: [u32; 2],
        id: u64,
    ) -> Result<Vec<f64>, qrt_scene::sampling::SamplingError> {
        let mut real = Self::new(scene, seed)?;
        real.stage = formats.stage(real.stage, numbers);
        let numbers = PathNumbers::new(scene, formats, numbers);
        let mut inputs = real.inputs(Some(numbers.watched()));
        let mut colours = [[0.0; BLOCK]; 3];
        real.fill(&mut inputs, pixel, id, 0..1);
        real.trace_block(&inputs, 1, &mut colours);
        let Some(watched) = &inputs.watched else {
            return Ok(Vec::new());
        };
        Ok(numbers.values(&real.stage, (&watched.borrow(), &colours), 0))
    }

    /// Returns the same machine with other vector instructions.
    pub fn with_simd(mut self, simd: Simd) -> Self {
        self.simd = simd;
        self
    }

    /// Adds the hierarchy of boxes in front of the faces, or removes it. By default, a machine has
    /// one if it makes the search faster. The colours are the same.
    pub fn with_boxes(mut self, boxes: bool) -> Self {
        self.bvh = boxes.then(|| Bvh::new(self.stage.geometry()));
        self
    }

    /// Replaces the scene's sequence by independent paths, `paths` for each pixel.
    pub fn monte_carlo(mut self, paths: u64) -> Self {
        let like = self.points.sequence().clone();
        self.points = Points::Independent { like, paths };
        self
    }

    /// The scene in the form that the tracer reads.
    pub fn stage(&self) -> &Stage<3> {
        &self.stage
    }

    /// R, the paths of a pixel.
    pub fn paths(&self) -> u64 {
        self.points.paths()
    }

    /// Traces every path of `pixels` (column, row) and passes the colours to `finished`, block by
    /// block. The blocks of a pixel come in the order of path indices.
    pub fn trace(&self, pixels: &[[u32; 2]], finished: impl FnMut(PathBlock<'_>)) {
        self.trace_range(pixels, 0..self.points.paths(), finished);
    }

    /// As [`Real::trace`], but traces only the paths with indices in `ids` of each pixel.
    pub fn trace_range(
        &self,
        pixels: &[[u32; 2]],
        ids: Range<u64>,
        mut finished: impl FnMut(PathBlock<'_>),
    ) {
        let asked = self.asked.as_ref();
        let mut inputs = self.inputs(asked.map(|asked| asked.watched()));
        let mut mark = asked.map(|asked| asked.marks());
        let mut colours = [[0.0; BLOCK]; 3];
        // A block holds runs of path indices, each of one pixel.
        let mut filled = 0;
        let mut runs: Vec<(usize, Range<usize>)> = Vec::new();
        for (number, &pixel) in pixels.iter().enumerate() {
            let mut first = ids.start;
            while first < ids.end {
                let count = (ids.end - first).min((BLOCK - filled) as u64) as usize;
                let range = filled..filled + count;
                self.fill(&mut inputs, pixel, first, range.clone());
                runs.push((number, range));
                first += count as u64;
                filled += count;
                if filled == BLOCK || (number + 1 == pixels.len() && first == ids.end) {
                    self.trace_block(&inputs, filled, &mut colours);
                    if let Some(mark) = &mut mark {
                        mark(&self.stage, (&inputs, filled), &mut colours);
                    }
                    for (pixel, range) in runs.drain(..) {
                        let colours = [0, 1, 2].map(|c: usize| &colours[c][range.clone()]);
                        finished(PathBlock { pixel, colours });
                    }
                    filled = 0;
                }
            }
        }
    }

    /// Creates the input of a block, without paths yet.
    fn inputs(&self, watched: Option<RefCell<Vec<Watched>>>) -> Inputs {
        Inputs {
            indices: vec![[0; BLOCK]; 4 * self.points.sequence().depths()],
            column: [0.0; BLOCK],
            row: [0.0; BLOCK],
            watched,
        }
    }

    /// Puts paths of one pixel, from index `first` on, into a range of a block.
    fn fill(&self, inputs: &mut Inputs, pixel: [u32; 2], first: u64, range: Range<usize>) {
        for coordinate in self.points.sequence().coordinates() {
            let out = &mut inputs.indices[coordinate.slot()][range.clone()];
            self.points.fill(self.seed, pixel, coordinate, first, out);
        }
        inputs.column[range.clone()].fill(f64::from(pixel[0]));
        inputs.row[range].fill(f64::from(pixel[1]));
    }

    /// The sums over all paths of `pixels`.
    pub fn sums(&self, pixels: &[[u32; 2]]) -> Vec<PixelSum> {
        let mut sums = vec![PixelSum::default(); pixels.len()];
        self.trace(pixels, |block| {
            let sum = &mut sums[block.pixel];
            for (total, colours) in sum.colour.iter_mut().zip(block.colours) {
                *total += colours.iter().sum::<f64>();
            }
        });
        sums
    }

    fn trace_block(&self, inputs: &Inputs, count: usize, colours: &mut [[f64; BLOCK]; 3]) {
        let block = TraceTask {
            stage: &self.stage,
            bvh: self.bvh.as_ref(),
            inputs,
            count,
            colours,
        };
        self.dispatch(block);
    }

    pub(super) fn boxes(&self) -> Option<&Bvh> {
        self.bvh.as_ref()
    }

    /// Runs `work` with this machine's lanes.
    #[cfg_attr(
        any(test, target_arch = "wasm32"),
        expect(clippy::unused_self, reason = "there, all machines have scalar lanes")
    )]
    pub(super) fn dispatch<F: WithSimd>(&self, work: F) -> F::Output {
        // This crate's unit tests and browsers use scalar lanes. Each instruction set adds another
        // copy of the tracer, to compile or to load, and not all browsers support the widest.
        #[cfg(any(test, target_arch = "wasm32"))]
        return work.with_simd(pulp::Scalar::new());
        #[cfg(not(any(test, target_arch = "wasm32")))]
        match self.simd {
            Simd::Widest => InstructionSet::widest(),
            Simd::Scalar => InstructionSet::Portable,
        }
        .dispatch(work)
    }
}

/// Number of paths that are traced between two checks for cancellation.
pub(super) const RUN: u64 = 1 << 16;
/// The largest number of paths of a pixel that one thread traces.
pub(super) const UNDIVIDED: u64 = 1 << 18;

struct TraceTask<'a> {
    stage: &'a Stage<3>,
    bvh: Option<&'a Bvh>,
    inputs: &'a Inputs,
    count: usize,
    colours: &'a mut [[f64; BLOCK]; 3],
}

impl WithSimd for TraceTask<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let geometry = self.stage.geometry();
        let faces = match self.bvh {
            Some(bvh) => Faces::Many(Indexed::new(geometry, bvh)),
            None => Faces::Few(geometry),
        };
        for first in (0..self.count).step_by(Lanes::<S, WIDTH>::COUNT) {
            let mut cx = Lanes::<S, WIDTH> {
                simd,
                inputs: self.inputs,
                first,
            };
            let colour = trace(&mut cx, self.stage, &faces);
            for (out, colour) in self.colours.iter_mut().zip(&colour) {
                out[first..first + Lanes::<S, WIDTH>::COUNT].copy_from_slice(lanes(colour));
            }
        }
    }
}
