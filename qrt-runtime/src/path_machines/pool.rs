//! Objects that threads borrow while they work: registers of lanes, rows of bits.

use std::sync::{Mutex, PoisonError};

/// A pool of objects. Later work reuses the objects that earlier work created.
pub(super) struct Pool<T>(Mutex<Vec<T>>);

impl<T> Pool<T> {
    pub(super) fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// Calls `work` with an object of the pool, or with a new one from `make` if the pool is empty.
    /// After an error, the object is not reused.
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
