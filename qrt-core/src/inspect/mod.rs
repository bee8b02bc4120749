//! The cost of a scene's oracle and its parts: the figures of `qrt inspect`, which
//! `qrt_lab::draw` draws.
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
pub use frame::{CallDiagram, DiagramBox, Wire};
pub use layout::{Lifetime, RegisterLayout};
pub use passes::PassFigures;
pub use pixel::OraclePixel;
pub use qrt_syntax::grouped;
pub use stages::{CallPart, CallStage};

use crate::compile::{Role, Strategy};
use crate::oracle::{
    CallCost, LARGE, Oracle, OracleCost, OracleError, OracleName, Oracles, PARTS_OF_A_CALL,
};
use qrt_circuit::lower::{self, Cost};
use qrt_circuit::quantum::{Conjunction, CountingCircuit, Window};
use qrt_circuit::{Op, Program};
use qrt_tracer::PixelClass;
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
    pub layout: RegisterLayout,
}

impl Inspection {
    /// Inspects one of [`Oracles::names`]. If it is large, the programs that `oracles` holds are dropped, and
    /// made again if they are asked for.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn new(oracles: &Oracles<'_>, name: OracleName) -> Result<Self, OracleError> {
        let mut oracle = oracles.channel(name.channel, name.class)?;
        if oracle.program.ops.len() > LARGE {
            // The inspection itself takes gigabytes.
            oracles.release();
            oracles.release_large();
        }
        let (whole, (size, layout, costs)) = oracle.with_whole(|whole| {
            let size = lower::size(whole);
            (size, RegisterLayout::new(whole), lower::tally(whole))
        });
        Ok(Self {
            toffoli_depth: size.depth,
            qubits: size.qubits,
            in_use: size.in_use,
            layout,
            costs,
            name,
            pixel: None,
            strategy: oracles.strategy()?,
            oracle,
            whole,
        })
    }

    /// Inspects the most expensive oracle of `channel`, or of all channels: the one with the most
    /// Toffolis, the first of equals. The film's pixels fix the classes that are compared.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn most_expensive(
        oracles: &Oracles<'_>,
        channel: Option<usize>,
    ) -> Result<Self, OracleError> {
        Self::most_expensive_of(oracles, &oracles.costs()?, channel)
    }

    /// As [`Inspection::most_expensive`], for pixels of one class, which need not be on the film.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn of_class(
        oracles: &Oracles<'_>,
        channel: Option<usize>,
        class: PixelClass,
    ) -> Result<Self, OracleError> {
        Self::most_expensive_of(oracles, &oracles.costs_of(class)?, channel)
    }

    fn most_expensive_of(
        oracles: &Oracles<'_>,
        costs: &[OracleCost],
        channel: Option<usize>,
    ) -> Result<Self, OracleError> {
        let costs = costs.iter().copied();
        let asked = costs.filter(|cost| channel.is_none_or(|one| one == cost.name.channel));
        match OracleCost::most_expensive(asked) {
            Some(OracleCost { name, .. }) => Self::new(oracles, name),
            None => unreachable!("each class has the three channels"),
        }
    }

    /// Inspects the oracle of a pixel alone, as it is exported: its position and the other parameters
    /// are built in. Without a channel, the one with the most Toffolis.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    ///
    /// # Panics
    /// If the pixel is outside the film.
    pub fn of_pixel(
        oracles: &Oracles<'_>,
        channel: Option<usize>,
        pixel: OraclePixel,
    ) -> Result<Self, OracleError> {
        let ([x, y], film) = (pixel.place, oracles.scene().scene().film);
        assert!(
            x < film.width && y < film.height,
            "there is no pixel {x},{y} on a film of {} x {}",
            film.width,
            film.height
        );
        let class = oracles.classes().class(pixel.place);
        let alone;
        let oracles = if oracles.pixel() == Some(pixel.place) {
            oracles
        } else {
            alone = oracles.of_pixel(pixel.place);
            &alone
        };
        let mut inspection = match channel {
            Some(channel) => Self::new(oracles, oracles.name(channel, class))?,
            None => Self::of_class(oracles, None, class)?,
        };
        pixel.build_in(&inspection.oracle, &inspection.whole, &mut inspection.costs);
        inspection.pixel = Some(pixel);
        Ok(inspection)
    }

    /// The entry of [`Oracles::costs`] for this oracle.
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
        match self.pixel {
            None => self.name.to_string(),
            Some(pixel) => pixel.which(self.name),
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
    pub fn part(&self, part: CallPart) -> Cost {
        self.cost(self.instructions(part))
    }

    /// The cost of some of the instructions.
    pub fn cost(&self, instructions: Range<usize>) -> Cost {
        self.costs[instructions].iter().copied().sum()
    }

    /// Toffolis of the call that look up tables whose address is bits of the path index or of sampled
    /// coordinates. A circuit of few path bits can be such a table altogether.
    pub fn toffolis_of_tables(&self) -> u64 {
        let id = self.oracle.id;
        let mut of_paths = vec![false; self.whole.registers.len()];
        of_paths[id.index()] = true;
        for op in &self.whole.ops {
            if let Op::Parity { target, .. } = op {
                of_paths[target.index()] = true;
            }
        }
        let instructions = self.whole.instructions.iter().zip(&self.costs);
        let tables = instructions.filter(|(instruction, _)| {
            matches!(&self.whole.ops[instruction.op as usize], Op::Table { address, .. }
                if address.iter().all(|bit| of_paths[bit.register.index()]))
        });
        tables.map(|(_, cost)| cost.toffoli).sum()
    }

    /// Number of qubits of the complete counting circuit with a phase register of `phase_bits` qubits and
    /// `window` on it, as `qrt export --part counting` writes it.
    pub fn complete_qubits(&self, phase_bits: u32, window: Window) -> u32 {
        let index = self.oracle.points.path_bits() + self.oracle.comparator_bits();
        CountingCircuit::qubits_around(
            self.qubits,
            index,
            phase_bits,
            window,
            Conjunction::Toffolis,
        )
    }

    /// Toffolis times qubits: the size of the computation in space and time.
    pub fn toffoli_x_qubits(&self) -> u64 {
        let product = u128::from(self.total().toffoli) * u128::from(self.qubits);
        u64::try_from(product).unwrap_or(u64::MAX)
    }

    /// The range of a part in [`Program::instructions`].
    pub fn instructions(&self, part: CallPart) -> Range<usize> {
        let compute = self.oracle.program.instructions.len();
        let whole = self.whole.instructions.len();
        match part {
            CallPart::Compute => 0..compute,
            CallPart::Flip => compute..whole - compute,
            CallPart::Uncompute => whole - compute..whole,
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

    /// The cost of the call without passes, and with the passes added one after the other. For that, the
    /// oracle is recorded again without and with the passes that change a recording.
    ///
    /// # Errors
    /// As [`Oracle::new`]: without some pass a scene's numbers may not fit.
    pub fn passes(&self, oracles: &Oracles<'_>) -> Result<Vec<PassFigures>, OracleError> {
        passes::figures(oracles, self)
    }
}
