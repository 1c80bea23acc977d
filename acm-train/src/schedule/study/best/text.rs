//! Printed result: all candidates under the folds, the choice with its reason, and the held-out score.

use std::path::Path;

use acm_core::display::{Display, plain, signed, with_spread};
use acm_datasets::text::{
    hint::{argument, command},
    terminal::ruled,
};

use super::{
    candidate::{self, Candidate},
    record::{BestRecord, WINNER},
};
use crate::run::evaluation::intervals::Intervals;
use crate::run::evaluation::spread::Spread;
use crate::run::evaluation::summary::{self, count, in_unit, total_name};
use crate::run::record::PartScores;

/// Largest number of folds that have their own columns.
const MOST_FOLDS: usize = 6;

/// Writes the printed text; the study is in `out`.
pub fn of(record: &BestRecord, intervals: Option<&Intervals>, out: &Path) -> String {
    let intervals = intervals.map_or(String::new(), |found| format!("\n\n{}", found.shown(&display(record))));
    let synthetic = if record.data.synthetic { " — synthetic data" } else { "" };
    let notes: String = record.notes.iter().map(|note| format!("\n{note}")).collect();
    let root = out.display();
    let page = command("acm-eval", "report", out, "");
    format!(
        "{}\n{}{synthetic}\n\n{}\n\n{}{notes}\n\n{}{intervals}\n\nrecords and predictions: {root}\na page: {page}\n{}",
        record.question,
        record.data.title,
        table(record),
        why(record),
        held_out(record),
        beside_a_robot(record, out)
    )
}

/// Writes how to use it on a robot, or why it cannot be used there.
fn beside_a_robot(record: &BestRecord, out: &Path) -> String {
    let stream = || {
        let saved = argument(out.join("robot.json").display());
        command("acm-eval", "stream", out, &format!(" --save {saved}"))
    };
    match (record.chosen().streams, record.winner.trained) {
        (true, true) => format!("beside a robot: {}", stream()),
        (true, false) => "beside a robot: once it is trained to the end, with protocol.final = true".into(),
        (false, _) => {
            "beside a robot: an outside baseline has no form there; with robot = true in [best], what is chosen has one"
                .into()
        }
    }
}

/// Returns the errors in one unit, by the largest of them.
pub fn display(record: &BestRecord) -> Display {
    let finite = record.candidates.iter().map(|candidate| candidate.mean).filter(|mean| mean.is_finite());
    Display::of(&record.data.unit, finite.fold(0.0, f64::max))
}

/// Writes the chosen model, and why it was chosen, in a sentence.
pub fn why(record: &BestRecord) -> String {
    let shown = display(record);
    reason(&record.candidates, " beyond the nominal model", |error| shown.show(error))
}

/// Writes which of the candidates was chosen, and why, in a sentence; `beyond` says what their numbers are beyond.
pub fn reason(candidates: &[Candidate], beyond: &str, shown: impl Fn(f64) -> String) -> String {
    let (chosen, least) = (candidate::chosen(candidates), candidate::least(candidates));
    let error = |candidate: &Candidate| shown(candidate.mean);
    let good = candidates.iter().filter(|candidate| candidate.as_good).count();
    if good == 1 {
        return format!(
            "Use {}: it errs least, {}, and no other is within one standard error.",
            chosen.name(),
            error(chosen)
        );
    }
    let numbers = |candidate: &Candidate| count(candidate.numbers, "fitted number");
    if chosen == least {
        let what = "errs least and is the simplest within one standard error";
        return format!("Use {}: with {} and {} it {what}.", chosen.name(), error(chosen), numbers(chosen));
    }
    format!(
        "Use {}: with {} and {}{beyond} it is the simplest of {good} within one standard error of the best, \
         {} ({}, {}).",
        chosen.name(),
        error(chosen),
        numbers(chosen),
        least.name(),
        error(least),
        numbers(least)
    )
}

fn table(record: &BestRecord) -> String {
    let shown = display(record);
    let folds = record.candidates.iter().map(|candidate| candidate.errors.0.len()).max().unwrap_or(0);
    let columns = if folds > MOST_FOLDS { 0 } else { folds };
    let total = total_name(&record.data.unit, record.outputs.len()).to_string();
    let header = std::iter::once(String::new())
        .chain((0..columns).map(|fold| format!("fold {fold}")))
        .chain([
            total + ", mean ± sd",
            shown.label("more than the best, ± standard error"),
            "numbers".into(),
            String::new(),
        ])
        .collect();
    let rows = record.candidates.iter().map(|candidate| row(candidate, columns, &shown)).collect();
    format!(
        "RMSE{} in cross-validation, {}; the simplest within one standard error of the best, or 1 %, is chosen\n{}",
        in_unit(&shown),
        record.folds,
        ruled(header, rows, 1)
    )
}

fn row(candidate: &Candidate, columns: usize, shown: &Display) -> Vec<String> {
    let spread = Spread::of(&candidate.errors.0).map_or(String::new(), |spread| spread.text(shown.factor));
    let more = with_spread(shown.factor * candidate.more, candidate.standard_error.map(|se| shown.factor * se));
    let more = if candidate.more == 0.0 { String::new() } else { signed(candidate.more, more) };
    let folds = candidate.errors.0.iter().take(columns).map(|error| plain(shown.factor * error, 2));
    [candidate.name()]
        .into_iter()
        .chain(folds)
        .chain([spread, more, candidate.numbers.to_string(), candidate.mark().into()])
        .collect()
}

fn held_out(record: &BestRecord) -> String {
    let Some(scores) = &record.winner.held_out else {
        return "No held-out trial was read: protocol.final is false, or there is none.".into();
    };
    let shown = summary::display(&record.data.unit, [scores]);
    let total = total_name(&record.data.unit, record.outputs.len()).to_string();
    let header = std::iter::once(String::new())
        .chain(record.outputs.iter().cloned())
        .chain([total, "better than nominal".into()]);
    let names =
        [("nominal", "nominal".to_string()), ("polynomial", "polynomial".into()), (WINNER, record.chosen().name())];
    let rows = names.iter().filter_map(|(key, name)| scored(scores, key, name, &shown)).collect();
    format!(
        "Held-out trials, which took no part, the winner alone and once: RMSE{}\n{}",
        in_unit(&shown),
        ruled(header.collect(), rows, 1)
    )
}

fn scored(scores: &PartScores, key: &str, name: &str, shown: &Display) -> Option<Vec<String>> {
    let (score, nominal) = (scores.estimators.get(key)?, scores.estimators.get("nominal")?);
    let gain = 100.0 * (1.0 - score.rmse_total / nominal.rmse_total);
    let gain = if key == "nominal" || !gain.is_finite() {
        String::new()
    } else {
        format!("{} %", signed(gain, plain(gain, 1)))
    };
    let error = |value: &f64| plain(shown.factor * value, 2);
    Some(
        [name.to_string()]
            .into_iter()
            .chain(score.rmse.iter().map(error))
            .chain([error(&score.rmse_total), gain])
            .collect(),
    )
}
