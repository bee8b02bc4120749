//! What work takes is estimated before it begins: what would take more memory than may be had is refused,
//! with the number, and with what to lower. Compiling a circuit that takes long is told of.

use super::failure::Failure;
use super::time::{self, PathCost};
use qrt_circuit::lower;
use qrt_core::oracle::{MOST_BITS, Options, Oracle};
use qrt_core::valid::ValidScene;
use qrt_runtime::memory::allowed_bytes;
use qrt_runtime::render::Model;
use std::time::Instant;

/// Bytes of a face as it is read and traced: 730 were measured, of a flat grid of 720,000 triangles.
const OF_FACE: u64 = 1000;
/// Bytes of a pixel in tiles, picture and files: 83 of a tile.
const OF_PIXEL: u64 = 104;
/// Up to so many faces a circuit is compiled without an estimate before it, which takes as long.
const FEW_FACES: usize = 400;
/// Faces of the two parts of a scene from which the whole is estimated.
const PARTS: [usize; 2] = [64, 128];

/// The memory that a command may take.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Memory {
    bytes: u64,
}

/// What is done with a circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    /// It is compiled and its operations counted or run.
    Program,
    /// Its gates run on so many threads.
    Gates(usize),
    /// Its gates are written.
    Export,
}

/// A size such as `500M`, `1.5G` or `4GiB`: units are powers of 1,024.
pub(crate) fn size(text: &str) -> Result<u64, String> {
    let refused = || format!("`{text}` is no size: write one such as 500M or 4G");
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = text[digits.len()..].to_ascii_uppercase();
    let unit = unit.trim_end_matches('B').trim_end_matches('I');
    let power = ["", "K", "M", "G", "T"]
        .iter()
        .position(|name| *name == unit);
    let power = power.ok_or_else(refused)?;
    let number: f64 = digits.parse().map_err(|_| refused())?;
    let bytes = number * libm::exp2(10.0 * power as f64);
    let fits = bytes >= 1.0 && bytes < u64::MAX as f64;
    if fits {
        Ok(bytes as u64)
    } else {
        Err(refused())
    }
}

/// Bytes in words.
fn words(bytes: f64) -> String {
    let (value, unit) = match bytes {
        bytes if bytes < 1e9 => (bytes / 1e6, "MB"),
        bytes if bytes < 1e12 => (bytes / 1e9, "GB"),
        bytes => (bytes / 1e12, "TB"),
    };
    let places = usize::from(value < 100.0);
    format!("{value:.places$} {unit}")
}

impl Memory {
    /// What is asked for, or three quarters of what there is.
    pub(crate) fn of(asked: Option<u64>) -> Self {
        let usual = || allowed_bytes().map_or(u64::MAX, |bytes| bytes / 4 * 3);
        Self {
            bytes: asked.unwrap_or_else(usual),
        }
    }

    /// As many faces a scene may have.
    pub(crate) fn faces(self) -> usize {
        usize::try_from(self.bytes / OF_FACE).unwrap_or(usize::MAX)
    }

    fn keep(self, what: &str, bytes: f64, lower: &str) -> Result<(), Failure> {
        if bytes <= self.bytes as f64 {
            return Ok(());
        }
        Err(Failure::Usage(format!(
            "{what} would take about {} of memory, and {} are allowed: {lower}, or allow more with \
             --max-memory",
            words(bytes),
            words(self.bytes as f64)
        )))
    }

    /// That the picture fits.
    pub(crate) fn keep_picture(
        self,
        scene: &ValidScene,
        crop: Option<[u32; 4]>,
    ) -> Result<(), Failure> {
        let film = scene.scene().film;
        let [_, _, width, height] = crop.unwrap_or([0, 0, film.width, film.height]);
        let pixels = f64::from(width.min(film.width)) * f64::from(height.min(film.height));
        let what = format!("a picture of {width} x {height} pixels");
        let lower = "render part of it with --crop, or a smaller film";
        self.keep(&what, pixels * OF_PIXEL as f64, lower)
    }

    /// That parts of so many bytes fit, and the picture that they make: it has about as many.
    pub(crate) fn keep_parts(self, bytes: u64) -> Result<(), Failure> {
        self.keep(
            "merging these parts",
            2.0 * bytes as f64,
            "merge on another machine",
        )
    }

    /// That the circuits fit that are compiled to plan for an accuracy.
    pub(crate) fn keep_plan(self, scene: &ValidScene) -> Result<(), Failure> {
        match scene.scene().accuracy {
            Some(_) => self.keep_circuit(scene, Work::Program),
            None => Ok(()),
        }
    }

    /// That what the model traces with fits.
    pub(crate) fn keep_model(
        self,
        scene: &ValidScene,
        model: Model,
        threads: usize,
    ) -> Result<(), Failure> {
        match model {
            Model::Real => Ok(()),
            Model::Fixed => self.keep_circuit(scene, Work::Program),
            Model::Gates => self.keep_circuit(scene, Work::Gates(threads)),
        }
    }

    /// That the oracle's circuit fits, which grows with the scene's faces.
    pub(crate) fn keep_circuit(self, scene: &ValidScene, work: Work) -> Result<(), Failure> {
        let faces = scene.polygons().len();
        if faces <= FEW_FACES {
            return Ok(());
        }
        let Some(whole) = Size::estimated(scene) else {
            // What is wrong is told, with its place, where the whole is compiled.
            return Ok(());
        };
        let what = format!("the circuit of a scene of {faces} faces");
        let lower = "use a coarser mesh, or fewer rays";
        self.keep(&what, whole.bytes(work), lower)?;
        let what = format!("compiling {what} and counting its gates");
        time::tell(&what, whole.seconds, "a coarser mesh takes less");
        Ok(())
    }
}

/// What a circuit consists of.
#[derive(Clone, Copy, Debug)]
struct Size {
    operations: f64,
    /// At the peak.
    qubits: f64,
    /// Bits of all registers.
    bits: f64,
    /// Of compute and uncompute.
    gates: f64,
    /// To compile it and make its gates.
    seconds: f64,
}

/// What a path of the scene's circuit goes through; nothing where the scene has none.
pub(crate) fn path_cost(scene: &ValidScene) -> PathCost {
    Size::estimated(scene).map_or_else(PathCost::default, |size| PathCost {
        operations: size.operations,
        gates: size.gates,
    })
}

impl Size {
    /// Of a scene's oracle, if it has one; of one of many faces, from two parts of it.
    fn estimated(scene: &ValidScene) -> Option<Self> {
        let faces = scene.polygons().len();
        if faces <= FEW_FACES {
            return Self::of(scene);
        }
        let [few, more] = PARTS.map(|faces| Self::of(&scene.thinned(faces)));
        let share = (faces - PARTS[0]) as f64 / (PARTS[1] - PARTS[0]) as f64;
        Some(few?.towards(&more?, share))
    }

    /// Of a scene's oracle, if it has one.
    fn of(scene: &ValidScene) -> Option<Self> {
        let start = Instant::now();
        let program = Oracle::rgb(scene, Options::default()).ok()?.program;
        let mut gates = 0.0;
        let qubits = lower::each_instruction(&program, |next, _| gates += 2.0 * next.len() as f64);
        let bits = program
            .registers
            .iter()
            .map(|register| f64::from(register.width));
        Some(Self {
            operations: program.ops.len() as f64,
            qubits: f64::from(qubits),
            bits: bits.sum(),
            gates,
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// On the line from here to `other`, at `share` of the way; it may be far beyond.
    fn towards(&self, other: &Self, share: f64) -> Self {
        let line = |from: f64, to: f64| from + (to - from) * share;
        Self {
            operations: line(self.operations, other.operations),
            qubits: line(self.qubits, other.qubits),
            bits: line(self.bits, other.bits),
            gates: line(self.gates, other.gates),
            seconds: line(self.seconds, other.seconds),
        }
    }

    /// Bytes that work with it takes: of the knot, whose 142,875 operations need 12.7 million qubits, 0.62 GB
    /// were measured of compiling and 0.80 GB of running gates.
    fn bytes(&self, work: Work) -> f64 {
        let (qubits, operations) = (self.qubits, self.operations);
        let compiled = 40.0 * qubits + 700.0 * operations;
        match work {
            Work::Gates(threads) if self.bits <= MOST_BITS as f64 => {
                compiled + 40.0 * self.gates + 256.0 * qubits * threads as f64
            }
            // Rows of 32 bytes, once; where registers are; the program with its inverse.
            Work::Gates(_) => compiled.max(64.0 * qubits + 500.0 * operations),
            Work::Export if self.bits <= MOST_BITS as f64 => compiled + 48.0 * self.gates,
            Work::Program | Work::Export => compiled,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_and_told() {
        for (text, bytes) in [
            ("1024", 1024),
            ("1k", 1 << 10),
            ("500M", 500 << 20),
            ("1.5G", 3 << 29),
            ("4GiB", 4 << 30),
            ("2TB", 2 << 40),
        ] {
            assert_eq!(size(text), Ok(bytes), "{text}");
        }
        for text in ["", "G", "-1G", "0", "1e99", "4X", "nan", "inf", "1 G G"] {
            assert!(size(text).is_err(), "{text}");
        }
        assert_eq!(words(7.2e9), "7.2 GB");
        assert_eq!(words(687e9), "687 GB");
        assert_eq!(words(3e6), "3.0 MB");
    }
}
