//! The oracles of a scene, by name, and the cost of one call of each.
//!
//! A scene has an oracle for each channel and each class of pixels ([`PixelClass`]): the classes
//! differ in their colour scale, the channels in their albedos. [`oracle_costs`] is the only list of
//! their costs: commands, budgets and plans all read it, or [`crate::inspect::Inspection`] of one of
//! its entries.
//!
//! A call is compute, compare, flip of the phase, uncompute ([`Oracle::whole`]). It does not include
//! the parts that counting adds (the reflection, the phase register).

use super::recording::{CHANNELS, PrimaryHit, Recording};
use super::{CallCost, Options, Oracle, OracleError, budget};
use crate::compile::{self, Strategy};
use crate::tracer::{PixelClass, PixelClasses};
use qrt_circuit::Cores;
use qrt_scene::valid::ValidScene;
use std::fmt;

/// The parts of one call of an oracle, in words.
pub const PARTS_OF_A_CALL: &str = "compute, compare and flip, uncompute";

/// The name of one of a scene's oracles: its channel, and the class of the pixels that it is for.
///
/// ```
/// use qrt_core::oracle::OracleName;
/// use qrt_core::tracer::PixelClass;
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
        CHANNELS[self.channel]
    }
}

impl fmt::Display for OracleName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "channel {}, {}", self.channel_name(), self.pixels())
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
    /// The cost of a call of `oracle`, which has that `name`. `known` caches the figures of
    /// operations.
    pub(super) fn new(name: OracleName, oracle: &Oracle, known: &mut compile::Known) -> Self {
        let figures = budget::figures(oracle, known);
        let call = budget::cost_by(oracle, &figures);
        Self { name, call }
    }

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

/// The names of a scene's oracles: each channel of each class that its pixels have.
pub fn oracle_names(scene: &ValidScene) -> Vec<OracleName> {
    let classes = PixelClasses::new(scene);
    let present = classes.present();
    let names = present.iter().flat_map(|&class| {
        (0..3).map(move |channel| OracleName {
            channel,
            class,
            of_all_pixels: present.len() == 1,
        })
    });
    names.collect()
}

/// The cost of a call of each of [`oracle_names`], in their order. The scene is traced once for each
/// class, and compiled on all cores.
///
/// # Errors
/// As [`Oracle::new`](super::Oracle::new).
///
/// ```
/// use qrt_scene::front::parse;
/// use qrt_core::inspect::Inspection;
/// use qrt_core::oracle::{OracleCost, oracle_costs};
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
/// let costs = oracle_costs(&scene)?;
/// assert_eq!(costs.len(), 3);
/// // It is what is inspected unless another is asked for.
/// let most = OracleCost::most_expensive(costs).unwrap();
/// let inspection = Inspection::most_expensive(&scene, None)?;
/// assert_eq!(inspection.oracle_cost(), most);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn oracle_costs(scene: &ValidScene) -> Result<Vec<OracleCost>, OracleError> {
    // Determined once for all oracles.
    let strategy = Options::default().strategy(scene)?;
    oracle_costs_under(scene, strategy)
}

/// The costs of [`oracle_costs`] for pixels of `class`. Only that class is compiled. None if no pixel
/// is of it.
///
/// # Errors
/// As [`oracle_costs`].
pub fn oracle_costs_of_class(
    scene: &ValidScene,
    class: PixelClass,
) -> Result<Vec<OracleCost>, OracleError> {
    let mut names = oracle_names(scene);
    names.retain(|name| name.class == class);
    costs_of(scene, &names, Options::default().strategy(scene)?)
}

/// The costs of [`oracle_costs`]. Only the classes whose costs are not in `known` are compiled.
///
/// # Errors
/// As [`oracle_costs`].
pub fn oracle_costs_knowing(
    scene: &ValidScene,
    known: &[OracleCost],
) -> Result<Vec<OracleCost>, OracleError> {
    let names = oracle_names(scene);
    let strategy = Options::default().strategy(scene)?;
    let mut costs = Vec::with_capacity(names.len());
    for names in names.chunk_by(|a, b| a.class == b.class) {
        let of_class = known.iter().filter(|cost| names.contains(&cost.name));
        let of_class: Vec<OracleCost> = of_class.copied().collect();
        costs.extend(if of_class.len() == names.len() {
            of_class
        } else {
            costs_of(scene, names, strategy)?
        });
    }
    Ok(costs)
}

/// The costs of [`oracle_costs`] under another strategy than the scene's.
///
/// # Errors
/// As [`oracle_costs`].
pub fn oracle_costs_under(
    scene: &ValidScene,
    strategy: Strategy,
) -> Result<Vec<OracleCost>, OracleError> {
    costs_of(scene, &oracle_names(scene), strategy)
}

/// The costs of a call of each of the oracles `names`, which are sorted by class.
fn costs_of(
    scene: &ValidScene,
    names: &[OracleName],
    strategy: Strategy,
) -> Result<Vec<OracleCost>, OracleError> {
    let mut costs = Vec::with_capacity(names.len());
    for names in names.chunk_by(|a, b| a.class == b.class) {
        let options = Options {
            strategy: Some(strategy),
            ..Options::of_class(names[0].class)
        };
        let recording = Recording::new(scene, [0, 1, 2], options, PrimaryHit::Traced)?;
        recording.known().cores = Cores::All;
        let oracles = Cores::All.map(names, 1, |name| recording.oracle(&[name.channel]));
        let known = &mut recording.known();
        let named = names.iter().zip(&oracles);
        costs.extend(named.map(|(&name, oracle)| OracleCost::new(name, oracle, known)));
    }
    Ok(costs)
}

/// The most expensive of a scene's oracles: see [`OracleCost::most_expensive`].
///
/// # Errors
/// As [`oracle_costs`].
pub fn most_expensive_oracle(scene: &ValidScene) -> Result<OracleCost, OracleError> {
    Ok(most_expensive_of(&oracle_costs(scene)?))
}

/// The most expensive of all oracles of a scene.
pub(super) fn most_expensive_of(costs: &[OracleCost]) -> OracleCost {
    match OracleCost::most_expensive(costs.iter().copied()) {
        Some(most) => most,
        None => unreachable!("the pixels of a film have a class, which has three channels"),
    }
}
