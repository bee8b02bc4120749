//! Measures the throughput of the real machine, and where the time goes.
//!
//! `cargo bench --bench tracing -- speed` prints paths per second of the Cornell box at D = 1..4 on
//! all cores, of a 65,536-triangle mesh, and of small meshes with and without boxes in front of
//! their faces, and the time to prepare lamps of one plane. It fails where a promise is broken: the
//! box at D = 4 traces at least 9.3 million paths a second on two cores of this kind (the
//! throughput of a production renderer's fastest mode on the same scene and two cores), the mesh at
//! least a third of the box's throughput, from afar and close up, and four times the corners of a
//! polygon, or four times the lamps of one plane, take at most eight times the time.

use crate::common::load::load;
use crate::common::mesh::{CLOSE, SIDE, VIEW, WHOLE, mesh, sets, with_obj};
use crate::common::{Arguments, Promises};
use qrt::runtime::path_machines::{Real, Simd};
use qrt::scene::valid::ValidScene;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Promised paths per second and core of the box.
const BAR: f64 = 9.3e6 / 2.0;

/// Number of runs of which the best counts: the machine's noise only ever slows.
const RUNS: usize = 5;

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    println!("million paths a second, best of {RUNS} runs, 32 x 32 pixels");
    println!("\nCornell box, {cores} threads");
    let mut box_speed = 0.0;
    for depth in 1..=4 {
        let scene = load(root, "scenes-yaml/cornell-box.yaml", &sets(depth, 13));
        let real = machine(&scene);
        box_speed = speed(&real, cores);
        println!("  D = {depth}               {:8.2}", box_speed / 1e6);
        if depth == 4 {
            println!("  D = 4, one thread   {:8.2}", speed(&real, 1) / 1e6);
            let scalar = machine(&scene).with_simd(Simd::Scalar);
            println!("  D = 4, one lane     {:8.2}", speed(&scalar, 1) / 1e6);
        }
    }
    println!(
        "\nknot of {} triangles, D = 4, {cores} threads",
        triangles(WHOLE)
    );
    let [table_speed, close_speed] = [("on its table     ", VIEW), ("filling the film ", CLOSE)]
        .map(|(name, view)| {
            let speed = speed(&machine(&mesh(root, view, WHOLE, 13)), cores);
            println!("  {name}   {:8.2}", speed / 1e6);
            speed
        });

    println!("\nknots, D = 4, one thread: all faces in turn | boxes in front");
    for size in [[3, 3], [3, 6], [3, 12], [4, 16], [4, 32], [8, 64]] {
        let scene = mesh(root, CLOSE, size, 8);
        let triangles = triangles(size);
        let turn = speed(&machine(&scene).with_boxes(false), 1);
        let boxes = speed(&machine(&scene).with_boxes(true), 1);
        let (turn, boxes) = (turn / 1e6, boxes / 1e6);
        println!("  {triangles:5} triangles     {turn:8.2} | {boxes:8.2}");
    }

    println!("\nlamps of one plane, milliseconds to prepare");
    let flat: [(&str, Shape, u32); 3] = [
        ("corners of a polygon", polygon, 100_000),
        ("lamps upon lamps", heap, 20_000),
        ("lamps side by side", strips, 20_000),
    ];
    let growth = flat.map(|(name, obj, most)| {
        let [fewer, more] = [most / 4, most].map(|count| {
            let took = set_up(root, &obj(count));
            println!("  {count:6} {name:20}   {:8.1}", 1e3 * took);
            took
        });
        (name, more / fewer)
    });

    println!();
    promises.judge(
        "box at D = 4: 4.65 million paths a second and core",
        box_speed >= BAR * cores as f64,
    );
    promises.judge(
        "mesh on its table: at least a third of the box",
        3.0 * table_speed >= box_speed,
    );
    promises.judge(
        "mesh filling the film: at least a third of the box",
        3.0 * close_speed >= box_speed,
    );
    for (name, growth) in growth {
        promises.judge(
            &format!("four times as many {name}: {growth:.1} times the time, at most eight"),
            growth <= 8.0,
        );
    }
}

/// A function from a number of corners or faces to an OBJ file.
type Shape = fn(u32) -> String;

/// Returns a polygon of `corners` corners in the plane z = 0, as an OBJ file.
fn polygon(corners: u32) -> String {
    let mut text = String::new();
    for corner in 0..corners {
        let turn = std::f64::consts::TAU * f64::from(corner) / f64::from(corners);
        let (sin, cos) = turn.sin_cos();
        writeln!(text, "v {cos} {sin} 0").expect("a text takes all");
    }
    text += "f";
    for corner in 1..=corners {
        write!(text, " {corner}").expect("a text takes all");
    }
    text
}

/// Returns squares of that plane that cover each other.
fn heap(count: u32) -> String {
    let square = |share: f64| {
        let size = 1.0 + share;
        [[-size, -size], [size, -size], [size, size], [-size, size]]
    };
    rectangles(count, square)
}

/// Returns oblique strips of that plane side by side, whose bounding boxes overlap.
fn strips(count: u32) -> String {
    let wide = 0.4 / f64::from(count);
    let strip = |x: f64| {
        [
            [x, -x],
            [x + wide, -x - wide],
            [x + wide + 2.0, 2.0 - x - wide],
            [x + 2.0, 2.0 - x],
        ]
    };
    rectangles(count, strip)
}

fn rectangles(count: u32, corners: impl Fn(f64) -> [[f64; 2]; 4]) -> String {
    let mut text = String::new();
    for number in 0..count {
        for [x, y] in corners(f64::from(number) / f64::from(count)) {
            writeln!(text, "v {x} {y} 0").expect("a text takes all");
        }
        text += "f -4 -3 -2 -1\n";
    }
    text
}

/// Returns the seconds from a scene with a lamp of this shape in the knot's place to a machine that traces it.
fn set_up(root: &Path, obj: &str) -> f64 {
    let sets = || {
        let mut sets = sets(2, 2);
        sets.push("geometry[2].mesh.material=lamp".to_owned());
        sets
    };
    (0..RUNS)
        .map(|_| {
            let started = Instant::now();
            let scene = with_obj(root, CLOSE[0], obj, sets());
            std::hint::black_box(machine(&scene));
            started.elapsed().as_secs_f64()
        })
        .fold(f64::INFINITY, f64::min)
}

fn triangles([around, along]: [u32; 2]) -> u32 {
    2 * around * along
}

fn machine(scene: &ValidScene) -> Real {
    Real::new(scene, 1).expect("a valid scene's sequence exists")
}

/// Returns paths a second over `threads` threads that share the film's rows.
fn speed(real: &Real, threads: usize) -> f64 {
    let rows: Vec<Vec<[u32; 2]>> = (0..SIDE)
        .map(|y| (0..SIDE).map(|x| [x, y]).collect())
        .collect();
    let paths = f64::from(SIDE * SIDE) * real.paths() as f64;
    (0..RUNS)
        .map(|_| {
            let started = Instant::now();
            std::thread::scope(|scope| {
                for thread in 0..threads {
                    let mine = rows.iter().skip(thread).step_by(threads);
                    scope.spawn(move || {
                        for row in mine {
                            std::hint::black_box(real.sums(row));
                        }
                    });
                }
            });
            paths / started.elapsed().as_secs_f64()
        })
        .fold(0.0, f64::max)
}
