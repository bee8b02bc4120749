//! A pixel's parameters, built into its oracle.

use crate::oracle::{Oracle, OracleName};
use qrt_circuit::lower::Cost;
use qrt_circuit::{Op, Program, RegisterId};
use std::fmt::Write as _;

/// A pixel, and the seed that shifts its paths: together they fix the parameters of its oracle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OraclePixel {
    /// Column and row of the pixel, from 0 at the top left; less than the film's width and height.
    pub place: [u32; 2],
    /// Key of the shifts of its paths.
    pub seed: u64,
}

impl OraclePixel {
    /// Names the pixel's oracle in words. `oracle` is the name of the oracle of its class.
    pub fn which(&self, oracle: OracleName) -> String {
        let [x, y] = self.place;
        let mut text = format!("channel {}, pixel {x},{y} alone", oracle.channel_name());
        if !oracle.of_all_pixels {
            let _ = write!(text, ", of the {}", oracle.pixels());
        }
        text
    }

    /// Subtracts from the costs of a call's instructions the X gates that this pixel does not have:
    /// a parameter's bit is an X where it is 1, and no gate where it is 0.
    pub(super) fn build_in(&self, oracle: &Oracle, whole: &Program, costs: &mut [Cost]) {
        let words = oracle.parameter_words(self.seed, self.place);
        let zeros = |parameter: u32, target: RegisterId| {
            let width = whole.width(target);
            let word = words.get(parameter as usize).copied().unwrap_or(0);
            let ones = (0..width).filter(|bit| word.checked_shr(*bit).unwrap_or(0) & 1 == 1);
            u64::from(width) - ones.count() as u64
        };
        for (instruction, cost) in whole.instructions.iter().zip(costs) {
            cost.x -= match whole.ops[instruction.op as usize] {
                Op::Load { parameter, target }
                | Op::Parity {
                    parameter: Some(parameter),
                    target,
                    ..
                } => zeros(parameter, target),
                _ => 0,
            };
        }
    }
}
