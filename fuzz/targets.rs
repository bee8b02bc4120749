//! Properties that hold for all bytes: the fuzzer searches for a counterexample, and `cargo test --test scenes`
//! tries the inputs in the corpora, and mutations of them.

use qrt_circuit::export::{ExportFormat, write_program};
use qrt_circuit::{
    Bit, Contents, Declaration, Gate, GateCircuit, Machine, Operand, Program, Qubit, Recorded,
    Recorder, RegisterId, Style, Type, Word, lower,
};
use qrt_runtime::checkpoint::{
    Checkpoint, CheckpointError, CountedPixels, Header, PixelPart, Tile,
};
use qrt_runtime::render::Merge;
use qrt_scene::Scene;
use qrt_scene::front::{Files, parse_with};
use qrt_scene::valid::Polygon;
use qrt_syntax::expr::{Domain, Expr, Variable, Variables};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

/// Reads a scene. An error can be displayed; a valid scene can be printed, and the printed text reads back as the
/// same scene.
pub(crate) fn scene(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let _ = read(text, &[]);
}

/// Returns the polygons of a scene, or the report of its errors.
fn read(text: &str, files: &[(&str, &[u8])]) -> Result<Vec<Polygon>, String> {
    match parse_with(text, "any.yaml", &[], Files::held(files)) {
        Ok(loaded) => {
            let scene = loaded.valid.scene();
            let printed = Scene::from_yaml(&scene.to_yaml(), "printed.yaml");
            assert_eq!(printed.as_ref(), Ok(scene));
            Ok(loaded.valid.polygons().to_vec())
        }
        Err(report) => {
            let shown = report.render(false);
            assert!(shown.contains("error["), "{shown}");
            assert!(
                !shown.contains(|c: char| c.is_control() && c != '\n'),
                "{shown:?}"
            );
            Err(shown)
        }
    }
}

/// Reads a mesh and, after a byte 0, its material library. Other line ends give the same mesh, or the same faults at
/// the same lines. The colours of vertices are read, too.
pub(crate) fn mesh(data: &[u8]) {
    const SCENE: &str = "
name: any
camera: { perspective: { eye: [0, 0, 3], target: [0, 0, 0], vfov: 45 } }
film: { width: 1, height: 1 }
materials: { grey: { lambertian: { albedo: [0.5, 0.5, 0.5] } } }
geometry: [mesh: { obj: any.obj }, mesh: { obj: any.obj, material: grey, scale: 0.5, rotate: [10, 20, 30] }]
sampling: { path_bits: 2 }
";
    let cut = data.iter().position(|byte| *byte == 0);
    let (obj, mtl) = data.split_at(cut.unwrap_or(data.len()));
    let mtl = mtl.get(1..).unwrap_or_default();
    let coloured = SCENE.replace("any.obj", "any.obj, colors: vertices");
    let _ = read(&coloured, &[("any.obj", obj), ("any.mtl", mtl)]);
    let plain = read(SCENE, &[("any.obj", obj), ("any.mtl", mtl)]);
    if data.contains(&b'\r') {
        return;
    }
    for end in ["\r\n", "\r"] {
        let ended = |text: &[u8]| {
            text.split(|byte| *byte == b'\n')
                .collect::<Vec<_>>()
                .join(end.as_bytes())
        };
        let (obj, mtl) = (ended(obj), ended(mtl));
        let ended = read(SCENE, &[("any.obj", &obj), ("any.mtl", &mtl)]);
        assert_eq!(ended, plain, "lines that end in {end:?}");
    }
}

/// Reads a PLY or a glTF file, as the first byte says. A glTF file may have its binary data beside it, after a byte 0.
pub(crate) fn other_mesh(data: &[u8]) {
    let Some((first, file)) = data.split_first() else {
        return;
    };
    let entry = ["ply: any", "gltf: any"][usize::from(first & 1)];
    let scene = format!(
        "
name: any
camera: {{ perspective: {{ eye: [0, 0, 3], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ grey: {{ lambertian: {{ albedo: [0.5, 0.5, 0.5] }} }} }}
geometry: [mesh: {{ {entry} }}, mesh: {{ {entry}, material: grey, scale: 0.5, rotate: [10, 20, 30] }}]
sampling: {{ path_bits: 2 }}
"
    );
    // A PLY file needs a material of the scene.
    let scene = if *first & 1 == 0 {
        scene.replace("mesh: { ply: any }, ", "")
    } else {
        scene
    };
    let cut = file.iter().position(|byte| *byte == 0);
    let binary = cut.map(|cut| &file[cut + 1..]).unwrap_or_default();
    let text = &file[..cut.unwrap_or(file.len())];
    let coloured = scene.replace(entry, &format!("{entry}, colors: vertices"));
    for (scene, file) in [(&scene, file), (&scene, text), (&coloured, file)] {
        let _ = read(scene, &[("any", file), ("any.bin", binary)]);
    }
}

/// Parses an expression. Its printed text parses to the same expression; its values lie in the range that interval
/// arithmetic gives, before and after simplification.
pub(crate) fn expression(data: &[u8]) {
    let Some(expression) = std::str::from_utf8(data)
        .ok()
        .and_then(|text| Expr::parse(text, &Variable::ALL).ok())
    else {
        return;
    };
    let printed = Expr::parse(&expression.to_string(), &Variable::ALL);
    let printed = printed.expect("what is printed can be read");
    let simple = expression.simplify();
    for variable in Variable::ALL {
        let _ = expression.diff(variable);
    }
    let range = expression.range(&Domain::default());
    for ([u, v, cos_i, cos_o, cos_a], [x, y, z]) in [
        ([0.5, 0.5, 0.5, 0.5, 0.5], [0.0, 1.0, -1.0]),
        ([0.1, 0.9, 0.25, 1.0, -1.0], [1e-6, 1e6, 0.5]),
        ([0.999, 0.001, 1.0, 0.001, 0.7], [-3.0, 0.1, 100.0]),
    ] {
        let at = Variables {
            u,
            v,
            cos_i,
            cos_o,
            cos_a,
            x,
            y,
            z,
        };
        let value = expression.eval(&at);
        assert_eq!(printed.eval(&at).to_bits(), value.to_bits(), "{expression}");
        if let Some(range) = range
            && value.is_finite()
        {
            assert!(
                range.lo <= value && value <= range.hi,
                "{expression}: {value} outside {range:?}"
            );
        }
        let _ = simple.eval(&at);
    }
}

/// A stream of bytes that continues with zeros after the last one.
struct Bytes<'a>(std::slice::Iter<'a, u8>);

impl Bytes<'_> {
    fn below(&mut self, count: u32) -> u32 {
        u32::from(self.0.next().copied().unwrap_or(0)) % count
    }

    fn word<'r>(
        &mut self,
        registers: &'r [Recorded],
        widths: &[u32],
        most: u32,
    ) -> Word<&'r Recorded> {
        let register = self.below(registers.len() as u32) as usize;
        let offset = self.below(widths[register]);
        let width = 1 + self.below((widths[register] - offset).min(most));
        let signed = self.below(2) == 1;
        Word {
            register: &registers[register],
            offset,
            width,
            signed,
            shift: 0,
        }
    }

    fn bit<'r>(&mut self, registers: &'r [Recorded], widths: &[u32]) -> Bit<&'r Recorded> {
        let register = self.below(registers.len() as u32) as usize;
        let index = self.below(widths[register]);
        Bit {
            register: &registers[register],
            index,
            inverted: self.below(2) == 1,
        }
    }
}

/// A program of a few operations, with its registers.
struct Made {
    program: Program,
    widths: Vec<u32>,
    held: Vec<RegisterId>,
}

fn made(bytes: &mut Bytes<'_>) -> Made {
    let style = [Style::InPlace, Style::OutOfPlace][bytes.below(2) as usize];
    let mut machine = Recorder::new(style);
    let mut widths = vec![1 + bytes.below(8), 1 + bytes.below(8)];
    let inputs = ["x", "y"].iter().zip(&widths);
    let mut registers: Vec<Recorded> = inputs
        .map(|(name, width)| machine.input(&Declaration::work(name, Type::UInt, *width)))
        .collect();
    for _ in 0..=bytes.below(6) {
        let (known, sizes) = (&registers[..], &widths[..]);
        let work = |width| Declaration::work("t", Type::UInt, width);
        let (a, b) = (bytes.word(known, sizes, 12), bytes.word(known, sizes, 12));
        let wide = a.width.max(b.width) + 2;
        let kind = bytes.below(9);
        let (made, width) = match kind {
            0 => (machine.copy(&work(a.width), a), a.width),
            1 => (
                machine.add(&work(wide), Operand::Word(a), Operand::Word(b)),
                wide,
            ),
            2 => (
                machine.subtract(&work(wide), Operand::Word(a), Operand::Word(b)),
                wide,
            ),
            3 => (
                machine.less(&work(1), Operand::Word(a), Operand::Word(b)),
                1,
            ),
            4 => {
                let width = a.width + b.width;
                (machine.multiply(&work(width), a, b, 0), width)
            }
            5 => (machine.square(&work(2 * a.width), a, 0), 2 * a.width),
            6 => {
                let when = bytes.bit(known, sizes);
                (
                    machine.select(&work(wide), when, Operand::Word(a), Operand::Word(b)),
                    wide,
                )
            }
            7 => {
                let (one, other) = (bytes.bit(known, sizes), bytes.bit(known, sizes));
                (machine.and(&work(1), one, other), 1)
            }
            _ => {
                let when = bytes.bit(known, sizes);
                (machine.negate(&work(wide), a, when), wide)
            }
        };
        registers.push(made);
        widths.push(width);
    }
    let held = registers.iter().map(Recorded::id).collect();
    Made {
        program: machine.finish(),
        widths,
        held,
    }
}

/// Records a program, and runs and uncomputes it by its definition and by its gates on some inputs: both give the
/// same values, and the gates leave only the inputs.
pub(crate) fn program(data: &[u8]) {
    let mut bytes = Bytes(data.iter());
    let Made {
        mut program,
        widths,
        held,
    } = made(&mut bytes);
    let undo = program.inverse().instructions;
    let computed = program.instructions.len();
    program.instructions.extend(undo);
    let [compute, uncompute] = lower::parts(&program, &[computed])
        .try_into()
        .expect("two parts");
    for _ in 0..3 {
        let values: Vec<u64> = widths[..2]
            .iter()
            .map(|width| u64::from(bytes.below(1 << width)))
            .collect();
        follow(&program, computed, [&compute, &uncompute], &held, &values);
    }
}

/// Writes a program whose registers have arbitrary names, in both languages. The text is valid in that language and
/// has the circuit's gates in their order, on the right qubits.
pub(crate) fn openqasm(data: &[u8]) {
    let mut bytes = Bytes(data.iter());
    let Made { mut program, .. } = made(&mut bytes);
    for register in &mut program.registers {
        let length = bytes.below(8) as usize;
        let name: Vec<u8> = bytes.0.by_ref().take(length).copied().collect();
        register.name = String::from_utf8_lossy(&name).into_owned();
    }
    let comment = String::from_utf8_lossy(bytes.0.as_slice()).into_owned();
    let circuit = lower::circuit(&program);
    for format in [ExportFormat::OpenQasm3, ExportFormat::OpenQasm2] {
        let mut text = Vec::new();
        let comments = [comment.clone()];
        write_program(&program, &[], format, &comments, &mut text).expect("memory takes all");
        let text = String::from_utf8(text).expect("it is text");
        read_openqasm(&text, format, &circuit);
    }
}

fn read_openqasm(text: &str, format: ExportFormat, circuit: &GateCircuit) {
    let mut lines = text.lines();
    let (version, library) = match format {
        ExportFormat::OpenQasm3 => ("OPENQASM 3.0;", "include \"stdgates.inc\";"),
        ExportFormat::OpenQasm2 => ("OPENQASM 2.0;", "include \"qelib1.inc\";"),
    };
    assert_eq!(lines.next(), Some(version));
    assert_eq!(lines.next(), Some(library));
    let mut sizes: HashMap<&str, usize> = HashMap::new();
    // Maps each qubit of the text to the circuit's, as far as the gates before have shown it.
    let mut places: HashMap<(&str, usize), Qubit> = HashMap::new();
    let mut gates = circuit.gates.iter();
    for line in lines {
        assert!(
            line.chars().all(|c| c == ' ' || c.is_ascii_graphic()),
            "{line:?}"
        );
        if line.starts_with("//") {
            continue;
        }
        let statement = line.strip_suffix(';').expect("a statement ends");
        let declared = match format {
            ExportFormat::OpenQasm3 => statement.strip_prefix("qubit[").map(|rest| {
                let (size, name) = rest.split_once("] ").expect("a size and a name");
                (name, size)
            }),
            ExportFormat::OpenQasm2 => statement.strip_prefix("qreg ").map(|rest| {
                let rest = rest.strip_suffix(']').expect("a size");
                rest.split_once('[').expect("a name and a size")
            }),
        };
        if let Some((name, size)) = declared {
            let legal = |c: char| c == '_' || c.is_ascii_alphanumeric();
            assert!(name.starts_with(|c: char| c.is_ascii_lowercase()), "{name}");
            assert!(name.len() > 1 && name.chars().all(legal), "{name}");
            assert!(!WORDS.contains(&name), "{name}");
            let size = size.parse().expect("a number");
            assert!(sizes.insert(name, size).is_none(), "{name} twice");
            continue;
        }
        let (gate, on) = statement.split_once(' ').expect("a gate and qubits");
        let expected = gates.next().expect("a gate of the circuit");
        let (name, qubits) = match *expected {
            Gate::X(t) => ("x", vec![t]),
            Gate::Cx(a, t) => ("cx", vec![a, t]),
            Gate::Ccx(a, b, t) => ("ccx", vec![a, b, t]),
            Gate::Load { .. } | Gate::Z(_) => unreachable!("no parameter, no phase"),
        };
        assert_eq!(gate, name);
        let on: Vec<_> = on.split(", ").collect();
        assert_eq!(on.len(), qubits.len(), "{line}");
        for (place, qubit) in on.into_iter().zip(qubits) {
            let (register, bit) = place
                .strip_suffix(']')
                .expect("a bit")
                .split_once('[')
                .expect("a bit");
            let bit: usize = bit.parse().expect("a number");
            assert!(bit < sizes[register], "{line}");
            assert_eq!(
                *places.entry((register, bit)).or_insert(qubit),
                qubit,
                "{line}"
            );
        }
    }
    assert_eq!(gates.next(), None, "a gate is missing");
    assert_eq!(sizes.values().sum::<usize>(), circuit.qubits as usize);
    let mut qubits: Vec<Qubit> = places.values().copied().collect();
    qubits.sort_unstable();
    qubits.dedup();
    assert_eq!(qubits.len(), places.len(), "two names for one qubit");
}

/// Some of the words and gates of OpenQASM, which the export must not use as the name of a register.
const WORDS: [&str; 14] = [
    "input", "output", "bit", "qubit", "qreg", "creg", "gate", "if", "in", "measure", "reset",
    "cx", "swap", "pi",
];

fn follow(
    program: &Program,
    computed: usize,
    parts: [&GateCircuit; 2],
    held: &[RegisterId],
    values: &[u64],
) {
    let mut contents = Contents::new(program, values, &[]);
    let mut bits = vec![false; parts[0].qubits as usize];
    for ((_, qubits), value) in parts[0].inputs.iter().zip(values) {
        for (place, qubit) in qubits.iter().enumerate() {
            bits[*qubit as usize] = value >> place & 1 == 1;
        }
    }
    let before = bits.clone();
    let run = |circuit: &GateCircuit, bits: &mut Vec<bool>| {
        for gate in &circuit.gates {
            match *gate {
                Gate::X(t) => bits[t as usize] ^= true,
                Gate::Cx(a, t) => bits[t as usize] ^= bits[a as usize],
                Gate::Ccx(a, b, t) => bits[t as usize] ^= bits[a as usize] & bits[b as usize],
                Gate::Load { .. } | Gate::Z(_) => unreachable!("no parameter, no phase"),
            }
        }
    };
    for instruction in &program.instructions[..computed] {
        contents
            .follow(program, *instruction)
            .expect("what computes is clean");
    }
    run(parts[0], &mut bits);
    for id in held {
        let qubits = parts[0].outputs.iter().find(|(register, _)| register == id);
        let (_, qubits) = qubits.expect("what was computed is held");
        let value = qubits
            .iter()
            .rev()
            .fold(0, |sum, q| 2 * sum + u64::from(bits[*q as usize]));
        assert_eq!(
            value,
            contents.registers[id.index()],
            "{program:?} on {values:?}"
        );
    }
    for instruction in &program.instructions[computed..] {
        contents
            .follow(program, *instruction)
            .expect("what undoes is clean");
    }
    run(parts[1], &mut bits);
    assert!(bits == before, "{program:?} on {values:?}");
}

/// Returns the checksum of a record (CRC-32 of ISO-HDLC).
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| {
            (sum >> 1) ^ (0xEDB8_8320 & (sum & 1).wrapping_neg())
        })
    })
}

/// Opens a checkpoint. Its first byte selects the test: records behind a valid header, a header of arbitrary words,
/// an arbitrary body of a header, or arbitrary bytes.
pub(crate) fn checkpoint(data: &[u8]) {
    let Some((kind, data)) = data.split_first() else {
        return;
    };
    let path = own_file();
    let _ = std::fs::remove_file(&path);
    match kind % 4 {
        0 => records(&path, data),
        1 => header_of_words(&path, data),
        2 => {
            let mut bytes = started(&path, &render());
            // The length of the body follows.
            bytes.truncate(MAGIC_AND_VERSION);
            bytes.extend((data.len() as u32).to_le_bytes());
            bytes.extend(data);
            let sum = crc(&bytes);
            bytes.extend(sum.to_le_bytes());
            strange(&path, &bytes);
        }
        _ => strange(&path, data),
    }
    let _ = std::fs::remove_file(&path);
}

/// Returns the path of a file that only this thread uses.
fn own_file() -> PathBuf {
    let (process, thread) = (std::process::id(), std::thread::current().id());
    std::env::temp_dir().join(format!("qrt-fuzz-{process}-{thread:?}.qrt-partial"))
}

/// Number of bytes of the magic number and the version, with which checkpoints begin.
const MAGIC_AND_VERSION: usize = 12;

/// Returns the header of the render that opens the checkpoints.
fn render() -> Header {
    Header {
        scene_hash: "any".into(),
        seed: 0,
        options: [("build".into(), "of today".into())].into(),
        width: 3,
        height: 2,
        crop: [1, 0, 2, 2],
    }
}

/// Returns the bytes of a checkpoint without records.
fn started(path: &Path, header: &Header) -> Vec<u8> {
    drop(Checkpoint::create(path, header).expect("a file can be made"));
    std::fs::read(path).expect("it is there")
}

/// Returns a checkpoint with the header of `render()`, without records.
pub(crate) fn header_of_the_render() -> Vec<u8> {
    let path = own_file();
    let bytes = started(&path, &render());
    let _ = std::fs::remove_file(&path);
    bytes
}

/// Checks that a header of arbitrary words reads back, and that no other render accepts it.
fn header_of_words(path: &Path, data: &[u8]) {
    let mut words = data.split(|byte| *byte == 255).map(|word| {
        let word = String::from_utf8_lossy(word);
        word.into_owned()
    });
    let mut numbers = [0; 8];
    let first = words.next().unwrap_or_default();
    for (number, byte) in numbers.iter_mut().zip(first.bytes()) {
        *number = u32::from(byte) << (byte & 0b1_1000);
    }
    let [width, height, x, y, columns, rows, low, high] = numbers;
    let mut header = Header {
        scene_hash: words.next().unwrap_or_default(),
        seed: u64::from(high) << 32 | u64::from(low),
        options: BTreeMap::new(),
        width,
        height,
        crop: [x, y, columns, rows],
    };
    while let (Some(name), Some(value)) = (words.next(), words.next()) {
        header.options.insert(name, value);
    }
    let bytes = started(path, &header);
    let (checkpoint, tiles) = Checkpoint::open(path, &header).expect("it is this render's");
    drop(checkpoint);
    assert!(tiles.is_empty());
    // The bytes are not a prefix of a valid checkpoint, so this is not a file that a kill cut short.
    let other = Checkpoint::open(path, &render());
    match other {
        Ok(_) => assert_eq!(header, render()),
        Err(CheckpointError::Differs { differences, .. }) => assert!(!differences.is_empty()),
        Err(error) => panic!("{error}"),
    }
    assert_eq!(std::fs::read(path).expect("it is there"), bytes);
}

/// Checks that a file of arbitrary bytes is refused and left unchanged, unless it is a checkpoint of this render.
fn strange(path: &Path, bytes: &[u8]) {
    let header = render();
    let right = started(path, &header);
    std::fs::write(path, bytes).expect("a file can be written");
    let begins = bytes.starts_with(&right) || right.starts_with(bytes);
    match Checkpoint::open(path, &header) {
        Ok((checkpoint, _)) => {
            drop(checkpoint);
            assert!(begins, "{bytes:?}");
            let left = std::fs::read(path).expect("it is there");
            assert!(left.starts_with(&right), "{left:?}");
        }
        Err(error) => {
            assert!(!begins, "{error}");
            assert!(!error.to_string().is_empty());
            assert_eq!(std::fs::read(path).expect("it is there"), bytes);
            // A render that starts from the beginning refuses the file, too.
            let begun = Checkpoint::create(path, &header);
            let foreign = matches!(begun, Err(CheckpointError::Foreign { .. }));
            assert_eq!(foreign, !bytes.starts_with(&right[..8]), "{begun:?}");
            drop(begun);
            assert_eq!(std::fs::read(path).expect("it is there"), bytes);
        }
    }
    // The file is not a part of a picture, either.
    assert!(Merge::default().add("any", bytes).is_err());
}

/// Appends records to a valid header, each up to a byte 255 and with its checksum.
fn with_records(path: &Path, header: &Header, data: &[u8]) -> Vec<u8> {
    let mut bytes = started(path, header);
    for record in data.split(|byte| *byte == 255) {
        bytes.extend(record);
        bytes.extend(crc(record).to_le_bytes());
    }
    bytes
}

/// Reads arbitrary records as those of a checkpoint. The tiles that are read lie on the film, and
/// are still there after another tile was appended. Records of a part of a
/// picture, whatever their ending, are no whole picture.
fn records(path: &Path, data: &[u8]) {
    let mut of_part = render();
    of_part.options.insert("tile".into(), "0/2".into());
    let bytes = with_records(path, &of_part, data);
    std::fs::remove_file(path).expect("it is there");
    let mut merge = Merge::default();
    if let Err(error) = merge.add("any", &bytes) {
        assert!(!error.to_string().is_empty());
    }
    // The other portion is missing.
    assert!(merge.finish().is_err(), "{bytes:?}");
    let header = render();
    let bytes = with_records(path, &header, data);
    std::fs::write(path, bytes).expect("a file can be written");
    let (mut checkpoint, mut tiles) = Checkpoint::open(path, &header).expect("it is one");
    let parts = checkpoint.take_parts();
    let inside = |x: u32, y: u32, width: u32, height: u32| {
        x >= 1 && width >= 1 && height >= 1 && x + width <= 3 && y + height <= 2
    };
    for tile in &tiles {
        assert!(inside(tile.x, tile.y, tile.width, tile.height), "{tile:?}");
        assert_eq!(tile.pixels.len() as u32, tile.width * tile.height);
    }
    for part in &parts {
        assert!(inside(part.pixel[0], part.pixel[1], 1, 1), "{part:?}");
        let same = |other: &&PixelPart| (other.pixel, other.number) == (part.pixel, part.number);
        assert_eq!(parts.iter().filter(same).count(), 1);
    }
    let new = Tile {
        x: 2,
        y: 1,
        width: 1,
        height: 1,
        pixels: vec![[0.5; 3]],
        counted: CountedPixels {
            queries: vec![1],
            good: vec![[2; 3]],
            widths: vec![[0.25; 3]],
            strata: vec![[3; 3]],
        },
    };
    checkpoint.append(&new).expect("it can be written");
    drop(checkpoint);
    tiles.push(new);
    let (mut checkpoint, again) = Checkpoint::open(path, &header).expect("it is one");
    // Colours may be NaN, which does not equal itself, so the test compares the printed text.
    assert_eq!(format!("{again:?}"), format!("{tiles:?}"));
    let mut left = parts;
    left.retain(|part| part.pixel != [2, 1]);
    assert_eq!(checkpoint.take_parts(), left);
    checkpoint.remove().expect("it can be removed");
}
