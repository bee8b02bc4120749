//! Colours and marks of series, the same in every plot.

use qrt_drawing::{STYLES, Series};
use qrt_scene::Estimator;

/// The style ([`Series::style`]) of a series that several plots share, by its name.
///
/// Names are those of estimators, sequences of paths, parts of the error, and the series that they
/// are compared with. `None` for any other name.
///
/// ```
/// use qrt_lab::trade::style;
/// assert_eq!(style("digital-net"), style("digital net"));
/// assert_ne!(style("paper"), style("adaptive-bayes"));
/// assert_eq!(style("qubits"), None);
/// ```
pub fn style(name: &str) -> Option<usize> {
    let mut estimators = Estimator::ALL.iter();
    if let Some(estimator) = estimators.find(|estimator| estimator.name() == name) {
        return style_of(*estimator);
    }
    Some(match name {
        "counting" | "total" => 0,
        "random paths" | "counting, E_T" => 1,
        "digital-net" | "digital net" | "paths, E_R" => 2,
        "product-lattice" | "product lattice" | "comparators, E_C" => 3,
        "width, E_W" => 4,
        "the front" | "depth, E_D" => 5,
        "all settings" => 14,
        _ => return None,
    })
}

/// An estimator's style; `None` for `exact`, which measures nothing. Styles 8 to 15 are 0 to 7 with
/// hollow marks. No estimator has the style of the net, and no two have the same.
fn style_of(estimator: Estimator) -> Option<usize> {
    Some(match estimator {
        Estimator::Exact => return None,
        Estimator::AdaptiveBayes => 0,
        Estimator::MonteCarlo => 1,
        Estimator::Paper => 3,
        Estimator::Sine => 4,
        Estimator::Mlae => 5,
        Estimator::Iqae => 6,
        Estimator::PhaseMean => 7,
        Estimator::RandomDepth => 8,
        Estimator::Qcoin => 9,
        Estimator::PosteriorMean => 10,
        Estimator::AbramsWilliams => 11,
        Estimator::Chebyshev => 12,
        Estimator::Qss => 13,
        Estimator::Miqae => 14,
        Estimator::Auto => 15,
    })
}

/// The style of the same colour, with hollow marks in place of filled ones and the reverse.
pub(super) fn hollow(style: usize) -> usize {
    (style + STYLES / 2) % STYLES
}

/// `wanted`, or the first style that none of `others` has.
pub(super) fn free(wanted: usize, others: &[Series]) -> usize {
    let taken = |style: &usize| others.iter().any(|series| series.style == Some(*style));
    let mut choice = std::iter::once(wanted).chain(0..STYLES);
    choice.find(|style| !taken(style)).unwrap_or(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;
    use qrt_drawing::Drawn;
    use qrt_scene::Sequence;

    /// Checks the series that share a plot: all estimators, or both sequences and random paths.
    #[test]
    fn what_stands_in_one_plot_is_told_apart() {
        let estimators = Estimator::ALL.iter().filter(|e| **e != Estimator::Exact);
        let net = style(Sequence::DigitalNet.name());
        let mut found: Vec<Option<usize>> = estimators.map(|e| style(e.name())).collect();
        assert!(!found.contains(&None) && !found.contains(&net));
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len(), Estimator::ALL.len() - 1);
        assert!(found.iter().flatten().all(|style| *style < STYLES));
        let paths = ["digital-net", "product-lattice", "random paths"].map(style);
        assert!(paths[0] != paths[1] && paths[1] != paths[2] && paths[0] != paths[2]);
    }

    #[test]
    fn a_style_that_is_taken_gives_way() {
        let taken = |style| Series::new("", [], Drawn::Points).styled(style);
        assert_eq!(free(3, &[]), 3);
        assert_eq!(free(1, &[taken(1), taken(0)]), 2);
        assert_eq!(hollow(hollow(4)), 4);
    }
}
