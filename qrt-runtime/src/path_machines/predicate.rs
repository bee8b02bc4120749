//! Predicates on the real machine: the tracer's numbers in 64-bit floating point, each rounded to
//! the nearest of its register's format, and the predicate's program on these.

use super::lanes::{BLOCK, Inputs, Watched};
use super::path_numbers::{Mark, Marker, PathNumbers};
use super::real::Real;
use qrt_core::oracle::{Marks, Predicate};
use qrt_machines::FixedMachine;
use qrt_machines::PixelLanes;
use qrt_tracer::Stage;
use std::cell::RefCell;
use std::sync::Arc;

/// A predicate on paths: its numbers, its program, and its marks.
#[derive(Clone, Debug)]
pub(super) struct Asked {
    numbers: PathNumbers,
    program: FixedMachine,
    marks: Marks,
}

impl Real {
    /// Marks paths by a predicate. In place of a path's colour the machine returns 1 for a good path
    /// and 0 for any other under [`Marks::Paths`], and the colour of a good path and black for any
    /// other under [`Marks::Light`].
    pub(crate) fn with_predicate(mut self, predicate: &Predicate, marks: Marks) -> Self {
        self.stage = predicate.formats().stage(self.stage, predicate.numbers());
        self.asked = Some(Arc::new(Asked::new(predicate, marks)));
        self
    }
}

impl Asked {
    pub(super) fn new(predicate: &Predicate, marks: Marks) -> Self {
        Self {
            numbers: PathNumbers::new(predicate.scene(), predicate.formats(), predicate.numbers()),
            program: FixedMachine::new(predicate.program(), &[predicate.good()]),
            marks,
        }
    }

    /// Replaces the colours of the first `count` paths of a block by the values that are counted.
    /// For [`Marks::Paths`] the value is 1 where the predicate holds and 0 elsewhere; for
    /// [`Marks::Light`] it is the colour where the predicate holds and 0 elsewhere. It is NaN where
    /// a number of the path does not fit its register, which is a defect.
    fn mark(
        &self,
        stage: &Stage<3>,
        lanes: &mut qrt_machines::FixedLanes,
        (inputs, count): (&Inputs, usize),
        colours: &mut [[f64; BLOCK]; 3],
    ) {
        let Some(watched) = &inputs.watched else {
            return;
        };
        let rays = watched.borrow();
        let mut unheld = [false; BLOCK];
        let mut columns = Vec::new();
        for &number in &*self.numbers.numbers {
            let format = self.numbers.formats.format(number);
            let column = (0..count).map(|lane| {
                let value = self.numbers.value(stage, (&rays, colours), number, lane);
                let bits = format.bits(value);
                unheld[lane] |= bits.is_none();
                bits.unwrap_or(0)
            });
            columns.push(column.collect::<Vec<u64>>());
        }
        let columns: Vec<&[u64]> = columns.iter().map(Vec::as_slice).collect();
        let span = PixelLanes {
            lanes: count,
            parameters: &[],
        };
        let mut good = [0_i64; BLOCK];
        let outputs = &mut [&mut good[..count]];
        self.program.run(lanes, &columns, &[span], outputs);
        for (lane, good) in good[..count].iter().enumerate() {
            for colour in &mut *colours {
                colour[lane] = match (self.marks, good) {
                    _ if unheld[lane] => f64::NAN,
                    (_, 0) => 0.0,
                    (Marks::Paths, _) => 1.0,
                    (Marks::Light, _) => colour[lane],
                };
            }
        }
        drop(rays);
        watched.borrow_mut().fill(Watched::NONE);
    }
}

impl Marker for Asked {
    fn watched(&self) -> RefCell<Vec<Watched>> {
        self.numbers.watched()
    }

    fn marks(&self) -> Mark<'_> {
        let mut lanes = self.program.lanes();
        Box::new(move |stage, block, colours| self.mark(stage, &mut lanes, block, colours))
    }
}

const _: () = assert!(BLOCK <= FixedMachine::LANES);
