//! When work is undone: how a program trades qubits for gates.
//!
//! What is kept to the end is computed once and undone once. What is undone at the end of a part of the
//! tracer, its scope, leaves copies of what others read, and frees its qubits; it is computed once more
//! when the copies are undone. Scopes within scopes double again (Bennett 1989).

use super::StageName;
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

    /// Its name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Body => "body",
            Self::Search => "search",
            Self::Ray => "ray",
            Self::Sample => "sample",
            Self::Component => "xyz",
            Self::Side => "side",
            Self::Shade => "shade",
        }
    }

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

    /// From the fewest gates to the fewest qubits, in steps: what `uncompute: auto` chooses from.
    pub const LADDER: [Self; 23] = {
        use Garbage::{Products, Quotients, Tables};
        use Scope::{Body, Component, Plane, Ray, Sample, Search, Shade, Side};
        const ALL: &[Garbage] = &[Tables, Products, Quotients];
        [
            Self::KEEP,
            Self::new(&[Component], &[]),
            Self::new(&[Ray], &[]),
            Self::new(&[], &[Quotients]),
            Self::new(&[Component], &[Quotients]),
            Self::new(&[Plane], &[]),
            Self::new(&[Plane, Component], &[]),
            Self::new(&[Plane, Sample, Component, Side, Shade], &[]),
            Self::new(&[Plane], &[Tables, Products]),
            Self::new(&[Plane, Component], &[Tables, Products]),
            Self::new(&[Plane, Search, Ray, Sample, Component, Side, Shade], &[]),
            Self::new(&[Plane, Body, Component], &[Tables, Products]),
            Self::new(&[Plane, Search, Component], &[Tables, Products]),
            Self::new(&[Plane, Search, Ray], &[Tables, Products]),
            Self::new(&[Plane, Search, Ray], ALL),
            Self::new(&[Plane, Body, Search, Sample, Component, Side, Shade], ALL),
            Self::new(&Scope::ALL, ALL),
            Self::new(&[Plane, Sample, Component, Side, Shade], ALL).recomputing(),
            Self::new(&[Plane, Body, Ray, Sample, Component, Side, Shade], ALL).recomputing(),
            Self::new(&[Plane, Search, Ray, Component], ALL).recomputing(),
            Self::new(&[Plane, Search, Ray, Sample, Component, Side, Shade], ALL).recomputing(),
            Self::new(&Scope::ALL, ALL).recomputing(),
            Self::new(&Scope::ALL, ALL).running_again(),
        ]
    };

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

    /// All that are worth trying: the small parts of a ray's way together, everything else apart.
    pub fn all() -> Vec<Self> {
        let [plane, body, search, ray, sample, component, side, shade] =
            Scope::ALL.map(|scope| vec![scope]);
        let small = [sample, side, shade].concat();
        let parts = [plane, body, search, ray, component, small];
        let chosen = |bits: usize| {
            let parts = parts.iter().enumerate();
            let parts = parts.filter(move |(k, _)| bits >> k & 1 == 1);
            parts
                .flat_map(|(_, scopes)| scopes.clone())
                .collect::<Vec<_>>()
        };
        let lean = |bits: usize| {
            let all = Garbage::ALL.into_iter().enumerate();
            all.filter(move |(k, _)| bits >> k & 1 == 1)
                .map(|(_, garbage)| garbage)
                .collect::<Vec<_>>()
        };
        let scopes = 0..1 << parts.len();
        let pairs = scopes.clone().flat_map(|s| (0..8).map(move |l| (s, l)));
        let kept = pairs.map(|(s, l)| Self::new(&chosen(s), &lean(l)));
        // Computed anew, what leaves garbage would leave it as often.
        let anew = scopes.map(|s| Self::new(&chosen(s), &Garbage::ALL));
        let anew = anew.flat_map(|strategy| [strategy.recomputing(), strategy.running_again()]);
        kept.chain(anew).collect()
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

impl std::fmt::Display for Strategy {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names = Scope::ALL.iter().filter(|scope| self.undoes(**scope));
        let names: Vec<&str> = names.map(|scope| scope.name()).collect();
        let lean = self.lean.iter().zip(["tables", "products", "quotients"]);
        let lean: Vec<&str> = lean
            .filter_map(|(lean, name)| lean.then_some(name))
            .collect();
        match (names.as_slice(), lean.as_slice()) {
            ([], []) => f.write_str("nothing")?,
            (names, []) => f.write_str(&names.join(" "))?,
            ([], lean) => write!(f, "garbage of {}", lean.join(" "))?,
            (names, lean) => write!(f, "{}; garbage of {}", names.join(" "), lean.join(" "))?,
        }
        f.write_str(match (self.recomputes, self.runs_again) {
            (_, true) => "; all that nobody reads",
            (true, false) => "; what nobody reads",
            (false, false) => "",
        })
    }
}
