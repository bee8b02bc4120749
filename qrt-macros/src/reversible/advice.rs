//! The right thing to write in place of what has no inverse.

use super::ir::Place;
use super::source::{bare, text};
use syn::{BinOp, Expr, ExprBinary, UnOp};

/// Returns the advice for an update that reads what it changes.
pub(super) fn elsewhere(target: &Place, update: &ExprBinary) -> String {
    let part = target
        .part
        .as_ref()
        .map_or_else(String::new, |[first, width]| match width.known() {
            Some(1) => format!("[{first}]"),
            _ => format!("[{first}..{}]", first.plus(width)),
        });
    let (left, right, operator) = (text(&update.left), text(&update.right), text(update.op));
    let copy = match update.op {
        BinOp::BitXorAssign(_) => "^=",
        _ => "+=",
    };
    format!(
        "write `out{part} {copy} {left}; out{part} {operator} {right};` into another register, `out`"
    )
}

/// Returns the advice for `left = right`.
pub(super) fn assignment(left: &str, right: &Expr, is_bit: bool) -> String {
    match right {
        Expr::Paren(inner) => return assignment(left, &inner.expr, is_bit),
        Expr::Unary(unary) if matches!(unary.op, UnOp::Not(_)) && bare(&unary.expr) == left => {
            if is_bit {
                return format!("write `{left} ^= true`");
            }
            return format!("write `out ^= !{left}` into another register");
        }
        Expr::Binary(binary) => {
            let (a, b) = (bare(&binary.left), bare(&binary.right));
            let update = match binary.op {
                BinOp::Add(_) => Some(("+=", true)),
                BinOp::BitXor(_) => Some(("^=", true)),
                BinOp::Sub(_) => Some(("-=", false)),
                _ => None,
            };
            match update {
                Some((update, _)) if a == left && !mentions(&binary.right, left) => {
                    return format!("write `{left} {update} {b}`");
                }
                Some((update, true)) if b == left && !mentions(&binary.left, left) => {
                    return format!("write `{left} {update} {a}`");
                }
                _ => {}
            }
        }
        _ => {}
    }
    // A sum is added term by term, so that a difference need not fit as a whole.
    let update = if is_bit { "^=" } else { "+=" };
    let shown = bare(right);
    if mentions(right, left) {
        return format!("write `out {update} {shown}` into another register");
    }
    format!("write `{left} {update} {shown}`, into a register that is 0 before")
}

/// True if an expression names what is written on the left.
fn mentions(expression: &Expr, left: &str) -> bool {
    let name = left.split(['[', '.', ' ']).next().unwrap_or(left);
    let text = text(expression);
    let mut words = text.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
    words.any(|word| word == name)
}

/// Returns the advice for an update that forgets bits; `None` if it is no update.
pub(super) fn no_update(update: &ExprBinary) -> Option<String> {
    let (left, right) = (bare(&update.left), bare(&update.right));
    let power = power_of_two(&update.right);
    let written = match (update.op, power) {
        (BinOp::MulAssign(_), _) => format!("out += {left} * {right}"),
        (BinOp::ShrAssign(_), _) => format!("out += {left} >> {right}"),
        (BinOp::ShlAssign(_), _) => format!("out += {left} << {right}"),
        (BinOp::DivAssign(_), Some(bits)) => format!("out += {left} >> {bits}"),
        (BinOp::RemAssign(_), Some(bits)) => format!("out += {left}[0..{bits}]"),
        (BinOp::BitAndAssign(_), _) => format!("out ^= {left} & {right}"),
        (BinOp::BitOrAssign(_), _) => format!("out ^= {left} | {right}"),
        (BinOp::DivAssign(_) | BinOp::RemAssign(_), None) => {
            let by_hand = "divide by powers of two only, by `>>` and by the lowest bits `a[0..4]`";
            return Some(by_hand.to_owned());
        }
        _ => return None,
    };
    Some(format!("write `{written}` into another register"))
}

/// Returns the advice for an operator that numbers do not have.
pub(super) fn operator(binary: &ExprBinary) -> String {
    let left = bare(&binary.left);
    match (binary.op, power_of_two(&binary.right)) {
        (BinOp::Div(_), Some(bits)) => format!("write `{left} >> {bits}`"),
        (BinOp::Rem(_), Some(bits)) => format!("write `{left}[0..{bits}]`"),
        (BinOp::Div(_) | BinOp::Rem(_), None) => {
            "divide by powers of two only, by `>>` and by the lowest bits `a[0..4]`".to_owned()
        }
        _ => in_scratch(binary),
    }
}

/// Returns the advice for what stands only behind `^=`.
pub(super) fn in_scratch(expression: impl quote::ToTokens) -> String {
    let shown = text(expression);
    format!("write `within! {{ t ^= {shown}; }} apply! {{ .. }}`, with a scratch register `t`")
}

/// Returns the exponent of a power of two, if the expression is one above 1.
fn power_of_two(expression: &Expr) -> Option<u32> {
    let units = super::scope::integer(expression).filter(|units| *units > 1)?;
    (units & (units - 1) == 0).then(|| units.trailing_zeros())
}
