//! Compiles a list of gates to code: runs of patterns, and the rows that they work on.

use super::patterns::PATTERNS;
use qrt_circuit::{Gate, GateCircuit, Qubit};
use std::cmp::Reverse;
use std::sync::LazyLock;

/// Longest run of one pattern.
const LONGEST: usize = 1 << 20;

/// Largest number of rows of a pattern.
const ROWS: usize = 10;

/// Layout of the rows: first those of the qubits, then that of the signs, then those of the
/// parameters' bits.
#[derive(Clone, Debug)]
pub(super) struct Wiring {
    qubits: u32,
    /// By parameter: its first row and its bits.
    parameters: Vec<(u32, u32)>,
    rows: usize,
}

impl Wiring {
    pub(super) fn new(circuits: &[&GateCircuit]) -> Self {
        let qubits = circuits.iter().map(|c| c.qubits).max().unwrap_or(0);
        let mut widths: Vec<u32> = Vec::new();
        for circuit in circuits {
            let many = widths.len().max(circuit.parameters.len());
            widths.resize(many, 0);
            for (width, parameter) in widths.iter_mut().zip(&circuit.parameters) {
                *width = (*width).max(parameter.width);
            }
        }
        let mut next = qubits + 1;
        let parameters = widths.into_iter().map(|width| {
            next += width;
            (next - width, width)
        });
        let parameters = parameters.collect();
        Self {
            qubits,
            parameters,
            rows: next as usize,
        }
    }

    pub(super) fn qubits(&self) -> u32 {
        self.qubits
    }

    pub(super) fn sign(&self) -> u32 {
        self.qubits
    }

    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// The parameters' bits: parameter, bit and row.
    pub(super) fn parameters(&self) -> impl Iterator<Item = (usize, u32, u32)> {
        let parameters = self.parameters.iter().enumerate();
        parameters
            .flat_map(|(place, (first, bits))| (0..*bits).map(move |bit| (place, bit, first + bit)))
    }

    /// Returns the code of `gates`, or the position of the first invalid gate.
    pub(super) fn compile(&self, gates: &[Gate]) -> Result<Box<[u32]>, usize> {
        Ok(code(&self.all_on_rows(self.qubits, gates)?).into())
    }

    /// Returns the code of `gates` on `qubits` qubits of their own, which all other rows follow. If
    /// `are_short`, the code has only single gates: the rows are so short that a search for longer
    /// patterns takes more time than these save.
    pub(super) fn compile_on(
        &self,
        qubits: u32,
        gates: &[Gate],
        are_short: bool,
    ) -> Result<Box<[u32]>, usize> {
        let gates = self.all_on_rows(qubits, gates)?;
        Ok(if are_short {
            code_of_each(&gates)
        } else {
            code(&gates)
        }
        .into())
    }

    fn all_on_rows(&self, qubits: u32, gates: &[Gate]) -> Result<Vec<Gate>, usize> {
        let mut rows = Vec::with_capacity(gates.len());
        for (place, gate) in gates.iter().enumerate() {
            rows.push(self.on_rows(qubits, *gate).ok_or(place)?);
        }
        Ok(rows)
    }

    /// Appends the code `own`, compiled on qubits of its own, with `qubits` in place of these.
    pub(super) fn relocate(&self, own: &[u32], qubits: &[Qubit], code: &mut Vec<u32>) {
        let own_qubits = qubits.len() as u32;
        let row = |row: &u32| match qubits.get(*row as usize) {
            Some(qubit) => *qubit,
            None => row - own_qubits + self.qubits,
        };
        let mut own = own;
        while let [head, rest @ ..] = own {
            let (number, count) = parts(*head);
            let (operands, rest) = rest.split_at(count * PATTERNS[number].rows);
            code.push(*head);
            code.extend(operands.iter().map(row));
            own = rest;
        }
    }

    /// Returns the gate as an X, a CNOT or a Toffoli on rows, of which the first `qubits` are
    /// qubits, or `None` if it is invalid.
    fn on_rows(&self, qubits: u32, gate: Gate) -> Option<Gate> {
        let is = |qubit| qubit < qubits;
        match gate {
            Gate::X(t) => is(t).then_some(gate),
            Gate::Cx(a, t) => (is(a) && is(t) && a != t).then_some(gate),
            Gate::Ccx(a, b, t) if a == b => self.on_rows(qubits, Gate::Cx(a, t)),
            Gate::Ccx(a, b, t) => (is(a) && is(b) && is(t) && a != t && b != t).then_some(gate),
            Gate::Load {
                parameter,
                bit,
                target,
            } => {
                let (first, bits) = *self.parameters.get(parameter as usize)?;
                let row = first - self.qubits + qubits + bit;
                (bit < bits && is(target)).then_some(Gate::Cx(row, target))
            }
            Gate::Z(q) => is(q).then_some(Gate::Cx(q, self.sign() - self.qubits + qubits)),
        }
    }
}

/// Returns the pattern and the length of the run that `head` begins.
#[inline(always)]
pub(super) fn parts(head: u32) -> (usize, usize) {
    ((head & 0xff) as usize, (head >> 8) as usize)
}

/// Returns the code of `gates`: for each run of a pattern a word `pattern | count << 8`, and the
/// rows that the run works on.
fn code(gates: &[Gate]) -> Vec<u32> {
    let mut code = Vec::with_capacity(gates.len());
    let mut head = None;
    let mut kinds = kinds(gates);
    let mut rest = gates;
    while !rest.is_empty() {
        let Some((number, rows)) = longest(rest, kinds) else {
            break;
        };
        let pattern = &PATTERNS[number];
        match head {
            Some((last, place)) if last == number && code[place] >> 8 < LONGEST as u32 => {
                code[place] += 1 << 8;
            }
            _ => {
                head = Some((number, code.len()));
                code.push(number as u32 | 1 << 8);
            }
        }
        code.extend_from_slice(&rows[..pattern.rows]);
        for place in MOST_GATES..MOST_GATES + pattern.gates.len() {
            kinds = kinds >> 2 | rest.get(place).map_or(0, kind) << (2 * MOST_GATES - 2);
        }
        rest = &rest[pattern.gates.len()..];
    }
    code
}

/// As [`code`], but uses only patterns of one gate.
fn code_of_each(gates: &[Gate]) -> Vec<u32> {
    let mut code = Vec::with_capacity(3 * gates.len());
    let (mut number, mut head) = (usize::MAX, 0);
    for gate in gates {
        let kind = kind(gate) as usize - 1;
        if kind != number || code[head] >> 8 == LONGEST as u32 {
            (number, head) = (kind, code.len());
            code.push(number as u32);
        }
        code[head] += 1 << 8;
        match *gate {
            Gate::X(t) => code.push(t),
            Gate::Cx(a, t) => code.extend([a, t]),
            Gate::Ccx(a, b, t) => code.extend([a, b, t]),
            // Gates on rows are never of these kinds.
            Gate::Load { .. } | Gate::Z(_) => {}
        }
    }
    code
}

/// Largest number of gates of a pattern: a word holds the kinds of this many.
const MOST_GATES: usize = 32;

/// The kind of a gate on rows, a number of two bits that is not 0: one more than the number of the
/// pattern that consists of this gate alone.
fn kind(gate: &Gate) -> u64 {
    match gate {
        Gate::X(_) => 1,
        Gate::Cx(..) => 2,
        Gate::Ccx(..) => 3,
        Gate::Load { .. } | Gate::Z(_) => 0,
    }
}

/// Returns the kinds of the first gates, the first in the lowest bits; zeros if there are no more.
fn kinds(gates: &[Gate]) -> u64 {
    let first = gates.iter().take(MOST_GATES).rev();
    first.fold(0, |kinds, gate| kinds << 2 | kind(gate))
}

/// A pattern, with the data by which a search finds it.
struct Candidate {
    number: usize,
    kinds: u64,
    mask: u64,
}

/// By the kinds of the first three gates, the patterns that may begin there, longest first.
static CANDIDATES: LazyLock<[Vec<Candidate>; 64]> = LazyLock::new(|| {
    let mut longest_first: Vec<usize> = (0..PATTERNS.len()).collect();
    longest_first.sort_by_key(|number| Reverse(PATTERNS[*number].gates.len()));
    std::array::from_fn(|three| {
        let all = longest_first.iter().map(|&number| {
            let gates = PATTERNS[number].gates;
            Candidate {
                number,
                kinds: kinds(gates),
                mask: u64::MAX >> (2 * (MOST_GATES - gates.len())),
            }
        });
        let differs = |c: &Candidate| (c.kinds ^ three as u64) & c.mask;
        // The lowest six bits belong to the first three gates.
        all.filter(|c| differs(c) << 58 == 0).collect()
    })
});

/// No row.
const FREE: u32 = u32::MAX;

/// By the name of an operand in a pattern: the row that it is bound to.
#[derive(Clone, Copy)]
struct Binding {
    rows: [u32; ROWS],
    /// For each bound row, the bit of the number `row % 64`: a quick test whether a row is new.
    seen: u64,
}

/// Returns the longest pattern that `gates` begin with, and its rows. `kinds` are the kinds of
/// `gates`.
fn longest(gates: &[Gate], kinds: u64) -> Option<(usize, [u32; ROWS])> {
    let candidates = CANDIDATES[(kinds & 63) as usize].iter();
    let mut candidates = candidates.filter(|c| kinds & c.mask == c.kinds);
    candidates.find_map(|candidate| {
        let mut bound = Binding {
            rows: [FREE; ROWS],
            seen: 0,
        };
        let pattern = PATTERNS[candidate.number].gates;
        bound
            .gates(pattern, gates)
            .then_some((candidate.number, bound.rows))
    })
}

impl Binding {
    /// Binds the rows of a pattern's gates to those of `gates`, different rows to different rows.
    /// Returns whether this is possible.
    fn gates(&mut self, pattern: &[Gate], gates: &[Gate]) -> bool {
        for (place, pair) in pattern.iter().zip(gates).enumerate() {
            let fits = match pair {
                (Gate::X(p), Gate::X(t)) => self.row(*p, *t),
                (Gate::Cx(p, q), Gate::Cx(a, t)) => self.row(*p, *a) && self.row(*q, *t),
                (Gate::Ccx(p, q, r), Gate::Ccx(a, b, t)) => {
                    let [first, second] = [p, q].map(|name| self.rows[*name as usize]);
                    if [first, second] == [FREE, FREE] {
                        // The controls may be in either order. If the first order fails later, the
                        // second is tried.
                        let before = *self;
                        if self.toffoli([*p, *q, *r], [*a, *b, *t])
                            && self.gates(&pattern[place + 1..], &gates[place + 1..])
                        {
                            return true;
                        }
                        *self = before;
                        self.toffoli([*p, *q, *r], [*b, *a, *t])
                    } else if first == *b || second == *a {
                        self.toffoli([*p, *q, *r], [*b, *a, *t])
                    } else {
                        self.toffoli([*p, *q, *r], [*a, *b, *t])
                    }
                }
                _ => false,
            };
            if !fits {
                return false;
            }
        }
        true
    }

    fn toffoli(&mut self, names: [u32; 3], rows: [u32; 3]) -> bool {
        self.row(names[0], rows[0]) && self.row(names[1], rows[1]) && self.row(names[2], rows[2])
    }

    #[inline(always)]
    fn row(&mut self, name: u32, row: u32) -> bool {
        let old = self.rows[name as usize];
        if old != FREE {
            return old == row;
        }
        let bit = 1 << (row & 63);
        if self.seen & bit != 0 && self.rows.contains(&row) {
            return false;
        }
        self.rows[name as usize] = row;
        self.seen |= bit;
        true
    }
}
