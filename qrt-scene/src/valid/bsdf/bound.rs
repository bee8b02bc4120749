//! A proven upper bound of an expression.

use qrt_syntax::expr::{Domain, Expr, Interval, Variable, Variables};
use std::collections::BinaryHeap;

/// A part of the domain, ordered by its upper bound.
struct Candidate {
    bound: f64,
    domain: Domain,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}
impl Eq for Candidate {}
impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// Returns an upper bound of `e`, and of 0, over the domain `whole`, by branch and bound. It halves
/// the part with the highest bound until a known value is nearly as high, or the step limit is
/// reached.
pub(super) fn supremum(e: &Expr, whole: &Domain) -> f64 {
    const EFFORT: usize = 4096;
    const CLOSE: f64 = 1.0 + 1e-4;
    let variables: Vec<Variable> = e.variables(e.root()).iter().collect();
    let bound = |domain: &Domain| e.range(domain).map_or(0.0, |range| range.hi.max(0.0));
    let mut heap = BinaryHeap::from([Candidate {
        bound: bound(whole),
        domain: *whole,
    }]);
    let mut reached: f64 = 0.0;
    let mut least_bound = f64::INFINITY;
    for _ in 0..EFFORT {
        let Some(Candidate {
            bound: highest,
            domain,
        }) = heap.pop()
        else {
            break;
        };
        least_bound = least_bound.min(highest);
        let width = |v: &Variable| {
            let (part, all) = (domain.get(*v), whole.get(*v));
            // A coordinate that is the same on all faces has no width.
            (part.hi - part.lo) / (all.hi - all.lo).max(f64::MIN_POSITIVE)
        };
        let widest = variables
            .iter()
            .max_by(|a, b| width(a).total_cmp(&width(b)));
        let Some(widest) = widest.filter(|_| highest > reached * CLOSE) else {
            break;
        };
        let Interval { lo, hi } = domain.get(*widest);
        let middle = lo + (hi - lo) / 2.0;
        if !(lo < middle && middle < hi) {
            break;
        }
        for half in [Interval { lo, hi: middle }, Interval { lo: middle, hi }] {
            let mut domain = domain;
            *domain.get_mut(*widest) = half;
            let centre = |v| {
                let Interval { lo, hi } = domain.get(v);
                lo + (hi - lo) / 2.0
            };
            let at = Variables {
                u: centre(Variable::U),
                v: centre(Variable::V),
                cos_i: centre(Variable::CosI),
                cos_o: centre(Variable::CosO),
                cos_a: centre(Variable::CosA),
                x: centre(Variable::X),
                y: centre(Variable::Y),
                z: centre(Variable::Z),
            };
            let value = e.eval(&at);
            if value.is_finite() {
                reached = reached.max(value);
            }
            heap.push(Candidate {
                bound: bound(&domain),
                domain,
            });
        }
    }
    least_bound * (1.0 + 1e-9)
}

/// True if `e` is not proven to be nonnegative everywhere in `domain`.
pub(super) fn may_be_negative(e: &Expr, domain: &Domain) -> bool {
    supremum(&-e, domain) > 0.0
}
