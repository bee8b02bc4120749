//! Calls between reversible functions.
//!
//! The text of a `#[reversible]` function is also the text of its inverse. The function runs on a
//! [`Host`], which determines the direction. The host is a machine or, within another reversible
//! function, its [`Caller`]. Only reversible functions take callers, so no other function is called
//! where it could not be undone. A caller knows the functions that are running, so an endless
//! recursion does not compile.

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
pub trait Frame {
    /// The function and its callers as a value.
    const RUNNING: &'static Running;
}

/// The caller of a reversible function: a reversible function on its machine, forwards or undone.
pub struct Caller<'a, M, F, const UNDONE: bool> {
    machine: &'a mut M,
    frame: PhantomData<F>,
}

impl<'a, M: Machine, F: Frame, const UNDONE: bool> Caller<'a, M, F, UNDONE> {
    /// Creates the caller for the function `F`, which runs on `machine`.
    #[inline(always)]
    pub fn new(machine: &'a mut M) -> Self {
        Self {
            machine,
            frame: PhantomData,
        }
    }

    /// Calls a reversible function with `registers`.
    #[inline(always)]
    pub fn call<G, H, P>(mut self, function: G, registers: impl Handed<P>)
    where
        G: Reversible<H, P>,
        H: Is<Self>,
    {
        function.run(H::is(&mut self), registers.handed());
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

/// A function's host type that equals `T`.
pub trait Is<T>: HostOf {
    /// Returns `host` as the function's host type.
    fn is(host: &mut T) -> &mut Self::Host;
}

impl<H> Is<H> for (H,) {
    #[inline(always)]
    fn is(host: &mut H) -> &mut H {
        host
    }
}

/// The registers that a function takes, `P`: their number and formats must agree.
#[diagnostic::on_unimplemented(
    message = "these are not the registers that the function takes [QRT0813]",
    label = "of another number, format or reference",
    note = "help: hand over a register for each parameter, of its format, by `&` or `&mut` as it is \
            declared; one whose width is computed goes where the parameter's is"
)]
pub trait Handed<P> {
    /// Returns the registers unchanged.
    fn handed(self) -> P;
}

impl<P> Handed<P> for P {
    #[inline(always)]
    fn handed(self) -> P {
        self
    }
}

impl<M, F, const UNDONE: bool> fmt::Debug for Caller<'_, M, F, UNDONE> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Caller").field("undone", &UNDONE).finish()
    }
}

impl<M: Machine, F: Frame, const UNDONE: bool> Host for Caller<'_, M, F, UNDONE> {
    type Register = M::Register;
    type Machine = M;
    const UNDONE: bool = UNDONE;
    const RUNNING: Option<&'static Running> = Some(F::RUNNING);

    #[inline(always)]
    fn machine(&mut self) -> &mut M {
        self.machine
    }
}

/// A function of `#[reversible]`, which takes a [`Host`] and the registers `P`.
#[diagnostic::on_unimplemented(
    message = "this function is not reversible [QRT0812]",
    label = "`#[reversible]` is missing before it",
    note = "help: write `#[reversible]` before the function that is called"
)]
pub trait Reversible<H: HostOf, P> {
    /// Runs the function.
    fn run(self, host: &mut H::Host, registers: P);
}

macro_rules! reversible {
    ($($register:ident)*) => {
        #[diagnostic::do_not_recommend]
        impl<H: Host, Function, $($register),*> Reversible<(H,), ($($register,)*)> for Function
        where
            Function: FnOnce(&mut H, $($register),*),
        {
            #[inline(always)]
            #[allow(non_snake_case)]
            fn run(self, host: &mut H, ($($register,)*): ($($register,)*)) {
                self(host, $($register),*);
            }
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
