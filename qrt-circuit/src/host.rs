//! How one reversible function calls another.
//!
//! A function of `#[reversible]` is its own inverse's only text: it runs on a [`Host`], which says
//! in which direction. That is a machine, or, within another reversible function, its [`Caller`].
//! Only reversible functions take callers, so that nothing else is called where it could not be
//! undone; and callers know which functions are running, so that one that would never end does not
//! compile.

use super::machine::Machine;
use std::fmt;
use std::marker::PhantomData;

/// What a reversible function runs on: any [`Machine`], or the function that calls it.
pub trait Host {
    /// A register of the machine.
    type Register;
    /// The machine that the function's operations run on.
    type Machine: Machine<Register = Self::Register>;
    /// Whether the function is undone.
    const UNDONE: bool;
    /// The functions that run already, the last first.
    const RUNNING: Option<&'static Running>;

    /// The machine itself.
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

/// Functions that call each other.
#[derive(Clone, Copy, Debug)]
pub struct Running {
    /// The path of the last.
    pub function: &'static str,
    /// The line and the column where it is written.
    pub place: [u32; 2],
    /// The function that has called it, with those that called that.
    pub from: Option<&'static Running>,
}

impl Running {
    /// Whether the last function runs already. Reversible code has no branch that could end a
    /// recursion, so that it would never return.
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

/// A function that runs, with those that called it, as a type.
pub trait Frame {
    /// The same as a value.
    const RUNNING: &'static Running;
}

/// A reversible function that calls another: on its machine, forwards or to be undone.
pub struct Caller<'a, M, F, const UNDONE: bool> {
    machine: &'a mut M,
    frame: PhantomData<F>,
}

impl<'a, M: Machine, F: Frame, const UNDONE: bool> Caller<'a, M, F, UNDONE> {
    /// The function `F`, which runs on this machine.
    #[inline(always)]
    pub fn new(machine: &'a mut M) -> Self {
        Self {
            machine,
            frame: PhantomData,
        }
    }

    /// Calls a reversible function with these registers.
    #[inline(always)]
    pub fn call<G, H, P>(mut self, function: G, registers: impl Handed<P>)
    where
        G: Reversible<H, P>,
        H: Is<Self>,
    {
        function.run(H::is(&mut self), registers.handed());
    }
}

/// The host that a function runs on: `(H,)` of `H`, so that it is known for certain that the
/// function is reversible before it is asked for whose host that is.
pub trait HostOf {
    /// The host.
    type Host;
}

impl<H> HostOf for (H,) {
    type Host = H;
}

/// A function's host that is `T`.
pub trait Is<T>: HostOf {
    /// The host.
    fn is(host: &mut T) -> &mut Self::Host;
}

impl<H> Is<H> for (H,) {
    #[inline(always)]
    fn is(host: &mut H) -> &mut H {
        host
    }
}

/// Registers that a function takes, `P`: as many, in its formats.
#[diagnostic::on_unimplemented(
    message = "these are not the registers that the function takes [QRT0813]",
    label = "of another number, format or reference",
    note = "help: hand over a register for each parameter, of its format, by `&` or `&mut` as it is \
            declared; one whose width is computed goes where the parameter's is"
)]
pub trait Handed<P> {
    /// The same.
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

/// A function of `#[reversible]`, which takes a [`Host`] and registers, `P` of them.
#[diagnostic::on_unimplemented(
    message = "this function is not reversible [QRT0812]",
    label = "`#[reversible]` is missing before it",
    note = "help: write `#[reversible]` before the function that is called"
)]
pub trait Reversible<H: HostOf, P> {
    /// Runs it.
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
