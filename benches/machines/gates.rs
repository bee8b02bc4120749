//! Throughput of the machines of the circuit: gates on basis states, and operations on integers.
//!
//! `cargo bench --bench machines -- gates` prints lane-gates a second and core: gates times the
//! states that each is executed on. The circuits are those of the compiler: a product of 16 bits
//! and a comparison, out of place and in place, whose rows fit in the nearest caches; and the
//! Cornell box for all three channels, of more than half a million gates, under either strategy.
//! Each is computed and uncomputed. Beside them it prints a limit, measured in the same run: the
//! throughput that loads and stores allow a machine that executes one Toffoli after the other from
//! the nearest cache. Sequences of gates that go through registers together exceed it. Then come
//! nanoseconds an operation takes a lane on the fixed machine.
//!
//! Next come all example scenes whose gates are held in memory, under `keep`: their rows have more
//! qubits than caches hold. The seconds of one core are processor time, so that other processes count
//! less. Last come circuits with too many gates to hold, which are generated again in each run: a mesh
//! whose planes are uncomputed one by one, and the knot of 1,536 faces, as its scene has it; under
//! `keep` its twelve million qubits leave memory for no more than 256 states.
//!
//! It fails where a promise is broken: 3e11 lane-gates a second and core with vectors of 256 bits
//! or more on circuits whose rows fit a cache, at least half the speed of the scoped box with rows of the same
//! length on every scene under `keep`, half its speed on generated gates for many states at a time, a
//! hundredth of it where memory holds 256 states, and simple operations on numbers of up to 32 bits in an
//! eighth of a nanosecond. Circuits with very many qubits have shorter rows. Fewer states then share the
//! cost of choosing a gate, and that cost depends on the processor, so circuits are compared at one length.

use crate::common::scenes::CIRCUITS;
use crate::common::{Arguments, Promises, load, mesh, processor, programs};
use pulp::{Simd, WithSimd, bytemuck};
use qrt::circuit::{
    BlockId, GateCircuit, Instruction, Op, Operand, Program, Qubit, Register, RegisterId, Style,
    Type, Word, lower,
};
use qrt::core::compile::Strategy;
use qrt::core::oracle::{Oracle, OracleOptions};
use qrt::machines::{FixedMachine, GatesMachine, InstructionSet, PixelLanes};
use qrt::runtime::path_machines::{OracleCircuits, OracleMachine};
use qrt::scene::valid::ValidScene;
use std::path::Path;
use std::sync::Arc;

/// Number of runs of which the best counts: the machine's noise only ever slows.
const RUNS: usize = 9;

/// Lane-gates a second and core: promised, and aimed at.
const BAR: f64 = 3e11;
const AIM: f64 = 6e11;

/// Throughput of any scene's circuit under `keep`, relative to the box under `scoped` with rows of the same length.
const LARGE: f64 = 0.5;

/// Throughput of gates that are generated again, relative to the same.
const ANEW: f64 = 0.5;

/// Throughput of the knot under `keep`, which runs on 256 states at a time: each gate takes longer to
/// generate than to run, and longer rows would not fit into a gigabyte.
const FEW_STATES: f64 = 0.01;

/// Nanoseconds of a simple operation on a lane.
const SIMPLE: f64 = 0.125;

/// Bits of the factors.
const BITS: u32 = 16;

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let limit = limit();
    println!("1e11 lane-gates a second, best of {RUNS} runs");
    println!(
        "  loads and stores allow, one core     {:6.2}",
        limit / 1e11
    );
    println!("\n                         gates  qubits   one core  of the limit  {cores} threads");
    let wide = InstructionSet::widest() != InstructionSet::Portable;
    let [mut slowest, mut scoped] = [f64::INFINITY; 2];
    let lists = [
        ("product, out of place", product(Style::OutOfPlace)),
        ("product, in place", product(Style::InPlace)),
        ("box, keep", scene("cornell-box", "keep")),
        ("box, scoped", scene("cornell-box", "scoped")),
    ];
    for (name, circuits) in &lists {
        let machine = machine(circuits);
        let one = gate_speed(&machine, 1);
        let all = gate_speed(&machine, cores);
        slowest = slowest.min(one);
        scoped = one;
        println!(
            "  {name:18} {:9}  {:6}     {:6.2}        {:6.2}     {:6.2}",
            gates(&machine),
            circuits[0].qubits,
            one / 1e11,
            one / limit,
            all / 1e11,
        );
    }
    let [_, _, (_, of_box), _] = &lists;
    for set in InstructionSet::available() {
        let speed = gate_speed(&machine(of_box).with_instructions(set), 1);
        println!(
            "  {:36}     {:6.2}",
            format!("box, keep, {set:?}"),
            speed / 1e11
        );
    }

    println!(
        "\n  under keep           gates  qubits  lanes   one core  of box, scoped, at as many"
    );
    let mut large = f64::INFINITY;
    let (_, of_scoped) = &lists[3];
    let scoped_at = [2048, 1024, 512].map(|lanes| {
        let machine = machine(of_scoped).with_lanes(lanes);
        (lanes, gate_speed(&machine, 1))
    });
    for (lanes, speed) in scoped_at {
        println!(
            "  box, scoped                          {lanes:4}     {:6.2}",
            speed / 1e11
        );
    }
    for name in CIRCUITS.into_iter().chain(["lit-box"]) {
        let circuits = scene(name, "keep");
        let machine = machine(&circuits);
        let speed = gate_speed(&machine, 1);
        let same_length = scoped_at
            .iter()
            .find(|(lanes, _)| *lanes == machine.lanes());
        let share = speed / same_length.map_or(scoped, |(_, speed)| *speed);
        large = large.min(share);
        println!(
            "  {name:16} {:9}  {:6}   {:4}     {:6.2}          {:6.2}",
            gates(&machine),
            circuits[0].qubits,
            machine.lanes(),
            speed / 1e11,
            share,
        );
    }

    println!("\n  made anew            gates  qubits  lanes   one core  of box, scoped");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let of_mesh = mesh::mesh(root, mesh::CLOSE, [6, 24], 12);
    let knot = load::load(root, "scenes-yaml/knot.yaml", &[]);
    let anew = [
        ("mesh, scoped", &of_mesh, Some(Strategy::SCOPED), ANEW),
        ("knot", &knot, None, ANEW),
        ("knot, keep", &knot, Some(Strategy::KEEP), FEW_STATES),
    ];
    let anew = anew.map(|(name, scene, strategy, least)| {
        let options = OracleOptions {
            strategy,
            ..OracleOptions::default()
        };
        (name, speed_anew(name, scene, options, scoped), least)
    });

    println!("\nnanoseconds an operation and a lane, one core, by the numbers' bits");
    let widths = [16, 24, 32, 40];
    println!("               {:>7} {:>7} {:>7} {:>7}", 16, 24, 32, 40);
    let mut simple: f64 = 0.0;
    for (name, kinds) in programs::MIXES {
        let times = widths.map(|width| {
            let time = operation_time(width, kinds);
            if programs::SIMPLE.contains(&name) && width <= 32 {
                simple = simple.max(time);
            }
            format!("{time:7.4}")
        });
        println!("  {name:12} {}", times.join(" "));
    }

    println!();
    promises.judge(
        &format!("lane-gates a second and core: {slowest:.1e}, at least {BAR:.0e} (aim {AIM:.0e})"),
        !wide || slowest >= BAR,
    );
    promises.judge(
        &format!("any scene under keep by the box under scoped, rows of one length: {large:.2}, at least {LARGE}"),
        !wide || large >= LARGE,
    );
    for (name, share, least) in anew {
        promises.judge(
            &format!(
                "gates made anew ({name}) by the box under scoped: {share:.3}, at least {least}"
            ),
            !wide || share >= least,
        );
    }
    promises.judge(
        "simple operations in an eighth of a nanosecond",
        !wide || simple <= SIMPLE,
    );
}

fn machine([compute, uncompute]: &[GateCircuit; 2]) -> GatesMachine {
    GatesMachine::new(&[compute, uncompute]).expect("gates of its own qubits")
}

fn gates(machine: &GatesMachine) -> usize {
    machine.len(0) + machine.len(1)
}

/// Returns lane-gates a second of `threads` threads, each with rows of its own.
fn gate_speed(machine: &GatesMachine, threads: usize) -> f64 {
    let times = 2_000_000 / gates(machine) + 1;
    let mut all: Vec<_> = (0..threads).map(|_| machine.rows()).collect();
    let words: Vec<u64> = (0..machine.lanes() as u64)
        .map(|lane| lane * lane)
        .collect();
    // In both kinds of circuit the inputs are the first qubits.
    let qubits: Vec<Qubit> = (0..14).collect();
    for rows in &mut all {
        rows.set(&qubits, &words);
    }
    let seconds = processor::least(RUNS, || {
        std::thread::scope(|scope| {
            for rows in &mut all {
                scope.spawn(move || {
                    for _ in 0..times {
                        machine.run(0, rows);
                        machine.run(1, rows);
                    }
                });
            }
        });
    });
    // `seconds` is the sum over all threads.
    (threads * times * gates(machine) * machine.lanes()) as f64 * threads as f64 / seconds
}

/// Prints lane-gates a second of an oracle whose gates are not held, on one block of paths; returns their
/// ratio to `scoped`, those of the scoped box.
fn speed_anew(name: &str, scene: &ValidScene, options: OracleOptions, scoped: f64) -> f64 {
    let oracle = Oracle::rgb(scene, options).unwrap_or_else(|error| panic!("{error}"));
    let pixel = [scene.scene().film.width / 2, scene.scene().film.height / 2];
    let machine = OracleMachine::gates(Arc::new(oracle), 1, false).expect("a right comparison");
    let parts = machine.parts().expect("a circuit");
    assert!(parts.compute.gates.is_empty(), "{name}: its gates are held");
    let flips: usize = parts.flips.iter().map(|flip| flip.gates.len()).sum();
    let gates = parts.gates() - flips;
    let lanes = machine.paths_at_once();
    let pixels = vec![pixel; lanes.div_ceil(machine.paths()) as usize];
    let ids = 0..lanes.min(machine.paths());
    let run = || {
        let started = processor::seconds();
        let traced = machine.trace(&pixels, ids.clone(), |_| ());
        traced.expect("clean qubits");
        processor::seconds() - started
    };
    let seconds = (0..2).map(|_| run()).fold(f64::INFINITY, f64::min);
    let states = pixels.len() as f64 * ids.end as f64;
    let speed = gates as f64 * states / seconds;
    println!(
        "  {name:16} {gates:9}  {:6}  {states:5}     {:6.3}          {:6.3}",
        parts.compute.qubits,
        speed / 1e11,
        speed / scoped,
    );
    speed / scoped
}

/// Returns lane-gates a second of nothing but `t ^= a & b` in the nearest cache.
fn limit() -> f64 {
    const WORDS: usize = 512;
    const TIMES: usize = 20_000;
    struct Stream<'a>([&'a mut [u64]; 3]);
    impl WithSimd for Stream<'_> {
        type Output = ();
        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            let [t, a, b] = self.0.map(|row| {
                let row: &mut [S::u64s] = bytemuck::cast_slice_mut(row);
                row
            });
            for _ in 0..TIMES {
                for ((t, a), b) in t.iter_mut().zip(&*a).zip(&*b) {
                    *t = simd.xor_u64s(*t, simd.and_u64s(*a, *b));
                }
                std::hint::black_box(&mut *t);
            }
        }
    }
    let mut words = vec![0x5555; 3 * WORDS + 8];
    let start = words.as_ptr().align_offset(64);
    let (t, rest) = words[start..][..3 * WORDS].split_at_mut(WORDS);
    let (a, b) = rest.split_at_mut(WORDS);
    let seconds = processor::least(RUNS, || {
        pulp::Arch::new().dispatch(Stream([&mut *t, &mut *a, &mut *b]));
    });
    (TIMES * WORDS * 64) as f64 / seconds
}

/// Returns the circuits of an example scene for all three channels, compute and uncompute.
fn scene(name: &str, uncompute: &str) -> [GateCircuit; 2] {
    let sets = [format!("circuit.uncompute={uncompute}")];
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = load::load(root, &format!("scenes-yaml/{name}.yaml"), &sets);
    let oracle = Oracle::rgb(&scene, OracleOptions::default());
    let parts = OracleCircuits::new(&oracle.unwrap_or_else(|error| panic!("{error}")));
    [parts.compute, parts.uncompute]
}

/// Returns the product of two numbers and its comparison with a third, computed and uncomputed.
fn product(style: Style) -> [GateCircuit; 2] {
    let mut program = Program::default();
    let mut register = |width: u32, ty: Type| {
        program.registers.push(Register::new("", ty, width));
        RegisterId(program.registers.len() as u32 - 1)
    };
    let number = Type::Fixed { fraction: BITS };
    let [a, b, c] = [BITS, BITS, 2 * BITS].map(|width| register(width, number));
    let target = register(2 * BITS, number);
    let scratch = register(0, Type::UInt);
    let less = register(1, Type::Bool);
    let word = |register: RegisterId, width: u32| Word {
        register,
        offset: 0,
        width,
        signed: true,
        shift: 0,
    };
    let multiply = Op::Multiply {
        a: word(a, BITS),
        b: word(b, BITS),
        drop: 0,
        style,
        target,
        scratch,
    };
    let width = lower::scratch_width(&multiply, |register| program.width(register));
    program.registers[scratch.index()].width = width;
    let compare = Op::Less {
        a: Operand::Word(word(target, 2 * BITS)),
        b: Operand::Word(word(c, 2 * BITS)),
        target: less,
    };
    program.ops = vec![multiply, compare];
    program.inputs = vec![a, b, c];
    let steps = [(0, false), (1, false), (1, true), (0, true)];
    program.instructions = steps
        .map(|(op, inverse)| Instruction {
            op,
            inverse,
            block: BlockId::ROOT,
        })
        .into();
    lower::parts(&program, &[2])
        .try_into()
        .expect("one cut makes two parts")
}

/// Returns the nanoseconds that an operation of a program of `kinds` takes a lane.
fn operation_time(width: u32, kinds: &str) -> f64 {
    const TIMES: usize = 10;
    let (program, outputs) = programs::program(width, kinds);
    let machine = FixedMachine::new(&program, &outputs);
    let mut lanes = machine.lanes();
    let ids: Vec<u64> = (0..FixedMachine::LANES as u64).collect();
    let span = PixelLanes {
        lanes: ids.len(),
        parameters: &[],
    };
    let mut out = vec![vec![0; ids.len()]; outputs.len()];
    let mut out: Vec<&mut [i64]> = out.iter_mut().map(Vec::as_mut_slice).collect();
    let seconds = processor::least(RUNS, || {
        for _ in 0..TIMES {
            machine.run(&mut lanes, &[&ids], &[span], &mut out);
        }
    });
    seconds * 1e9 / (TIMES * program.ops.len() * ids.len()) as f64
}
