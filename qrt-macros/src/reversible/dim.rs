//! Widths, places of bits and numbers of passes: linear in the constants that a routine is generic
//! over and in the variables of its loops.

use proc_macro2::{Literal, TokenStream};
use quote::quote;
use std::collections::BTreeMap;
use syn::Ident;

/// `constant + sum of factor * name`. Names stand for numbers that are not negative.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Linear {
    pub(super) constant: i64,
    terms: BTreeMap<Ident, i64>,
}

impl From<i64> for Linear {
    fn from(constant: i64) -> Self {
        Self {
            constant,
            terms: BTreeMap::new(),
        }
    }
}

impl Linear {
    pub(super) fn name(name: &Ident) -> Self {
        Self {
            constant: 0,
            terms: [(name.clone(), 1)].into(),
        }
    }

    pub(super) fn plus(&self, other: &Self) -> Self {
        let mut sum = self.clone();
        sum.constant = sum.constant.saturating_add(other.constant);
        for (name, factor) in &other.terms {
            let own = sum.terms.entry(name.clone()).or_default();
            *own = own.saturating_add(*factor);
        }
        sum.terms.retain(|_, factor| *factor != 0);
        sum
    }

    pub(super) fn times(&self, factor: i64) -> Self {
        let terms = self.terms.iter().filter(|_| factor != 0);
        Self {
            constant: self.constant.saturating_mul(factor),
            terms: terms
                .map(|(name, own)| (name.clone(), own.saturating_mul(factor)))
                .collect(),
        }
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        self.plus(&other.times(-1))
    }

    /// The number, if it depends on nothing.
    pub(super) fn known(&self) -> Option<i64> {
        self.terms.is_empty().then_some(self.constant)
    }

    /// Whether it is known not to be negative, whatever the names stand for.
    pub(super) fn never_negative(&self) -> bool {
        self.constant >= 0 && self.terms.values().all(|factor| *factor >= 0)
    }

    pub(super) fn is_zero(&self) -> bool {
        self.known() == Some(0)
    }

    pub(super) fn factor(&self, name: &Ident) -> i64 {
        self.terms.get(name).copied().unwrap_or(0)
    }

    /// The same sum with `value` in place of `name`.
    pub(super) fn with(&self, name: &Ident, value: &Self) -> Self {
        let factor = self.factor(name);
        let mut rest = self.clone();
        rest.terms.remove(name);
        rest.plus(&value.times(factor))
    }

    /// Its parts that are added and those that are subtracted.
    fn sides(&self) -> [Self; 2] {
        let side = |sign: i64| Self {
            constant: (self.constant * sign).max(0),
            terms: self
                .terms
                .iter()
                .filter(|(_, factor)| **factor * sign > 0)
                .map(|(name, factor)| (name.clone(), factor * sign))
                .collect(),
        };
        [side(1), side(-1)]
    }

    /// As a `u32` of the generated code.
    pub(super) fn tokens(&self) -> TokenStream {
        let [plus, minus] = self.sides();
        let mut all = plus.sum();
        if minus != Self::from(0) {
            for part in minus.parts() {
                all = quote!(#all - #part);
            }
        }
        all
    }

    /// That it is not negative, as a condition of the generated code without a negative number.
    pub(super) fn never_negative_tokens(&self) -> TokenStream {
        let [plus, minus] = self.sides();
        let (plus, minus) = (plus.sum(), minus.sum());
        quote!(#minus <= #plus)
    }

    fn sum(&self) -> TokenStream {
        let parts = self.parts();
        let Some((first, rest)) = parts.split_first() else {
            return quote!(0);
        };
        rest.iter()
            .fold(first.clone(), |sum, part| quote!(#sum + #part))
    }

    fn parts(&self) -> Vec<TokenStream> {
        let terms = self.terms.iter().map(|(name, factor)| {
            if *factor == 1 {
                return quote!(#name);
            }
            let factor = Literal::i64_unsuffixed(*factor);
            quote!(#factor * #name)
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
        f.write_str(&self.tokens().to_string())
    }
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

    /// Without the parts that are never greater than another.
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

    /// As a `u32` of the generated code.
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
