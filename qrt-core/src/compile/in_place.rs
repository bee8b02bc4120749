//! Sums that are computed into the register of one of their operands.
//!
//! The register, the host's, then holds one of the two numbers at a time. It is wide enough for both.

use super::draft::Draft;
use qrt_circuit::lower::QuickMap;
use qrt_circuit::{Op, Operand, Register, RegisterId, When, Word};

/// A sum that is computed into the register of an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Hosted {
    /// The place of the operation that computes the operand.
    pub(super) host: usize,
    /// The place of the sum.
    pub(super) sum: usize,
    /// The operand, as the sum reads it.
    word: Word,
    /// The number that is added to it.
    addend: Operand,
    subtract: bool,
}

/// The sums of `draft` that may be computed in place, each into each of its operands.
pub(super) fn sums_in_place(draft: &Draft) -> Vec<Hosted> {
    let mut computed: QuickMap<RegisterId, usize> = QuickMap::default();
    for (place, (op, _)) in draft.ops.iter().enumerate() {
        if let [target] = op.targets()[..] {
            computed.insert(target, place);
        }
    }
    let is_whole = |word: &Word| {
        let register = &draft.registers[word.register.index()];
        (word.offset, word.shift, word.width) == (0, 0, register.width)
    };
    let hosted = |sum: usize, operand: Operand, addend: Operand, subtract: bool| {
        let Operand::Word(word) = operand else {
            return None;
        };
        let is_own = matches!(addend, Operand::Word(other) if other.register == word.register);
        let host = *computed.get(&word.register)?;
        (is_whole(&word) && !is_own).then_some(Hosted {
            host,
            sum,
            word,
            addend,
            subtract,
        })
    };
    let sums = draft.ops.iter().enumerate().flat_map(|(sum, (op, _))| {
        let &Op::Add { a, b, subtract, .. } = op else {
            return [None, None];
        };
        let second = if subtract {
            None
        } else {
            hosted(sum, b, a, false)
        };
        [hosted(sum, a, b, subtract), second]
    });
    sums.flatten().collect()
}

/// Returns `draft` with the sums of `hosted` computed in place, each at its place among the operations. `None` if
/// widening a register would change a number, if a sum would read the register that it changes, or if two sums are
/// inverses of each other, which a recorder of the program would take for one.
pub(super) fn in_place(draft: &Draft, hosted: &[Hosted]) -> Option<Draft> {
    let mut draft = draft.clone();
    let mut homes: QuickMap<RegisterId, RegisterId> = QuickMap::default();
    for sum in hosted {
        let root = root(sum.host, hosted);
        let members = hosted
            .iter()
            .filter(|other| root == self::root(other.host, hosted));
        let members = members.map(|other| other.sum).chain([root]);
        let registers = members.map(|place| result(&draft.ops[place].0));
        let registers: Vec<RegisterId> = registers.collect();
        let widths = registers.iter().map(|id| draft.registers[id.index()].width);
        let width = widths.max().unwrap_or(0);
        if width > sum.word.width && !fits(&draft.ops[sum.host].0, sum.word) {
            return None;
        }
        if !homes.contains_key(&registers[0]) {
            let home = new_home(&mut draft, *registers.last()?, width);
            homes.extend(registers.into_iter().map(|register| (register, home)));
        }
    }
    let home = |id: RegisterId| *homes.get(&id).unwrap_or(&id);
    for (op, _) in &mut draft.ops {
        *op = op.clone().map(home, home);
    }
    for sum in hosted {
        let target = home(sum.word.register);
        let a = sum.addend.map_register(home);
        if matches!(a, Operand::Word(word) if word.register == target) {
            return None;
        }
        draft.ops[sum.sum].0 = Op::AddInto {
            a,
            subtract: sum.subtract,
            when: When::Always,
            target,
        };
    }
    // Parities read all bits of a register, and would read those of the wider one.
    let is_home = |id: &RegisterId| homes.values().any(|home| home == id);
    let reads_all = |op: &Op| matches!(op, Op::Parity { source, .. } if is_home(source));
    let is_possible = !draft.ops.iter().any(|(op, _)| reads_all(op)) && !has_inverses(hosted, home);
    is_possible.then_some(draft)
}

/// True if two sums undo each other in one register.
fn has_inverses(hosted: &[Hosted], home: impl Fn(RegisterId) -> RegisterId) -> bool {
    let change = |sum: &Hosted| (home(sum.word.register), sum.addend.map_register(&home));
    let pairs = (0..hosted.len()).flat_map(|last| (0..last).map(move |first| [first, last]));
    let mut pairs = pairs.map(|pair| pair.map(|place| &hosted[place]));
    pairs.any(|[one, other]| one.subtract != other.subtract && change(one) == change(other))
}

/// The register that an operation computes, or changes.
pub(super) fn result(op: &Op) -> RegisterId {
    match op {
        Op::AddInto { target, .. } => *target,
        other => other.targets()[0],
    }
}

/// The place of the operation that computes the register in which `host` leaves its result.
fn root(host: usize, hosted: &[Hosted]) -> usize {
    let above = hosted.iter().find(|other| other.sum == host);
    above.map_or(host, |above| root(above.host, hosted))
}

/// Creates a register of `width` bits that is otherwise as `register`.
fn new_home(draft: &mut Draft, register: RegisterId, width: u32) -> RegisterId {
    let original = draft.registers[register.index()].clone();
    let id = RegisterId(draft.registers.len() as u32);
    draft.registers.push(Register {
        name: format!("{}'", original.name),
        width,
        range: None,
        ..original
    });
    id
}

/// True if `word` reads all results of `op`, so that a wider register holds the same numbers.
fn fits(op: &Op, word: Word) -> bool {
    let wide = |range: [i64; 2]| range.map(i128::from);
    let range = |operand: &Operand| match operand {
        Operand::Word(word) => wide(word.range()),
        Operand::Constant(value) => wide([*value; 2]),
    };
    let results = match op {
        Op::Load { .. } if !word.signed => wide(word.range()),
        Op::Copy { a, .. } => wide(a.range()),
        Op::Add { a, b, subtract, .. } => {
            let ([least, most], [lower, upper]) = (range(a), range(b));
            let [lower, upper] = if *subtract {
                [-upper, -lower]
            } else {
                [lower, upper]
            };
            [least + lower, most + upper]
        }
        Op::Select { a, b, .. } => {
            let ([least, most], [lower, upper]) = (range(a), range(b));
            [least.min(lower), most.max(upper)]
        }
        _ => return false,
    };
    let [least, most] = wide(word.range());
    least <= results[0] && results[1] <= most
}
