//! The intermediate representation of a routine: names are resolved, widths are known.

use super::constants::Constants;
use super::dim::{self, Dim, Linear, Loop};
use super::source::{text, type_text};
use proc_macro2::{Span, TokenStream};
use quote::quote;
use std::fmt;
use std::rc::Rc;
use syn::{ExprPath, Ident, Type};

/// A function marked `#[reversible]`.
pub(super) struct Routine {
    pub(super) signature: Signature,
    pub(super) body: Vec<Statement>,
    pub(super) demands: Vec<Demand>,
    pub(super) tables: Vec<Rc<Table>>,
}

/// A constant array of the author's module, and its name in the generated code.
pub(super) struct Table {
    pub(super) name: Ident,
    pub(super) path: TokenStream,
}

/// The trait that a function is a method of.
#[derive(Clone, Default)]
pub(super) enum OfTrait {
    /// It is a method of no trait.
    #[default]
    None,
    /// The trait around it declares it.
    Declared,
    /// It stands in an `impl` of this trait.
    Implemented(syn::Path),
}

/// All parts of a function except its body.
#[derive(Clone)]
pub(super) struct Signature {
    pub(super) attributes: Vec<syn::Attribute>,
    pub(super) visibility: syn::Visibility,
    pub(super) name: Ident,
    pub(super) of: OfTrait,
    /// True if `constants` are all generics around the function, as far as the attribute shows.
    pub(super) complete: bool,
    /// The name of the machine's type, which the function does not mention.
    pub(super) machine: Ident,
    /// The constants that the function itself is generic over.
    pub(super) own: Constants,
    /// The function's own constants, and those of the `impl` around it.
    pub(super) constants: Constants,
    pub(super) parameters: Vec<Rc<Register>>,
    /// Names of parameters that are not registers.
    pub(super) unusable: Vec<Ident>,
    pub(super) demands: Vec<Demand>,
}

/// A condition on the constants that a routine is generic over, or that its module has.
#[derive(Clone)]
pub(super) struct Demand {
    pub(super) condition: TokenStream,
    pub(super) message: String,
    /// The statement or term that needs the condition.
    pub(super) span: Span,
}

/// A register as it is declared: a single one, one of an array's, or all of an array's.
#[derive(Clone)]
pub(super) struct Register {
    pub(super) name: Ident,
    /// The type of one register.
    pub(super) ty: Type,
    /// The number of registers of an array.
    pub(super) array: Option<Array>,
    /// The index of one of the array's registers.
    pub(super) element: Option<Linear>,
    pub(super) format: Format,
    /// The type of the generated code that has its format, if Rust cannot compute the width.
    pub(super) computed: Option<Ident>,
    /// True for a parameter, which is a reference; false for a scratch register, which is a value.
    pub(super) parameter: bool,
    pub(super) mutable: bool,
}

/// The number of registers of an array, and its tokens.
#[derive(Clone)]
pub(super) struct Array {
    pub(super) length: Linear,
    pub(super) written: TokenStream,
}

impl Register {
    /// True if this is all of an array's registers.
    pub(super) fn is_array(&self) -> bool {
        self.array.is_some() && self.element.is_none()
    }

    /// True if the two are certainly different registers, in these loops.
    pub(super) fn is_apart(&self, other: &Self, loops: &[Loop]) -> bool {
        if self.name != other.name {
            return true;
        }
        let one = |element: &Linear| [element.clone(), 1.into()];
        let elements = self.element.as_ref().zip(other.element.as_ref());
        elements.is_some_and(|(a, b)| dim::apart(&one(a), &one(b), loops))
    }

    /// Returns the type of its declaration.
    pub(super) fn type_text(&self) -> String {
        let ty = type_text(&self.ty);
        match &self.array {
            Some(array) => format!("[{ty}; {}]", text(&array.written)),
            None => ty,
        }
    }

    /// Returns the type of its format in the generated code, within a routine of these constants.
    pub(super) fn format_tokens(&self, constants: &[Ident]) -> TokenStream {
        let ty = &self.ty;
        let computed = self.computed.as_ref();
        computed.map_or_else(|| quote!(#ty), |name| quote!(#name<#(#constants),*>))
    }

    /// Returns the register in the generated code.
    pub(super) fn tokens(&self) -> TokenStream {
        self.tokens_at(&self.name)
    }

    /// Returns the register in the generated code, by its name as written at one place.
    pub(super) fn tokens_at(&self, name: &Ident) -> TokenStream {
        let element = self.element.as_ref().map(Linear::grouped);
        let element = element.map(|place| quote!([#place as ::core::primitive::usize]));
        quote!(#name #element)
    }
}

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.element {
            Some(element) => write!(f, "{}[{element}]", self.name),
            None => write!(f, "{}", self.name),
        }
    }
}

/// The meaning of a register's bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Format {
    pub(super) kind: Kind,
    pub(super) width: Linear,
    pub(super) fraction: Linear,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Bool,
    UInt,
    Int,
    UFixed,
    Fixed,
}

impl Format {
    pub(super) fn signed(&self) -> bool {
        matches!(self.kind, Kind::Int | Kind::Fixed)
    }

    pub(super) fn fixed(&self) -> bool {
        matches!(self.kind, Kind::Fixed | Kind::UFixed)
    }
}

/// A number of an expression, and its source text.
#[derive(Clone)]
pub(super) struct Number {
    pub(super) kind: NumberKind,
    pub(super) size: Size,
    pub(super) source: TokenStream,
}

/// The meaning of a number's bits.
#[derive(Clone, Debug)]
pub(super) struct Size {
    pub(super) width: Dim,
    pub(super) signed: bool,
    pub(super) fraction: Linear,
    /// True if it has a point. Shifts then move the point, and round nothing.
    pub(super) fixed: bool,
    /// True if its lowest fraction bits may be dropped without `floor(..)`.
    pub(super) floors: bool,
}

#[derive(Clone)]
pub(super) enum NumberKind {
    /// A constant, in units of the lowest fraction bit.
    Constant(i64),
    /// A number that is known when the program is built: constants and loops' variables.
    Given(Linear),
    /// Bits of a register from the given one on; their number is the number's width.
    Word(Rc<Register>, Linear),
    /// An entry of a table.
    Entry(Rc<Table>, Box<Entry>),
    Truth(Box<Bit>),
    /// The number times `2^n`.
    Shifted(Box<Number>, Linear),
    /// The number without its `n` lowest bits: `floor(x / 2^n)`.
    Dropped(Box<Number>, Linear),
    /// The same bits, with the point at another place.
    Pointed(Box<Number>),
    Product(Box<Number>, Box<Number>),
    Square(Box<Number>),
    /// Numbers that are added, and numbers (`true`) that are subtracted.
    Sum(Vec<(bool, Number)>),
}

/// The place of a table's entry.
#[derive(Clone)]
pub(super) enum Entry {
    /// A place that is known when the program is built.
    At(Linear),
    /// The number in some bits of a register; their number.
    Of(Place, i64),
}

/// A truth value of an expression.
#[derive(Clone)]
pub(super) enum Bit {
    Constant(bool),
    At(Rc<Register>, Linear),
    Not(Box<Bit>),
    And(Box<Bit>, Box<Bit>),
    Xor(Box<Bit>, Box<Bit>),
    Less(Box<Number>, Box<Number>),
    Equal(Box<Number>, Box<Number>),
}

/// The target of an update: some bits of a register, or all.
#[derive(Clone)]
pub(super) struct Place {
    pub(super) register: Rc<Register>,
    /// The first bit and the number of bits.
    pub(super) part: Option<[Linear; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Update {
    Add,
    Subtract,
    Xor,
}

/// One term of the sum that an update adds.
#[derive(Clone)]
pub(super) enum Term {
    Number(Number),
    Bit(Bit, TokenStream),
}

#[derive(Clone)]
pub(super) struct Statement {
    pub(super) kind: StatementKind,
    /// The source text that errors underline.
    pub(super) source: TokenStream,
}

#[derive(Clone)]
pub(super) enum StatementKind {
    Update(Place, Vec<(Update, Term)>),
    Swap(Rc<Register>, Rc<Register>),
    /// The author's claim that a scratch register is 0, which is checked whenever it runs.
    Zero(Rc<Register>),
    Call {
        path: ExprPath,
        /// True if the call is of the inverse of the named function.
        inverse: bool,
        /// The registers, whether they may be changed, and their names in the call.
        arguments: Vec<(Rc<Register>, bool, Ident)>,
    },
    If(Bit, Vec<Statement>, Vec<Statement>),
    For {
        variable: Ident,
        bounds: [Linear; 2],
        reversed: bool,
        body: Vec<Statement>,
    },
    /// Runs the first statements, then the second, then the inverses of the first.
    Within(Vec<Statement>, Vec<Statement>),
    /// A scratch register, and the statements of its scope.
    Scratch(Rc<Register>, Vec<Statement>),
    Block(Vec<Statement>),
}

impl Statement {
    pub(super) fn inverse(&self) -> Self {
        use StatementKind as K;
        let kind = match &self.kind {
            K::Update(place, terms) => {
                let turned = terms.iter().rev().map(|(update, term)| {
                    let update = match update {
                        Update::Add => Update::Subtract,
                        Update::Subtract => Update::Add,
                        Update::Xor => Update::Xor,
                    };
                    (update, term.clone())
                });
                K::Update(place.clone(), turned.collect())
            }
            K::Swap(a, b) => K::Swap(a.clone(), b.clone()),
            K::Zero(register) => K::Zero(register.clone()),
            K::Call {
                path,
                inverse,
                arguments,
            } => K::Call {
                path: path.clone(),
                inverse: !inverse,
                arguments: arguments.clone(),
            },
            K::If(bit, holds, fails) => K::If(bit.clone(), inverse(holds), inverse(fails)),
            K::For {
                variable,
                bounds,
                reversed,
                body,
            } => K::For {
                variable: variable.clone(),
                bounds: bounds.clone(),
                reversed: !reversed,
                body: inverse(body),
            },
            K::Within(within, apply) => K::Within(within.clone(), inverse(apply)),
            K::Scratch(register, body) => K::Scratch(register.clone(), inverse(body)),
            K::Block(body) => K::Block(inverse(body)),
        };
        Self {
            kind,
            source: self.source.clone(),
        }
    }
}

/// Returns the inverses of the statements, in reverse order.
pub(super) fn inverse(statements: &[Statement]) -> Vec<Statement> {
    statements.iter().rev().map(Statement::inverse).collect()
}
