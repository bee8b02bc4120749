//! Routines that are running on this thread. Reversible code has no branch that could end a
//! recursion: a routine that comes to itself again never returns.

use std::cell::RefCell;

/// A routine: its name, where it is written, and the constants that it is generic over.
type Running = (&'static str, [u32; 2], Vec<u32>);

thread_local! {
    static RUNNING: RefCell<Vec<Running>> = const { RefCell::new(Vec::new()) };
}

/// A routine that runs until this is dropped.
#[derive(Debug)]
pub struct Routine(());

impl Routine {
    /// A routine begins: `name`, written in this line and column, with these constants.
    ///
    /// # Panics
    /// If it runs already, on this thread: it calls itself, by way of those that began since.
    ///
    /// ```
    /// use qrt_circuit::Routine;
    ///
    /// let outer = Routine::enter("sort", [1, 1], &[4]);
    /// drop(Routine::enter("sort", [1, 1], &[2]));
    /// drop(outer);
    /// drop(Routine::enter("sort", [1, 1], &[4]));
    /// ```
    pub fn enter(name: &'static str, place: [u32; 2], constants: &[u32]) -> Self {
        RUNNING.with_borrow_mut(|running| {
            let this = (name, place, constants.to_vec());
            if let Some(first) = running.iter().position(|other| *other == this) {
                let names = running[first + 1..]
                    .iter()
                    .map(|(name, ..)| format!("`{name}`"));
                let names: Vec<String> = names.collect();
                panic!(
                    "`{name}` calls itself, by way of {}, and would never return [QRT0812]",
                    names.join(", ")
                );
            }
            running.push(this);
        });
        Self(())
    }
}

impl Drop for Routine {
    fn drop(&mut self) {
        RUNNING.with_borrow_mut(Vec::pop);
    }
}
