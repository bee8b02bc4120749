//! Compiles the figures' scenes, so that a browser gets the results without the compiler.
//!
//! This script builds the circuit's oracle and lowers it to a list of gates, and reads the picture's
//! scene into data. It writes both as Rust into `OUT_DIR`.

use qrt_circuit::{Gate, Operand, Program, RegisterId, Type, lower};
use qrt_core::compile::{Label, Role};
use qrt_core::oracle::{Oracle, OracleOptions};
use qrt_scene::front;
use qrt_scene::{Camera, Geometry, Material, Scene};
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

const CIRCUIT: &str = "scenes/lamp.yaml";
const PICTURE: &str = "../../scenes-yaml/cornell-box.yaml";
/// Overrides that make the picture's scene smaller, as `--set` does.
const SMALLER: [&str; 2] = ["film={ width: 24, height: 24 }", "sampling.path_bits=10"];

fn main() -> Result<(), Box<dyn Error>> {
    let out = std::env::var("OUT_DIR")?;
    for file in [CIRCUIT, PICTURE, "build.rs"] {
        println!("cargo::rerun-if-changed={file}");
    }
    std::fs::write(Path::new(&out).join("circuit.rs"), circuit()?)?;
    std::fs::write(Path::new(&out).join("picture.rs"), picture()?)?;
    Ok(())
}

/// Returns the oracle of the first channel of the first pixel: compute, compare and flip, uncompute.
fn circuit() -> Result<String, Box<dyn Error>> {
    let scene = front::load(CIRCUIT.as_ref(), &[])?.valid;
    let oracle = Oracle::new(&scene, 0, OracleOptions::default())?;
    let program = oracle.whole(0);
    let cuts: Vec<usize> = (1..program.instructions.len()).collect();
    let parts = lower::parts(&program, &cuts);
    let compute = oracle.program.instructions.len();
    let words = oracle.parameter_words(0, [0, 0]);
    let blocks = &program.blocks;
    let depth = |depth: Option<u32>| depth.map_or(-1, i64::from);

    let mut out = String::new();
    for (name, value) in [
        ("ID", u64::from(oracle.id.0)),
        ("COMPARATOR", u64::from(oracle.comparator.0)),
        ("QUBITS", u64::from(parts[0].qubits)),
        ("COMPUTED", compute as u64),
        ("COLOUR", u64::from(register(oracle.channels[0].colour)?.0)),
        ("COUNT", u64::from(register(oracle.channels[0].count)?.0)),
    ] {
        writeln!(out, "pub(super) const {name}: usize = {value};")?;
    }
    writeln!(
        out,
        "pub(super) const SCALE: f64 = {:?};",
        oracle.channels[0].scale
    )?;

    writeln!(out, "pub(super) const REGISTERS: &[Register] = &[")?;
    for register in &program.registers {
        let fraction = match register.ty {
            Type::UFixed { fraction } | Type::Fixed { fraction } => fraction,
            _ => 0,
        };
        let meaning = match register.ty {
            Type::Scratch => "Scratch",
            Type::Int | Type::Fixed { .. } => "Signed",
            Type::Bool | Type::UInt | Type::UFixed { .. } => "Unsigned",
        };
        writeln!(
            out,
            "Register {{ name: {:?}, ty: {:?}, role: {:?}, depth: {}, width: {}, fraction: \
             {fraction}, meaning: Meaning::{meaning} }},",
            register.name,
            register.ty.name(register.width),
            Role::from_register(register).to_string(),
            depth(Label::from_block(&blocks[register.block.index()]).depth),
            register.width,
        )?;
    }
    writeln!(out, "];")?;

    // A register keeps its qubits as long as it holds a value.
    let mut qubits: Vec<Vec<u8>> = vec![Vec::new(); program.registers.len()];
    let mut held = |held: &[(RegisterId, Vec<u32>)]| -> Result<Vec<u8>, Box<dyn Error>> {
        for (register, now) in held {
            let now: Vec<u8> = (now.iter())
                .map(|qubit| u8::try_from(*qubit))
                .collect::<Result<_, _>>()?;
            let known = &mut qubits[register.index()];
            if !known.is_empty() && *known != now {
                return Err("a register moves to other qubits".into());
            }
            *known = now;
        }
        let registers = held.iter().map(|(register, _)| u8::try_from(register.0));
        Ok(registers.collect::<Result<_, _>>()?)
    };
    let before = held(&parts[0].inputs)?;
    writeln!(out, "pub(super) const BEFORE: &[u8] = &{before:?};")?;
    writeln!(out, "pub(super) const STEPS: &[Step] = &[")?;
    let mut all: Vec<Vec<[u8; 4]>> = Vec::new();
    for (step, part) in program.instructions.iter().zip(&parts) {
        let block = &blocks[step.block.index()];
        let mut gates: Vec<[u8; 4]> = (part.gates.iter())
            .filter_map(|gate| encoded(*gate, &words).transpose())
            .collect::<Result<_, _>>()?;
        all.push(gates.clone());
        // Gates of uncompute mirror those of compute, so they are written once.
        let twin = all.get(parts.len() - all.len());
        let mirrored = all.len() > parts.len() - compute
            && twin.is_some_and(|twin| twin.iter().rev().eq(&gates));
        if mirrored {
            gates.clear();
        }
        writeln!(
            out,
            "Step {{ told: {:?}, block: {:?}, held: &{:?}, mirrored: {mirrored}, gates: &{gates:?} \
             }},",
            description(&program, step.op, step.inverse),
            block.name,
            held(&part.outputs)?,
        )?;
    }
    writeln!(out, "];")?;
    writeln!(out, "pub(super) const PLACES: &[&[u8]] = &[")?;
    for qubits in &qubits {
        writeln!(out, "&{qubits:?},")?;
    }
    writeln!(out, "];")?;
    Ok(out)
}

fn register(operand: Operand) -> Result<RegisterId, Box<dyn Error>> {
    match operand {
        Operand::Word(word) => Ok(word.register),
        Operand::Constant(_) => Err("the scene's colour is the same on every path".into()),
    }
}

/// Encodes a gate as four bytes: its kind and its qubits. A pixel's own words become an X or nothing.
fn encoded(gate: Gate, words: &[u64]) -> Result<Option<[u8; 4]>, std::num::TryFromIntError> {
    let bytes = |kind: u8, a: u32, b: u32, t: u32| -> Result<_, std::num::TryFromIntError> {
        Ok(Some([
            kind,
            u8::try_from(a)?,
            u8::try_from(b)?,
            u8::try_from(t)?,
        ]))
    };
    match gate {
        Gate::X(t) => bytes(0, 0, 0, t),
        Gate::Cx(a, t) => bytes(1, a, 0, t),
        Gate::Ccx(a, b, t) => bytes(2, a, b, t),
        Gate::Z(t) => bytes(3, 0, 0, t),
        Gate::Load {
            parameter,
            bit,
            target,
        } if words[parameter as usize] >> bit & 1 == 1 => bytes(0, 0, 0, target),
        Gate::Load { .. } => Ok(None),
    }
}

/// Describes an operation in words: its name, and the registers that it changes and reads.
fn description(program: &Program, op: u32, inverse: bool) -> String {
    let op = &program.ops[op as usize];
    let name = |id: &RegisterId| program.registers[id.index()].name.as_str();
    let mut reads: Vec<&str> = op.reads().iter().map(name).collect();
    reads.dedup();
    let targets: Vec<&str> = op.targets().iter().map(name).collect();
    let mut told = if inverse { "undo " } else { "" }.to_owned() + op.name();
    if !targets.is_empty() {
        told = told + " " + &targets.join(", ");
    }
    if !reads.is_empty() {
        told = told + " from " + &reads.join(", ");
    }
    told
}

/// Returns the scene as a Rust expression, for the kinds of parts that it has.
fn picture() -> Result<String, Box<dyn Error>> {
    let sets = SMALLER.map(str::to_owned);
    let loaded = front::load(PICTURE.as_ref(), &sets)?;
    let scene = loaded.valid.scene();
    let Scene {
        name,
        camera: Camera::Perspective(camera),
        film,
        sky: None,
        sun: None,
        materials,
        geometry,
        sampling,
        precision,
        comparator,
        counting,
        circuit,
        accuracy: None,
        budget: None,
    } = scene
    else {
        return Err("the picture has a camera or a block that is not provided for".into());
    };
    let mut out = String::new();
    writeln!(out, "pub(super) const SMALLER: [&str; 2] = {SMALLER:?};")?;
    writeln!(out, "type Quad = ([[f64; 3]; 4], &'static str);")?;
    writeln!(out, "const QUADS: &[Quad] = &[")?;
    for part in geometry {
        let Geometry::Quad(quad) = part else {
            return Err("the picture has a shape that is not provided for".into());
        };
        let vertices = quad.vertices.map(|vertex| vertex.to_array());
        writeln!(out, "({vertices:?}, {:?}),", quad.material)?;
    }
    writeln!(out, "];")?;
    writeln!(
        out,
        "pub(super) fn scene() -> Scene {{ Scene {{ name: {name:?}.to_owned(),"
    )?;
    let [eye, target, up] = [camera.eye, camera.target, camera.up].map(|p| p.to_array());
    writeln!(
        out,
        "camera: Camera::Perspective(Perspective {{ eye: {eye:?}.into(), target: {target:?}.into(), \
         up: {up:?}.into(), vfov: {:?}, lens: None }}),",
        camera.vfov
    )?;
    writeln!(
        out,
        "film: {film:?}, sky: None, sun: None, materials: vec!["
    )?;
    for (name, material) in materials {
        let made = match material {
            Material::Lambertian(part) => format!("Material::Lambertian({part:?})"),
            Material::Emitter(part) => format!("Material::Emitter({part:?})"),
            _ => return Err("the picture has a material that is not provided for".into()),
        };
        writeln!(out, "({name:?}.to_owned(), {made}),")?;
    }
    writeln!(
        out,
        "], geometry: QUADS.iter().map(|(vertices, material)| Geometry::Quad(\
         qrt_scene::Quad::new(vertices.map(Into::into), *material))).collect(),"
    )?;
    writeln!(
        out,
        "sampling: Sampling {{ sequence: Sequence::{:?}, path_bits: {}, depths: vec![",
        sampling.sequence, sampling.path_bits
    )?;
    for depth in &sampling.depths {
        writeln!(
            out,
            "DepthSampling {{ bits: {:?}, map: Map::{:?}, light: LightPoint::{:?}, lens: None }},",
            depth.bits, depth.map, depth.light
        )?;
    }
    writeln!(
        out,
        "], lights: Lights::{:?} }}, precision: {precision:?},",
        sampling.lights
    )?;
    writeln!(
        out,
        "comparator: Comparator {{ bits: {}, at: ComparatorAt::{:?} }},",
        comparator.bits, comparator.at
    )?;
    writeln!(
        out,
        "counting: Counting {{ phase_bits: {}, repetitions: {}, window: Window::{:?}, estimator: \
         Some(Estimator::{:?}), strata: {:?}, error: {:?} }},",
        counting.phase_bits,
        counting.repetitions,
        counting.window,
        counting.estimator(),
        counting.strata,
        counting.error
    )?;
    writeln!(
        out,
        "circuit: Circuit {{ uncompute: Uncompute::{:?}, nearest: Nearest::{:?} }}, accuracy: \
         None, budget: None }} }}",
        circuit.uncompute, circuit.nearest
    )?;
    Ok(out)
}
