//! Groups of edges that are undone at their ends.
//!
//! A group computes the sides on which a ray passes its edges: bits, the top ones of sums. If its work is
//! undone at its end, the whole of each register that others read is kept. So each group computes its products
//! itself, even those that another group has, and copies the bits that others read.

use super::draft::Draft;
use super::{Label, StageName};
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{Bit, BlockId, Op, Register, RegisterId, Type, Word};

struct Separation<'a> {
    registers: &'a mut Vec<Register>,
    ops: Vec<(Op, BlockId)>,
    /// By register: the product in a group that computes it.
    products: Vec<Option<(Op, BlockId)>>,
    /// The products that groups repeat.
    repeated: QuickMap<(RegisterId, BlockId), RegisterId>,
    /// The bits of groups that others read, and their copies once they are made.
    bits: QuickMap<(RegisterId, u32), Option<RegisterId>>,
}

/// Makes the groups of a draft independent of each other.
pub(super) fn separate(draft: &mut Draft) {
    let stage = |block| Label::from_block(block).stage;
    let is_group = |block| matches!(stage(block), StageName::Edges(_));
    let groups: Vec<bool> = draft.blocks.iter().map(is_group).collect();
    if !groups.contains(&true) {
        return;
    }
    let bits = bits_read(draft, &groups);
    let all = std::mem::take(&mut draft.ops);
    let mut separation = Separation {
        products: vec![None; draft.registers.len()],
        registers: &mut draft.registers,
        ops: Vec::with_capacity(all.len()),
        repeated: QuickMap::default(),
        bits,
    };
    for (op, block) in all {
        if groups[block.index()] {
            separation.within(op, block);
        } else {
            separation.outside(op, block);
        }
    }
    draft.ops = separation.ops;
}

/// The bits of registers of groups that conjunctions outside the groups read.
fn bits_read(draft: &Draft, groups: &[bool]) -> QuickMap<(RegisterId, u32), Option<RegisterId>> {
    let mut computed = vec![false; draft.registers.len()];
    let mut bits = QuickMap::default();
    for (op, block) in &draft.ops {
        if groups[block.index()] {
            for target in op.targets() {
                computed[target.index()] = true;
            }
        } else if let Op::And { a, b, .. } = op {
            for bit in [a, b] {
                if computed[bit.register.index()] && draft.registers[bit.register.index()].width > 1
                {
                    bits.insert((bit.register, bit.index), None);
                }
            }
        }
    }
    bits
}

impl Separation<'_> {
    fn register(&mut self, register: Register) -> RegisterId {
        self.registers.push(register);
        RegisterId(self.registers.len() as u32 - 1)
    }

    fn within(&mut self, op: Op, block: BlockId) {
        for read in op.reads() {
            if let Some(Some((product, own))) = self.products.get(read.index())
                && *own != block
                && !self.repeated.contains_key(&(read, block))
            {
                let product = product.clone();
                let again = product.map(
                    |read| read,
                    |original: RegisterId| {
                        let original = self.registers[original.index()].clone();
                        self.register(Register { block, ..original })
                    },
                );
                let targets = again.targets().into_iter();
                self.repeated
                    .extend(targets.map(|own| ((read, block), own)));
                self.ops.push((again, block));
            }
        }
        let own = |read| self.repeated.get(&(read, block)).copied().unwrap_or(read);
        let op = op.map(own, |target| target);
        let targets = op.targets();
        if matches!(op, Op::Scale { .. }) {
            for target in &targets {
                self.products[target.index()] = Some((op.clone(), block));
            }
        }
        self.ops.push((op, block));
        for target in targets {
            for index in 0..self.registers[target.index()].width {
                if self.bits.contains_key(&(target, index)) {
                    self.copy_bit(target, index, block);
                }
            }
        }
    }

    fn copy_bit(&mut self, register: RegisterId, index: u32, block: BlockId) {
        let original = self.registers[register.index()].clone();
        let target = self.register(Register {
            name: format!("{}.{index}", original.name),
            ty: Type::Bool,
            width: 1,
            range: None,
            ..original
        });
        let a = Word {
            register,
            offset: index,
            width: 1,
            signed: false,
            shift: 0,
        };
        self.ops.push((Op::Copy { a, target }, block));
        self.bits.insert((register, index), Some(target));
    }

    fn outside(&mut self, op: Op, block: BlockId) {
        let copied = |bit: Bit| match self.bits.get(&(bit.register, bit.index)) {
            Some(&Some(register)) => Bit {
                register,
                index: 0,
                ..bit
            },
            _ => bit,
        };
        let op = match op {
            Op::And { a, b, target } => Op::And {
                a: copied(a),
                b: copied(b),
                target,
            },
            other => other,
        };
        self.ops.push((op, block));
    }
}
