//! Expressions, computed out of place: their temporaries, and the way to read the result.

use super::dim::{Dim, Linear};
use super::ir::{Bit, Entry, Number, NumberKind, Register, Size, Table};
use super::source::text;
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::{format_ident, quote};

/// Returns a variable of the generated code. It is another than an author's variable of the same
/// name; an author's constant or static cannot be told from it, hence the underscores.
pub(super) fn own(name: &str) -> Ident {
    Ident::new(&format!("__{name}"), Span::mixed_site())
}

/// The temporaries that a statement computes before it and undoes after it.
#[derive(Default)]
pub(super) struct Temporaries {
    pub(super) computed: Vec<TokenStream>,
    names: Vec<Ident>,
    /// Registers that cannot be read while the statement runs: their bits are copied.
    pub(super) copied: Vec<syn::Ident>,
    /// Number of temporaries that the routine has had before.
    first: usize,
}

/// A number, as an operation reads it.
pub(super) enum Value {
    Constant(TokenStream),
    Word(View),
}

/// Some bits of a register, as an operation reads them.
#[derive(Clone)]
pub(super) struct View {
    /// The tokens of a reference to the register.
    register: TokenStream,
    /// Its [`qrt_circuit::Word`], if all of it is read.
    whole: Option<TokenStream>,
    first: Linear,
    width: Dim,
    signed: bool,
    shift: Linear,
}

impl View {
    fn temporary(name: &Ident, width: Dim, signed: bool) -> Self {
        Self {
            register: quote!(&#name),
            whole: None,
            first: 0.into(),
            width,
            signed,
            shift: 0.into(),
        }
    }

    fn tokens(&self) -> TokenStream {
        let (register, first) = (&self.register, self.first.tokens());
        let width = self.width.tokens();
        let word = match &self.whole {
            Some(whole) => whole.clone(),
            None if self.signed => quote!(__qrt::Word::signed(#register, #first, #width)),
            None => quote!(__qrt::Word::unsigned(#register, #first, #width)),
        };
        if self.shift.is_zero() {
            return word;
        }
        let shift = self.shift.tokens();
        quote!(#word.shifted(#shift))
    }
}

impl Value {
    fn operand(&self) -> TokenStream {
        match self {
            Self::Constant(units) => quote!(__qrt::Operand::Constant(#units)),
            Self::Word(view) => {
                let word = view.tokens();
                quote!(__qrt::Operand::Word(#word))
            }
        }
    }

    fn shifted(self, by: &Linear) -> Self {
        match self {
            _ if by.is_zero() => self,
            Self::Constant(units) => {
                let known = units.to_string().parse::<i64>().ok().zip(by.known());
                let shifted = known.and_then(|(units, by)| units.checked_shl(by as u32));
                Self::Constant(if let Some(units) = shifted {
                    let units = Literal::i64_unsuffixed(units);
                    quote!(#units)
                } else {
                    let by = by.grouped();
                    quote!(#units << #by)
                })
            }
            Self::Word(view) => Self::Word(View {
                shift: view.shift.plus(by),
                ..view
            }),
        }
    }
}

impl Temporaries {
    /// Creates an empty list, after `first` temporaries of other statements.
    pub(super) fn after(first: usize) -> Self {
        Self {
            first,
            ..Self::default()
        }
    }

    /// Returns code that undoes the temporaries, last first.
    pub(super) fn undone(&self) -> TokenStream {
        let names = self.names.iter().rev();
        let machine = own("machine");
        quote!(#(__qrt::Machine::undo(#machine, [#names]);)*)
    }

    pub(super) fn count(&self) -> usize {
        self.names.len()
    }

    /// Returns the name of the next temporary.
    fn next(&self) -> Ident {
        own(&format!("t{}", self.first + self.names.len()))
    }

    fn operation(&mut self, operation: &str, operands: &TokenStream) -> Ident {
        let name = self.next();
        let (machine, operation) = (own("machine"), format_ident!("{operation}"));
        self.computed
            .push(quote!(let #name = __qrt::Machine::#operation(#machine, #operands);));
        self.names.push(name.clone());
        name
    }

    /// Returns an operand of an operation.
    pub(super) fn operand(&mut self, number: &Number) -> TokenStream {
        self.value(number).operand()
    }

    /// Returns an operand, shifted up to the first bit of a place.
    pub(super) fn operand_at(&mut self, number: &Number, first: &Linear) -> TokenStream {
        self.value(number).shifted(first).operand()
    }

    fn word(&mut self, number: &Number) -> TokenStream {
        match self.value(number) {
            Value::Word(view) => view.tokens(),
            Value::Constant(_) => {
                let name = self.sum(&[(false, number.clone())], number);
                View::temporary(&name, number.size.width.clone(), number.size.signed).tokens()
            }
        }
    }

    fn value(&mut self, number: &Number) -> Value {
        let Size { width, signed, .. } = &number.size;
        match &number.kind {
            NumberKind::Constant(units) => {
                let units = Literal::i64_unsuffixed(*units);
                Value::Constant(quote!(#units))
            }
            NumberKind::Given(value) => {
                let value = value.tokens();
                // The author's module need not have `From` in scope.
                let from = quote!(<::core::primitive::i64 as ::core::convert::From<_>>::from);
                Value::Constant(quote!(#from(#value)))
            }
            NumberKind::Entry(table, entry) => self.entry(table, entry, number),
            NumberKind::Word(register, first) => Value::Word(self.read(register, first, number)),
            NumberKind::Truth(bit) => {
                let when = self.bit(bit);
                let declared = declaration(number, width);
                let name = self.operation(
                    "select",
                    &quote!(#declared, #when, __qrt::Operand::Constant(1), __qrt::Operand::Constant(0),),
                );
                Value::Word(View::temporary(&name, 1.into(), false))
            }
            NumberKind::Shifted(inner, by) => self.value(inner).shifted(by),
            NumberKind::Pointed(inner) => self.value(inner),
            NumberKind::Dropped(inner, by) => self.dropped(inner, by, number),
            NumberKind::Product(..) | NumberKind::Square(_) => {
                let name = self.product(number, &0.into(), number);
                Value::Word(View::temporary(&name, width.clone(), *signed))
            }
            NumberKind::Sum(terms) => {
                let name = self.sum(terms, number);
                Value::Word(View::temporary(&name, width.clone(), *signed))
            }
        }
    }

    fn entry(&mut self, table: &Table, entry: &Entry, number: &Number) -> Value {
        let column = &table.name;
        let (place, width) = match entry {
            Entry::At(place) => {
                let place = place.grouped();
                return Value::Constant(quote!(#column[#place as ::core::primitive::usize]));
            }
            Entry::Of(place, width) => (place, *width),
        };
        let first = place
            .part
            .as_ref()
            .map_or_else(|| 0.into(), |[first, _]| first.clone());
        let address = (0..width).map(|bit| {
            let bit = Bit::At(place.register.clone(), first.plus(&bit.into()));
            self.bit(&bit)
        });
        let address: Vec<TokenStream> = address.collect();
        let declared = declaration(number, &number.size.width);
        let (name, machine) = (self.next(), own("machine"));
        self.computed.push(quote! {
            let [#name] = __qrt::Machine::table(
                #machine, [#declared], &[#(#address),*], [#column], 0,
            );
        });
        self.names.push(name.clone());
        let Size { width, signed, .. } = &number.size;
        Value::Word(View::temporary(&name, width.clone(), *signed))
    }

    fn read(&mut self, register: &Register, first: &Linear, number: &Number) -> View {
        let name = register.tokens();
        let Size { width, signed, .. } = &number.size;
        let all = first.is_zero() && *width == register.format.width.clone().into();
        let view = View {
            register: quote!(#name.register()),
            whole: (all && *signed == register.format.signed()).then(|| quote!(#name.word())),
            first: first.clone(),
            width: width.clone(),
            signed: *signed,
            shift: 0.into(),
        };
        if !self.copied.contains(&register.name) {
            return view;
        }
        let (declared, word) = (declaration(number, width), view.tokens());
        let copy = self.operation("copy", &quote!(#declared, #word));
        View::temporary(&copy, width.clone(), *signed)
    }

    fn dropped(&mut self, inner: &Number, by: &Linear, number: &Number) -> Value {
        if inner.is_product() {
            let name = self.product(inner, by, number);
            let Size { width, signed, .. } = &number.size;
            return Value::Word(View::temporary(&name, width.clone(), *signed));
        }
        let view = match self.value(inner) {
            Value::Word(view) => view,
            Value::Constant(units) => {
                let by = by.grouped();
                return Value::Constant(quote!(#units >> #by));
            }
        };
        let width = number.size.width.clone();
        if by.minus(&view.shift).never_negative() {
            let first = view.first.plus(&by.minus(&view.shift));
            let (shift, whole) = (0.into(), None);
            return Value::Word(View {
                whole,
                first,
                width,
                shift,
                ..view
            });
        }
        if view.shift.minus(by).never_negative() {
            let shift = view.shift.minus(by);
            return Value::Word(View { shift, ..view });
        }
        // It is not known here which of the two is greater: the zeros below become bits.
        let (declared, word) = (declaration(inner, &inner.size.width), view.tokens());
        let copy = self.operation("copy", &quote!(#declared, #word));
        let view = View::temporary(&copy, width, inner.size.signed);
        Value::Word(View {
            first: by.clone(),
            ..view
        })
    }

    /// Computes a product without its lowest bits; its size is that of `result`.
    fn product(&mut self, number: &Number, drop: &Linear, result: &Number) -> Ident {
        if let NumberKind::Pointed(inner) = &number.kind {
            return self.product(inner, drop, result);
        }
        let declared = declaration(result, &result.size.width);
        let drop = drop.tokens();
        match &number.kind {
            NumberKind::Square(a) => {
                let a = self.word(a);
                self.operation("square", &quote!(#declared, #a, #drop))
            }
            NumberKind::Product(a, b) => {
                if let Value::Constant(factor) = self.value(a) {
                    let b = self.word(b);
                    return self.operation("scale", &quote!(#declared, #b, #factor, #drop));
                }
                let (a, b) = (self.word(a), self.word(b));
                self.operation("multiply", &quote!(#declared, #a, #b, #drop))
            }
            _ => self.sum(&[(false, number.clone())], number),
        }
    }

    /// Computes a sum, with its terms aligned to the result's last bit.
    fn sum(&mut self, terms: &[(bool, Number)], result: &Number) -> Ident {
        let declared = declaration(result, &result.size.width);
        let fraction = &result.size.fraction;
        let mut sum = quote!(__qrt::Operand::Constant(0));
        let mut name = None;
        for (place, (subtract, term)) in terms.iter().enumerate() {
            let below = fraction.minus(&term.size.fraction);
            let term = self.operand_at(term, &below);
            if place == 0 && !subtract && terms.len() > 1 {
                sum = term;
                continue;
            }
            let operation = if *subtract { "subtract" } else { "add" };
            let next = self.operation(operation, &quote!(#declared, #sum, #term));
            let view = View::temporary(&next, result.size.width.clone(), result.size.signed);
            let word = view.tokens();
            sum = quote!(__qrt::Operand::Word(#word));
            name = Some(next);
        }
        name.unwrap_or_else(|| format_ident!("_"))
    }

    /// Returns a bit of a register or of a temporary.
    pub(super) fn bit(&mut self, bit: &Bit) -> TokenStream {
        match bit {
            Bit::Constant(value) => {
                let declared = bit_declaration("constant");
                let units = Literal::i64_unsuffixed(i64::from(*value));
                let name = self.operation(
                    "add",
                    &quote!(#declared, __qrt::Operand::Constant(#units), __qrt::Operand::Constant(0),),
                );
                quote!(__qrt::Bit::at(&#name, 0))
            }
            Bit::At(register, index) => {
                let name = register.tokens();
                let index = index.tokens();
                if !self.copied.contains(&register.name) {
                    return quote!(__qrt::Bit::at(#name.register(), #index));
                }
                let declared = bit_declaration(&format!("{register}[{index}]"));
                let copy = self.operation(
                    "copy",
                    &quote!(#declared, __qrt::Word::unsigned(#name.register(), #index, 1)),
                );
                quote!(__qrt::Bit::at(&#copy, 0))
            }
            Bit::Not(inner) => {
                let inner = self.bit(inner);
                quote!(#inner.inverted())
            }
            Bit::And(a, b) => {
                let (a, b) = (self.bit(a), self.bit(b));
                let declared = bit_declaration("and");
                let name = self.operation("and", &quote!(#declared, #a, #b));
                quote!(__qrt::Bit::at(&#name, 0))
            }
            Bit::Xor(a, b) => {
                let (a, b) = (self.bit(a), self.bit(b));
                let declared = bit_declaration("xor");
                let name = self.operation("xor", &quote!(#declared, #a, #b));
                quote!(__qrt::Bit::at(&#name, 0))
            }
            Bit::Less(a, b) => {
                let [a, b] = self.aligned(a, b);
                let name = self.less(&a, &b);
                quote!(__qrt::Bit::at(&#name, 0))
            }
            Bit::Equal(a, b) => {
                let [a, b] = self.aligned(a, b);
                let (less, greater) = (self.less(&a, &b), self.less(&b, &a));
                let declared = bit_declaration("equal");
                let name = self.operation(
                    "and",
                    &quote!(#declared,
                        __qrt::Bit::at(&#less, 0).inverted(),
                        __qrt::Bit::at(&#greater, 0).inverted(),),
                );
                quote!(__qrt::Bit::at(&#name, 0))
            }
        }
    }

    /// Returns a bit that is not negated as an operand, shifted up to the first bit of a place.
    pub(super) fn bit_operand(&mut self, bit: &Bit, first: &Linear) -> TokenStream {
        if let Bit::At(..) | Bit::Constant(_) | Bit::Not(_) = bit {
            let number = super::number::truth(bit.clone(), TokenStream::new());
            return self.operand_at(&number, first);
        }
        self.bit(bit);
        let computed = self
            .names
            .last()
            .map(|name| View::temporary(name, 1.into(), false));
        let computed = computed.map(|view| Value::Word(view).shifted(first).operand());
        computed.unwrap_or_default()
    }

    fn less(&mut self, a: &TokenStream, b: &TokenStream) -> Ident {
        let declared = bit_declaration("less");
        self.operation("less", &quote!(#declared, #a, #b))
    }

    /// Returns two numbers in units of the lower last bit of the two.
    fn aligned(&mut self, a: &Number, b: &Number) -> [TokenStream; 2] {
        let more = a.size.fraction.minus(&b.size.fraction);
        let less = more.times(-1);
        if more.never_negative() || b.is_constant() && !less.never_negative() {
            [self.operand(a), self.operand_at(b, &more)]
        } else {
            [self.operand_at(a, &less), self.operand(b)]
        }
    }
}

impl Number {
    fn is_constant(&self) -> bool {
        matches!(self.kind, NumberKind::Constant(_) | NumberKind::Given(_))
    }
}

fn bit_declaration(name: &str) -> TokenStream {
    quote!(&__qrt::Declaration::work(#name, __qrt::Type::Bool, 1))
}

fn declaration(number: &Number, width: &Dim) -> TokenStream {
    let name = text(&number.source);
    let fraction = number.size.fraction.tokens();
    let ty = match (number.size.fixed, number.size.signed) {
        (false, false) => quote!(__qrt::Type::UInt),
        (false, true) => quote!(__qrt::Type::Int),
        (true, false) => quote!(__qrt::Type::UFixed { fraction: #fraction }),
        (true, true) => quote!(__qrt::Type::Fixed { fraction: #fraction }),
    };
    let width = width.tokens();
    quote!(&__qrt::Declaration::work(#name, #ty, #width))
}
