//! Programs of operations of given kinds, on random operands.

use qrt::circuit::{
    Bit, BlockId, Instruction, Op, Operand, Program, Register, RegisterId, Style, Type, Word,
};
use std::sync::Arc;

/// Kinds of operations, in turn: `+` add, `k` subtract a constant, `<` less, `&` and, `?` select,
/// `n` negate, `*` multiply, `c` scale, `/` divide, `r` square root, `t` a table of 32 entries.
pub(crate) const MIXES: [(&str, &str); 12] = [
    ("add", "+"),
    ("add constant", "k"),
    ("less", "<"),
    ("and", "&"),
    ("select", "?"),
    ("negate", "n"),
    ("multiply", "*"),
    ("scale", "c"),
    ("divide", "/"),
    ("square root", "r"),
    ("table", "t"),
    ("mixed", "++*?<&nkc+*?++*+<&+*t"),
];

/// Kinds that take a few instructions on a lane.
pub(crate) const SIMPLE: [&str; 6] = ["add", "add constant", "less", "and", "select", "negate"];

/// Number of operations of the given kinds, before the ones that gather unread results.
const OPS: usize = 3000;

struct Maker {
    program: Program,
    numbers: Vec<RegisterId>,
    truths: Vec<RegisterId>,
    width: u32,
    state: u64,
}

/// Returns a program on numbers of `width` bits, and the words to read, which depend on all operations.
pub(crate) fn program(width: u32, kinds: &str) -> (Program, [Word; 2]) {
    let mut maker = Maker {
        program: Program::default(),
        numbers: Vec::new(),
        truths: Vec::new(),
        width,
        state: 1,
    };
    let id = maker.register(16, Type::UInt);
    maker.program.inputs = vec![id];
    for _ in 0..8 {
        let columns = (0..16).map(|_| maker.draw() << 20 ^ maker.draw()).collect();
        let target = maker.number();
        maker.push(Op::Parity {
            source: id,
            columns,
            parameter: None,
            target,
        });
    }
    maker.op('<');
    let kinds: Vec<char> = kinds.chars().collect();
    for place in 0..OPS {
        maker.op(kinds[place % kinds.len()]);
    }
    maker.gather();
    let number = maker.word(maker.numbers[maker.numbers.len() - 1]);
    let truth = Word {
        register: maker.truths[maker.truths.len() - 1],
        offset: 0,
        width: 1,
        signed: false,
        shift: 0,
    };
    (maker.program, [number, truth])
}

impl Maker {
    fn draw(&mut self) -> u64 {
        let step = self.state.wrapping_mul(6_364_136_223_846_793_005);
        self.state = step.wrapping_add(1_442_695_040_888_963_407);
        self.state >> 33
    }

    fn register(&mut self, width: u32, ty: Type) -> RegisterId {
        let id = RegisterId(self.program.registers.len() as u32);
        self.program.registers.push(Register::new("", ty, width));
        id
    }

    fn number(&mut self) -> RegisterId {
        let fraction = self.width - 3;
        let number = self.register(self.width, Type::Fixed { fraction });
        self.numbers.push(number);
        number
    }

    fn truth(&mut self) -> RegisterId {
        let truth = self.register(1, Type::Bool);
        self.truths.push(truth);
        truth
    }

    fn push(&mut self, op: Op) {
        self.program.instructions.push(Instruction {
            op: self.program.ops.len() as u32,
            inverse: false,
            block: BlockId::ROOT,
        });
        self.program.ops.push(op);
    }

    fn word(&self, register: RegisterId) -> Word {
        Word {
            register,
            offset: 0,
            width: self.width,
            signed: true,
            shift: 0,
        }
    }

    /// Returns one of the latest registers, mostly.
    fn old(&mut self, truths: bool) -> RegisterId {
        let far = self.draw().is_multiple_of(4);
        let draw = self.draw() as usize;
        let all = if truths { &self.truths } else { &self.numbers };
        let back = draw % all.len().min(if far { 60 } else { 8 });
        all[all.len() - 1 - back]
    }

    fn bit(&mut self) -> Bit {
        Bit {
            register: self.old(true),
            index: 0,
            inverted: false,
        }
    }

    fn op(&mut self, kind: char) {
        let (x, y) = (self.old(false), self.old(false));
        let (a, b) = (self.word(x), self.word(y));
        let unsigned = |word: Word| Word {
            width: word.width - 1,
            signed: false,
            ..word
        };
        let (number, other) = (Operand::Word(a), Operand::Word(b));
        let (style, drop) = (Style::OutOfPlace, self.width - 3);
        let scratch = x;
        let subtract = kind == 'k';
        let op = match kind {
            '+' | 'k' => Op::Add {
                a: number,
                b: if subtract {
                    Operand::Constant(77)
                } else {
                    other
                },
                subtract,
                target: self.number(),
            },
            '<' => Op::Less {
                a: number,
                b: other,
                target: self.truth(),
            },
            '&' => Op::And {
                a: self.bit(),
                b: self.bit(),
                target: self.truth(),
            },
            '?' => Op::Select {
                when: self.bit(),
                a: number,
                b: other,
                target: self.number(),
            },
            'n' => Op::Negate {
                a,
                when: self.bit(),
                target: self.number(),
            },
            '*' => Op::Multiply {
                a,
                b,
                drop,
                style,
                target: self.number(),
                scratch,
            },
            'c' => Op::Scale {
                a,
                factor: 1234,
                drop,
                style,
                target: self.number(),
                scratch,
            },
            '/' => Op::Divide {
                a: unsigned(a),
                b: unsigned(b),
                style,
                quotient: self.number(),
                fits: self.truth(),
                scratch,
            },
            'r' => Op::SquareRoot {
                a: unsigned(a),
                style,
                target: self.number(),
                scratch,
            },
            _ => {
                let bits = (0..5).map(|index| Bit {
                    register: x,
                    index,
                    inverted: false,
                });
                let entries = (0..32).map(|_| self.draw() as i64);
                let column: Arc<[i64]> = entries.collect();
                let columns = vec![column];
                Op::Table {
                    style: Style::OutOfPlace,
                    address: bits.collect(),
                    columns: columns.into(),
                    low: 0,
                    targets: Box::new([self.number()]),
                    scratch,
                }
            }
        };
        self.push(op);
    }

    /// Adds up the registers that no operation reads, so that the program needs all of them.
    fn gather(&mut self) {
        let mut read = vec![false; self.program.registers.len()];
        for op in &self.program.ops {
            for register in op.reads() {
                read[register.index()] = true;
            }
        }
        let unread = |all: &[RegisterId]| -> Vec<RegisterId> {
            all.iter().copied().filter(|r| !read[r.index()]).collect()
        };
        let (numbers, truths) = (unread(&self.numbers), unread(&self.truths));
        for pair in numbers.windows(2) {
            let last = self.numbers[self.numbers.len() - 1];
            let sum = [last, pair[0]].map(|register| Operand::Word(self.word(register)));
            let target = self.number();
            self.push(Op::Add {
                a: sum[0],
                b: sum[1],
                subtract: false,
                target,
            });
        }
        for pair in truths.windows(2) {
            let last = self.truths[self.truths.len() - 1];
            let [a, b] = [last, pair[0]].map(|register| Bit {
                register,
                index: 0,
                inverted: false,
            });
            let target = self.truth();
            self.push(Op::Xor { a, b, target });
        }
    }
}
