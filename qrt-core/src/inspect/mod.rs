//! The cost of a scene's oracle and its parts: the figures of `qrt inspect`, which
//! `qrt_runtime::draw` draws.
//!
//! All figures are computed from one whole call of the oracle, `O_f` = compute, compare and flip,
//! uncompute ([`Oracle::whole`]): its instructions, their costs, the blocks that the costs are
//! charged to and the registers that the instructions compute. This module makes no assumption about
//! the circuit of a scene.

mod blocks;
mod frame;
mod layout;
mod passes;
mod pixel;
mod stages;
#[cfg(test)]
mod tests;

pub use blocks::BlockFigures;
pub use frame::{Frame, FrameBox, Wire};
pub use layout::{Layout, Lifetime};
pub use passes::{PassFigures, pass_figures};
pub use pixel::OraclePixel;
pub use qrt_scene::syntax::grouped;
pub use stages::{Part, Stage};

use crate::compile::{Role, Strategy};
use crate::oracle::{
    CallCost, Options, Oracle, OracleCost, OracleError, OracleName, PARTS_OF_A_CALL, oracle_costs,
};
use crate::tracer::PixelClasses;
use qrt_circuit::Program;
use qrt_circuit::lower::{self, Cost};
use qrt_scene::valid::ValidScene;
use std::fmt::Write as _;
use std::ops::Range;

/// The names of the channels, in their order.
pub const CHANNELS: [&str; 3] = ["r", "g", "b"];

/// One call of a channel's oracle, with its cost.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// Channel and class of pixels of the oracle.
    pub name: OracleName,
    /// The pixel whose parameters are built in. Without a pixel, the costs count every X gate that a
    /// pixel of the class may need.
    pub pixel: Option<OraclePixel>,
    /// The uncomputation strategy.
    pub strategy: Strategy,
    /// The oracle of that channel.
    pub oracle: Oracle,
    /// `O_f`: all its instructions.
    pub whole: Program,
    /// The cost of each instruction of the call in gates.
    pub costs: Vec<Cost>,
    /// Number of qubits in use while each instruction of the call runs, its own ancillas included.
    pub in_use: Vec<u32>,
    /// Number of qubits that the call needs: the maximum in use at any time.
    pub qubits: u32,
    /// The Toffoli depth: Toffolis on the longest chain of gates in which each gate waits for the one
    /// before.
    pub toffoli_depth: u64,
    /// The qubits and the lifetimes of each register.
    pub layout: Layout,
}

impl Inspection {
    /// Inspects the oracle of `channel`, for pixels of the class that `options` names; without a
    /// channel, the one whose oracle has the most Toffolis, the first of equals.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn new(
        scene: &ValidScene,
        channel: Option<usize>,
        options: Options,
    ) -> Result<Self, OracleError> {
        let first = channel.unwrap_or(0);
        // Determined once for all channels.
        let strategy = options.strategy(scene)?;
        let options = Options {
            strategy: Some(strategy),
            ..options
        };
        let mut most = Candidate::new(scene, first, options)?;
        if channel.is_none() {
            for channel in first + 1..CHANNELS.len() {
                let other = Candidate::new(scene, channel, options)?;
                if other.toffoli > most.toffoli {
                    most = other;
                }
            }
        }
        let Candidate {
            channel,
            oracle,
            whole,
            costs,
            ..
        } = most;
        let size = lower::size(&whole);
        let present = PixelClasses::new(scene).present();
        Ok(Self {
            toffoli_depth: size.depth,
            qubits: size.qubits,
            in_use: size.in_use,
            layout: Layout::new(&whole),
            name: OracleName {
                channel,
                class: options.class,
                of_all_pixels: present == [options.class],
            },
            pixel: None,
            strategy,
            oracle,
            whole,
            costs,
        })
    }

    /// Inspects the most expensive oracle of `channel`, or of all channels. The film's pixels fix the
    /// classes that are compared.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn most_expensive(scene: &ValidScene, channel: Option<usize>) -> Result<Self, OracleError> {
        Self::most_expensive_of(scene, &oracle_costs(scene)?, channel)
    }

    /// Inspects the most expensive oracle by `costs`, the scene's [`oracle_costs`] or some of them.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    ///
    /// # Panics
    /// If `costs` has no oracle of `channel`, or none at all.
    pub fn most_expensive_of(
        scene: &ValidScene,
        costs: &[OracleCost],
        channel: Option<usize>,
    ) -> Result<Self, OracleError> {
        let costs = costs.iter().copied();
        let asked = costs.filter(|cost| channel.is_none_or(|one| one == cost.name.channel));
        let Some(OracleCost { name, .. }) = OracleCost::most_expensive(asked) else {
            panic!("there are no costs of an oracle that is asked for");
        };
        Self::new(scene, Some(name.channel), Options::of_class(name.class))
    }

    /// Inspects the oracle of a pixel as it is exported: that of the pixel's class, with the pixel's
    /// parameters built in. Without a channel, the one with the most Toffolis.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    ///
    /// # Panics
    /// If the pixel is outside the film.
    pub fn of_pixel(
        scene: &ValidScene,
        channel: Option<usize>,
        pixel: OraclePixel,
    ) -> Result<Self, OracleError> {
        let ([x, y], film) = (pixel.place, scene.scene().film);
        assert!(
            x < film.width && y < film.height,
            "there is no pixel {x},{y} on a film of {} x {}",
            film.width,
            film.height
        );
        let class = PixelClasses::new(scene).class(pixel.place);
        let mut inspection = Self::new(scene, channel, Options::of_class(class))?;
        pixel.build_in(&inspection.oracle, &inspection.whole, &mut inspection.costs);
        inspection.pixel = Some(pixel);
        Ok(inspection)
    }

    /// The entry of [`oracle_costs`] for this oracle.
    pub fn oracle_cost(&self) -> OracleCost {
        OracleCost {
            name: self.name,
            call: CallCost {
                qubits: u64::from(self.qubits),
                toffoli: self.total().toffoli,
            },
        }
    }

    /// Names the oracle in words: its channel, and its pixel or class of pixels.
    pub fn which(&self) -> String {
        let channel = self.name.channel_name();
        match self.pixel {
            None => self.name.to_string(),
            Some(OraclePixel { place: [x, y], .. }) => {
                let mut text = format!("channel {channel}, pixel {x},{y}");
                if !self.name.of_all_pixels {
                    let _ = write!(text, " of the {}", self.name.pixels());
                }
                text
            }
        }
    }

    /// Names the oracle like [`Inspection::which`], but without its pixels if it serves all of them.
    pub fn which_briefly(&self) -> String {
        match self.pixel {
            None if self.name.of_all_pixels => format!("channel {}", self.name.channel_name()),
            _ => self.which(),
        }
    }

    /// Qubits and Toffolis of a call and the parts that are counted, in words.
    pub fn call_in_words(&self) -> String {
        let CallCost { qubits, toffoli } = self.oracle_cost().call;
        format!(
            "{} qubits, {} Toffolis: {PARTS_OF_A_CALL}",
            grouped(qubits),
            grouped(toffoli)
        )
    }

    /// The cost of the whole call in gates.
    pub fn total(&self) -> Cost {
        self.costs.iter().copied().sum()
    }

    /// The cost of a part; the three add up to [`Inspection::total`].
    pub fn part(&self, part: Part) -> Cost {
        self.cost(self.instructions(part))
    }

    /// The cost of some of the instructions.
    pub fn cost(&self, instructions: Range<usize>) -> Cost {
        self.costs[instructions].iter().copied().sum()
    }

    /// Toffolis times qubits: the size of the computation in space and time.
    pub fn toffoli_x_qubits(&self) -> u64 {
        let product = u128::from(self.total().toffoli) * u128::from(self.qubits);
        u64::try_from(product).unwrap_or(u64::MAX)
    }

    /// The range of a part in [`Program::instructions`].
    pub fn instructions(&self, part: Part) -> Range<usize> {
        let compute = self.oracle.program.instructions.len();
        let whole = self.whole.instructions.len();
        match part {
            Part::Compute => 0..compute,
            Part::Flip => compute..whole - compute,
            Part::Uncompute => whole - compute..whole,
        }
    }

    /// The most qubits in use during `instructions`; the qubits of the inputs if there are none.
    pub fn peak(&self, instructions: Range<usize>) -> u32 {
        let inputs = self.whole.inputs.iter();
        let inputs = inputs.map(|&input| self.whole.width(input)).sum();
        let most = self.in_use[instructions].iter().copied().max();
        most.unwrap_or(inputs)
    }

    /// Qubits in use at the peak: those of each of [`Role::ALL`], and the ancillas that the operation
    /// borrows. They add up to [`Inspection::qubits`].
    pub fn peak_by_role(&self) -> ([u32; Role::ALL.len()], u32) {
        let most = self.in_use.iter().copied().max().unwrap_or(0);
        let at = self.in_use.iter().position(|&n| n == most).unwrap_or(0);
        let mut roles = [0; Role::ALL.len()];
        for lifetime in &self.layout.lifetimes {
            if lifetime.instructions.contains(&at) {
                let register = &self.whole.registers[lifetime.register.index()];
                let place = Role::ALL
                    .iter()
                    .position(|&role| role == Role::from_register(register));
                roles[place.unwrap_or_default()] += register.width;
            }
        }
        let ancillas = self.qubits.saturating_sub(roles.iter().sum());
        (roles, ancillas)
    }

    /// The cost of the call without passes, and with the passes added one after the other.
    ///
    /// # Errors
    /// As [`Oracle::new`]: without some pass a scene's numbers may not fit.
    pub fn passes(&self, scene: &ValidScene) -> Result<Vec<PassFigures>, OracleError> {
        pass_figures(scene, self)
    }
}

/// A channel that may be the most expensive.
struct Candidate {
    channel: usize,
    oracle: Oracle,
    whole: Program,
    costs: Vec<Cost>,
    toffoli: u64,
}

impl Candidate {
    fn new(scene: &ValidScene, channel: usize, options: Options) -> Result<Self, OracleError> {
        let oracle = Oracle::new(scene, channel, options)?;
        let whole = oracle.whole(0);
        let costs = lower::tally(&whole);
        Ok(Self {
            channel,
            toffoli: costs.iter().copied().sum::<Cost>().toffoli,
            oracle,
            whole,
            costs,
        })
    }
}
