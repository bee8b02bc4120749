//! Searches of some shapes as programs, which run bit by bit.

use crate::compile::{self, Builder, Index, Passes, RealValue, Strategy, Target};
use qrt_circuit::{Contents, Operand, Program, RegisterId, Word};
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::ValidScene;
use qrt_tracer::{Arith, NO_FACE, NO_PLANE, NearestSearch, PixelClass, Ray, Stage, Start};
use std::sync::Mutex;

/// A search of some shapes as a program.
pub(super) struct Circuit {
    pub(super) program: Program,
    inputs: Vec<RegisterId>,
    distance: Operand,
    face: Operand,
    fraction: u32,
}

impl Circuit {
    /// The search for the nearest face of a ray that leaves a surface and is anywhere in the stage.
    pub(super) fn nearest(scene: &ValidScene, fraction: u32) -> Self {
        Self::new(scene, fraction, |search, cx, ray| {
            let all = cx.truth(true);
            let hit = search.nearest(cx, ray, all);
            let none = cx.index(NO_FACE);
            (hit.distance, cx.select_index(hit.found, hit.face, none))
        })
    }

    /// A search of such a ray, which returns a distance and a face.
    pub(super) fn new(
        scene: &ValidScene,
        fraction: u32,
        searched: impl for<'b> FnOnce(
            &dyn NearestSearch<Builder<'b>>,
            &mut Builder<'b>,
            &Ray<Builder<'b>>,
        ) -> (RealValue, Index),
    ) -> Self {
        let stage = Stage::<3>::rgb(scene, PixelClass::MayMeetLamp);
        let faces = scene.surface_of_faces().len();
        let points = PathPoints::new(&scene.scene().sampling).unwrap();
        let target = Target {
            fraction,
            strategy: Strategy::KEEP,
            points: &points,
            film: [1, 1],
            pixel: None,
            faces: faces as u32,
            passes: Passes::ALL,
        };
        let search = stage.search(1.0 / (1_u64 << fraction) as f64);
        let mut builder = Builder::new(target);
        let given: Vec<_> = (0..6)
            .map(|k| builder.given_signed(&format!("in{k}"), 1.0))
            .collect();
        let at = |k: usize| [given[k].1, given[k + 1].1, given[k + 2].1];
        let cx = &mut builder;
        let ray = Ray {
            origin: at(0),
            direction: at(3),
            from: cx.index(NO_PLANE),
            t_max: stage.t_max(),
            start: Start::Surface,
        };
        let (distance, face) = searched(&search, cx, &ray);
        let distance = cx.held(distance);
        let distance = cx.operand_of(distance).0;
        // One more than the greatest label stands for none.
        let numbers: Vec<[f64; 1]> = (0..=faces).map(|n| [n as f64]).collect();
        let [face] = cx.rows(&numbers, face);
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
    pub(super) fn run(&self, ray: [i64; 6]) -> (usize, f64) {
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
