//! A scene's program in one pixel, as a value.

use super::Oracle;
use qrt_circuit::export::{ExportCounts, ExportError, ExportFormat, write_program};
use qrt_circuit::{Gate, Operand, Program};
use std::io::Write;
use std::ops::Deref;

/// A scene's program with a pixel and a seed built in. It is a [`Program`] without classical
/// parameters, from a path index to the path's colours, with the data of its registers.
///
/// It derefs to the program: [`Program::inverse`], [`Program::circuit`], the operations and the
/// instructions are available. `path_machines::run_paths` of the runtime runs its paths, for example
/// with `run_paths::on_fixed`.
///
/// ```
/// use qrt_scene::front::parse;
/// use qrt_core::oracle::{OracleOptions, Oracle};
/// use qrt_circuit::Contents;
/// use qrt_circuit::export::ExportFormat;
///
/// # let text = "
/// # name: lamp
/// # camera: { perspective: { eye: [0, 0, 2], target: [0, 0, 0], vfov: 45 } }
/// # film: { width: 4, height: 4 }
/// # materials: { lamp: { emitter: { radiance: [1, 0.5, 0] } } }
/// # geometry:
/// #   - quad: { vertices: [[0, -9, 0], [9, -9, 0], [9, 9, 0], [0, 9, 0]], material: lamp }
/// # sampling: { path_bits: 3, depths: [{ bits: [3, 3] }] }
/// # precision: { fraction: 8 }
/// # comparator: { bits: 2 }
/// # ";
/// let scene = parse(text, "lamp.yaml", &[], "".as_ref())?.valid;
/// let oracle = Oracle::rgb(&scene, OracleOptions::default())?;
/// // Column 3, row 1, under the seed 7.
/// let bound = oracle.program_at(7, [3, 1]);
///
/// // Path 5, by the definition of each operation.
/// let mut contents = Contents::new(&bound, &[5, 0], &[]);
/// for instruction in &bound.instructions {
///     contents.follow(&bound, *instruction)?;
/// }
/// // It sees the lamp: red and green exceed all 4 comparators of their own bounds.
/// assert_eq!(bound.good(&contents.registers), [4, 4, 0]);
///
/// // Undone, all is zero again but the inputs.
/// for instruction in &bound.inverse().instructions {
///     contents.follow(&bound, *instruction)?;
/// }
/// assert_eq!(contents.registers.iter().sum::<u64>(), 5);
///
/// // Its gates, one by one, and as a text for other programs.
/// let mut toffolis = 0;
/// bound.each_gate(|gate| toffolis += u64::from(matches!(gate, qrt_circuit::Gate::Ccx(..))));
/// let mut text = Vec::new();
/// assert_eq!(bound.write(ExportFormat::OpenQasm3, &mut text)?.by_name["ccx"], toffolis);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct BoundProgram {
    oracle: Oracle,
    seed: u64,
    pixel: [u32; 2],
}

impl Oracle {
    /// The program in pixel (column, row), under the seed that shifts its paths.
    pub fn program_at(&self, seed: u64, pixel: [u32; 2]) -> BoundProgram {
        let program = match self.program.bound(&self.parameter_words(seed, pixel)) {
            Ok(program) => program,
            // Unreachable: the parameters are the program's own.
            Err(error) => unreachable!("{error}"),
        };
        let oracle = Self {
            program,
            parameters: Vec::new(),
            ..self.clone()
        };
        BoundProgram {
            oracle,
            seed,
            pixel,
        }
    }
}

impl Deref for BoundProgram {
    type Target = Program;
    fn deref(&self) -> &Program {
        &self.oracle.program
    }
}

impl BoundProgram {
    /// The oracle in that pixel: the scene's oracle with the pixel's parameters built in. Machines take
    /// it as they take any oracle.
    pub fn oracle(&self) -> &Oracle {
        &self.oracle
    }

    /// Column and row of the pixel.
    pub fn pixel(&self) -> [u32; 2] {
        self.pixel
    }

    /// The seed of the shifts of its paths.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// R, the number of path indices.
    pub fn paths(&self) -> u64 {
        1 << self.oracle.points.path_bits()
    }

    /// A call of the oracle of channel number `channel` of [`Oracle::channels`]: compute, compare,
    /// flip the phase, undo.
    pub fn whole(&self, channel: usize) -> Program {
        self.oracle.whole(channel)
    }

    /// Number of a path's good comparators by channel. `registers` are the contents of all registers
    /// after the program.
    pub fn good(&self, registers: &[u64]) -> Vec<u64> {
        let channels = self.oracle.channels.iter();
        let counts = channels.map(|channel| match channel.count {
            Operand::Constant(value) => value,
            Operand::Word(word) => word.read(registers[word.register.index()]),
        });
        counts.map(|count| self.oracle.good(count)).collect()
    }

    /// Calls `each` for the program's gates one by one, without storing them all.
    pub fn each_gate(&self, mut each: impl FnMut(Gate)) {
        qrt_circuit::lower::each_instruction(self, |gates, _| {
            for &gate in gates {
                each(gate);
            }
        });
    }

    /// Writes the program as OpenQASM, with its pixel and seed below the header: [`write_program`].
    ///
    /// # Errors
    /// An error of `out`.
    pub fn write(
        &self,
        format: ExportFormat,
        out: &mut impl Write,
    ) -> Result<ExportCounts, ExportError> {
        let [column, row] = self.pixel;
        let about = format!("pixel {column}, {row}; seed {}", self.seed);
        write_program(self, &[], format, &[about], out)
    }
}
