//! The builder: the tracer, read as a program.
//!
//! It implements [`Arith`](crate::tracer::Arith) by recording what it is asked for. Real numbers
//! become fixed-point numbers with one number of fraction bits; each is
//!
//! ```text
//! ± register 2^-fraction + constant + a column + b row
//! ```
//!
//! so that signs, constants and what the pixel fixes cost nothing until something needs the bits.
//! On the way:
//!
//! * **constants fold**, and products with constants become shifts and signed digits;
//! * **equal values are shared**: an operation with the operands of an earlier one is that one;
//! * **intervals** bound every value, and give its register the width that holds them: nothing can
//!   overflow, whatever the path;
//! * **functions of few bits** (a material's weight, a sampled coordinate's sine, the product of two
//!   weights) stay tables until something needs their bits, and become arithmetic only where that
//!   is cheaper;
//! * what nothing needs in the end was never there.
//!
//! Rounding: constants and tables are rounded to nearest, products, quotients and roots down.

mod arith;
mod choice;
mod divide;
mod function;
mod given;
mod names;
mod number;
mod order;
mod product;
mod root;
mod table;
mod truth;
pub(super) mod value;

pub use names::{NamedPlace, Place};
pub use value::{Bool, Index, Real};

use super::passes::Draft;
use super::{
    Bit, Block, BlockId, Op, Operand, Parameter, Register, RegisterId, Role, Style, Type, Word,
};
use crate::sampling::PathPoints;
use crate::syntax::{Circuit, What};
use crate::tracer::{Axis, Coordinate, Named};
use names::Nameable;
use std::collections::HashMap;
use value::{Affine, Choice, Truth, Value};

use number::negative as negative_range;

/// Most bits of any number: what an `i64` holds beside its sign.
const MAX_BITS: u32 = 62;

/// Most address bits of a table.
const MAX_ADDRESS: u32 = 16;

/// Most address bits of a function that is tabulated although arithmetic could compute it.
const FEW: usize = 10;

/// Why a scene has no circuit.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum BuildError {
    /// A quotient without a bound: its divisor may be zero.
    UnboundedQuotient,
    /// A number that needs more than 62 bits.
    TooWide {
        /// What it is.
        what: &'static str,
        /// Bits it needs.
        bits: u32,
    },
}

impl BuildError {
    /// What this says of the scene.
    pub(crate) fn problem(&self) -> Circuit {
        match *self {
            Self::UnboundedQuotient => Circuit::UnboundedQuotient,
            Self::TooWide { what, bits } => {
                let most = MAX_BITS;
                Circuit::TooWide { what, bits, most }
            }
        }
    }
}

impl std::fmt::Display for BuildError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        What::from(self.problem()).fmt(f)
    }
}

impl std::error::Error for BuildError {}

/// What a program is built for.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Fraction bits of every number.
    pub fraction: u32,
    /// How operations that leave something behind are lowered.
    pub style: Style,
    /// The paths of a pixel.
    pub points: &'a PathPoints,
    /// Columns and rows.
    pub film: [u32; 2],
    /// Primitives.
    pub faces: u32,
    /// What is done on the way.
    pub passes: Passes,
}

/// What the builder does to make a program cheaper. All of it, unless the price of a pass is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools)] // Each is a pass that can be left out.
pub struct Passes {
    /// Equal values are computed once.
    pub share: bool,
    /// Functions of few bits stay tables where these are cheaper.
    pub tabulate: bool,
    /// What nothing needs vanishes.
    pub needed: bool,
    /// Tables of one address become one.
    pub merge: bool,
}

impl Passes {
    /// All of them.
    pub const ALL: Self = Self {
        share: true,
        tabulate: true,
        needed: true,
        merge: true,
    };
    /// None.
    pub const NONE: Self = Self {
        share: false,
        tabulate: false,
        needed: false,
        merge: false,
    };
}

/// A recorder of the tracer: see [the module](self).
pub struct Builder<'a> {
    target: Target<'a>,
    registers: Vec<Register>,
    blocks: Vec<Block>,
    parameters: Vec<Parameter>,
    ops: Vec<(Op, BlockId)>,
    records: Vec<RegisterId>,
    error: Option<BuildError>,
    id: RegisterId,
    open: Vec<BlockId>,
    values: Vec<Value>,
    truths: Vec<Truth>,
    choices: Vec<Choice>,
    known: HashMap<Op, usize>,
    coordinates: HashMap<(usize, bool), Index>,
    names: Vec<(Named, usize, Nameable)>,
    asked: u64,
    shared: u64,
}

/// What a builder recorded.
#[derive(Clone)]
pub(crate) struct Recorded {
    pub(super) draft: Draft,
    pub(super) parameters: Vec<Parameter>,
    /// Registers that stay although nothing may need them.
    pub(super) records: Vec<RegisterId>,
    /// What the tracer has names for.
    pub(crate) names: Vec<NamedPlace>,
}

impl<'a> Builder<'a> {
    /// An empty program with an id register.
    pub fn new(target: Target<'a>) -> Self {
        let mut builder = Self {
            target,
            registers: Vec::new(),
            blocks: vec![Block {
                parent: None,
                name: "oracle".to_owned(),
                depth: None,
                scope: false,
            }],
            parameters: Vec::new(),
            ops: Vec::new(),
            records: Vec::new(),
            error: None,
            id: RegisterId(0),
            open: vec![BlockId::ROOT],
            values: Vec::new(),
            truths: Vec::new(),
            choices: Vec::new(),
            known: HashMap::new(),
            coordinates: HashMap::new(),
            names: Vec::new(),
            asked: 0,
            shared: 0,
        };
        builder.id = builder.register("id", Type::UInt, Role::Id, target.points.path_bits());
        builder
    }

    /// Fraction bits of every number.
    pub fn fraction_bits(&self) -> u32 {
        self.target.fraction
    }

    /// The register that holds `a`, its sign and constant included, and its interval in units of
    /// the last place.
    pub fn operand_of(&mut self, a: Real) -> (Operand, [i64; 2]) {
        self.operand(a)
    }

    /// The same number in a register of its own, sign and constant included.
    pub fn held(&mut self, a: Real) -> Real {
        match self.operand(a) {
            (Operand::Word(word), range) => self.computed(word, range),
            (Operand::Constant(value), _) => Real::constant(value as f64 * self.ulp()),
        }
    }

    /// What follows belongs to the rounding of colours, until [`crate::tracer::Arith::leave`].
    pub(crate) fn enter_count(&mut self) {
        self.begin("count".to_owned(), None, false);
    }

    /// What was recorded, or why that cannot be.
    pub(crate) fn finish(self) -> Result<Recorded, BuildError> {
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

    /// Operations that were asked for, and of these, those that were there already.
    pub fn sharing(&self) -> [u64; 2] {
        [self.asked, self.shared]
    }

    /// The path's id.
    pub fn id(&self) -> RegisterId {
        self.id
    }

    pub(super) fn block(&self) -> BlockId {
        self.open.last().copied().unwrap_or(BlockId::ROOT)
    }

    pub(super) fn begin(&mut self, name: String, depth: Option<u32>, scope: bool) {
        let id = BlockId(self.blocks.len() as u32);
        let parent = self.block();
        let depth = depth.or(self.blocks[parent.index()].depth);
        self.blocks.push(Block {
            parent: Some(parent),
            name,
            depth,
            scope,
        });
        self.open.push(id);
    }

    pub(super) fn end(&mut self) {
        if self.open.len() > 1 {
            self.open.pop();
        }
    }

    pub(super) fn fail(&mut self, error: BuildError) {
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
            role,
            width,
            block,
            range: None,
        });
        id
    }

    /// The targets of the operation that `op` makes of them, or of an equal one that is there.
    /// `targets` are the results' types and widths.
    fn emit(
        &mut self,
        targets: &[(Type, u32)],
        op: impl FnOnce(&[RegisterId], RegisterId) -> Op,
    ) -> Vec<RegisterId> {
        const NOBODY: RegisterId = RegisterId(u32::MAX);
        self.asked += 1;
        // Equal operands at another width are another operation.
        let widths: Vec<RegisterId> = targets
            .iter()
            .map(|&(_, width)| RegisterId(u32::MAX - 1 - width))
            .collect();
        let mut op = op(&widths, NOBODY);
        if let (true, Some(&known)) = (self.target.passes.share, self.known.get(&op)) {
            self.shared += 1;
            return self.ops[known].0.targets();
        }
        let key = op.clone();
        for &(_, width) in targets {
            if width > MAX_BITS {
                self.fail(BuildError::TooWide {
                    what: "a value of the tracer",
                    bits: width,
                });
            }
        }
        let name = op.name();
        let mut next = targets.iter();
        let scratch = op.scratch().is_some();
        let mut made = Vec::with_capacity(targets.len() + 1);
        for &(ty, width) in next.by_ref() {
            made.push(self.register(name, ty, Role::Work, width.min(MAX_BITS)));
        }
        if scratch {
            made.push(self.register(name, Type::Scratch, Role::Scratch, 0));
        }
        let mut fresh = made.iter();
        op.rename(|register, computed| {
            if computed && let Some(&id) = fresh.next() {
                *register = id;
            }
        });
        self.known.insert(key, self.ops.len());
        let block = self.block();
        self.ops.push((op, block));
        made.truncate(targets.len());
        made
    }

    fn number_type(&self, signed: bool) -> Type {
        let fraction = self.target.fraction;
        if signed {
            Type::Fixed { fraction }
        } else {
            Type::UFixed { fraction }
        }
    }

    /// One of the parameters, made or found.
    fn parameter(&mut self, parameter: Parameter) -> u32 {
        let found = self.parameters.iter().position(|known| *known == parameter);
        found.unwrap_or_else(|| {
            self.parameters.push(parameter);
            self.parameters.len() - 1
        }) as u32
    }

    fn sample_index(&mut self, coordinate: Coordinate) -> Index {
        let axis = usize::from(coordinate.axis == Axis::V);
        let key = (coordinate.depth, axis == 1);
        if let Some(&known) = self.coordinates.get(&key) {
            return known;
        }
        let points = self.target.points;
        let bits = points.bits(coordinate.depth, axis);
        let index = if bits == 0 {
            Index::Constant(0)
        } else {
            let columns = (0..points.path_bits())
                .map(|bit| u64::from(points.column(coordinate.depth, axis, bit)))
                .collect();
            let shifted = points.shifts();
            let parameter = shifted.then(|| {
                self.parameter(Parameter::Shift {
                    depth: coordinate.depth,
                    axis,
                    bits,
                })
            });
            let source = self.id;
            let target = self.emit(&[(Type::UInt, bits)], |t, _| Op::Parity {
                source,
                columns,
                parameter,
                target: t[0],
            })[0];
            self.choice_of(Word {
                register: target,
                offset: 0,
                width: bits,
                signed: false,
                shift: 0,
            })
        };
        self.coordinates.insert(key, index);
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

    /// All of an unsigned register.
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
