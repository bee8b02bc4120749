//! The problems of a scene, for an editor that underlines them.

use super::Answer;
use qrt_scene::front::Loaded;
use qrt_syntax::{Report, Reported};

/// Answers the problems of a scene, or its warnings and its properties. `from` and `to` count
/// UTF-16 units, as scripts do. A problem without a place is put at the start of the text.
pub(super) fn check(loaded: Result<Loaded, Report>) -> Answer {
    match loaded {
        Err(report) => problems(Answer::default().number("valid", 0.0), &report),
        Ok(loaded) => {
            let scene = loaded.valid.scene();
            let answer = Answer::default()
                .number("valid", 1.0)
                .text("name", scene.name.as_str())
                .number("width", scene.film.width.into())
                .number("height", scene.film.height.into())
                .number("polygons", loaded.valid.polygons().len() as f64)
                .number("planned", f64::from(scene.accuracy.is_some()));
            match loaded.warnings() {
                Some(report) => problems(answer, &report),
                None => answer,
            }
        }
    }
}

fn problems(answer: Answer, report: &Report) -> Answer {
    let all: Vec<Reported<'_>> = report.problems().collect();
    let text = report.text();
    let at = |bytes: usize| text.get(..bytes).map_or(0, |t| t.encode_utf16().count()) as f64;
    let place = |of: fn(&std::ops::Range<usize>) -> usize| {
        all.iter().map(move |problem| {
            let place = problem.place.as_ref().filter(|place| place.in_scene);
            place.map_or(0, |place| of(&place.bytes))
        })
    };
    let line = |text: &str| text.replace('\n', " ");
    let lines = |of: fn(&Reported<'_>) -> String| -> Vec<String> {
        all.iter().map(|problem| line(&of(problem))).collect()
    };
    answer
        .number("problems", all.len() as f64)
        .list("from", place(|bytes| bytes.start).map(at))
        .list("to", place(|bytes| bytes.end).map(at))
        .list(
            "line",
            all.iter()
                .map(|problem| problem.place.as_ref().map_or(0, |place| place.line) as f64),
        )
        .list(
            "column",
            all.iter()
                .map(|problem| problem.place.as_ref().map_or(0, |place| place.column) as f64),
        )
        .lines("codes", &lines(|problem| problem.code.to_owned()))
        .lines("messages", &lines(|problem| problem.message.to_owned()))
        .lines("labels", &lines(|problem| problem.label.to_owned()))
        .lines(
            "helps",
            &lines(|problem| problem.help.unwrap_or_default().to_owned()),
        )
}
