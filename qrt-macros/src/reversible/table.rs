//! Constant arrays of the author's module, read at a constant place or at the number that a register
//! holds: a look-up table, which is a QROM.

use super::dim::Linear;
use super::ir::{Demand, Entry, Kind, Number, NumberKind, Place, Size, Table};
use super::outside;
use super::scope::Scope;
use super::source::{begin, text};
use proc_macro2::TokenStream;
use qrt_syntax::codes;
use quote::{ToTokens as _, format_ident, quote};
use std::rc::Rc;
use syn::{Expr, ExprIndex, Path};

/// The most bits of an index: the table has an entry for each number.
const MOST_BITS: i64 = 20;

impl Scope {
    /// Returns the path of the constant array that an expression reads, if it reads one.
    pub(super) fn table_path<'a>(&self, index: &'a ExprIndex) -> Option<&'a Path> {
        let Expr::Path(array) = &*index.expr else {
            return None;
        };
        let name = &array.path.segments.last()?.ident;
        let is_own = array
            .path
            .get_ident()
            .is_some_and(|name| self.is_known(name));
        (outside::is_constant(name) && !is_own).then_some(&array.path)
    }

    /// Reads `TABLE[k]`.
    pub(super) fn entry(
        &mut self,
        path: &Path,
        index: &ExprIndex,
        source: TokenStream,
    ) -> Option<Number> {
        let array = &*index.expr;
        if let Some(word) = outside::dependence(array.to_token_stream(), &self.constants) {
            let message = format!("a table cannot depend on `{word}`");
            let name = &path.segments.last()?.ident;
            let help = format!(
                "write a constant of the module, and read that: `const {name}: [u32; 4] = [0, 1, 4, 9];`"
            );
            self.problems.add(codes::REV_INDEX, array, &message, &help);
            return None;
        }
        let table = self.table(array);
        let (shown, name) = (text(array), &table.name);
        let length = Linear::named(
            format!("{shown}.len()"),
            quote!((#name.len() as ::core::primitive::u32)),
        );
        let entry = if let Some(place) = self.linear(&index.index) {
            let message = format!(
                "an entry beyond the last of `{shown}` [QRT0819]\n  = help: entries count from 0, so that the last has the length less 1"
            );
            let last = length.minus(&1.into());
            let within = self.holds(&place, &message) && self.holds(&last.minus(&place), &message);
            if !within {
                let message = format!("`{shown}` has no such entry");
                let help = format!("its first is `{shown}[0]`");
                self.problems
                    .add(codes::REV_INDEX, &index.index, &message, &help);
                return None;
            }
            Entry::At(place)
        } else {
            let place = self.place(&index.index)?;
            let width = self.index_bits(&place, &index.index)?;
            let entries = 1_i64 << width;
            let counted = text(&index.index);
            // An index of fewer bits than the register has.
            let is_wide = width > 2 && place.part.is_none();
            let narrower = if is_wide {
                format!(", or index it by some of the bits: `{counted}[0..2]` counts 4 entries")
            } else {
                String::new()
            };
            let message = format!(
                "`{shown}` has not the {entries} entries that `{counted}` counts [QRT0819]\n  = help: \
                 give it {entries} entries{narrower}"
            );
            let missing = length.minus(&entries.into());
            self.holds(&missing, &message);
            self.holds(&missing.times(-1), &message);
            Entry::Of(place, width)
        };
        let bits = Linear::named(
            format!("bits of {shown}"),
            quote!(::qrt::circuit::format::entry_bits(#name)),
        );
        let size = Size {
            width: bits.into(),
            signed: false,
            fraction: 0.into(),
            fixed: false,
            floors: false,
        };
        let kind = NumberKind::Entry(table, Box::new(entry));
        Some(Number { kind, size, source })
    }

    /// Returns the number of bits of an index.
    fn index_bits(&mut self, place: &Place, source: &Expr) -> Option<i64> {
        let format = &place.register.format;
        let width = match &place.part {
            Some([_, width]) => width.known(),
            None => format.width.known(),
        };
        let counts = place.part.is_some() || matches!(format.kind, Kind::UInt | Kind::Bool);
        let shown = text(source);
        let (message, help) = match width {
            Some(1..=MOST_BITS) if counts => return width,
            Some(_) if !counts => (
                format!("`{shown}` does not count entries from 0"),
                format!("name its bits: `{shown}[0..4]`"),
            ),
            Some(_) => (
                format!("`{shown}` counts more than 2^{MOST_BITS} entries"),
                format!("name some of its bits: `{shown}[0..8]`"),
            ),
            None => (
                format!("the entries that `{shown}` counts are not known here"),
                "use an index whose width is a number".to_owned(),
            ),
        };
        self.problems.add(codes::REV_INDEX, source, &message, &help);
        None
    }

    /// Returns the table of a path, which the generated code holds once.
    fn table(&mut self, path: &Expr) -> Rc<Table> {
        let tokens = quote!(#path);
        let text = tokens.to_string();
        let known = self
            .tables
            .iter()
            .find(|known| known.path.to_string() == text);
        if let Some(known) = known {
            return known.clone();
        }
        let table = Rc::new(Table {
            name: format_ident!("__TABLE_{}", self.tables.len()),
            path: tokens,
        });
        self.tables.push(table.clone());
        self.demand_whole(path, &table);
        table
    }

    /// Demands that the entries are whole numbers that registers can hold.
    fn demand_whole(&mut self, path: &Expr, table: &Table) {
        let name = &table.name;
        let message = format!(
            "`{}` holds a number that is not a whole one from 0 to 2^62 [QRT0808]\n  = help: write whole \
             numbers from 0 on; those below go into another table, whose entries are subtracted",
            text(path)
        );
        let condition = quote!({
            let mut __at = 0;
            let mut __whole = ::qrt::circuit::format::entry_bits(#name) < 63;
            while __at < #name.len() {
                __whole = __whole
                    && #name[__at] as ::core::primitive::f64
                        == #path[__at] as ::core::primitive::f64;
                __at += 1;
            }
            __whole
        });
        let span = begin(&quote!(#path));
        let demand = Demand {
            condition,
            message,
            span,
        };
        outside::demand(&mut self.demands, demand);
    }
}

impl Table {
    /// Returns the table of the generated code: the author's entries, as one type of number.
    pub(super) fn declared(&self) -> TokenStream {
        let Self { name, path } = self;
        quote! {
            const #name: &[::core::primitive::i64] = &{
                let mut __column = [0; #path.len()];
                let mut __at = 0;
                while __at < __column.len() {
                    __column[__at] = #path[__at] as ::core::primitive::i64;
                    __at += 1;
                }
                __column
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::reversible::expanded;
    use crate::reversible::problem::Problems;
    use proc_macro2::TokenStream;
    use qrt_syntax::codes;
    use quote::quote;

    /// Returns the code that reads `array[k]` in a function over `W`, and the problems.
    fn read(array: &TokenStream) -> (String, Problems) {
        let (tokens, problems) = expanded(
            &TokenStream::new(),
            quote! {
                fn f<const W: u32>(k: &UInt<2>, out: &mut UInt<W>) {
                    out += #array[k];
                }
            },
        );
        (tokens.to_string(), problems)
    }

    #[test]
    fn tables_are_constants_of_the_module() {
        for (array, word) in [
            (quote!(Self::TABLE), "Self"),
            (quote!(<Self as Squares>::TABLE), "Self"),
            (quote!(Squares::<W>::TABLE), "W"),
            (quote!(Squares::<{ W + 1 }>::TABLE), "W"),
        ] {
            let (_, problems) = read(&array);
            let [problem] = problems.found() else {
                panic!("{array}: {:?}", problems.messages());
            };
            assert_eq!(problem.code, codes::REV_INDEX);
            assert_eq!(
                problem.message,
                format!("a table cannot depend on `{word}`")
            );
            let help = "write a constant of the module, and read that: `const TABLE: [u32; 4] = [0, 1, 4, 9];`";
            assert_eq!(problem.help, help);
        }
    }

    #[test]
    fn lengths_of_tables_are_checked_without_a_call() {
        let (tokens, _) = read(&quote!(TABLE));
        let items: Vec<&str> = tokens.split("const _ : () = {").skip(1).collect();
        // In one of the three functions alone.
        let [item] = items.as_slice() else {
            panic!("{tokens}");
        };
        assert!(item.contains("demand (4 <= (__TABLE_0 . len ()"), "{item}");
    }

    #[test]
    fn tables_may_be_those_of_another_type() {
        for array in [
            quote!(TABLE),
            quote!(Squares::TABLE),
            quote!(<Squares<4>>::TABLE),
            quote!(<A as Squares>::TABLE),
        ] {
            let (tokens, problems) = read(&array);
            assert_eq!(problems.messages(), [""; 0], "{array}");
            let squeezed = |text: &str| text.replace(' ', "");
            let column = squeezed(&format!("= [0; {array}.len()]"));
            assert!(squeezed(&tokens).contains(&column), "{column}: {tokens}");
        }
    }
}
