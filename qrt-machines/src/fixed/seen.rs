//! Values that steps read or compute.

use super::lane::Kind;

/// A value that a step reads or computes: its kind, and its place.
pub(super) struct Seen<'a> {
    pub(super) kind: Kind,
    pub(super) place: &'a mut u32,
    pub(super) computed: bool,
}

impl<'a> Seen<'a> {
    pub(super) fn read(kind: Kind, place: &'a mut u32) -> Self {
        Self {
            kind,
            place,
            computed: false,
        }
    }

    pub(super) fn computed(kind: Kind, place: &'a mut u32) -> Self {
        Self {
            kind,
            place,
            computed: true,
        }
    }
}
