//! Fuses two steps into one: a sum, and the read of its only needed bit, as in comparisons.

use super::arith::Arith;
use super::lane::Kind;
use super::steps::{Step, StepLane};

/// Replaces each sum of which only one bit is read, and only once, by a step that computes that
/// bit.
pub(super) fn fused(steps: Vec<Step>, values: u32, kept: &[(Kind, u32)]) -> Vec<Step> {
    let mut steps: Vec<Option<Step>> = steps.into_iter().map(Some).collect();
    let mut reads = vec![0_u32; values as usize];
    let mut computed_by = vec![usize::MAX; values as usize];
    for (_, value) in kept {
        reads[*value as usize] += 1;
    }
    for (place, step) in steps.iter_mut().enumerate() {
        let Some(step) = step else { continue };
        step.visit(|seen| {
            let value = *seen.place as usize;
            if seen.computed {
                computed_by[value] = place;
            } else {
                reads[value] += 1;
            }
        });
    }
    for place in 0..steps.len() {
        let Some(read) = steps[place].as_ref().and_then(bit_of) else {
            continue;
        };
        let from = computed_by[read as usize];
        if reads[read as usize] != 1 || from == usize::MAX {
            continue;
        }
        let one = match (&steps[from], &steps[place]) {
            (Some(Step::Short(sum)), Some(Step::Short(bit))) => both(sum, bit),
            (Some(Step::Int(sum)), Some(Step::Int(bit))) => both(sum, bit),
            (Some(Step::Long(sum)), Some(Step::Long(bit))) => both(sum, bit),
            _ => None,
        };
        if one.is_some() {
            steps[place] = one;
            steps[from] = None;
        }
    }
    steps.into_iter().flatten().collect()
}

/// Returns the value of which the step reads a bit, if the step does nothing else.
fn bit_of(step: &Step) -> Option<u32> {
    match step {
        Step::Short(Arith::Bit { a, .. })
        | Step::Int(Arith::Bit { a, .. })
        | Step::Long(Arith::Bit { a, .. }) => Some(*a),
        _ => None,
    }
}

fn both<K: StepLane>(sum: &Arith<K>, bit: &Arith<K>) -> Option<Step> {
    let Arith::Bit { index, t, .. } = *bit else {
        return None;
    };
    // The register has the bit, so the bits that are cut from the sum are above it.
    let (a, b, subtract) = match *sum {
        Arith::Add { a, b, .. } => (a, b, false),
        Arith::Sub { a, b, .. } => (a, b, true),
        _ => return None,
    };
    Some(K::step(Arith::SumBit {
        a,
        b,
        subtract,
        index,
        t,
    }))
}
