//! Square roots.
//!
//! Digit by digit without restoring, two bits of the radicand a step. Let Q be the root so far, q
//! its last bit and D the remainder. The next remainder is `4D + pair - (4Q + 1)` where q is 1, and
//! `4D + pair + (4Q + 3)` where q is 0. Both are `4D + pair + 3 + 4 (Q ^ q)`, with all bits of Q
//! flipped where q is 1, so a step is one addition. The sign of the result is the complement of the
//! root's next bit, and its qubit becomes that bit. After j steps D has j + 2 bits: k(k + 1)/2
//! Toffolis for a root of k bits, out of place.

use super::super::{Style, Word};
use super::{GateSink, Lowering, Qubit, Wire, qubits};

impl Lowering {
    pub(super) fn root(&mut self, a: Word, style: Style, target: &[Qubit]) {
        let k = a.bits().div_ceil(2) as usize;
        let a = self.word(a, 2 * k);
        match style {
            Style::OutOfPlace => {
                let mut root = target[..k.min(target.len())].to_vec();
                root.extend(self.allocate_garbage(k - root.len()));
                let mut rest = vec![Wire::ZERO];
                for step in 0..k {
                    let place = k - 1 - step;
                    let mut number = vec![a[2 * place], a[2 * place + 1]];
                    number.append(&mut rest);
                    let mut t = self.allocate_garbage(step + 2);
                    t.push(root[place]);
                    let row = self.turn(&root, step);
                    self.add(&number, &row, Wire::ZERO, &t);
                    self.turn(&root, step);
                    self.x(root[place]);
                    t.pop();
                    rest = qubits(&t);
                }
            }
            Style::InPlace => {
                let mut all = self.allocate_garbage(k + 1);
                all.extend_from_slice(&target[..k.min(target.len())]);
                let missing = 2 * k + 1 - all.len();
                all.extend(self.allocate_garbage(missing));
                for (wire, t) in a.iter().zip(&all) {
                    self.copy(*wire, *t);
                }
                let root = all[k + 1..].to_vec();
                for step in 0..k {
                    let place = k - 1 - step;
                    let window = &all[2 * place..=2 * k - step];
                    let row = self.turn(&root, step);
                    self.add_into(&row, false, Wire::ONE, window);
                    self.turn(&root, step);
                    self.x(root[place]);
                }
            }
        }
    }

    /// Flips the root's first bits where the last of them is 1, and returns the step's addend. A
    /// second call flips them back.
    fn turn(&mut self, root: &[Qubit], step: usize) -> Vec<Wire> {
        let Some(last) = step.checked_sub(1).map(|before| root.len() - 1 - before) else {
            return vec![Wire::ONE; 3];
        };
        let mut row = vec![Wire::ONE, Wire::ONE, Wire::ZERO];
        for bit in &root[last + 1..] {
            self.cx(root[last], *bit);
            row.push(Wire::qubit(*bit));
        }
        row.push(Wire::qubit(root[last]));
        row
    }
}
