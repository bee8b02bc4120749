//! How fast the machines of the circuit are: gates on basis states, and operations on integers.
//!
//! `cargo bench --bench gates` prints lane-gates a second and core: gates times the states that
//! each is executed on. The lists are what multipliers and comparators of 16 bits are made of,
//! computed and uncomputed: one of a few thousand gates, whose rows the nearest caches hold, and
//! one of half a million over 20,000 qubits, the size of a scene. Beside them stands what the
//! processor's loads and stores allow a machine that executes one Toffoli after the other from the
//! nearest cache. Then come nanoseconds an operation takes a lane on the fixed machine.
//!
//! It fails where a promise is broken: 3e11 lane-gates a second and core with vectors of 256 bits
//! or more, and simple operations on numbers of up to 32 bits in an eighth of a nanosecond.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "common/programs.rs"]
mod programs;

use pulp::{Simd, WithSimd, bytemuck};
use qrt::core::circuit::{Circuit, Gate, Qubit};
use qrt::runtime::machines::{Fixed, Gates, InstructionSet, Span};
use std::process::ExitCode;
use std::time::Instant;

/// Best of so many runs: the machine's noise only ever slows.
const RUNS: usize = 9;

/// Lane-gates a second and core.
const BAR: f64 = 3e11;

/// Nanoseconds of a simple operation on a lane.
const SIMPLE: f64 = 0.125;

/// Bits of the factors.
const BITS: usize = 16;

fn main() -> ExitCode {
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let limit = limit();
    println!("1e11 lane-gates a second, best of {RUNS} runs");
    println!(
        "  loads and stores allow, one core     {:6.2}",
        limit / 1e11
    );
    println!("\n                  gates  qubits   one core  of the limit  {cores} threads");
    let wide = InstructionSet::widest() != InstructionSet::Portable;
    let mut slowest = f64::INFINITY;
    for (style, in_place) in [("out of place", false), ("in place", true)] {
        for (size, least) in [("one", 1), ("many", 500_000)] {
            let circuit = multipliers(least, in_place);
            let machine = Gates::new(&[&circuit]).expect("gates of its own qubits");
            let one = gate_speed(&machine, 1);
            let all = gate_speed(&machine, cores);
            slowest = slowest.min(one);
            println!(
                "{style:12} {size:4} {:6}  {:6}     {:6.2}        {:6.2}      {:6.2}",
                machine.len(0),
                circuit.qubits,
                one / 1e11,
                one / limit,
                all / 1e11,
            );
        }
    }
    let circuit = multipliers(1, false);
    for set in InstructionSet::available() {
        let machine = Gates::new(&[&circuit]).expect("gates of its own qubits");
        let speed = gate_speed(&machine.with_instructions(set), 1);
        println!(
            "{:17} one core              {:6.2}",
            format!("{set:?}"),
            speed / 1e11
        );
    }

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

    let mut kept = true;
    let mut promise = |what: &str, kept_now: bool| {
        println!("{} {what}", if kept_now { "kept  " } else { "BROKEN" });
        kept &= kept_now;
    };
    println!();
    promise("3e11 lane-gates a second and core", !wide || slowest >= BAR);
    promise(
        "simple operations in an eighth of a nanosecond",
        !wide || simple <= SIMPLE,
    );
    if kept {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Least seconds of [`RUNS`].
fn best(mut run: impl FnMut()) -> f64 {
    let seconds = (0..RUNS).map(|_| {
        let started = Instant::now();
        run();
        started.elapsed().as_secs_f64()
    });
    seconds.fold(f64::INFINITY, f64::min)
}

/// Lane-gates a second of `threads` threads, each with rows of its own.
fn gate_speed(machine: &Gates, threads: usize) -> f64 {
    let times = 2_000_000 / machine.len(0) + 1;
    let mut all: Vec<_> = (0..threads).map(|_| machine.rows()).collect();
    let words: Vec<u64> = (0..Gates::LANES as u64).map(|lane| lane * lane).collect();
    let qubits: Vec<Qubit> = (0..2 * BITS as u32).collect();
    for rows in &mut all {
        rows.set(&qubits, &words);
    }
    let seconds = best(|| {
        std::thread::scope(|scope| {
            for rows in &mut all {
                scope.spawn(move || (0..times).for_each(|_| machine.run(0, rows)));
            }
        });
    });
    (threads * times * machine.len(0) * Gates::LANES) as f64 / seconds
}

/// Lane-gates a second of nothing but `t ^= a & b` in the nearest cache.
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
    let seconds = best(|| pulp::Arch::new().dispatch(Stream([&mut *t, &mut *a, &mut *b])));
    (TIMES * WORDS * 64) as f64 / seconds
}

/// Qubits handed out in order.
struct Taken(u32);

impl Taken {
    fn take(&mut self, count: usize) -> Vec<Qubit> {
        let first = self.0;
        self.0 += count as u32;
        (first..self.0).collect()
    }
}

/// At least `least` gates: products of the same two numbers and comparisons with what they are
/// compared with, each undone by its own gates in reverse.
fn multipliers(least: usize, in_place: bool) -> Circuit {
    let mut taken = Taken(0);
    let mut gates = Vec::new();
    let (a, b) = (taken.take(BITS), taken.take(BITS));
    let kept = taken.0;
    let mut qubits = kept;
    while gates.len() < least {
        if taken.0 > 20_000 {
            taken.0 = kept;
        }
        let start = gates.len();
        let product = taken.take(2 * BITS + 1);
        let (bits, carries) = (taken.take(BITS), taken.take(BITS + 1));
        for (row, factor) in a.iter().enumerate() {
            let sum = &product[row..];
            if in_place {
                let partial: Vec<_> = bits.iter().zip(&b).collect();
                gates.extend(partial.iter().map(|(p, b)| Gate::Ccx(*factor, **b, **p)));
                add_in_place(&mut gates, &bits, sum, carries[0]);
                gates.extend(partial.iter().map(|(p, b)| Gate::Ccx(*factor, **b, **p)));
            } else {
                let (bits, carries) = (taken.take(BITS), taken.take(BITS + 1));
                gates.extend(bits.iter().zip(&b).map(|(p, b)| Gate::Ccx(*factor, *b, *p)));
                add(&mut gates, &bits, sum, &carries);
            }
        }
        let less = taken.take(1)[0];
        compare(&mut gates, &product[..BITS], &b, carries[0], less);
        let back: Vec<Gate> = gates[start..].iter().rev().copied().collect();
        gates.extend(back);
        qubits = qubits.max(taken.0);
    }
    Circuit {
        gates,
        qubits,
        ..Circuit::default()
    }
}

/// Adds `a` to `sum`, whose next bit is zero, and leaves the carries.
fn add(gates: &mut Vec<Gate>, a: &[Qubit], sum: &[Qubit], carries: &[Qubit]) {
    for (place, &a) in a.iter().enumerate() {
        let [s, c, next] = [sum[place], carries[place], carries[place + 1]];
        gates.extend([Gate::Cx(c, a), Gate::Cx(c, s), Gate::Ccx(a, s, next)]);
        gates.extend([Gate::Cx(c, next), Gate::Cx(c, a), Gate::Cx(a, s)]);
    }
    gates.push(Gate::Cx(carries[a.len()], sum[a.len()]));
}

/// Cuccaro, Draper, Kutin and Moulton's majorities up: the carry ends in the last of `a`.
fn majorities(gates: &mut Vec<Gate>, a: &[Qubit], b: &[Qubit], mut carry: Qubit) {
    for (&a, &b) in a.iter().zip(b) {
        gates.extend([Gate::Cx(a, b), Gate::Cx(a, carry), Gate::Ccx(carry, b, a)]);
        carry = a;
    }
}

/// Adds `a` to `sum`, whose next bit is zero, and leaves nothing.
fn add_in_place(gates: &mut Vec<Gate>, a: &[Qubit], sum: &[Qubit], carry: Qubit) {
    majorities(gates, a, sum, carry);
    gates.push(Gate::Cx(a[a.len() - 1], sum[a.len()]));
    for place in (0..a.len()).rev() {
        let carry = if place == 0 { carry } else { a[place - 1] };
        let [a, s] = [a[place], sum[place]];
        gates.extend([
            Gate::Ccx(carry, s, a),
            Gate::Cx(a, carry),
            Gate::Cx(carry, s),
        ]);
    }
}

/// Flips `less` where a + b overflows, and leaves nothing.
fn compare(gates: &mut Vec<Gate>, a: &[Qubit], b: &[Qubit], carry: Qubit, less: Qubit) {
    let start = gates.len();
    majorities(gates, a, b, carry);
    let back: Vec<Gate> = gates[start..].iter().rev().copied().collect();
    gates.push(Gate::Cx(a[a.len() - 1], less));
    gates.extend(back);
}

/// Nanoseconds an operation of such a program takes a lane.
fn operation_time(width: u32, kinds: &str) -> f64 {
    const TIMES: usize = 10;
    let (program, outputs) = programs::program(width, kinds);
    let machine = Fixed::new(&program, &outputs);
    let mut lanes = machine.lanes();
    let ids: Vec<u64> = (0..Fixed::LANES as u64).collect();
    let span = Span {
        lanes: ids.len(),
        parameters: &[],
    };
    let mut out = vec![vec![0; ids.len()]; outputs.len()];
    let mut out: Vec<&mut [i64]> = out.iter_mut().map(Vec::as_mut_slice).collect();
    let seconds = best(|| {
        for _ in 0..TIMES {
            machine.run(&mut lanes, &[&ids], &[span], &mut out);
        }
    });
    seconds * 1e9 / (TIMES * program.ops.len() * ids.len()) as f64
}
