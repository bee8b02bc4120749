//! All oracles of a scene, from one recording of each class of its pixels.

use super::recording::{PrimaryHit, Recording};
use super::{CallCost, Oracle, OracleError, OracleOptions};
use crate::compile::{Passes, Strategy};
use qrt_circuit::Cores;
use qrt_scene::valid::ValidScene;
use qrt_tracer::{PixelClass, PixelClasses};
use std::borrow::Cow;
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// The parts of one call of an oracle, in words.
pub const PARTS_OF_A_CALL: &str = "compute, compare and flip, uncompute";

/// Number of operations of a large program, which takes about half a gigabyte. Fewer such programs are
/// held at a time, although that takes longer.
pub(crate) const LARGE: usize = 1 << 20;

/// The name of one of a scene's oracles: its channel, and the class of the pixels that it is for.
///
/// ```
/// use qrt_core::oracle::OracleName;
/// use qrt_tracer::PixelClass;
///
/// let name = OracleName { channel: 1, class: PixelClass::MeetsNoLamp, of_all_pixels: false };
/// assert_eq!(name.to_string(), "channel g, pixels that see no lamp");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OracleName {
    /// The channel: 0 red, 1 green, 2 blue.
    pub channel: usize,
    /// The class of the pixels.
    pub class: PixelClass,
    /// True if all pixels of the film are of that class.
    pub of_all_pixels: bool,
}

impl OracleName {
    /// The class of the pixels as a keyword: `all`, `may-see-lamp` or `sees-no-lamp`.
    pub fn class_name(&self) -> &'static str {
        match self.class {
            _ if self.of_all_pixels => "all",
            PixelClass::MayMeetLamp => "may-see-lamp",
            PixelClass::MeetsNoLamp => "sees-no-lamp",
        }
    }

    /// The pixels in words: `all pixels`, `pixels that may see a lamp` or
    /// `pixels that see no lamp`.
    pub fn pixels(&self) -> &'static str {
        match self.class {
            _ if self.of_all_pixels => "all pixels",
            PixelClass::MayMeetLamp => "pixels that may see a lamp",
            PixelClass::MeetsNoLamp => "pixels that see no lamp",
        }
    }

    /// The keyword of the channel: `r`, `g` or `b`.
    pub fn channel_name(&self) -> &'static str {
        super::CHANNELS[self.channel]
    }
}

impl fmt::Display for OracleName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "channel {}, {}", self.channel_name(), self.pixels())
    }
}

impl CallCost {
    /// The most qubits and the most Toffolis of a call of any oracle in `costs`. The two may be of
    /// different oracles. Both are 0 if there are none.
    pub fn greatest(costs: &[OracleCost]) -> Self {
        let calls = || costs.iter().map(|cost| cost.call);
        Self {
            qubits: calls().map(|call| call.qubits).max().unwrap_or(0),
            toffoli: calls().map(|call| call.toffoli).max().unwrap_or(0),
        }
    }
}

/// One of a scene's oracles, and the cost of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OracleCost {
    /// Channel and class of pixels.
    pub name: OracleName,
    /// Qubits and Toffolis of a call.
    pub call: CallCost,
}

impl OracleCost {
    /// The one of two with more Toffolis; `self` if they are equal.
    #[must_use]
    pub fn dearer(self, other: Self) -> Self {
        if self.call.toffoli < other.call.toffoli {
            other
        } else {
            self
        }
    }

    /// The oracle with the most Toffolis; the first of equals. None if there are no oracles.
    pub fn most_expensive(costs: impl IntoIterator<Item = Self>) -> Option<Self> {
        costs.into_iter().reduce(Self::dearer)
    }
}

/// The oracles of a scene: one for each channel and each class of its pixels ([`PixelClass`]). The
/// classes differ in their colour scale, the channels in their albedos.
///
/// The tracer runs once for each class, and records its operations, when an oracle of that class is
/// first asked for. All oracles of the class are assembled from this recording: the oracle that
/// machines run for a picture, and the oracle of each channel alone, whose cost commands, budgets and
/// plans read.
///
/// A call is compute, compare, flip of the phase, uncompute ([`Oracle::whole`]). It does not include
/// the parts that counting adds (the reflection, the phase register).
///
/// ```
/// use qrt_scene::front::parse;
/// use qrt_core::oracle::{OracleCost, Oracles};
///
/// # let text = "
/// # name: lamp
/// # camera: { perspective: { eye: [0, 0, 2], target: [0, 0, 0], vfov: 45 } }
/// # film: { width: 4, height: 4 }
/// # materials: { lamp: { emitter: { radiance: [1, 0.5, 0] } } }
/// # geometry:
/// #   - quad: { vertices: [[0, -9, 0], [9, -9, 0], [9, 9, 0], [0, 9, 0]], material: lamp }
/// # sampling: { path_bits: 3, depths: [{ bits: [3, 3] }] }
/// # precision: { fraction: 8 }
/// # comparator: { bits: 2 }
/// # ";
/// let scene = parse(text, "lamp.yaml", &[], "".as_ref())?.valid;
/// let oracles = Oracles::new(&scene);
/// let costs = oracles.costs()?;
/// assert_eq!(costs.len(), 3);
/// let most = OracleCost::most_expensive(costs).unwrap();
/// assert_eq!(oracles.all_channels(most.name.class)?.channels.len(), 3);
/// // The tracer has run once for both.
/// assert_eq!(scene.recordings(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Oracles<'a> {
    scene: Cow<'a, ValidScene>,
    classes: PixelClasses,
    luminance: bool,
    /// The only pixel that the oracles are for; none if they are for all pixels of their classes.
    pixel: Option<[u32; 2]>,
    /// The strategy that [`Oracles::strategy`] found.
    pub(super) strategy: OnceLock<Strategy>,
    of: [Class; PixelClass::ALL.len()],
}

/// The recordings of a class of pixels, and the oracles that are assembled from them.
#[derive(Default)]
struct Class {
    /// By [`Strategy::recording`].
    recordings: [Mutex<Option<Arc<Recording>>>; Strategy::RECORDINGS],
    all_channels: Mutex<Option<Arc<Oracle>>>,
    costs: Mutex<Vec<(Strategy, [OracleCost; 3])>>,
}

impl<'a> Oracles<'a> {
    /// The oracles of `scene`. Nothing is compiled yet.
    pub fn new(scene: &'a ValidScene) -> Self {
        Self::of_scene(Cow::Borrowed(scene))
    }

    /// As [`Oracles::new`], of a scene that the oracles may own.
    pub fn of_scene(scene: Cow<'a, ValidScene>) -> Self {
        Self {
            classes: PixelClasses::new(&scene),
            scene,
            luminance: false,
            pixel: None,
            strategy: OnceLock::new(),
            of: Default::default(),
        }
    }

    /// The same oracles, with the luminance as a fourth channel of [`Oracles::all_channels`].
    #[must_use]
    pub fn with_luminance(self) -> Self {
        Self {
            luminance: true,
            of: Default::default(),
            ..self
        }
    }

    /// True under [`Oracles::with_luminance`].
    pub fn has_luminance(&self) -> bool {
        self.luminance
    }

    /// The oracles of the pixel (column, row) alone: its position is a constant in them, and costs no
    /// qubits.
    pub fn of_pixel(&self, pixel: [u32; 2]) -> Oracles<'_> {
        Oracles {
            scene: Cow::Borrowed(&self.scene),
            classes: self.classes.clone(),
            luminance: false,
            pixel: Some(pixel),
            strategy: OnceLock::new(),
            of: Default::default(),
        }
    }

    /// The only pixel that the oracles are for; none if they are for all pixels of their classes.
    pub fn pixel(&self) -> Option<[u32; 2]> {
        self.pixel
    }

    /// The scene of the oracles.
    pub fn scene(&self) -> &ValidScene {
        &self.scene
    }

    /// The classes of the scene's pixels.
    pub fn classes(&self) -> &PixelClasses {
        &self.classes
    }

    /// The classes that the oracles are for: those that pixels of the film have, or that of the only
    /// pixel.
    fn present(&self) -> Vec<PixelClass> {
        match self.pixel {
            Some(pixel) => vec![self.classes.class(pixel)],
            None => self.classes.present().to_vec(),
        }
    }

    /// The name of each oracle: each channel of each class that the pixels have.
    pub fn names(&self) -> Vec<OracleName> {
        let present = self.present().into_iter();
        present.flat_map(|class| self.names_of(class)).collect()
    }

    /// The name of the oracle of channel 0 red, 1 green or 2 blue, for pixels of `class`.
    pub fn name(&self, channel: usize, class: PixelClass) -> OracleName {
        OracleName {
            channel,
            class,
            of_all_pixels: self.classes.present() == [class],
        }
    }

    fn names_of(&self, class: PixelClass) -> [OracleName; 3] {
        [0, 1, 2].map(|channel| self.name(channel, class))
    }

    /// The oracle that machines run for the pictures of a class of pixels: the program of the three
    /// channels, which share their paths, and of their luminance under [`Oracles::with_luminance`]. It
    /// is assembled once.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn all_channels(&self, class: PixelClass) -> Result<Arc<Oracle>, OracleError> {
        let strategy = self.strategy()?;
        let mut known = locked(&self.of[class as usize].all_channels);
        if let Some(oracle) = &*known {
            return Ok(oracle.clone());
        }
        let recording = self.recording(class, strategy)?;
        recording.known().cores = Cores::All;
        let oracle = Arc::new(recording.oracle_under(strategy, self.places()));
        Ok(known.insert(oracle).clone())
    }

    /// [`Oracles::all_channels`] and [`Oracles::costs_of`] of a class, assembled together on all cores.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn with_costs(
        &self,
        class: PixelClass,
    ) -> Result<(Arc<Oracle>, [OracleCost; 3]), OracleError> {
        let costs = self.assembled(class, self.strategy()?, true)?;
        Ok((self.all_channels(class)?, costs))
    }

    /// The oracle of one channel, for pixels of a class. It is as [`Oracle::new`] makes it, except for
    /// the numbers of its registers and [`Oracle::sharing`], which is that of all channels.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn channel(&self, channel: usize, class: PixelClass) -> Result<Oracle, OracleError> {
        let strategy = self.strategy()?;
        let recording = self.recording(class, strategy)?;
        Ok(recording.oracle_under(strategy, &[channel]))
    }

    /// The cost of a call of each of [`Oracles::names`], in their order. This is the only list of costs:
    /// all commands, budgets and plans read it.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn costs(&self) -> Result<Vec<OracleCost>, OracleError> {
        self.costs_under(self.strategy()?)
    }

    /// The costs of [`Oracles::costs`] under another strategy than the scene's.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn costs_under(&self, strategy: Strategy) -> Result<Vec<OracleCost>, OracleError> {
        let mut costs = Vec::new();
        for class in self.present() {
            costs.extend(self.priced(class, strategy)?);
        }
        Ok(costs)
    }

    /// The costs of red, green and blue for pixels of a class.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn costs_of(&self, class: PixelClass) -> Result<[OracleCost; 3], OracleError> {
        self.priced(class, self.strategy()?)
    }

    /// The most expensive of the scene's oracles: see [`OracleCost::most_expensive`].
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn most_expensive(&self) -> Result<OracleCost, OracleError> {
        Ok(most_expensive_of(&self.costs()?))
    }

    /// The oracle `name` under each of several sets of passes. The channel is recorded by itself, once
    /// for successive sets that need the same recording.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub(crate) fn by_passes(
        &self,
        name: OracleName,
        sets: &[Passes],
    ) -> Result<Vec<Oracle>, OracleError> {
        let strategy = self.strategy()?;
        let mut oracles = Vec::with_capacity(sets.len());
        for sets in sets.chunk_by(|a, b| a.same_recording(*b)) {
            let options = OracleOptions {
                strategy: Some(strategy),
                passes: sets[0],
                class: name.class,
                pixel: self.pixel,
            };
            let first = PrimaryHit::Traced;
            let recording = Recording::new(&self.scene, [name.channel], options, first)?;
            oracles.extend(sets.iter().map(|set| recording.oracle_with(*set, &[0])));
        }
        Ok(oracles)
    }

    /// Assembles [`Oracles::all_channels`] of each class, and drops the recordings: work on the circuits
    /// then needs no other memory.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn assemble_all_channels(&self) -> Result<(), OracleError> {
        for class in self.present() {
            self.all_channels(class)?;
        }
        self.release();
        Ok(())
    }

    /// Drops the recordings, which take as much memory as their oracles. An oracle that was not
    /// assembled before is recorded again if it is asked for.
    pub fn release(&self) {
        for recording in self.of.iter().flat_map(|class| &class.recordings) {
            *locked(recording) = None;
        }
    }

    /// Drops each of [`Oracles::all_channels`] that takes hundreds of megabytes. It is assembled again if it is
    /// asked for.
    pub fn release_large(&self) {
        for class in &self.of {
            let mut known = locked(&class.all_channels);
            *known = known.take().filter(|all| all.program.ops.len() <= LARGE);
        }
    }

    fn places(&self) -> &'static [usize] {
        if self.luminance {
            &[0, 1, 2, 3]
        } else {
            &[0, 1, 2]
        }
    }

    fn priced(
        &self,
        class: PixelClass,
        strategy: Strategy,
    ) -> Result<[OracleCost; 3], OracleError> {
        self.assembled(class, strategy, false)
    }

    /// The costs of the three channels and, if `with_all` is set, the oracle of [`Oracles::all_channels`],
    /// which is then kept. What is not kept yet is assembled on all cores.
    fn assembled(
        &self,
        class: PixelClass,
        strategy: Strategy,
        with_all: bool,
    ) -> Result<[OracleCost; 3], OracleError> {
        let mut kept = locked(&self.of[class as usize].costs);
        if let Some((_, costs)) = kept.iter().find(|(of, _)| *of == strategy) {
            return Ok(*costs);
        }
        let recording = self.recording(class, strategy)?;
        recording.known().cores = Cores::All;
        let with_all = with_all && locked(&self.of[class as usize].all_channels).is_none();
        let names = self.names_of(class);
        let of_channel = |&channel: &usize| {
            let stem = recording.stem(strategy, channel);
            OracleCost {
                name: names[channel],
                call: recording.priced(stem, strategy, channel).cost(),
            }
        };
        // Each program is dropped once it is counted. Large ones are not held at the same time.
        let cores = if recording.operations() > LARGE {
            Cores::One
        } else {
            Cores::All
        };
        let costs = cores.map(&[0, 1, 2], 1, of_channel);
        let costs = [0, 1, 2].map(|channel: usize| costs[channel]);
        if with_all {
            let all = recording.oracle_under(strategy, self.places());
            locked(&self.of[class as usize].all_channels).get_or_insert(Arc::new(all));
        }
        kept.push((strategy, costs));
        Ok(costs)
    }

    /// The recording of a class that `strategy` needs, made once.
    pub(super) fn recording(
        &self,
        class: PixelClass,
        strategy: Strategy,
    ) -> Result<Arc<Recording>, OracleError> {
        let mut known = locked(&self.of[class as usize].recordings[strategy.recording()]);
        if let Some(recording) = &*known {
            return Ok(recording.clone());
        }
        let options = OracleOptions {
            strategy: Some(strategy),
            pixel: self.pixel,
            ..OracleOptions::of_class(class)
        };
        let recording = if self.luminance {
            Recording::with_luminance(&self.scene, options)?
        } else {
            Recording::new(&self.scene, [0, 1, 2], options, PrimaryHit::Traced)?
        };
        Ok(known.insert(Arc::new(recording)).clone())
    }
}

/// Locks a cache. Entries are complete when inserted, so a poisoned lock is safe to reuse.
fn locked<T>(cache: &Mutex<T>) -> MutexGuard<'_, T> {
    cache.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The most expensive of all oracles of a scene.
pub(super) fn most_expensive_of(costs: &[OracleCost]) -> OracleCost {
    match OracleCost::most_expensive(costs.iter().copied()) {
        Some(most) => most,
        None => unreachable!("the pixels of a film have a class, which has three channels"),
    }
}
