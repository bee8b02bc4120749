//! The builder: the tracer, read as a program.
//!
//! It implements [`Arith`](qrt_tracer::Arith) by recording the operations that the tracer calls.
//! Real numbers become fixed-point numbers with one common number of fraction bits. Each is
//!
//! ```text
//! ± register 2^-fraction + constant + a column + b row
//! ```
//!
//! so that signs, constants and values that the pixel fixes cost nothing until an operation needs
//! the bits. While the builder records:
//!
//! * **constants fold**, and products with constants become shifts and signed digits;
//! * **equal values are shared**: an operation with the operands of an earlier one reuses its
//!   result;
//! * **intervals** bound every value. A register has the width that its interval needs, so nothing
//!   can overflow on any path;
//! * **functions of few bits** (a material's weight, a sampled coordinate's sine, the product of two
//!   weights) stay tables until an operation needs their bits, and become arithmetic only where that
//!   is cheaper;
//! * operations that nothing needs in the end are left out.
//!
//! Constants and tables are rounded to nearest. Products, quotients and roots are rounded down.

mod arith;
mod choice;
mod divide;
mod draft;
mod function;
mod given;
mod groups;
mod held;
mod in_place;
mod known;
mod label;
mod names;
mod number;
mod order;
mod passes;
mod pebble;
mod product;
mod queue;
mod recompute;
mod root;
mod strategy;
mod table;
mod truth;
mod value;

pub(crate) use known::{Known, locked};
pub use label::{Label, PixelWord, Role, StageName};
pub use names::{NamedPlace, ValuePlace};
pub(crate) use passes::{PricedProgram, Roots, Stem, assemble};
pub use strategy::{Garbage, Scope, Strategy};
pub use value::{BoolValue, Index, RealValue};

use draft::Draft;
use names::NamedValue;
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{Bit, Block, BlockId, Op, Operand, Register, RegisterId, Style, Type, Word};
use qrt_scene::sampling::PathPoints;
use qrt_syntax::{Circuit, What};
use qrt_tracer::{Coordinate, Segment, WideValue};
use std::collections::HashMap;
use std::rc::Rc;
use table::SharedTables;
use value::{Affine, Choice, Truth, Value};

use number::negative as negative_range;

/// Most bits of any number: an `i64` holds it with its sign and one bit to spare.
const MAX_BITS: u32 = 62;

/// Most address bits of the table of a function of a sample coordinate.
const MAX_ADDRESS: u32 = 16;

/// Most bits of an integer that tables are addressed by: the number of any face, or of none.
const MAX_INDEX: u32 = 23;

/// Most address bits of a function that is tabulated although arithmetic could compute it.
const FEW: usize = 10;

/// The type and the width of an operation's result, before it has a register.
type Shape = (Type, u32);

/// The shape of an operation's garbage, before its width is known.
const GARBAGE: Shape = (Type::Scratch, 0);

/// The reason why a scene has no circuit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum BuildError {
    /// A quotient without a bound: its divisor may be zero.
    UnboundedQuotient,
    /// A function that may be infinite for its argument, such as the logarithm of zero.
    UnboundedFunction,
    /// A number that needs more than 62 bits.
    TooWide {
        /// The kind of number.
        what: &'static str,
        /// Number of bits that it needs.
        bits: u32,
        /// Number of fraction bits of every number.
        fraction: u32,
        /// The value of a material that it is computed for, if any.
        value: Option<WideValue>,
    },
}

impl BuildError {
    /// The corresponding problem of the scene.
    pub(crate) fn problem(&self) -> Circuit {
        match self {
            Self::UnboundedQuotient => Circuit::UnboundedQuotient,
            Self::UnboundedFunction => Circuit::UnboundedFunction,
            Self::TooWide {
                what,
                bits,
                fraction,
                value,
            } => Circuit::TooWide {
                what,
                bits: *bits,
                most: MAX_BITS,
                whole: MAX_BITS.saturating_sub(*fraction),
                value: value
                    .as_ref()
                    .map(|value| (value.key, value.material.clone())),
            },
        }
    }
}

impl std::fmt::Display for BuildError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        What::from(self.problem()).fmt(f)
    }
}

impl std::error::Error for BuildError {}

/// The settings with which a program is built.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Number of fraction bits of every number.
    pub fraction: u32,
    /// The uncomputation strategy.
    pub strategy: Strategy,
    /// The paths of a pixel.
    pub points: &'a PathPoints,
    /// Columns and rows of the film.
    pub film: [u32; 2],
    /// The only pixel (column, row) that the program is for; none if it is for all pixels of the film.
    pub pixel: Option<[u32; 2]>,
    /// One more than the greatest number of a face that a ray can meet.
    pub faces: u32,
    /// The passes that make the program cheaper.
    pub passes: Passes,
}

/// The passes with which the builder makes a program cheaper. All passes are on, unless the saving
/// of one is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools)] // Each is a pass that can be left out.
pub struct Passes {
    /// True if equal values are computed once.
    pub share: bool,
    /// True if functions of few bits stay tables where tables are cheaper.
    pub tabulate: bool,
    /// True if operations that nothing needs are removed.
    pub needed: bool,
    /// True if tables of one address are merged into one.
    pub merge: bool,
    /// True if products of one number with several constants share sums.
    pub multiples: bool,
}

impl Passes {
    /// Every pass that makes a program smaller.
    pub const ALL: Self = Self {
        share: true,
        tabulate: true,
        needed: true,
        merge: true,
        multiples: true,
    };
    /// No pass: the program as the tracer recorded it.
    pub const NONE: Self = Self {
        share: false,
        tabulate: false,
        needed: false,
        merge: false,
        multiples: false,
    };

    /// True if programs under both sets of passes are assembled from the same recording. The other
    /// passes change a recorded program.
    pub(crate) fn same_recording(self, other: Self) -> bool {
        (self.share, self.tabulate) == (other.share, other.tabulate)
    }
}

/// Records the tracer as a program: see [the module](self).
pub struct Builder<'a> {
    target: Target<'a>,
    registers: Vec<Register>,
    blocks: Vec<Block>,
    parameters: Vec<PixelWord>,
    /// The index of each parameter, by [`PixelWord::key`].
    places: QuickMap<[u64; 5], u32>,
    ops: Vec<(Op, BlockId)>,
    records: Vec<RegisterId>,
    error: Option<BuildError>,
    id: RegisterId,
    open: Vec<BlockId>,
    values: Vec<Value>,
    truths: Vec<Truth>,
    choices: Vec<Choice>,
    known: QuickMap<Op<RegisterId, u32>, usize>,
    coordinates: HashMap<Coordinate, Index>,
    /// By width: the entries 0, 1, 2, ... of the table of an integer whose address is its own bits.
    counted: HashMap<u32, Rc<[f64]>>,
    shared_tables: SharedTables,
    names: Vec<NamedValue>,
    /// By ray: its start and its hit, as the tracer reported them.
    segments: Vec<Segment<Self>>,
    /// The surface whose weight is being computed.
    surface: Option<u32>,
    /// By surface: the value of a material that the surface's weight is computed from.
    wide_values: Vec<Option<WideValue>>,
    asked: u64,
    shared: u64,
}

/// The recording of a builder.
#[derive(Clone)]
pub(crate) struct Recorded {
    draft: Draft,
    pub(crate) parameters: Vec<PixelWord>,
    /// Registers that are kept even if nothing needs them.
    records: Vec<RegisterId>,
    /// The values that the tracer has names for.
    pub(crate) names: Vec<NamedPlace>,
}

impl Recorded {
    /// Number of operations.
    pub(crate) fn operations(&self) -> usize {
        self.draft.ops.len()
    }

    /// The registers, with the widths that all programs of the recording give them; garbage has none yet.
    pub(crate) fn registers(&self) -> &[Register] {
        &self.draft.registers
    }
}

impl<'a> Builder<'a> {
    /// Creates a builder of an empty program. The program's only input is the path index.
    pub fn new(target: Target<'a>) -> Self {
        let mut builder = Self {
            target,
            registers: Vec::new(),
            blocks: vec![
                Label {
                    stage: StageName::Oracle,
                    depth: None,
                }
                .block(None),
            ],
            parameters: Vec::new(),
            places: QuickMap::default(),
            ops: Vec::new(),
            records: Vec::new(),
            error: None,
            id: RegisterId(0),
            open: vec![BlockId::ROOT],
            values: Vec::new(),
            truths: Vec::new(),
            choices: Vec::new(),
            known: QuickMap::default(),
            coordinates: HashMap::new(),
            counted: HashMap::new(),
            shared_tables: SharedTables::default(),
            names: Vec::new(),
            segments: Vec::new(),
            surface: None,
            wide_values: Vec::new(),
            asked: 0,
            shared: 0,
        };
        builder.id = builder.register("id", Type::UInt, Role::Id, target.points.path_bits());
        builder
    }

    /// Number of fraction bits of every number.
    pub(crate) fn fraction_bits(&self) -> u32 {
        self.target.fraction
    }

    /// The register that holds `a`, its sign and constant included, and its interval in units of
    /// the last place.
    pub(crate) fn operand_of(&mut self, a: RealValue) -> (Operand, [i64; 2]) {
        self.operand(a)
    }

    /// The same number in a register of its own, sign and constant included.
    pub fn held(&mut self, a: RealValue) -> RealValue {
        match self.operand(a) {
            (Operand::Word(word), range) => self.computed(word, range),
            (Operand::Constant(value), _) => RealValue::constant(value as f64 * self.ulp()),
        }
    }

    /// Opens the block of the rounding of colours. [`qrt_tracer::Arith::leave`] closes the block.
    pub(crate) fn enter_count(&mut self) {
        self.begin(StageName::Count, None);
    }

    /// Returns the recording, or the first error.
    pub(crate) fn finish(mut self) -> Result<Recorded, BuildError> {
        self.registers.shrink_to_fit();
        self.ops.shrink_to_fit();
        match self.error {
            Some(error) => Err(error),
            None => Ok(Recorded {
                names: self.named_places(),
                draft: Draft {
                    registers: self.registers,
                    blocks: self.blocks,
                    ops: self.ops,
                },
                parameters: self.parameters,
                records: self.records,
            }),
        }
    }

    /// A register that is filled before the program runs, or written after it.
    pub(crate) fn outside(&mut self, name: &str, ty: Type, role: Role, width: u32) -> RegisterId {
        self.register(name, ty, role, width)
    }

    /// Number of operations requested, and number of these that reused an earlier operation.
    pub fn sharing(&self) -> [u64; 2] {
        [self.asked, self.shared]
    }

    /// The register of the path index.
    pub fn id(&self) -> RegisterId {
        self.id
    }

    fn block(&self) -> BlockId {
        self.open.last().copied().unwrap_or(BlockId::ROOT)
    }

    /// True if a value computed in `block` is read from its register, false if it is recomputed.
    fn is_at_hand(&self, block: BlockId) -> bool {
        !self.target.strategy.recomputes() || self.open.contains(&block)
    }

    /// The style of an operation with this garbage.
    ///
    /// In groups of edges and in slots it is out of place: products of edges share their sums, and their block
    /// is short. If the block is a scope, its end undoes the garbage; if not, the garbage stays.
    fn style(&self, garbage: Garbage) -> Style {
        let stage = Label::from_block(&self.blocks[self.block().index()]).stage;
        let is_short = matches!(stage, StageName::Edges(_) | StageName::Slot(_));
        if is_short && !self.target.strategy.recomputes() {
            Style::OutOfPlace
        } else {
            self.target.strategy.style(garbage)
        }
    }

    /// True if a register that a table filled is read, false if the table fills another register.
    fn is_filled(&self, register: RegisterId) -> bool {
        self.is_at_hand(self.registers[register.index()].block)
    }

    fn begin(&mut self, stage: StageName, depth: Option<u32>) {
        let id = BlockId(self.blocks.len() as u32);
        let parent = self.block();
        let depth = depth.or(Label::from_block(&self.blocks[parent.index()]).depth);
        self.blocks.push(Label { stage, depth }.block(Some(parent)));
        self.open.push(id);
    }

    fn end(&mut self) {
        if self.open.len() > 1 {
            self.open.pop();
        }
    }

    /// Sets the values of materials that the surfaces' weights are computed from, by surface number.
    pub(crate) fn with_values(mut self, values: Vec<Option<WideValue>>) -> Self {
        self.wide_values = values;
        self
    }

    /// Reports a number that is too wide for a register.
    fn too_many_bits(&mut self, what: &'static str, bits: u32) {
        let surface = self.surface.map(|surface| surface as usize);
        let value = surface.and_then(|surface| self.wide_values.get(surface).cloned());
        self.fail(BuildError::TooWide {
            what,
            bits,
            fraction: self.target.fraction,
            value: value.flatten(),
        });
    }

    fn fail(&mut self, error: BuildError) {
        self.error.get_or_insert(error);
    }

    fn register(&mut self, name: &str, ty: Type, role: Role, width: u32) -> RegisterId {
        let block = self.block();
        let id = RegisterId(self.registers.len() as u32);
        let name = match role {
            Role::Work | Role::Scratch => format!("{name}{}", id.0),
            _ => name.to_owned(),
        };
        self.registers.push(Register {
            name,
            ty,
            tag: role.tag(),
            width,
            block,
            range: None,
        });
        id
    }

    /// Records an operation, or finds an equal earlier one, and returns its targets. `op` has the
    /// shapes of its results in place of its targets.
    fn emit(&mut self, op: Op<RegisterId, Shape>) -> Vec<RegisterId> {
        self.asked += 1;
        // The key contains the widths: equal operands at another width are another operation.
        let key = op.clone().map(|read| read, |(_, width)| width);
        if let (true, Some(&known)) = (self.target.passes.share, self.known.get(&key))
            && self.is_at_hand(self.ops[known].1)
        {
            self.shared += 1;
            return self.ops[known].0.targets();
        }
        for (_, bits) in op.targets() {
            if bits > MAX_BITS {
                let what = "a value of the tracer";
                self.too_many_bits(what, bits);
            }
        }
        self.known.insert(key, self.ops.len());
        self.emit_anew(op)
    }

    /// Records an operation, even if there is an equal one, and returns its targets.
    fn emit_anew(&mut self, op: Op<RegisterId, Shape>) -> Vec<RegisterId> {
        let name = op.name();
        let op = op.map(
            |read| read,
            |(ty, width)| {
                let role = match ty {
                    Type::Scratch => Role::Scratch,
                    _ => Role::Work,
                };
                self.register(name, ty, role, width.min(MAX_BITS))
            },
        );
        let targets = op.targets();
        let block = self.block();
        self.ops.push((op, block));
        targets
    }

    fn number_type(&self, signed: bool) -> Type {
        let fraction = self.target.fraction;
        if signed {
            Type::Fixed { fraction }
        } else {
            Type::UFixed { fraction }
        }
    }

    /// The index of a parameter, which is added if it is new.
    fn parameter(&mut self, parameter: PixelWord) -> u32 {
        let next = self.parameters.len() as u32;
        *self.places.entry(parameter.key()).or_insert_with(|| {
            self.parameters.push(parameter);
            next
        })
    }

    fn sample_index(&mut self, coordinate: Coordinate) -> Index {
        if let Some(&known) = self.coordinates.get(&coordinate) {
            return known;
        }
        let points = self.target.points;
        let bits = points.bits(coordinate);
        let index = if bits == 0 {
            Index::Constant(0)
        } else {
            let columns = (0..points.path_bits())
                .map(|bit| u64::from(points.column(coordinate, bit)))
                .collect();
            let shifted = points.shifts();
            let parameter = shifted.then(|| self.parameter(PixelWord::Shift { coordinate, bits }));
            let source = self.id;
            let target = self.emit(Op::Parity {
                source,
                columns,
                parameter,
                target: (Type::UInt, bits),
            })[0];
            let word = Word {
                register: target,
                offset: 0,
                width: bits,
                signed: false,
                shift: 0,
            };
            self.choice_within(word, MAX_ADDRESS)
        };
        self.coordinates.insert(coordinate, index);
        index
    }

    /// The bits of `word`, the least significant first.
    fn bits(word: Word) -> impl Iterator<Item = Bit> {
        (0..word.width).map(move |place| Bit {
            register: word.register,
            index: word.offset + place,
            inverted: false,
        })
    }

    /// All bits of a register of `width` bits.
    fn whole(register: RegisterId, width: u32, signed: bool) -> Word {
        Word {
            register,
            offset: 0,
            width,
            signed,
            shift: 0,
        }
    }
}

#[cfg(test)]
mod tests;
