//! Searches of some shapes as programs, which run bit by bit.

use crate::compile::{self, Builder, Passes, Strategy, Target};
use crate::tracer::ray::{Ray, Start};
use crate::tracer::search::{Running, Search};
use crate::tracer::{Arith, PixelClass, Stage};
use qrt_circuit::{Contents, Operand, Program, RegisterId, Word};
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::ValidScene;
use std::sync::Mutex;

/// A search of some shapes as a program.
pub(in crate::tracer::search) struct Circuit {
    pub(in crate::tracer::search) program: Program,
    inputs: Vec<RegisterId>,
    distance: Operand,
    face: Operand,
    fraction: u32,
}

impl Circuit {
    /// The search of a ray that leaves a surface and is anywhere in the stage.
    pub(in crate::tracer::search) fn new(
        scene: &ValidScene,
        fraction: u32,
        nearest_of: impl for<'b> FnOnce(
            &Search<'_>,
            &mut Builder<'b>,
            &Ray<Builder<'b>>,
            &mut Running<Builder<'b>>,
        ),
    ) -> Self {
        let stage = Stage::<3>::rgb(scene, PixelClass::MayMeetLamp);
        let points = PathPoints::new(&scene.scene().sampling).unwrap();
        let target = Target {
            fraction,
            strategy: Strategy::KEEP,
            points: &points,
            film: [1, 1],
            pixel: None,
            faces: stage.surface_of.len() as u32,
            passes: Passes::ALL,
        };
        let search = Search::new(&stage, 1.0 / (1_u64 << fraction) as f64);
        let mut builder = Builder::new(target);
        let given: Vec<_> = (0..6)
            .map(|k| builder.given_signed(&format!("in{k}"), 1.0))
            .collect();
        let at = |k: usize| [given[k].1, given[k + 1].1, given[k + 2].1];
        let cx = &mut builder;
        let ray = Ray {
            origin: at(0),
            direction: at(3),
            from: cx.index(crate::tracer::NO_PLANE),
            t_max: stage.t_max,
            start: Start::Surface,
        };
        let mut nearest = Running::new(cx, stage.t_max);
        nearest_of(&search, cx, &ray, &mut nearest);
        let distance = cx.held(nearest.distance);
        let distance = cx.operand_of(distance).0;
        // One more than the greatest label stands for none.
        let numbers: Vec<[f64; 1]> = (0..=stage.surface_of.len()).map(|n| [n as f64]).collect();
        let [face] = cx.rows(&numbers, nearest.face);
        let face = cx.held(face);
        let face = cx.operand_of(face).0;
        let id = builder.id();
        let recorded = builder.finish().unwrap();
        let registers = [distance, face].map(|operand| match operand {
            Operand::Word(word) => word.register,
            Operand::Constant(_) => panic!("a constant result"),
        });
        let mut inputs = vec![id];
        inputs.extend(given.iter().map(|(register, _)| *register));
        let known = Mutex::default();
        let (program, renamed) = compile::assemble(
            recorded,
            registers.as_slice().into(),
            Passes::ALL,
            Strategy::KEEP,
            &inputs,
            &known,
        );
        let of = |operand| match operand {
            Operand::Word(word) => Operand::Word(Word {
                register: *renamed.get(&word.register).unwrap_or(&word.register),
                ..word
            }),
            constant @ Operand::Constant(_) => constant,
        };
        Self {
            program,
            inputs: inputs[1..].to_vec(),
            distance: of(distance),
            face: of(face),
            fraction,
        }
    }

    /// The face and the distance for a ray in units in the last place.
    pub(in crate::tracer::search) fn run(&self, ray: [i64; 6]) -> (usize, f64) {
        let mut values = vec![0];
        for (register, value) in self.inputs.iter().zip(ray) {
            let width = self.program.width(*register);
            values.push(value.cast_unsigned() & (u64::MAX >> (64 - width)));
        }
        let mut contents = Contents::new(&self.program, &values, &[]);
        for &instruction in &self.program.instructions {
            contents.follow(&self.program, instruction).unwrap();
        }
        let units = (1_u64 << self.fraction) as f64;
        let read = |operand: Operand| match operand {
            Operand::Word(word) => {
                word.read(contents.registers[word.register.index()]) as f64 / units
            }
            Operand::Constant(value) => value as f64 / units,
        };
        (read(self.face).round() as usize, read(self.distance))
    }
}
