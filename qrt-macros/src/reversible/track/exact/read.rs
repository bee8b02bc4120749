//! The operands of statements, as polynomials.

use super::{Exact, Known, Poly, Unknown};
use crate::reversible::dim::{Dim, Linear};
use crate::reversible::ir::{Bit, Entry, Number, NumberKind, Register};

impl Exact {
    /// Returns the number of the word of all of a register's current bits.
    pub(super) fn number_of(&mut self, register: &str) -> u32 {
        let bits = self.bits(register);
        self.touch(register, 0..bits.len());
        self.atoms.word(&bits)
    }

    pub(super) fn read(
        &mut self,
        register: &Register,
        first: &Linear,
        width: usize,
    ) -> Known<Vec<Poly>> {
        let first = self.known(first)? as usize;
        let name = self.name(register)?;
        self.touch(&name, first..first + width);
        let bits = self.bits(&name);
        Ok(bits.into_iter().skip(first).take(width).collect())
    }

    /// Returns the lowest `width` bits of a number.
    pub(super) fn word(&mut self, number: &Number, width: usize) -> Known<Vec<Poly>> {
        // The lowest bits of an entry are the same bits, by whatever number of them.
        if let NumberKind::Entry(..) = &number.kind {
            let name = self.computed(&number.kind)?;
            return Ok(self.atoms.bits(&name, width));
        }
        let own = self.width(&number.size.width)?;
        let mut bits = match &number.kind {
            NumberKind::Constant(units) => {
                let bit = |place: usize| Poly::constant(units >> place.min(63) & 1 == 1);
                return Ok((0..width).map(bit).collect());
            }
            NumberKind::Given(value) => match self.known(value) {
                Ok(value) => {
                    let bit = |place: usize| Poly::constant(value >> place.min(63) & 1 == 1);
                    return Ok((0..width).map(bit).collect());
                }
                Err(Unknown) => self.atoms.bits(&value.to_string(), own),
            },
            NumberKind::Word(register, first) => self.read(register, first, own)?,
            NumberKind::Truth(bit) => vec![self.bit(bit)?],
            NumberKind::Shifted(inner, by) => {
                let by = self.known(by)? as usize;
                let mut bits = vec![Poly::default(); by.min(width)];
                bits.extend(self.word(inner, width.saturating_sub(by))?);
                return Ok(bits);
            }
            NumberKind::Dropped(inner, by) => {
                let by = self.known(by)? as usize;
                return Ok(self.word(inner, width + by)?.split_off(by));
            }
            NumberKind::Pointed(inner) => return self.word(inner, width),
            computed => {
                let name = self.computed(computed)?;
                self.atoms.bits(&name, own)
            }
        };
        let sign = match bits.last() {
            Some(top) if number.size.signed => top.clone(),
            _ => Poly::default(),
        };
        bits.resize(width, sign);
        Ok(bits)
    }

    /// Returns the name of the result of an operation.
    pub(super) fn computed(&mut self, kind: &NumberKind) -> Known<String> {
        Ok(match kind {
            NumberKind::Product(a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                format!("product {} {}", (&a).min(&b), (&a).max(&b))
            }
            NumberKind::Entry(table, entry) => {
                let place = match &**entry {
                    Entry::At(place) => self.known(place)?.to_string(),
                    Entry::Of(place, width) => {
                        let first = place.part.as_ref().map(|[first, _]| first.clone());
                        let first = first.unwrap_or_else(|| 0.into());
                        let bits = self.read(&place.register, &first, *width as usize)?;
                        format!("of {}", self.atoms.word(&bits))
                    }
                };
                format!("{} {place}", table.path)
            }
            NumberKind::Square(a) => {
                let a = self.number(a)?;
                format!("product {a} {a}")
            }
            NumberKind::Sum(terms) => {
                let mut parts = Vec::new();
                for (subtracted, term) in terms {
                    let sign = if *subtracted { '-' } else { '+' };
                    parts.push(format!("{sign}{}", self.number(term)?));
                }
                parts.sort_unstable();
                format!("sum {}", parts.join(" "))
            }
            _ => return Err(Unknown),
        })
    }

    /// Returns the name of a number: equal for equal numbers.
    pub(super) fn number(&mut self, number: &Number) -> Known<String> {
        let width = self.width(&number.size.width)?;
        let bits = self.word(number, width)?;
        let sign = if number.size.signed { "s" } else { "u" };
        let fraction = self.known(&number.size.fraction)?;
        Ok(format!("{}{sign}{fraction}", self.atoms.word(&bits)))
    }

    pub(super) fn bit(&mut self, bit: &Bit) -> Known<Poly> {
        Ok(match bit {
            Bit::Constant(value) => Poly::constant(*value),
            Bit::At(register, index) => {
                let bits = self.read(register, index, 1)?;
                bits.into_iter().next().ok_or(Unknown)?
            }
            Bit::Not(inner) => self.bit(inner)?.not(),
            Bit::And(a, b) => {
                let (a, b) = (self.bit(a)?, self.bit(b)?);
                a.and(&b, &mut self.atoms)
            }
            Bit::Xor(a, b) => {
                let (a, b) = (self.bit(a)?, self.bit(b)?);
                a.xor(&b)
            }
            Bit::Less(a, b) => {
                let name = format!("{} < {}", self.number(a)?, self.number(b)?);
                Poly::atom(self.atoms.named(&name))
            }
            Bit::Equal(a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                let name = format!("{} = {}", (&a).min(&b), (&a).max(&b));
                Poly::atom(self.atoms.named(&name))
            }
        })
    }

    /// Returns the number in the current passes of the loops around.
    pub(super) fn known(&self, number: &Linear) -> Known<i64> {
        let loops = self.loops.iter().rev();
        let number = loops.fold(number.clone(), |number, (variable, pass)| {
            number.with(variable, &Linear::from(*pass))
        });
        number.known().ok_or(Unknown)
    }

    pub(super) fn width(&self, width: &Dim) -> Known<usize> {
        let parts = width.parts().iter().map(|part| self.known(part));
        let parts: Vec<i64> = parts.collect::<Known<_>>()?;
        Ok(parts.into_iter().max().unwrap_or(0).max(0) as usize)
    }
}
