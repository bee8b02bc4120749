//! The distribution of the phase register's outcomes.

use crate::count::CountFigures;
use serde_json::{Value, json};

/// Returns the listed outcomes with their probabilities; if outcomes were drawn, the estimate and the posterior.
pub fn count(count: &CountFigures) -> Value {
    let options = &count.options;
    let outcomes: Vec<Value> = count
        .outcomes
        .iter()
        .map(|&y| {
            let probability = count.distribution.probability(y);
            json!({ "y": y, "theta": count.phase(y), "probability": probability })
        })
        .collect();
    let mut answer = json!({
        "version": 1,
        "good": options.good,
        "total": options.total,
        "phase_bits": options.phase_bits,
        "window": options.window.name(),
        "theta": count.distribution.theta(),
        "shown": count.listed.name(),
        "outcomes": outcomes,
    });
    if let Some(drawn) = &count.drawn {
        answer["seed"] = json!(options.seed);
        answer["draws"] = drawn
            .counts
            .iter()
            .map(|(y, times)| json!({ "y": y, "count": times }))
            .collect();
        let estimate = &drawn.estimate;
        answer["estimate"] = json!({
            "good": estimate.good,
            "amplitude": estimate.amplitude,
            "interval": [estimate.interval.0, estimate.interval.1],
            "confidence": estimate.confidence,
            "queries": estimate.queries,
            "shots": estimate.shots,
            "ln_likelihood": estimate.ln_likelihood,
        });
        if let Some(posterior) = &drawn.posterior {
            let likeliest: Vec<Value> = posterior
                .likeliest
                .iter()
                .map(|(good, p)| json!({ "good": good, "probability": p }))
                .collect();
            answer["posterior"] = json!({
                "mean": posterior.mean,
                "standard_deviation": posterior.deviation,
                "likeliest": likeliest,
            });
        }
    }
    answer
}
