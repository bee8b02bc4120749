//! Inputs of a program in registers, and their comparison with computed values.

use super::number::RegisterShape;
use super::value::{Affine, BoolValue, Index, RealValue, Value};
use super::{Bit, Builder, Op, Operand, RegisterId, Role, StageName, Type};

impl Builder<'_> {
    /// Creates an input register for a number from 0 to `most`. Returns the register and the
    /// number.
    pub(crate) fn given_number(
        &mut self,
        name: &str,
        role: Role,
        most: f64,
    ) -> (RegisterId, RealValue) {
        let most = self.rounded(most);
        let RegisterShape { ty, width, signed } = self.shape([0, most]);
        let register = self.outside(name, ty, role, width);
        let number = self.value(Value {
            range: [0, most],
            word: Some(Self::whole(register, width, signed)),
            table: None,
        });
        (register, number)
    }

    /// An input register that holds a number from `-most` to `most`, and the number.
    #[cfg(test)]
    pub(crate) fn given_signed(&mut self, name: &str, most: f64) -> (RegisterId, RealValue) {
        let most = self.rounded(most);
        let RegisterShape { ty, width, signed } = self.shape([-most, most]);
        let register = self.outside(name, ty, Role::Id, width);
        let number = self.value(Value {
            range: [-most, most],
            word: Some(Self::whole(register, width, signed)),
            table: None,
        });
        (register, number)
    }

    /// Creates an input register of `width` bits for an integer. Returns the register and the
    /// integer.
    pub(crate) fn given_index(
        &mut self,
        name: &str,
        role: Role,
        width: u32,
    ) -> (RegisterId, Index) {
        let register = self.outside(name, Type::UInt, role, width);
        let index = self.choice_of(Self::whole(register, width, false));
        (register, index)
    }

    /// `a < b`
    pub(crate) fn index_less(&mut self, a: Index, b: Index) -> BoolValue {
        let (a, b) = (self.choice_operand(a), self.choice_operand(b));
        if let (Operand::Constant(a), Operand::Constant(b)) = (a, b) {
            return BoolValue::Constant(a < b);
        }
        let target = self.emit(Op::Less {
            a,
            b,
            target: (Type::Bool, 1),
        })[0];
        self.truth_of(Bit {
            register: target,
            index: 0,
            inverted: false,
        })
    }

    /// The bit that holds the truth value `a`; none if `a` is the same on every path.
    pub(crate) fn truth_bit(&mut self, a: BoolValue) -> Option<Bit> {
        matches!(a, BoolValue::Node { .. }).then(|| self.bit(a))
    }

    /// Opens the block of the comparison with the nearest hit so far.
    /// [`qrt_tracer::Arith::leave`] closes the block.
    pub(crate) fn enter_nearer(&mut self) {
        self.begin(StageName::Nearer, None);
    }

    /// Returns the number without its constant, and the bound to compare it with: row `row` of
    /// `table`, minus the constant, plus one ulp in the direction of `sign`. The table contains
    /// both shifts, so neither costs an addition. A number whose offset depends on the pixel keeps
    /// its offset.
    pub(super) fn beside(
        &mut self,
        value: RealValue,
        table: &[[f64; 1]],
        row: Index,
        sign: f64,
    ) -> (RealValue, RealValue) {
        let outward = sign * self.ulp();
        if !value.offset.is_constant() {
            let bound = self.row(row, table.len(), |row| {
                table.get(row).map_or(0.0, |[bound]| bound + outward)
            });
            return (value, bound);
        }
        let moved = outward - (value.offset.constant + value.bias);
        let bound = self.row(row, table.len(), |row| {
            table.get(row).map_or(0.0, |[bound]| bound + moved)
        });
        let bare = RealValue {
            offset: Affine::ZERO,
            bias: 0.0,
            ..value
        };
        (bare, bound)
    }
}
