//! Assigns values to slots, and removes steps that are not needed.

use super::lane::{Kind, Slots};
use super::steps::Step;

/// Number of slots of each kind.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts([usize; 4]);

impl Counts {
    pub(super) fn slots(self) -> Slots {
        let [truths, shorts, ints, longs] = self.0;
        Slots {
            truths: vec![Box::default(); truths],
            shorts: vec![Box::default(); shorts],
            ints: vec![Box::default(); ints],
            longs: vec![Box::default(); longs],
        }
    }
}

/// Leaves out the steps on which no value in `kept` depends.
pub(super) fn needed(steps: Vec<Step>, values: u32, kept: &[(Kind, u32)]) -> Vec<Step> {
    let mut wanted = vec![false; values as usize];
    for (_, value) in kept {
        wanted[*value as usize] = true;
    }
    let mut left = Vec::new();
    for mut step in steps.into_iter().rev() {
        let mut runs = false;
        step.visit(|seen| runs |= seen.computed && wanted[*seen.place as usize]);
        if runs {
            step.visit(|seen| wanted[*seen.place as usize] |= !seen.computed);
            left.push(step);
        }
    }
    left.reverse();
    left
}

/// Replaces values' numbers by positions among the slots of their kind. A slot is reused after the
/// last read of its value; the slots of values in `kept` are never reused.
pub(super) fn assign(steps: &mut [Step], values: u32, kept: &mut [(Kind, u32)]) -> Counts {
    const NEVER: usize = usize::MAX;
    let mut last = vec![0; values as usize];
    for (place, step) in steps.iter_mut().enumerate() {
        step.visit(|seen| last[*seen.place as usize] = place);
    }
    for (_, value) in &*kept {
        last[*value as usize] = NEVER;
    }
    let mut slot = vec![0_u32; values as usize];
    let mut counts = Counts::default();
    let mut free: [Vec<u32>; 4] = Default::default();
    for (place, step) in steps.iter_mut().enumerate() {
        let mut over = Vec::new();
        step.visit(|seen| {
            let value = *seen.place as usize;
            if !seen.computed && last[value] == place && !over.contains(&(seen.kind, value)) {
                over.push((seen.kind, value));
            }
        });
        // Steps compute results in spare rows, so a result may take an operand's slot.
        for (kind, value) in over {
            free[kind as usize].push(slot[value]);
        }
        let mut unread = Vec::new();
        step.visit(|seen| {
            let value = *seen.place as usize;
            if seen.computed {
                let kind = seen.kind as usize;
                slot[value] = free[kind].pop().unwrap_or_else(|| {
                    counts.0[kind] += 1;
                    counts.0[kind] as u32 - 1
                });
                if last[value] == place {
                    unread.push((kind, slot[value]));
                }
            }
        });
        for (kind, place) in unread {
            free[kind].push(place);
        }
        step.visit(|seen| *seen.place = slot[*seen.place as usize]);
    }
    for (_, value) in kept {
        *value = slot[*value as usize];
    }
    counts
}
