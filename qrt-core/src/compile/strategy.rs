//! When work is undone: how a program trades qubits for gates.
//!
//! What is kept to the end is computed once and undone once. What is undone at the end of a part of the
//! tracer, its scope, leaves copies of what others read, and frees its qubits; it is computed once more
//! when the copies are undone. Scopes within scopes double again (Bennett 1989).

use super::StageName;
use crate::scene::{Again, PARTS, Uncompute};
use qrt_circuit::Style;

/// Parts of the tracer whose work can be undone at their ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scope {
    /// A plane and the faces on it, within a search.
    Plane,
    /// A convex body, within a search.
    Body,
    /// A search for an intersection.
    Search,
    /// A ray, from the camera, a surface or to a lamp.
    Ray,
    /// The sampled direction, within a ray.
    Sample,
    /// A component of a vector, within a ray.
    Component,
    /// On which side a surface is met.
    Side,
    /// The light that a vertex adds.
    Shade,
}

impl Scope {
    /// All of them, from the parts to the whole.
    pub const ALL: [Self; 8] = [
        Self::Plane,
        Self::Body,
        Self::Search,
        Self::Ray,
        Self::Sample,
        Self::Component,
        Self::Side,
        Self::Shade,
    ];

    /// The scope that a stage is.
    fn of(stage: StageName) -> Option<Self> {
        Some(match stage {
            StageName::Plane(_) | StageName::Primitive(_) => Self::Plane,
            StageName::Body(_) => Self::Body,
            StageName::FindIntersection | StageName::Shadow => Self::Search,
            StageName::GenerateRay | StageName::SampleLight => Self::Ray,
            StageName::Sample => Self::Sample,
            StageName::Component(_) => Self::Component,
            StageName::Side => Self::Side,
            StageName::Shade => Self::Shade,
            _ => return None,
        })
    }
}

/// Operations that compute more than their results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Garbage {
    /// Tables.
    Tables,
    /// Products and squares.
    Products,
    /// Quotients and roots.
    Quotients,
}

impl Garbage {
    /// All kinds of operations that have an out-of-place and an in-place form.
    pub const ALL: [Self; 3] = [Self::Tables, Self::Products, Self::Quotients];
}

/// What is undone when.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Strategy {
    scopes: u16,
    /// By [`Garbage`]: whether it is undone at once, for as many gates again.
    lean: [bool; 3],
    /// Whether what is cheap is computed anew where it is read, and undone where nobody reads it any more.
    recomputes: bool,
    /// Whether more is undone, by running again what it was computed from.
    runs_again: bool,
}

impl Strategy {
    /// Everything stays to the end: fewest gates, most qubits.
    pub const KEEP: Self = Self {
        scopes: 0,
        lean: [false; 3],
        recomputes: false,
        runs_again: false,
    };

    /// All parts but convex bodies are scopes, and operations leave no garbage.
    pub const SCOPED: Self = Self {
        scopes: ((1 << Scope::ALL.len()) - 1) & !(1 << Scope::Body as u16),
        lean: [true; 3],
        recomputes: false,
        runs_again: false,
    };

    /// What is decided one by one, what changes most first: parts of a ray's way that are undone at their
    /// ends, the small ones together, and garbage that is undone at once. Whichever are taken already, one
    /// more costs no fewer Toffolis, and no more qubits but for a few that it copies.
    /// [`PARTS`] has their names.
    pub(crate) const CHOICES: [Self; PARTS.len()] = {
        use Garbage::{Products, Quotients, Tables};
        use Scope::{Body, Component, Plane, Ray, Sample, Search, Shade, Side};
        [
            Self::new(&[Plane], &[]),
            Self::new(&[], &[Products]),
            Self::new(&[Ray], &[]),
            Self::new(&[Search], &[]),
            Self::new(&[], &[Tables]),
            Self::new(&[], &[Quotients]),
            Self::new(&[Body], &[]),
            Self::new(&[Sample, Side, Shade], &[]),
            Self::new(&[Component], &[]),
        ]
    };

    /// How many choices there are of some of [`Strategy::CHOICES`].
    pub(crate) const CHOSEN: usize = 1 << Self::CHOICES.len();

    /// Those of [`Strategy::CHOICES`] whose bits are set.
    pub(crate) fn of_choices(bits: usize) -> Self {
        let chosen = Self::CHOICES.iter().enumerate();
        let chosen = chosen.filter(|(place, _)| bits >> place & 1 == 1);
        chosen.fold(Self::KEEP, |all, (_, one)| Self {
            scopes: all.scopes | one.scopes,
            lean: [0, 1, 2].map(|kind| all.lean[kind] | one.lean[kind]),
            ..all
        })
    }

    /// The strategy of a scene's `circuit.uncompute`; none of `auto`, which chooses one.
    pub fn of(uncompute: Uncompute) -> Option<Self> {
        let (parts, again) = uncompute.parts()?;
        let kept = Self::of_choices(parts.into());
        Some(match again {
            Again::Nothing => kept,
            Again::Cheap => kept.recomputing(),
            Again::Sources => kept.running_again(),
        })
    }

    /// The value of a scene's `circuit.uncompute` that names this strategy.
    ///
    /// ```
    /// use qrt_core::compile::Strategy;
    /// for strategy in Strategy::all() {
    ///     assert_eq!(Strategy::of(strategy.uncompute()), Some(strategy));
    /// }
    /// ```
    pub fn uncompute(self) -> Uncompute {
        let is_taken = |one: &Self| {
            let mut lean = self.lean.iter().zip(one.lean);
            self.scopes & one.scopes == one.scopes && lean.all(|(own, lean)| *own || !lean)
        };
        let choices = Self::CHOICES.iter().enumerate();
        let parts = choices.filter(|(_, one)| is_taken(one));
        let parts = parts.fold(0, |parts, (bit, _)| parts | 1 << bit);
        Uncompute::of_parts(
            parts,
            match (self.recomputes, self.runs_again) {
                (_, true) => Again::Sources,
                (true, false) => Again::Cheap,
                (false, false) => Again::Nothing,
            },
        )
    }

    /// These scopes, and operations that undo this garbage at once.
    pub const fn new(scopes: &[Scope], lean: &[Garbage]) -> Self {
        let mut strategy = Self::KEEP;
        let mut at = 0;
        while at < scopes.len() {
            strategy.scopes |= 1 << scopes[at] as u16;
            at += 1;
        }
        at = 0;
        while at < lean.len() {
            strategy.lean[lean[at] as usize] = true;
            at += 1;
        }
        strategy
    }

    /// The same, but that what is cheap is computed anew where it is read, and undone where nobody reads
    /// it any more.
    pub const fn recomputing(mut self) -> Self {
        self.recomputes = true;
        self
    }

    /// The same as [`Strategy::recomputing`], and more is undone, by running again what it was computed
    /// from.
    pub const fn running_again(mut self) -> Self {
        self.runs_again = true;
        self.recomputing()
    }

    /// Whether what is cheap is computed anew where it is read, and undone where nobody reads it any more.
    pub const fn recomputes(&self) -> bool {
        self.recomputes
    }

    /// Whether more is undone, by running again what it was computed from.
    pub const fn runs_again(&self) -> bool {
        self.runs_again
    }

    /// How many kinds of recordings strategies need.
    pub(crate) const RECORDINGS: usize = 16;

    /// The number of the kind of recording that it needs, below [`Strategy::RECORDINGS`]: strategies of
    /// one kind differ in what is made of it.
    pub(crate) fn recording(self) -> usize {
        let flags = [self.lean[0], self.lean[1], self.lean[2], self.recomputes];
        flags
            .iter()
            .fold(0, |number, flag| 2 * number + usize::from(*flag))
    }

    /// All that are worth trying. What is computed anew and leaves garbage would leave it as often.
    pub fn all() -> Vec<Self> {
        let kept = (0..Self::CHOSEN).map(Self::of_choices);
        let anew = Self::all_without_garbage()
            .flat_map(|strategy| [strategy.recomputing(), strategy.running_again()]);
        kept.chain(anew).collect()
    }

    /// Those of them that compute nothing anew and leave no garbage.
    pub(crate) fn all_without_garbage() -> impl Iterator<Item = Self> {
        let kept = (0..Self::CHOSEN).map(Self::of_choices);
        kept.filter(|strategy| strategy.lean == [true; 3])
    }

    /// How operations are lowered that have this garbage.
    pub const fn style(&self, garbage: Garbage) -> Style {
        if self.lean[garbage as usize] {
            Style::InPlace
        } else {
            Style::OutOfPlace
        }
    }

    /// Whether the work of these parts is undone at their ends.
    pub const fn undoes(&self, scope: Scope) -> bool {
        self.scopes >> scope as u16 & 1 == 1
    }

    /// Whether a block of this stage is a scope.
    pub(super) fn is_scope(self, stage: StageName) -> bool {
        Scope::of(stage).is_some_and(|scope| self.undoes(scope))
    }

    /// Whether anything is undone before the end.
    pub(super) const fn is_keep(self) -> bool {
        self.scopes == 0
    }
}

/// Writes the value of `circuit.uncompute` that names this strategy.
impl std::fmt::Display for Strategy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.uncompute().name())
    }
}
