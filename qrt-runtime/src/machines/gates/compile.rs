//! From a list of gates to code: runs of patterns, and the rows that they work on.

use super::patterns::{PATTERNS, Pattern};
use qrt_circuit::{Circuit, Gate};

/// Longest run of one pattern.
const LONGEST: usize = 1 << 20;

/// Most rows of a pattern.
const ROWS: usize = 10;

/// Where the rows are: first the qubits', then the signs', then the parameters' bits.
#[derive(Clone, Debug)]
pub(super) struct Wiring {
    qubits: u32,
    /// By parameter: its first row and its bits.
    parameters: Vec<(u32, u32)>,
    rows: usize,
}

impl Wiring {
    pub(super) fn new(circuits: &[&Circuit]) -> Self {
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

    /// The code of `gates`, or the place of the first that is none.
    pub(super) fn compile(&self, gates: &[Gate]) -> Result<Box<[u32]>, usize> {
        let gates = gates.iter().enumerate();
        let rows = gates.map(|(place, gate)| self.on_rows(*gate).ok_or(place));
        let rows: Vec<Gate> = rows.collect::<Result<_, _>>()?;
        Ok(code(&rows).into())
    }

    /// The gate as an X, a CNOT or a Toffoli on rows, if it is one.
    fn on_rows(&self, gate: Gate) -> Option<Gate> {
        let is = |qubit| qubit < self.qubits;
        match gate {
            Gate::X(t) => is(t).then_some(gate),
            Gate::Cx(a, t) => (is(a) && is(t) && a != t).then_some(gate),
            Gate::Ccx(a, b, t) if a == b => self.on_rows(Gate::Cx(a, t)),
            Gate::Ccx(a, b, t) => (is(a) && is(b) && is(t) && a != t && b != t).then_some(gate),
            Gate::Load {
                parameter,
                bit,
                target,
            } => {
                let (first, bits) = *self.parameters.get(parameter as usize)?;
                (bit < bits && is(target)).then_some(Gate::Cx(first + bit, target))
            }
            Gate::Z(q) => is(q).then_some(Gate::Cx(q, self.sign())),
        }
    }
}

/// The pattern and the length of the run that `head` begins.
#[inline(always)]
pub(super) fn parts(head: u32) -> (usize, usize) {
    ((head & 0xff) as usize, (head >> 8) as usize)
}

/// Code: for each run of a pattern a word `pattern | count << 8`, and the rows it works on.
fn code(gates: &[Gate]) -> Vec<u32> {
    let mut code = Vec::new();
    let mut head = None;
    let mut rest = gates;
    while !rest.is_empty() {
        let Some((number, rows)) = longest(rest) else {
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
        rest = &rest[pattern.gates.len()..];
    }
    code
}

/// The longest pattern that `gates` begin with, and its rows.
fn longest(gates: &[Gate]) -> Option<(usize, [u32; ROWS])> {
    let fits = |(number, pattern): (usize, &Pattern)| {
        let mut bound = [None; ROWS];
        let rows = gates.len() >= pattern.gates.len() && bind(pattern.gates, gates, &mut bound);
        rows.then(|| (number, bound.map(|row| row.unwrap_or(0))))
    };
    let matches = PATTERNS.iter().enumerate().filter_map(fits);
    matches.max_by_key(|(number, _)| PATTERNS[*number].gates.len())
}

/// Binds the rows of a pattern's gates to those of `gates`, different ones to different ones.
fn bind(pattern: &[Gate], gates: &[Gate], bound: &mut [Option<u32>; ROWS]) -> bool {
    let ([first, pattern @ ..], [gate, gates @ ..]) = (pattern, gates) else {
        return true;
    };
    let before = *bound;
    let ways: &[(&[u32], &[u32])] = match (first, gate) {
        (Gate::X(p), Gate::X(t)) => &[(&[*p], &[*t])],
        (Gate::Cx(p, q), Gate::Cx(a, t)) => &[(&[*p, *q], &[*a, *t])],
        (Gate::Ccx(p, q, r), Gate::Ccx(a, b, t)) => &[
            (&[*p, *q, *r], &[*a, *b, *t]),
            (&[*p, *q, *r], &[*b, *a, *t]),
        ],
        _ => &[],
    };
    ways.iter().any(|(names, rows)| {
        *bound = before;
        let all = names.iter().zip(*rows);
        all.fold(true, |fits, (name, row)| {
            fits && bind_one(bound, *name, *row)
        }) && bind(pattern, gates, bound)
    })
}

fn bind_one(bound: &mut [Option<u32>; ROWS], name: u32, row: u32) -> bool {
    let taken = bound.contains(&Some(row));
    match &mut bound[name as usize] {
        Some(old) => *old == row,
        free if !taken => {
            *free = Some(row);
            true
        }
        _ => false,
    }
}
