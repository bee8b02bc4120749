//! Operations lowered once for all operations that are alike, on qubits of their own.
//!
//! The gates of an operation depend on its kind and on the widths of its registers; the places of
//! its qubits only rename them. So results made from gates are computed once for all operations
//! that are alike, while they fit into the memory budget. That pays for a program that runs many
//! times, or whose operations are much alike.

use super::super::{Gate, Program, Qubit};
use super::Lowering;
use super::figures::QuickMap;
use super::place::{Shape, numbered, placed};
use std::collections::hash_map::Entry;

/// Bytes of a template besides its result: its operation, and its place in a map.
const ENTRY: usize = 320;

/// A cache of results made from gates: one `T` for each operation and each inverse.
pub struct Templates<T> {
    /// Templates used lately, and templates used before that, by shape and by whether it is the
    /// inverse.
    lately: QuickMap<(Shape, bool), Template<T>>,
    before: QuickMap<(Shape, bool), Template<T>>,
    /// Bytes of `lately`, and the most bytes of both maps together.
    held: usize,
    room: usize,
}

struct Template<T> {
    made: T,
    bytes: usize,
    /// Number of qubits that it borrows. They are numbered after those of its registers.
    borrowed: u32,
    /// The numbers of the borrowed qubits, in the order in which they are returned.
    returned: Box<[Qubit]>,
}

impl<T> Templates<T> {
    /// Creates an empty cache with a memory budget of `bytes`.
    pub fn with_room(bytes: usize) -> Self {
        Self {
            lately: QuickMap::default(),
            before: QuickMap::default(),
            held: 0,
            room: bytes,
        }
    }

    fn template<E>(
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

/// Lowers a program instruction by instruction, as [`super::each_instruction`] does, with each
/// operation on qubits of its own.
///
/// `make` receives an operation's gates and their number of qubits. It returns a result and the
/// size of the result in bytes. `each` receives the result, and the program's qubits by the number
/// of the operation's own.
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
/// An error of `make` or of `each`.
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
        let template = templates.template(((shape, widths), instruction.inverse), &mut make)?;
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
