//! Writes an expression so that parsing it gives it back.

use super::{Expr, ExprNode, Id};
use std::fmt;

const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const SIGN: u8 = 3;
const POWER: u8 = 4;
const ATOM: u8 = 5;

enum Piece {
    Text(&'static str),
    Integer(i32),
    /// A node, in parentheses if it binds less than this.
    Node(Id, u8),
}

impl Expr {
    /// Number of nodes of the written expression, which repeats shared nodes: derivatives of nested
    /// `if_less` can have few nodes but a very long text.
    pub fn written_nodes(&self) -> u64 {
        let mut sizes: Vec<u64> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let parts = node.operands().map(|id| sizes[id.index()]);
            sizes.push(parts.fold(1, u64::saturating_add));
        }
        sizes[self.root.index()]
    }
}

impl fmt::Display for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // An explicit stack, because a long sum is as deep as it is long.
        let mut stack = vec![Piece::Node(self.root, SUM)];
        while let Some(piece) = stack.pop() {
            match piece {
                Piece::Text(text) => f.write_str(text)?,
                Piece::Integer(n) => write!(f, "{n}")?,
                Piece::Node(id, least) => {
                    let node = self.nodes[id.index()];
                    let (binds, pieces) = layout(node);
                    if binds < least {
                        f.write_str("(")?;
                        stack.push(Piece::Text(")"));
                    }
                    match node {
                        ExprNode::Number(value) => write!(f, "{}", Number(value))?,
                        ExprNode::Variable(variable) => f.write_str(variable.name())?,
                        _ => stack.extend(pieces.into_iter().rev()),
                    }
                }
            }
        }
        Ok(())
    }
}

/// Returns the binding strength of a node, and its pieces; a number or a variable has none.
fn layout(node: ExprNode) -> (u8, Vec<Piece>) {
    use Piece::{Integer, Text};
    let operand = Piece::Node;
    let call = |name, operands: &[Id]| {
        let mut pieces = vec![Text(name), Text("(")];
        for (i, id) in operands.iter().enumerate() {
            if i > 0 {
                pieces.push(Text(", "));
            }
            pieces.push(operand(*id, SUM));
        }
        pieces.push(Text(")"));
        (ATOM, pieces)
    };
    match node {
        ExprNode::Number(value) if value.is_sign_negative() => (SIGN, Vec::new()),
        ExprNode::Number(_) | ExprNode::Variable(_) => (ATOM, Vec::new()),
        ExprNode::Neg(a) => (SIGN, vec![Text("-"), operand(a, SIGN)]),
        ExprNode::Add(a, b) => (SUM, vec![operand(a, SUM), Text(" + "), operand(b, PRODUCT)]),
        ExprNode::Sub(a, b) => (SUM, vec![operand(a, SUM), Text(" - "), operand(b, PRODUCT)]),
        ExprNode::Mul(a, b) => (
            PRODUCT,
            vec![operand(a, PRODUCT), Text("*"), operand(b, SIGN)],
        ),
        ExprNode::Div(a, b) => (
            PRODUCT,
            vec![operand(a, PRODUCT), Text("/"), operand(b, SIGN)],
        ),
        ExprNode::Powi(a, n) => (POWER, vec![operand(a, ATOM), Text("^"), Integer(n)]),
        ExprNode::Pow(a, b) => call("pow", &[a, b]),
        ExprNode::Sqrt(a) => call("sqrt", &[a]),
        ExprNode::Abs(a) => call("abs", &[a]),
        ExprNode::Min(a, b) => call("min", &[a, b]),
        ExprNode::Max(a, b) => call("max", &[a, b]),
        ExprNode::Function(f, a) => call(f.name(), &[a]),
        ExprNode::Atan2(a, b) => call("atan2", &[a, b]),
        ExprNode::IfLess(a, b, x, y) => call("if_less", &[a, b, x, y]),
    }
}

/// A number in the shortest digits that give it back, without long runs of zeros.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.abs() == std::f64::consts::PI {
            f.write_str(if self.0 < 0.0 { "-pi" } else { "pi" })
        } else if self.0 != 0.0 && !(1e-4..1e15).contains(&self.0.abs()) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}
