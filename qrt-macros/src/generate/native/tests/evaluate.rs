//! Evaluation of written code for one path: the meaning of each method of the vectors, on integers.

use std::collections::HashMap;
use syn::{Expr, ExprMethodCall, File, ImplItem, Item, Lit, Pat, Stmt, UnOp};

/// The value of an expression.
#[derive(Clone, Debug)]
enum Value {
    Truth(bool),
    Int(i32),
    Long(i64),
    /// A constant argument.
    Constant(i64),
    /// A table, or the variables that a block returns.
    List(Vec<Value>),
    /// The instruction set.
    Vectors,
    /// The pixel's classical parameters.
    Words,
}

use Value::{Constant, Int, List, Long, Truth, Vectors, Words};

/// The state of the code on one path.
pub(super) struct Path<'a> {
    words: &'a [u64],
    variables: HashMap<String, Value>,
}

/// Returns the counts by channel, then the colours by channel, of the path of this `id`.
pub(super) fn outputs(file: &File, words: &[u64], id: u64) -> Vec<i64> {
    let mut path = Path {
        words,
        variables: HashMap::new(),
    };
    let given = [
        ("v", Vectors),
        ("words", Words),
        ("ids", Long(id.cast_signed())),
    ];
    path.variables
        .extend(given.map(|(name, value)| (name.to_owned(), value)));
    for item in &file.items {
        match item {
            Item::Static(table) => {
                let entries = path.value(&table.expr);
                path.variables.insert(table.ident.to_string(), entries);
            }
            Item::Impl(native) => {
                let Some(ImplItem::Fn(native)) = native.items.first() else {
                    panic!("no function");
                };
                return numbers(path.block(&native.block.stmts));
            }
            other => panic!("{other:?}"),
        }
    }
    panic!("no code")
}

fn numbers(value: Value) -> Vec<i64> {
    match value {
        Long(number) => vec![number],
        List(all) => all.into_iter().flat_map(numbers).collect(),
        other => panic!("{other:?}"),
    }
}

impl Path<'_> {
    /// Returns the value of the last expression.
    fn block(&mut self, statements: &[Stmt]) -> Value {
        let mut last = List(Vec::new());
        for statement in statements {
            match statement {
                Stmt::Local(local) => {
                    let value = self.value(&local.init.as_ref().unwrap().expr);
                    self.bind(&local.pat, value);
                }
                Stmt::Expr(value, None) => last = self.value(value),
                other => panic!("{other:?}"),
            }
        }
        last
    }

    fn bind(&mut self, pattern: &Pat, value: Value) {
        match (pattern, value) {
            (Pat::Ident(name), value) => {
                self.variables.insert(name.ident.to_string(), value);
            }
            (Pat::Tuple(names), List(values)) => {
                assert_eq!(names.elems.len(), values.len());
                for (name, value) in names.elems.iter().zip(values) {
                    self.bind(name, value);
                }
            }
            other => panic!("{other:?}"),
        }
    }

    fn value(&mut self, expression: &Expr) -> Value {
        match expression {
            Expr::Path(path) => {
                let name = path.path.get_ident().unwrap().to_string();
                let value = self.variables.get(&name).cloned();
                value.unwrap_or_else(|| panic!("no variable `{name}`"))
            }
            Expr::Lit(literal) => match &literal.lit {
                Lit::Int(number) => Constant(number.base10_parse().unwrap()),
                Lit::Bool(truth) => Truth(truth.value),
                other => panic!("{other:?}"),
            },
            Expr::Unary(minus) if matches!(minus.op, UnOp::Neg(_)) => {
                // The least integer has no positive counterpart.
                if let Expr::Lit(literal) = &*minus.expr
                    && let Lit::Int(number) = &literal.lit
                {
                    return Constant(format!("-{}", number.base10_digits()).parse().unwrap());
                }
                panic!("{minus:?}")
            }
            Expr::Reference(reference) => self.value(&reference.expr),
            Expr::Array(array) => List(array.elems.iter().map(|e| self.value(e)).collect()),
            Expr::Tuple(tuple) => List(tuple.elems.iter().map(|e| self.value(e)).collect()),
            Expr::Block(block) => self.block(&block.block.stmts),
            Expr::Cast(cast) => match self.value(&cast.expr) {
                Constant(value) => Constant((value as i32).into()),
                other => panic!("{other:?}"),
            },
            Expr::Closure(part) => self.value(&part.body),
            Expr::Call(call) if matches!(call.args[0], Expr::Closure(_)) => {
                self.value(&call.args[0])
            }
            Expr::Call(call) => {
                let given: Vec<Value> = call.args.iter().map(|a| self.value(a)).collect();
                let [Words, Constant(place), Constant(width), Truth(signed)] = given[..] else {
                    panic!("{given:?}");
                };
                let unused = 64 - width;
                let bits = self.words[place as usize] << unused;
                Constant(if signed {
                    bits.cast_signed() >> unused
                } else {
                    (bits >> unused).cast_signed()
                })
            }
            Expr::MethodCall(call) => self.method(call),
            other => panic!("{other:?}"),
        }
    }

    fn method(&mut self, call: &ExprMethodCall) -> Value {
        let of = self.value(&call.receiver);
        let given: Vec<Value> = call.args.iter().map(|a| self.value(a)).collect();
        let name = call.method.to_string();
        match of {
            Vectors => vectors(&name, &given),
            Truth(truth) => match (&*name, given.as_slice()) {
                ("and", [Truth(other)]) => Truth(truth & other),
                ("xor", [Truth(other)]) => Truth(truth ^ other),
                ("not", []) => Truth(!truth),
                _ => panic!("{truth:?}.{name}({given:?})"),
            },
            Int(a) => integers(&name, (a.into(), 32), &given),
            Long(a) => integers(&name, (a.into(), 64), &given),
            other => panic!("{other:?}.{name}"),
        }
    }
}

fn of_bits(value: i128, bits: u32) -> Value {
    if bits == 32 {
        Int(value as i32)
    } else {
        Long(value as i64)
    }
}

/// Returns the number, and the width of its lanes in bits.
fn number(value: &Value) -> (i128, u32) {
    match value {
        Int(value) => ((*value).into(), 32),
        Long(value) => ((*value).into(), 64),
        other => panic!("{other:?} is no number"),
    }
}

fn integers(name: &str, (a, bits): (i128, u32), given: &[Value]) -> Value {
    let other = |value: &Value| {
        let (number, others) = number(value);
        assert_eq!(others, bits, "{name} of lanes of two kinds");
        number
    };
    let within = |by: i64, end: u32| {
        assert!(
            (0..=i64::from(end)).contains(&by),
            "{a}: {bits} .{name} by {by}"
        );
        by
    };
    match (name, given) {
        ("add", [b]) => of_bits(a + other(b), bits),
        ("sub", [b]) => of_bits(a - other(b), bits),
        ("mul", [b]) => of_bits(a.wrapping_mul(other(b)), bits),
        ("xor", [b]) => of_bits(a ^ other(b), bits),
        ("left", [Constant(by)]) => of_bits(a << within(*by, bits - 1), bits),
        ("right", [Constant(by)]) => of_bits(a >> within(*by, bits - 1), bits),
        ("lowest", [Constant(kept)]) => {
            assert!(*kept > 0);
            of_bits(a & ((1 << within(*kept, bits - 1)) - 1), bits)
        }
        ("less", [b]) => Truth(a < other(b)),
        ("has", [Constant(mask)]) => {
            let mask = i128::from(*mask) & ((1 << bits) - 1);
            Truth(a & mask != 0)
        }
        ("choose", [Truth(when), b]) => {
            let b = other(b);
            of_bits(if *when { a } else { b }, bits)
        }
        _ => panic!("{a}.{name}({given:?})"),
    }
}

fn vectors(name: &str, given: &[Value]) -> Value {
    let entry = |table: &[Value], index: i32| {
        let index = index as usize & (table.len() - 1);
        match &table[index] {
            Constant(entry) => *entry,
            other => panic!("{other:?}"),
        }
    };
    match (name, given) {
        ("truths", [Truth(all)]) => Truth(*all),
        ("ints", [Constant(all)]) => Int(i32::try_from(*all).unwrap()),
        ("longs", [Constant(all)]) => Long(*all),
        ("widen", [Int(a)]) => Long((*a).into()),
        ("narrow", [Long(a)]) => Int(*a as i32),
        ("product_above", [Int(a), Int(b), Constant(drop @ 0..64)]) => {
            Int(((i64::from(*a) * i64::from(*b)) >> drop) as i32)
        }
        ("product", [Int(a), Int(b)]) => Long(i64::from(*a) * i64::from(*b)),
        ("product_of_longs", [Long(a), Long(b), Constant(drop)]) => {
            Long(((i128::from(*a) * i128::from(*b)) >> (*drop).min(127)) as i64)
        }
        ("quotient_single", [Int(a), Int(b), Constant(up)]) => {
            assert!((0..1 << 24).contains(a) && (0..1 << 24).contains(b));
            Int((*a as f32 * (*up as f32).exp2() / *b as f32) as i32)
        }
        ("quotient_double", [Long(a), Long(b)]) => {
            assert!((0..1 << 52).contains(a) && (0..1 << 52).contains(b));
            Long(a.checked_div(*b).unwrap_or(-1))
        }
        ("quotient_of_longs", [Long(a), Long(b)]) => {
            assert!(*a >= 0 && *b >= 0);
            Long(a.checked_div(*b).unwrap_or(-1))
        }
        ("root_single", [Int(a)]) => {
            assert!((0..1 << 23).contains(a));
            Int(a.isqrt())
        }
        ("root_double", [Long(a)]) => {
            assert!((0..1 << 52).contains(a));
            Long(a.isqrt())
        }
        ("root_of_longs", [Long(a)]) => Long(a.isqrt()),
        ("table16", [List(table), Int(index)]) => {
            assert_eq!(table.len(), 16);
            Int(entry(table, *index) as i32)
        }
        ("table32", [List(table), Int(index)]) => {
            assert_eq!(table.len(), 32);
            Int(entry(table, *index) as i32)
        }
        ("table", [List(table), Int(index)]) => Int(entry(table, *index) as i32),
        ("wide_table", [List(table), Int(index)]) => Long(entry(table, *index)),
        ("marks", [Constant(table), Int(index @ 0..32)]) => Truth(table >> index & 1 == 1),
        _ => panic!("v.{name}({given:?})"),
    }
}
