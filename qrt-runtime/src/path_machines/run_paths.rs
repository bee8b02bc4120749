//! The paths of one pixel, run by an oracle's program that is bound to it: a [`BoundProgram`].

use super::{Defect, OracleMachine};
use qrt_circuit::{Contents, Unclean};
use qrt_core::oracle::BoundProgram;
use std::ops::Range;
use std::sync::Arc;

/// Runs the paths `ids` of a scene's program in a pixel, by the definition of its operations.
/// Returns, by path, the number of comparators that are good in each channel.
///
/// # Errors
/// If an inverse does not find the value that its operation computes.
pub fn on_definition(bound: &BoundProgram, ids: Range<u64>) -> Result<Vec<Vec<u64>>, Unclean> {
    ids.map(|id| {
        let mut contents = Contents::new(bound, &[id, 0], &[]);
        for instruction in &bound.instructions {
            contents.follow(bound, *instruction)?;
        }
        Ok(bound.good(&contents.registers))
    })
    .collect()
}

/// As [`on_definition`], on the fixed machine. The program must have three channels.
///
/// # Errors
/// The first defect found.
pub fn on_fixed(bound: &BoundProgram, ids: Range<u64>) -> Result<Vec<Vec<u64>>, Defect> {
    let oracle = Arc::new(bound.oracle().clone());
    on_machine(
        &OracleMachine::fixed(oracle, bound.seed(), false),
        bound,
        ids,
    )
}

/// As [`on_fixed`], on the gates machine: it runs every gate of compute, flip and uncompute,
/// and checks all ancillas between paths.
///
/// # Errors
/// The first defect found.
pub fn on_gates(bound: &BoundProgram, ids: Range<u64>) -> Result<Vec<Vec<u64>>, Defect> {
    let oracle = Arc::new(bound.oracle().clone());
    on_machine(
        &OracleMachine::gates(oracle, bound.seed(), false)?,
        bound,
        ids,
    )
}

fn on_machine(
    machine: &OracleMachine,
    bound: &BoundProgram,
    ids: Range<u64>,
) -> Result<Vec<Vec<u64>>, Defect> {
    let mut paths = Vec::new();
    machine.trace(&[bound.pixel()], ids, |run| {
        let channels = run.good.iter().filter(|good| !good.is_empty());
        let channels: Vec<&[i64]> = channels.copied().collect();
        let count = channels.first().map_or(0, |good| good.len());
        let path = |place: usize| channels.iter().map(move |good| good[place].cast_unsigned());
        paths.extend((0..count).map(|place| path(place).collect()));
    })?;
    Ok(paths)
}
