//! Strategies of uncomputation: how a program trades qubits for gates.
//!
//! A value that is kept to the end is computed once and undone once. A scope is a part of the tracer whose
//! work is undone at its end. It leaves copies of the results that are read outside it, and frees its
//! qubits; it is computed once more when the copies are undone. Each level of nested scopes doubles the
//! cost again (Bennett 1989).

use super::StageName;
use qrt_circuit::Style;
use qrt_scene::{Recomputed, UNCOMPUTE_PARTS, Uncompute};

/// Parts of the tracer whose work can be undone at their ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scope {
    /// A plane and the faces on it, a sphere, or some edges of a mesh, within a search.
    Plane,
    /// A convex body, or all meshes, within a search.
    Body,
    /// A search for an intersection.
    Search,
    /// A ray, from the camera, a surface or to a lamp.
    Ray,
    /// The sampled direction, within a ray.
    Sample,
    /// A component of a vector, within a ray.
    Component,
    /// The side on which a ray meets a surface, and the normal there.
    Side,
    /// The light that a vertex adds.
    Shade,
}

impl Scope {
    /// All scopes.
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

    /// The scope of a stage, if it has one.
    fn from_stage(stage: StageName) -> Option<Self> {
        Some(match stage {
            StageName::Plane(_)
            | StageName::Primitive(_)
            | StageName::Sphere(_)
            | StageName::Edges(_)
            | StageName::Slot(_) => Self::Plane,
            StageName::Body(_) | StageName::Mesh => Self::Body,
            StageName::FindIntersection | StageName::Shadow => Self::Search,
            StageName::GenerateRay | StageName::SampleLight => Self::Ray,
            StageName::Sample => Self::Sample,
            StageName::Component(_) => Self::Component,
            StageName::Side | StageName::Normal => Self::Side,
            StageName::Shade | StageName::Sky => Self::Shade,
            _ => return None,
        })
    }
}

/// Kinds of operations that compute more than their results.
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

/// A strategy of uncomputation: which values are undone when.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Strategy {
    scopes: u16,
    /// By [`Garbage`]: true if it is undone at once, which doubles the gates of the operation.
    lean: [bool; 3],
    /// The values that are recomputed at each use and undone after their last use.
    again: Recomputed,
}

impl Strategy {
    /// Keeps everything to the end: fewest gates, most qubits.
    pub const KEEP: Self = Self {
        scopes: 0,
        lean: [false; 3],
        again: Recomputed::Nothing,
    };

    /// All parts but convex bodies and meshes are scopes. Operations leave no garbage, except within groups of
    /// edges and slots, which are scopes, and encoders.
    pub const SCOPED: Self = Self {
        scopes: ((1 << Scope::ALL.len()) - 1) & !(1 << Scope::Body as u16),
        lean: [true; 3],
        again: Recomputed::Nothing,
    };

    /// The order with the fewest qubits that a search of the reversible pebble game finds, in programs of at most
    /// 64 operations: those of some 25 operations are solved exactly. Larger programs are ordered scope by scope,
    /// with or without parts that are run again, whichever takes fewer qubits.
    pub const PEBBLED: Self = Self {
        again: Recomputed::Any,
        ..Self::SCOPED
    };

    /// The independent choices of a strategy, the most effective first: scopes, the small ones together,
    /// and garbage that is undone at once. Whichever choices are made already, one more saves no Toffolis
    /// and costs no qubits except a few for copies. [`UNCOMPUTE_PARTS`] has their names.
    pub(crate) const CHOICES: [Self; UNCOMPUTE_PARTS.len()] = {
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

    /// Number of subsets of [`Strategy::CHOICES`].
    pub(crate) const CHOSEN: usize = 1 << Self::CHOICES.len();

    /// The strategy with those of [`Strategy::CHOICES`] whose bits are set.
    pub(crate) fn of_choices(bits: usize) -> Self {
        let chosen = Self::CHOICES.iter().enumerate();
        let chosen = chosen.filter(|(place, _)| bits >> place & 1 == 1);
        chosen.fold(Self::KEEP, |all, (_, one)| Self {
            scopes: all.scopes | one.scopes,
            lean: [0, 1, 2].map(|kind| all.lean[kind] | one.lean[kind]),
            ..all
        })
    }

    /// The strategy of a scene's `circuit.uncompute`; none for `auto`, which chooses one.
    pub fn from_uncompute(uncompute: Uncompute) -> Option<Self> {
        let (parts, again) = uncompute.parts()?;
        Some(Self {
            again,
            ..Self::of_choices(parts.into())
        })
    }

    /// The value of a scene's `circuit.uncompute` that names this strategy.
    ///
    /// ```
    /// use qrt_core::compile::Strategy;
    /// for strategy in Strategy::all() {
    ///     assert_eq!(Strategy::from_uncompute(strategy.uncompute()), Some(strategy));
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
        Uncompute::of_parts(parts, self.again)
    }

    /// The strategy with these `scopes`, in which operations undo the garbage in `lean` at once.
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

    /// The same strategy, but it recomputes cheap values at each use and undoes them after the last.
    pub(crate) const fn recomputing(mut self) -> Self {
        self.again = Recomputed::Cheap;
        self
    }

    /// The same as [`Strategy::recomputing`], but it undoes more values, by recomputing their inputs.
    pub(crate) const fn running_again(mut self) -> Self {
        self.again = Recomputed::Sources;
        self
    }

    /// True if the recording computes cheap values at each use.
    pub(crate) const fn recomputes(self) -> bool {
        matches!(self.again, Recomputed::Cheap | Recomputed::Sources)
    }

    /// True if values may be undone after their last use, before the end of their scope.
    pub(super) const fn undoes_early(self) -> bool {
        !matches!(self.again, Recomputed::Nothing)
    }

    /// True if inputs of a value may be recomputed to undo it.
    pub(super) const fn runs_again(self) -> bool {
        matches!(self.again, Recomputed::Sources | Recomputed::Any)
    }

    /// True if small programs take the order with the fewest qubits.
    pub(crate) const fn pebbles(self) -> bool {
        matches!(self.again, Recomputed::Any)
    }

    /// Number of kinds of recordings that strategies need.
    pub(crate) const RECORDINGS: usize = 16;

    /// The kind of recording that the strategy needs, a number below [`Strategy::RECORDINGS`]. Strategies
    /// of one kind differ in the passes after the recording.
    pub(crate) fn recording(self) -> usize {
        let flags = [self.lean[0], self.lean[1], self.lean[2], self.recomputes()];
        flags
            .iter()
            .fold(0, |number, flag| 2 * number + usize::from(*flag))
    }

    /// Number of kinds of [`Strategy::stem`].
    pub(crate) const STEMS: usize = 2 * Self::RECORDINGS;

    /// A number below [`Strategy::STEMS`] that strategies share whose programs are alike until the passes that
    /// depend on other scopes than planes.
    pub(crate) fn stem(self) -> usize {
        2 * self.recording() + usize::from(self.undoes(Scope::Plane))
    }

    /// The places in `all` of strategies whose costs are found together, group by group.
    ///
    /// ```
    /// use qrt_core::compile::Strategy;
    /// let all = Strategy::all();
    /// let groups = Strategy::groups(&all);
    /// let mut places = groups.concat();
    /// places.sort();
    /// assert_eq!(places, (0..all.len()).collect::<Vec<_>>());
    /// ```
    pub fn groups(all: &[Self]) -> Vec<Vec<usize>> {
        let mut groups = vec![Vec::new(); Self::STEMS];
        for (place, strategy) in all.iter().enumerate() {
            groups[strategy.stem()].push(place);
        }
        groups.retain(|group| !group.is_empty());
        groups
    }

    /// All strategies worth trying. Those that recompute leave no garbage: they would leave it at each
    /// recomputation.
    pub fn all() -> Vec<Self> {
        let kept = (0..Self::CHOSEN).map(Self::of_choices);
        let anew = Self::all_without_garbage()
            .flat_map(|strategy| [strategy.recomputing(), strategy.running_again()]);
        kept.chain(anew).chain([Self::PEBBLED]).collect()
    }

    /// The strategies of [`Strategy::all`] that recompute nothing and leave no garbage.
    pub(crate) fn all_without_garbage() -> impl Iterator<Item = Self> {
        let kept = (0..Self::CHOSEN).map(Self::of_choices);
        kept.filter(|strategy| strategy.lean == [true; 3])
    }

    /// The style in which operations with this garbage are lowered.
    pub const fn style(&self, garbage: Garbage) -> Style {
        if self.lean[garbage as usize] {
            Style::InPlace
        } else {
            Style::OutOfPlace
        }
    }

    /// True if the work of this scope is undone at its end.
    pub(crate) const fn undoes(self, scope: Scope) -> bool {
        self.scopes >> scope as u16 & 1 == 1
    }

    /// True if a block of this stage is a scope.
    pub(super) fn is_scope(self, stage: StageName) -> bool {
        Scope::from_stage(stage).is_some_and(|scope| self.undoes(scope))
    }

    /// True if no scope is undone before the end.
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
