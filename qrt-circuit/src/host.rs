//! Calls between reversible functions.
//!
//! The text of a `#[reversible]` function is also the text of its inverse. The function runs on a
//! [`Host`], which determines the direction. The host is a machine or, within another reversible
//! function, its [`Caller`]. Only reversible functions take callers, so no other function is called
//! where it could not be undone. A caller knows the functions that are running, so an endless
//! recursion does not compile.

use super::format::{Format, Reg};
use super::machine::Machine;
use std::fmt;
use std::marker::PhantomData;

/// The host of a reversible function: any [`Machine`], or the function that calls it.
pub trait Host {
    /// A register of the machine.
    type Register;
    /// The machine that runs the function's operations.
    type Machine: Machine<Register = Self::Register>;
    /// True if the function is undone.
    const UNDONE: bool;
    /// The functions that are running, the last call first.
    const RUNNING: Option<&'static Running>;

    /// Returns the machine itself.
    fn machine(&mut self) -> &mut Self::Machine;
}

impl<M: Machine> Host for M {
    type Register = M::Register;
    type Machine = M;
    const UNDONE: bool = false;
    const RUNNING: Option<&'static Running> = None;

    #[inline(always)]
    fn machine(&mut self) -> &mut M {
        self
    }
}

/// A running function and its callers.
#[derive(Clone, Copy, Debug)]
pub struct Running {
    /// The path of the function that was called last.
    pub function: &'static str,
    /// The line and the column of its definition.
    pub place: [u32; 2],
    /// The function that called it, with the callers of that one.
    pub from: Option<&'static Running>,
}

impl Running {
    /// True if the last function was already running. Reversible code has no branch that could end
    /// a recursion, so the function would never return.
    ///
    /// ```
    /// use qrt_circuit::Running;
    ///
    /// const SORT: Running = Running { function: "sort", place: [1, 1], from: None };
    /// const SWAP: Running = Running { function: "swap", place: [9, 1], from: Some(&SORT) };
    /// const AGAIN: Running = Running { from: Some(&SWAP), ..SORT };
    /// assert!(!SORT.repeats() && !SWAP.repeats());
    /// assert!(AGAIN.repeats());
    /// ```
    pub const fn repeats(&self) -> bool {
        let mut from = self.from;
        while let Some(earlier) = from {
            let [line, column] = self.place;
            let same = line == earlier.place[0] && column == earlier.place[1];
            if same && equal(self.function.as_bytes(), earlier.function.as_bytes()) {
                return true;
            }
            from = earlier.from;
        }
        false
    }
}

const fn equal(a: &[u8], b: &[u8]) -> bool {
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}

/// A running function and its callers, as a type.
pub trait CallFrame {
    /// The function and its callers as a value.
    const RUNNING: &'static Running;
    /// True if the function is undone.
    const UNDONE: bool;
}

/// A host that undoes what runs on it.
#[derive(Debug)]
pub struct Undone<'a, H>(pub &'a mut H);

impl<H: Host> Host for Undone<'_, H> {
    type Register = H::Register;
    type Machine = H::Machine;
    const UNDONE: bool = !H::UNDONE;
    const RUNNING: Option<&'static Running> = H::RUNNING;

    #[inline(always)]
    fn machine(&mut self) -> &mut H::Machine {
        self.0.machine()
    }
}

/// The caller of a reversible function: a reversible function on its machine. `INVERSE` is true if
/// the call is of the function's inverse.
pub struct Caller<'a, M, F, const INVERSE: bool> {
    machine: &'a mut M,
    frame: PhantomData<F>,
}

impl<'a, M: Machine, F: CallFrame, const INVERSE: bool> Caller<'a, M, F, INVERSE> {
    /// Creates the caller for the function `F`, which runs on `machine`.
    #[inline(always)]
    pub fn new(machine: &'a mut M) -> Self {
        Self {
            machine,
            frame: PhantomData,
        }
    }
}

/// The type of a function's host, wrapped: `(H,)` for `H`. The wrapper makes the compiler establish
/// that the function is reversible before it resolves the host's type.
pub trait HostOf {
    /// The host.
    type Host;
}

impl<H> HostOf for (H,) {
    type Host = H;
}

/// Panics with `message` unless a condition of generated code holds. The compiler shows the message
/// alone, and no macro of the panic's.
///
/// ```
/// const _: () = qrt_circuit::demand(2 + 2 == 4, "the sum is not four");
/// ```
#[track_caller]
#[inline(always)]
pub const fn demand(holds: bool, message: &'static str) {
    assert!(holds, "{}", message);
}

/// A function's host, whose type is `H`, wrapped.
pub struct HostRef<'a, H: HostOf>(&'a mut H::Host);

/// A type of no value. With an implementation for it, a trait has two that are possible, so the
/// compiler chooses none before the types are known otherwise.
#[derive(Debug)]
pub enum Undetermined {}

impl HostOf for Undetermined {
    type Host = Self;
}

// Every type implements the traits of a call, and generated code takes them from the type parameter
// of the function that calls. If they are not implemented, the compiler shows the message alone: it
// neither says so again by the traits' names nor shows a bound.

/// The type `T`, which generated code writes across all source text that an error underlines.
pub type Itself<T> = T;

/// A function's host type `H` that equals `T`, wrapped.
#[diagnostic::on_unimplemented(
    message = "this function is not reversible [QRT0812]",
    label = "`#[reversible]` is missing before it",
    note = "help: write `#[reversible]` before the function that is called"
)]
pub trait Is<H: HostOf, T> {
    /// Returns `host` as the function's host.
    fn is(host: &mut T) -> HostRef<'_, H>;
}

#[diagnostic::do_not_recommend]
impl<M, H> Is<(H,), H> for M {
    #[inline(always)]
    fn is(host: &mut H) -> HostRef<'_, (H,)> {
        HostRef(host)
    }
}

#[diagnostic::do_not_recommend]
impl<M, H> Is<Undetermined, H> for M {
    fn is(_: &mut H) -> HostRef<'_, Undetermined> {
        unreachable!("the host of no function")
    }
}

/// A tuple of borrowed registers of a machine whose registers are `R`.
pub trait Registers<R>: Sized {
    /// The registers' formats, borrowed as the registers are: `(&UInt<4>, &mut UInt<8>)`.
    type Formats: Formats<R, Registers = Self>;
}

/// The formats of borrowed registers.
pub trait Formats<R> {
    /// The registers of a machine whose registers are `R`.
    type Registers;
}

/// A borrowed register, or all registers of a borrowed array.
pub trait BorrowedRegister<R>: Sized {
    /// The format, borrowed as the register is.
    type Format: Formats<R, Registers = Self>;
}

macro_rules! argument {
    ($([$($generic:tt)*] $borrowed:ty = $format:ty;)*) => { $(
        impl<'a, R, F: Format, $($generic)*> BorrowedRegister<R> for $borrowed {
            type Format = $format;
        }

        impl<'a, R: 'a, F: Format, $($generic)*> Formats<R> for $format {
            type Registers = $borrowed;
        }
    )* };
}

argument! {
    [] &'a Reg<R, F> = &'a F;
    [] &'a mut Reg<R, F> = &'a mut F;
    [const N: usize] &'a [Reg<R, F>; N] = &'a [F; N];
    [const N: usize] &'a mut [Reg<R, F>; N] = &'a mut [F; N];
}

/// The formats of the registers of a call. The function takes `T` and is handed `S`: their number and
/// formats must agree. Neither names the machine, so the compiler shows the error once, although a
/// reversible function is compiled for several machines. `V` stays unknown in an error, so that the
/// compiler suggests no `where` bound.
#[diagnostic::on_unimplemented(
    message = "the function takes `{T}`, and is handed `{S}` [QRT0813]",
    label = "of another number, format or reference",
    note = "help: hand over a register for each parameter, of its format, by `&` or `&mut` as it is \
            declared; one whose width is computed goes where the parameter's is"
)]
pub trait Handed<T, S, V> {
    /// Returns the registers unchanged.
    fn handed<R, P, Q>(registers: Q) -> P
    where
        P: Registers<R, Formats = T>,
        Q: Registers<R, Formats = S>,
        T: Formats<R>,
        S: Formats<R>;
}

#[diagnostic::do_not_recommend]
impl<M, S> Handed<Undetermined, S, ()> for M {
    fn handed<R, P, Q>(_: Q) -> P
    where
        P: Registers<R, Formats = Undetermined>,
        Q: Registers<R, Formats = S>,
        Undetermined: Formats<R>,
        S: Formats<R>,
    {
        unreachable!("the registers of no function")
    }
}

/// The registers of a machine whose registers are `R`, by the formats of `P`.
type OfFormats<R, P> = <<P as Registers<R>>::Formats as Formats<R>>::Registers;

#[inline(always)]
fn by_formats<R, P: Registers<R>>(registers: P) -> OfFormats<R, P> {
    registers
}

#[inline(always)]
fn of_formats<R, P: Registers<R>>(registers: OfFormats<R, P>) -> P {
    registers
}

impl<H: HostOf> fmt::Debug for HostRef<'_, H> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HostRef").finish_non_exhaustive()
    }
}

impl<M, F, const INVERSE: bool> fmt::Debug for Caller<'_, M, F, INVERSE> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Caller").field("inverse", &INVERSE).finish()
    }
}

impl<M: Machine, F: CallFrame, const INVERSE: bool> Host for Caller<'_, M, F, INVERSE> {
    type Register = M::Register;
    type Machine = M;
    const UNDONE: bool = F::UNDONE != INVERSE;
    const RUNNING: Option<&'static Running> = Some(F::RUNNING);

    #[inline(always)]
    fn machine(&mut self) -> &mut M {
        self.machine
    }
}

/// A function `G` of `#[reversible]`, which takes a [`Host`], whose type is `H`, wrapped, and the
/// registers `P`.
#[diagnostic::on_unimplemented(
    message = "this function is not reversible [QRT0812]",
    label = "`#[reversible]` is missing before it",
    note = "help: write `#[reversible]` before the function that is called"
)]
pub trait Reversible<G, H: HostOf, P> {
    /// Runs the function.
    fn run(function: G, host: HostRef<'_, H>, registers: P);
}

macro_rules! reversible {
    ($($register:ident)*) => {
        #[diagnostic::do_not_recommend]
        impl<M, H: Host, Function, $($register),*> Reversible<Function, (H,), ($($register,)*)> for M
        where
            Function: FnOnce(&mut H, $($register),*),
        {
            #[inline(always)]
            #[allow(non_snake_case)]
            fn run(
                function: Function,
                HostRef(host): HostRef<'_, (H,)>,
                ($($register,)*): ($($register,)*),
            ) {
                function(host, $($register),*);
            }
        }

        #[diagnostic::do_not_recommend]
        impl<M, $($register),*> Handed<($($register,)*), ($($register,)*), ()> for M {
            #[inline(always)]
            fn handed<Register, P, Given>(registers: Given) -> P
            where
                P: Registers<Register, Formats = ($($register,)*)>,
                Given: Registers<Register, Formats = ($($register,)*)>,
                ($($register,)*): Formats<Register>,
            {
                of_formats::<Register, P>(by_formats::<Register, Given>(registers))
            }
        }

        impl<T, $($register: BorrowedRegister<T>),*> Registers<T> for ($($register,)*) {
            type Formats = ($($register::Format,)*);
        }

        impl<T, $($register: Formats<T>),*> Formats<T> for ($($register,)*) {
            type Registers = ($($register::Registers,)*);
        }
    };
}

reversible!();
reversible!(A);
reversible!(A B);
reversible!(A B C);
reversible!(A B C D);
reversible!(A B C D E);
reversible!(A B C D E F);
reversible!(A B C D E F G);
reversible!(A B C D E F G I);
reversible!(A B C D E F G I J);
reversible!(A B C D E F G I J K);
reversible!(A B C D E F G I J K L);
reversible!(A B C D E F G I J K L N);
reversible!(A B C D E F G I J K L N O);
reversible!(A B C D E F G I J K L N O Q);
reversible!(A B C D E F G I J K L N O Q R);
reversible!(A B C D E F G I J K L N O Q R S);
