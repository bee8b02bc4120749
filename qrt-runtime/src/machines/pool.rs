//! What threads borrow while they work: registers of lanes, rows of bits.

use std::sync::{Mutex, PoisonError};

/// A pool of objects that were made for work that is over, to be used again by work to come.
pub(super) struct Pool<T>(Mutex<Vec<T>>);

impl<T> Pool<T> {
    pub(super) fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// Does `work` with something of the pool, or with what `make` makes. After an error it is not
    /// used again.
    pub(super) fn lend<E>(
        &self,
        make: impl FnOnce() -> T,
        work: impl FnOnce(&mut T) -> Result<(), E>,
    ) -> Result<(), E> {
        let all = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let idle = all().pop();
        let mut own = idle.unwrap_or_else(make);
        work(&mut own)?;
        all().push(own);
        Ok(())
    }
}
