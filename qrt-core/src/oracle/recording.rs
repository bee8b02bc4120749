//! A scene's program as the builder recorded it, from which the oracles of channels are assembled.

use super::call_cost::PricedCall;
use super::nearest::fits_table;
use super::target::target;
use super::{
    Channel, LUMINANCE, LUMINANCE_CHANNEL, Oracle, OracleError, OracleOptions, luminance,
    register_of,
};
use crate::compile::{
    self, Builder, NamedPlace, Passes, PixelWord, RealValue, Recorded, Role, Roots, Stem, Strategy,
};
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{Operand, Program, RegisterId, Type, Word};
use qrt_scene::Nearest;
use qrt_scene::sampling::PathPoints;
use qrt_scene::valid::ValidScene;
use qrt_tracer::{Arith, FaceTable, NearestSearch, PrimaryHitGiven, Quantity, Stage, trace};
use std::collections::HashSet;
use std::sync::{Mutex, MutexGuard};

/// The source of the first ray's hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PrimaryHit {
    /// The tracer finds the primary hit.
    Traced,
    /// The primary hit is given in a register.
    Given,
}

/// The colours of a path, and the register of its primary hit if the hit is an input.
pub(super) fn record<'a, N: NearestSearch<Builder<'a>>, const C: usize>(
    scene: &ValidScene,
    builder: &mut Builder<'a>,
    stage: &Stage<C>,
    nearest: &N,
    first: PrimaryHit,
) -> Result<([RealValue; C], Option<RegisterId>), OracleError> {
    let list = FaceTable::new(stage);
    if first == PrimaryHit::Traced || list.is_empty() && !list.lacks_spheres {
        return Ok((trace(builder, stage, nearest), None));
    }
    fits_table(scene, &list)?;
    // One number more than faces, which stands for none.
    let width = list.len().ilog2() + 1;
    let (register, face) = builder.given_index("nearest", Role::Id, width);
    let nearest = PrimaryHitGiven::new(&list, face, nearest);
    Ok((trace(builder, stage, &nearest), Some(register)))
}

/// A colour that is counted, as the builder's value.
struct Output {
    /// The number of the channel.
    number: usize,
    colour: RealValue,
    /// The upper bound of the colour, in radiance.
    scale: f64,
}

/// A recording of a scene. `known` is an oracle without a program.
pub(super) struct Recording {
    recorded: Recorded,
    strategy: Strategy,
    options: OracleOptions,
    known: Oracle,
    ops: Mutex<compile::Known>,
}

impl Recording {
    pub(super) fn new<const C: usize>(
        scene: &ValidScene,
        channels: [usize; C],
        options: OracleOptions,
        first: PrimaryHit,
    ) -> Result<Self, OracleError> {
        Self::with(scene, channels, options, first, |_, _, _| Vec::new())
    }

    /// Records all three channels, followed by their luminance.
    pub(super) fn with_luminance(
        scene: &ValidScene,
        options: OracleOptions,
    ) -> Result<Self, OracleError> {
        Self::with(
            scene,
            [0, 1, 2],
            options,
            PrimaryHit::Traced,
            |builder, colours, bounds| {
                let scale = luminance(bounds);
                let shares = [0, 1, 2].map(|c| {
                    // A black picture has no scale.
                    let share = if scale > 0.0 {
                        LUMINANCE[c] * bounds[c] / scale
                    } else {
                        0.0
                    };
                    builder.scale(colours[c], share)
                });
                let sum = shares
                    .into_iter()
                    .reduce(|sum, share| builder.add(sum, share));
                sum.map(|colour| Output {
                    number: LUMINANCE_CHANNEL,
                    colour,
                    scale,
                })
                .into_iter()
                .collect()
            },
        )
    }

    /// Records the channels, and others that `more` makes of their colours and bounds.
    fn with<const C: usize>(
        scene: &ValidScene,
        channels: [usize; C],
        options: OracleOptions,
        first: PrimaryHit,
        more: impl FnOnce(&mut Builder<'_>, &[RealValue; C], &[f64; C]) -> Vec<Output>,
    ) -> Result<Self, OracleError> {
        let written = scene.scene();
        let stage = Stage::new(scene, channels, options.class).relative();
        let points = PathPoints::new(&written.sampling)?;
        let strategy = options.strategy(scene)?;
        let target = target(scene, &stage, &points, strategy, options)?;
        let (film, fraction) = (target.film, target.fraction);
        let mut builder = Builder::new(target).with_values(stage.values(scene));
        let bits = written.comparator.bits;
        let comparator = builder.outside("comparator", Type::UInt, Role::Comparator, bits);
        let flag = builder.outside("flag", Type::Bool, Role::Flag, 1);
        let (colours, nearest) = match written.circuit.nearest {
            Nearest::Running => {
                let search = stage.search(1.0 / (1_u64 << fraction) as f64);
                record(scene, &mut builder, &stage, &search, first)?
            }
            Nearest::Paper => record(
                scene,
                &mut builder,
                &stage,
                &stage.recorded_search(1.0 / (1_u64 << fraction) as f64),
                first,
            )?,
        };
        let bounds = stage.bound();
        let more = more(&mut builder, &colours, &bounds);
        let own = (0..C).map(|k| Output {
            number: channels[k],
            colour: colours[k],
            scale: bounds[k],
        });
        let mut outputs = Vec::new();
        for Output {
            number,
            colour,
            scale,
        } in own.chain(more)
        {
            let (colour, count) = builder.counted(colour, bits, written.comparator.at);
            outputs.push(Channel {
                number,
                colour,
                count,
                scale,
            });
        }
        let id = builder.id();
        let sharing = builder.sharing();
        scene.count_recording();
        let mut recorded = builder.finish()?;
        for named in &mut recorded.names {
            if named.name.quantity == Quantity::Throughput {
                named.component = channels[named.component];
            }
        }
        let known = Oracle {
            program: Program::default(),
            parameters: recorded.parameters.clone(),
            channels: outputs,
            id,
            comparator,
            nearest,
            flag,
            fraction,
            points,
            film,
            pixel: options.pixel,
            places: Vec::new(),
            sharing,
        };
        Ok(Self {
            recorded,
            strategy,
            options,
            known,
            ops: Mutex::default(),
        })
    }

    /// Number of recorded operations, those that no oracle needs included.
    pub(super) fn operations(&self) -> usize {
        self.recorded.operations()
    }

    /// Locks the cache of operations' figures; other threads wait until the guard is dropped.
    pub(super) fn known(&self) -> MutexGuard<'_, compile::Known> {
        compile::locked(&self.ops)
    }

    /// The oracle of the recorded channels at `places`.
    pub(super) fn oracle(&self, places: &[usize]) -> Oracle {
        self.oracle_under(self.strategy, places)
    }

    /// The same under another `strategy` that needs the same recording ([`Strategy::recording`]).
    pub(super) fn oracle_under(&self, strategy: Strategy, places: &[usize]) -> Oracle {
        self.assembled((strategy, self.options.passes), &self.ops, places)
    }

    /// The same under other `passes` that need the same recording ([`Passes::same_recording`]).
    pub(super) fn oracle_with(&self, passes: Passes, places: &[usize]) -> Oracle {
        self.assembled((self.strategy, passes), &Mutex::default(), places)
    }

    /// The qubits that the comparison of `channels` takes beside the program's.
    fn flip_qubits(&self, channels: &[Channel], known: &mut compile::Known) -> u32 {
        let registers = self.recorded.registers();
        let width = |id: RegisterId| registers[id.index()].width;
        let bits = width(self.known.comparator);
        let steps = channels
            .iter()
            .map(|channel| self.known.flip_of(channel, bits));
        let qubits = steps.flat_map(|steps| steps.ops).map(|op| {
            let fresh = op.fresh().into_iter().map(width);
            fresh.sum::<u32>() + known.alike.figures(&op, width).borrowed
        });
        qubits.max().unwrap_or(0)
    }

    /// The part of the programs of the channel at `place` that strategies share with `strategy`.
    pub(super) fn stem(&self, strategy: Strategy, place: usize) -> Stem {
        let channel = &self.known.channels[place];
        let roots = channel_roots(std::slice::from_ref(channel));
        let passes = self.options.passes;
        Stem::new(&self.recorded, &roots, passes, strategy, &self.ops)
    }

    /// The call of the channel at `place` for its cost, given [`Recording::stem`].
    pub(super) fn priced(&self, stem: Stem, strategy: Strategy, place: usize) -> PricedCall {
        let mut channel = self.known.channels[place].clone();
        let registers = channel_roots(std::slice::from_ref(&channel));
        let after = self.after(strategy, std::slice::from_ref(&channel), &self.ops);
        let roots = Roots {
            registers: &registers,
            after,
        };
        let program = stem.priced(roots, self.options.passes, strategy, &self.ops);
        channel.count = renamed(channel.count, &program.renamed);
        let width = |id: RegisterId| program.registers()[id.index()].width;
        let flip = self.known.flip_of(&channel, width(self.known.comparator));
        PricedCall::new(program, self.inputs(), flip, &mut self.known())
    }

    fn inputs(&self) -> Vec<RegisterId> {
        let mut inputs = vec![self.known.id, self.known.comparator];
        inputs.extend(self.known.nearest);
        inputs
    }

    /// The qubits of the comparison of `channels`, if the strategy orders instructions by it.
    fn after(&self, strategy: Strategy, channels: &[Channel], ops: &Mutex<compile::Known>) -> u32 {
        if strategy.pebbles() {
            self.flip_qubits(channels, &mut compile::locked(ops))
        } else {
            0
        }
    }

    fn assembled(
        &self,
        (strategy, passes): (Strategy, Passes),
        ops: &Mutex<compile::Known>,
        places: &[usize],
    ) -> Oracle {
        let mut outputs: Vec<Channel> = places
            .iter()
            .map(|&place| self.known.channels[place].clone())
            .collect();
        let roots = channel_roots(&outputs);
        let inputs = self.inputs();
        let roots = Roots {
            registers: &roots,
            after: self.after(strategy, &outputs, ops),
        };
        let (mut program, copies) =
            compile::assemble(self.recorded.clone(), roots, passes, strategy, &inputs, ops);
        for output in &mut outputs {
            output.colour = renamed(output.colour, &copies);
            output.count = renamed(output.count, &copies);
            if let Operand::Word(word) = output.colour {
                let register = &mut program.registers[word.register.index()];
                register.tag = Role::Colour.tag();
                register.name = format!("colour.{}", super::CHANNELS[output.number]);
            }
        }
        let held = program.outputs();
        let places = self.recorded.names.iter().map(|named| NamedPlace {
            place: named.place.renamed(|id| *copies.get(&id).unwrap_or(&id)),
            ..*named
        });
        let places = places.filter(|named| held.contains(&named.place.register()));
        let places: Vec<NamedPlace> = places.collect();
        // If two values are in one register, it has the first one's name.
        let mut called = HashSet::new();
        for named in &places {
            let id = named.place.register();
            let register = &mut program.registers[id.index()];
            if Role::from_register(register) == Role::Work && called.insert(id) {
                register.name = named.to_string();
            }
        }
        Oracle {
            parameters: PixelWord::of_program(&self.known.parameters, &program),
            places,
            program,
            channels: outputs,
            ..self.known.clone()
        }
    }
}

/// The registers of the results of channels.
fn channel_roots(channels: &[Channel]) -> Vec<RegisterId> {
    let operands = channels.iter().flat_map(|o| [o.colour, o.count]);
    operands.filter_map(register_of).collect()
}

/// The operand, with a copy in the place of its register if there is one.
fn renamed(operand: Operand, copies: &QuickMap<RegisterId, RegisterId>) -> Operand {
    let copy = |id: RegisterId| copies.get(&id).copied().unwrap_or(id);
    match operand {
        Operand::Word(word) => Operand::Word(Word {
            register: copy(word.register),
            ..word
        }),
        constant @ Operand::Constant(_) => constant,
    }
}
