//! Widths, places of bits and numbers of passes. They are linear in the constants that a routine is
//! generic over and in the variables of its loops.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::BTreeMap;
use syn::Ident;

/// `constant + sum of factor * name`. Names stand for numbers that are not negative.
#[derive(Clone, Debug, Default)]
pub(super) struct Linear {
    pub(super) constant: i64,
    terms: BTreeMap<String, Term>,
}

/// The factor of a name, and the name's tokens in the generated code.
#[derive(Clone, Debug)]
struct Term {
    factor: i64,
    tokens: TokenStream,
}

impl PartialEq for Linear {
    fn eq(&self, other: &Self) -> bool {
        self.minus(other).is_zero()
    }
}

impl Eq for Linear {}

impl From<i64> for Linear {
    fn from(constant: i64) -> Self {
        Self {
            constant,
            terms: BTreeMap::new(),
        }
    }
}

impl Linear {
    /// Returns the number of a name: a constant of the function's generics, or a loop's variable.
    pub(super) fn name(name: &Ident) -> Self {
        Self::named(name.to_string(), quote!(#name))
    }

    /// Returns a number that messages show as `text`, and whose `tokens` are a `u32` of the
    /// generated code.
    pub(super) fn named(text: String, tokens: TokenStream) -> Self {
        let factor = 1;
        Self {
            constant: 0,
            terms: [(text, Term { factor, tokens })].into(),
        }
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        sum.constant = sum.constant.saturating_add(other.constant);
        for (name, term) in &other.terms {
            match sum.terms.get_mut(name) {
                Some(own) => own.factor = own.factor.saturating_add(term.factor),
                None => drop(sum.terms.insert(name.clone(), term.clone())),
            }
        }
        sum.terms.retain(|_, term| term.factor != 0);
        sum
    }

    pub(super) fn times(&self, factor: i64) -> Self {
        let mut product = self.clone();
        product.constant = product.constant.saturating_mul(factor);
        for term in product.terms.values_mut() {
            term.factor = term.factor.saturating_mul(factor);
        }
        product.terms.retain(|_, term| term.factor != 0);
        product
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        self.plus(&other.times(-1))
    }

    /// Returns the number, if it depends on no name.
    pub(super) fn known(&self) -> Option<i64> {
        self.terms.is_empty().then_some(self.constant)
    }

    /// True if it is known not to be negative, for all values of the names.
    pub(super) fn never_negative(&self) -> bool {
        self.constant >= 0 && self.terms.values().all(|term| term.factor >= 0)
    }

    pub(super) fn is_zero(&self) -> bool {
        self.known() == Some(0)
    }

    pub(super) fn factor(&self, name: &Ident) -> i64 {
        self.terms
            .get(&name.to_string())
            .map_or(0, |term| term.factor)
    }

    /// Returns the same sum with `value` in place of `name`.
    pub(super) fn with(&self, name: &Ident, value: &Self) -> Self {
        let factor = self.factor(name);
        let mut rest = self.clone();
        rest.terms.remove(&name.to_string());
        rest.plus(&value.times(factor))
    }

    /// Returns the parts that are added, and the parts that are subtracted.
    fn sides(&self) -> [Self; 2] {
        [1, -1].map(|sign| {
            let mut side = self.times(sign);
            side.constant = side.constant.max(0);
            side.terms.retain(|_, term| term.factor > 0);
            side
        })
    }

    /// Returns the number as a `u32` of the generated code.
    pub(super) fn tokens(&self) -> TokenStream {
        let [plus, minus] = self.sides();
        let plus = plus.sum();
        let minus = minus.parts();
        quote!(#plus #(- #minus)*)
    }

    /// Returns the same tokens, grouped so that an operator may follow.
    pub(super) fn grouped(&self) -> TokenStream {
        let tokens = self.tokens();
        if tokens.clone().into_iter().count() == 1 {
            return tokens;
        }
        quote!((#tokens))
    }

    /// Returns the condition that it is not negative, as generated code without a negative number.
    pub(super) fn never_negative_tokens(&self) -> TokenStream {
        let [plus, minus] = self.sides();
        let (plus, minus) = (plus.sum(), minus.sum());
        quote!(#minus <= #plus)
    }

    /// Returns the number as an `i64` of the generated code, which may be negative.
    pub(super) fn signed_tokens(&self) -> TokenStream {
        let [plus, minus] = self.sides().map(|side| side.sum());
        quote!((#plus) as ::core::primitive::i64 - (#minus) as ::core::primitive::i64)
    }

    fn sum(&self) -> TokenStream {
        let parts = self.parts();
        let Some((first, rest)) = parts.split_first() else {
            return quote!(0);
        };
        quote!(#first #(+ #rest)*)
    }

    fn parts(&self) -> Vec<TokenStream> {
        let terms = self.terms.values().map(|Term { factor, tokens }| {
            if *factor == 1 {
                return tokens.clone();
            }
            let factor = Literal::i64_unsuffixed(*factor);
            quote!(#factor * #tokens)
        });
        let mut parts: Vec<TokenStream> = terms.collect();
        if self.constant != 0 {
            let constant = Literal::i64_unsuffixed(self.constant);
            parts.push(quote!(#constant));
        }
        parts
    }
}

impl std::fmt::Display for Linear {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut parts: Vec<(bool, String)> = Vec::new();
        for (name, Term { factor, .. }) in &self.terms {
            let shown = match factor.unsigned_abs() {
                1 => name.clone(),
                factor => format!("{factor} * {name}"),
            };
            parts.push((*factor < 0, shown));
        }
        if self.constant != 0 || parts.is_empty() {
            parts.push((self.constant < 0, self.constant.unsigned_abs().to_string()));
        }
        // Added parts come first.
        parts.sort_by_key(|(subtracted, _)| *subtracted);
        for (place, (subtracted, part)) in parts.iter().enumerate() {
            match (place, subtracted) {
                (0, false) => f.write_str(part)?,
                (0, true) => write!(f, "-{part}")?,
                (_, false) => write!(f, " + {part}")?,
                (_, true) => write!(f, " - {part}")?,
            }
        }
        Ok(())
    }
}

/// A loop's variable, and the bounds of its range.
pub(super) type Loop = (Ident, [Linear; 2]);

/// Returns the least value of a number in `loops`, the outer ones first.
pub(super) fn least(number: &Linear, loops: &[Loop]) -> Linear {
    let mut least = number.clone();
    for (variable, [first, end]) in loops.iter().rev() {
        let worst = if least.factor(variable) > 0 {
            first.clone()
        } else {
            end.minus(&1.into())
        };
        least = least.with(variable, &worst);
    }
    least
}

/// True if two runs of bits, each a first bit and a number of bits, certainly have none in common.
pub(super) fn apart(a: &[Linear; 2], b: &[Linear; 2], loops: &[Loop]) -> bool {
    let before = |[first, width]: &[Linear; 2], [other, _]: &[Linear; 2]| {
        least(&other.minus(&first.plus(width)), loops).never_negative()
    };
    before(a, b) || before(b, a)
}

/// A number of bits: the greatest of some [`Linear`]s.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Dim(Vec<Linear>);

impl From<Linear> for Dim {
    fn from(bits: Linear) -> Self {
        Self(vec![bits])
    }
}

impl From<i64> for Dim {
    fn from(bits: i64) -> Self {
        Linear::from(bits).into()
    }
}

impl Dim {
    pub(super) fn parts(&self) -> &[Linear] {
        &self.0
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        let sums = self
            .0
            .iter()
            .flat_map(|a| other.0.iter().map(|b| a.plus(b)));
        Self(sums.collect()).reduced()
    }

    pub(super) fn add(&self, bits: &Linear) -> Self {
        Self(self.0.iter().map(|part| part.plus(bits)).collect())
    }

    pub(super) fn max(&self, other: &Self) -> Self {
        Self(self.0.iter().chain(&other.0).cloned().collect()).reduced()
    }

    /// Removes the parts that are never greater than another.
    fn reduced(self) -> Self {
        let mut kept: Vec<Linear> = Vec::new();
        for part in self.0 {
            if kept.iter().any(|other| other.minus(&part).never_negative()) {
                continue;
            }
            kept.retain(|other| !part.minus(other).never_negative());
            kept.push(part);
        }
        Self(kept)
    }

    pub(super) fn known(&self) -> Option<i64> {
        match self.0.as_slice() {
            [one] => one.known(),
            _ => None,
        }
    }

    /// Returns the number of bits as a `u32` of the generated code.
    pub(super) fn tokens(&self) -> TokenStream {
        let parts = self.0.iter().map(Linear::tokens);
        let all = parts.reduce(|a, b| quote!(::core::cmp::max(#a, #b)));
        all.unwrap_or_else(|| quote!(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use quote::format_ident;

    #[test]
    fn sums_are_written_plainly() {
        let [w, v] = ["W", "V"].map(|name| Linear::name(&format_ident!("{name}")));
        assert_eq!(w.plus(&w).plus(&3.into()).to_string(), "2 * W + 3");
        assert_eq!(w.minus(&v).minus(&1.into()).to_string(), "W - V - 1");
        assert_eq!(w.minus(&w).known(), Some(0));
        let fits = w.minus(&v).minus(&1.into()).never_negative_tokens();
        assert_eq!(fits.to_string(), "V + 1 <= W");
    }

    #[test]
    fn the_greatest_of_widths_is_as_short_as_it_can_be() {
        let w: Dim = Linear::name(&format_ident!("W")).into();
        assert_eq!(w.max(&w.add(&1.into())).tokens().to_string(), "W + 1");
        assert_eq!(Dim::from(4).max(&7.into()).known(), Some(7));
        assert_eq!(
            w.max(&7.into()).tokens().to_string(),
            ":: core :: cmp :: max (W , 7)"
        );
    }
}
