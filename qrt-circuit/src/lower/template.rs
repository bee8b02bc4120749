//! Operations lowered once for all that are alike, on qubits of their own.
//!
//! The gates of an operation follow from what it does and from the widths of its registers; where its
//! qubits are only names them. So what is made of the gates of a program that runs many times, or whose
//! operations are much alike, is made once for all that are, as long as there is room to keep it.

use super::super::{Gate, Program, Qubit};
use super::Lowering;
use super::figures::{QuickMap, Shape};
use super::place::{numbered, placed};
use std::collections::hash_map::Entry;

/// Bytes of a template beside what was made: its operation, and its place in a map.
const ENTRY: usize = 320;

/// What was made of the gates of operations, `T` of those of one operation or of its inverse.
pub struct Templates<T> {
    /// What was asked for lately, and what was before that, by shape and whether it is the inverse.
    lately: QuickMap<(Shape, bool), Template<T>>,
    before: QuickMap<(Shape, bool), Template<T>>,
    /// Bytes of the former, and of both together at most.
    held: usize,
    room: usize,
}

struct Template<T> {
    made: T,
    bytes: usize,
    /// How many qubits it borrows: they are numbered after those of its registers.
    borrowed: u32,
    /// The numbers of these, in the order in which they are given back.
    returned: Box<[Qubit]>,
}

impl<T> Templates<T> {
    /// None, and room for so many bytes of them.
    pub fn with_room(bytes: usize) -> Self {
        Self {
            lately: QuickMap::default(),
            before: QuickMap::default(),
            held: 0,
            room: bytes,
        }
    }

    fn of<E>(
        &mut self,
        key: (Shape, bool),
        make: impl FnOnce(&[Gate], u32) -> Result<(T, usize), E>,
    ) -> Result<&Template<T>, E> {
        if self.held > self.room / 2 {
            self.before = std::mem::take(&mut self.lately);
            self.held = 0;
        }
        match self.lately.entry(key) {
            Entry::Occupied(known) => Ok(known.into_mut()),
            Entry::Vacant(new) => {
                let template = match self.before.remove(new.key()) {
                    Some(known) => known,
                    None => Template::new(new.key(), make)?,
                };
                self.held += template.bytes + ENTRY;
                Ok(new.insert(template))
            }
        }
    }
}

impl<T> Template<T> {
    fn new<E>(
        ((op, widths), inverse): &(Shape, bool),
        make: impl FnOnce(&[Gate], u32) -> Result<(T, usize), E>,
    ) -> Result<Self, E> {
        let mut lowering = placed(widths);
        let own = lowering.pool.made();
        let scratch = op.scratch().map(|id| lowering.register(id));
        lowering.scratch = Some(scratch.unwrap_or_default());
        lowering.lower(op);
        if *inverse {
            lowering.gates.reverse();
        }
        let qubits = lowering.pool.made();
        let (made, bytes) = make(&lowering.gates, qubits)?;
        Ok(Self {
            made,
            bytes,
            borrowed: qubits - own,
            returned: lowering.pool.idle().into(),
        })
    }
}

/// Lowers a program instruction by instruction, as [`super::try_each_instruction`] does, with each operation
/// on qubits of its own: `make` gets its gates and how many qubits they have, and says how many bytes what it
/// makes of them takes; `each` gets that and the program's qubits by the number of the operation's own.
///
/// ```
/// use qrt_circuit::lower::{Templates, circuit, try_each_template};
/// use qrt_circuit::{Declaration, Machine, Recorder, Style, Type, Word};
///
/// // The squares of two numbers.
/// let mut m = Recorder::new(Style::InPlace);
/// for _ in 0..2 {
///     let x = m.input(&Declaration::work("x", Type::UInt, 3));
///     m.square(&Declaration::work("square", Type::UInt, 6), Word::unsigned(&x, 0, 3), 0);
/// }
/// let program = m.finish();
/// let (mut lowered, mut gates) = (0, 0);
/// try_each_template(
///     &program,
///     &mut Templates::with_room(1 << 20),
///     |own, _qubits| {
///         lowered += 1;
///         Ok::<_, std::convert::Infallible>((own.to_vec(), size_of_val(own)))
///     },
///     |own, _qubits| {
///         gates += own.len();
///         Ok(())
///     },
/// )?;
/// assert_eq!((lowered, gates), (1, circuit(&program).gates.len()));
/// # Ok::<(), std::convert::Infallible>(())
/// ```
///
/// # Errors
/// That of `make` or of `each`.
pub fn try_each_template<T, E>(
    program: &Program,
    templates: &mut Templates<T>,
    mut make: impl FnMut(&[Gate], u32) -> Result<(T, usize), E>,
    mut each: impl FnMut(&T, &[Qubit]) -> Result<(), E>,
) -> Result<(), E> {
    let mut lowering = Lowering::on(program);
    let mut qubits = Vec::new();
    for instruction in &program.instructions {
        let op = &program.ops[instruction.op as usize];
        lowering.place_fresh(program, op);
        let (shape, registers) = numbered(op);
        let widths = registers.iter().map(|id| program.width(*id)).collect();
        let template = templates.of(((shape, widths), instruction.inverse), &mut make)?;
        qubits.clear();
        for register in &registers {
            qubits.extend_from_slice(&lowering.registers[register.index()]);
        }
        qubits.extend((0..template.borrowed).map(|_| lowering.pool.allocate()));
        for own in &template.returned {
            lowering.pool.free(qubits[*own as usize]);
        }
        if instruction.inverse {
            lowering.displace_fresh(op);
        }
        each(&template.made, &qubits)?;
    }
    Ok(())
}
