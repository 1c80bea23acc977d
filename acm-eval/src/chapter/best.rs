//! Chapter of `study = "best"`: all candidates under the folds, the steps to an average, and the winner on held-out trials.

use std::path::Path;

use acm_train::run::evaluation::intervals::{self, Interval, Intervals};
use acm_train::run::evaluation::spread::Spread;
use acm_train::run::evaluation::summary;
use acm_train::run::record::{PartScores, Versions};
use acm_train::schedule::study::best::average::Step;
use acm_train::schedule::study::best::candidate::Candidate;
use acm_train::schedule::study::best::record::{BestRecord, FILE, WINNER};
use acm_train::schedule::study::best::text::{display, why};
use maud::{Markup, html};

use super::Chapter;
use crate::{
    error::EvalError,
    json::versioned,
    tables::{Cell, Column, Row, Table},
    unit::{Display, total_name},
};

/// Reads `best.json` of a study's folder.
///
/// # Errors
/// It is missing: the study was stopped; or it is damaged.
pub fn read(folder: &Path) -> Result<BestRecord, EvalError> {
    let file = folder.join(FILE);
    if !file.is_file() {
        return Err(EvalError::Unfinished { folder: folder.into(), run: file });
    }
    let record: BestRecord = versioned(&file)?;
    match record.candidates.is_empty() {
        true => Err(EvalError::Record { file, reason: "it names no candidate".into() }),
        false => Ok(record),
    }
}

/// Returns the chapter.
///
/// # Errors
/// As [`read`].
pub fn chapter(folder: &Path, slug: String) -> Result<Chapter, EvalError> {
    let record = read(folder)?;
    let Versions { acm, burn, commit } = &record.versions;
    let commit = commit.as_ref().map_or(String::new(), |commit| format!(", commit {commit}"));
    let versions = html! { "acm " (acm) ", burn " (burn) (commit) };
    let command = format!("acm-train --config {}", record.config);
    let made_by = html! { code { (command) } ", in " code { (folder.display()) } };
    let errors = Column::measure(total_name(&record.data.unit, record.outputs.len()), &display(&record));
    let steps = steps(&record.steps, errors, "under the folds");
    let found = intervals::read(folder)?.map(|found| interval_table(&record, &found));
    let tables: Vec<Table> =
        [Some(candidates(&record)), held_out(&record), found, Some(steps)].into_iter().flatten().collect();
    Ok(Chapter {
        slug,
        title: "Which model to use".into(),
        data: record.data.clone(),
        missing: vec![],
        lead: lead(&record),
        notes: record.notes.clone(),
        questions: vec![(String::new(), record.question.clone())],
        main: tables[0].name,
        tables,
        figures: vec![],
        provenance: vec![("Made by", made_by), ("Versions", versions)],
    })
}

fn lead(record: &BestRecord) -> Markup {
    let error = |scores: &PartScores, key: &str| {
        let shown = summary::display(&record.data.unit, [scores]);
        scores.estimators.get(key).map_or(String::new(), |score| shown.show(score.rmse_total))
    };
    html! {
        p.lead { (why(record)) }
        @if let Some(scores) = &record.winner.held_out {
            p.lead {
                "On held-out trials, which took no part, it errs by " b { (error(scores, WINNER)) } ", the nominal model by "
                (error(scores, "nominal")) "."
            }
        }
    }
}

fn candidates(record: &BestRecord) -> Table {
    let shown = display(record);
    let folds = record.candidates.iter().map(|candidate| candidate.errors.0.len()).max().unwrap_or(0);
    let measure = |title: &str| Column::measure(title, &shown);
    let mut columns = vec![Column::text("Model")];
    columns.extend((0..folds).map(|fold| measure(&format!("Fold {fold}"))));
    columns.push(measure(total_name(&record.data.unit, record.outputs.len())));
    columns.extend([measure("More than the best"), measure("Standard error")]);
    columns.extend([Column::number("Fitted numbers", "", 0), Column::text("")]);
    Table {
        name: "best",
        title: "Which model".into(),
        note: format!(
            "Root mean square error in cross-validation, {}, mean ± standard deviation over folds; no held-out trial was read. \
             Errors of what chose its epoch on the fold itself are raised by what that choice gained there. Differences to \
             the best are over folds, with the standard error of their mean. Of the models within one standard error of the \
             best, the one with the fewest fitted numbers beyond the nominal model is chosen.",
            record.folds
        ),
        columns,
        rows: record.candidates.iter().map(|candidate| row(candidate, folds)).collect(),
        folded: false,
    }
}

fn row(candidate: &Candidate, folds: usize) -> Row {
    let fold = |fold: usize| candidate.errors.0.get(fold).map_or(Cell::Empty, |error| Cell::number(*error));
    let mut cells = vec![Cell::Text(candidate.name())];
    cells.extend((0..folds).map(fold));
    cells.extend([Cell::of(Spread::of(&candidate.errors.0)), Cell::number(candidate.more)]);
    cells.push(candidate.standard_error.map_or(Cell::Empty, Cell::number));
    cells.extend([Cell::Count(candidate.numbers), Cell::Text(candidate.mark().into())]);
    Row { cells, opens: candidate.members.len() == 2, bound: false }
}

fn held_out(record: &BestRecord) -> Option<Table> {
    let scores = record.winner.held_out.as_ref()?;
    let shown: Display = summary::display(&record.data.unit, [scores]);
    let mut columns = vec![Column::text("Model")];
    columns.extend(record.outputs.iter().map(|output| Column::measure(output, &shown)));
    columns.push(Column::measure(total_name(&record.data.unit, record.outputs.len()), &shown));
    let named =
        [("nominal", "Nominal".to_string()), ("polynomial", "Polynomial".into()), (WINNER, record.chosen().name())];
    let line = |(key, name): &(&str, String)| {
        let score = scores.estimators.get(*key)?;
        let numbers = score.rmse.iter().chain([&score.rmse_total]).map(|error| Cell::number(*error));
        Some(Row { cells: std::iter::once(Cell::Text(name.clone())).chain(numbers).collect(), ..Row::default() })
    };
    Some(Table {
        name: "best-held-out",
        title: "The winner on held-out trials".into(),
        note: "Root mean square error. Only the winner was scored there, once, after it had been chosen.".into(),
        columns,
        rows: named.iter().filter_map(line).collect(),
        folded: false,
    })
}

/// Returns the table of the winner's intervals, output by output.
fn interval_table(record: &BestRecord, intervals: &Intervals) -> Table {
    let share = |title: &str| Column::number(title, "%", 0);
    let row = |of: &Interval| {
        let held_out = of.held_out.map_or(Cell::Empty, |share| Cell::number(100.0 * share));
        let numbers = [Cell::number(of.half_width), Cell::number(100.0 * of.left_out), held_out];
        Row { cells: std::iter::once(Cell::Text(of.output.clone())).chain(numbers).collect(), ..Row::default() }
    };
    Table {
        name: "best-intervals",
        title: "How far off the winner may be".into(),
        note: format!(
            "{}. Prediction ± half-width, from the errors of the winner on the folds. Left out: coverage of each unit by the \
             half-width of the others; held-out: coverage of the trials that took no part.",
            intervals.title()
        ),
        columns: vec![
            Column::text("Output"),
            Column::measure("Half-width", &display(record)),
            share("Left out, held"),
            share("Held-out, held"),
        ],
        rows: intervals.outputs.iter().map(row).collect(),
        folded: false,
    }
}

/// Returns the steps to an average; `errors` is the column of errors `on` what they were judged by.
pub fn steps(steps: &[Step], errors: Column, on: &str) -> Table {
    let rows = steps.iter().flat_map(|step| {
        step.tried.iter().enumerate().map(move |(place, (name, error))| Row {
            cells: vec![
                Cell::Text(step.taken.join(", ")),
                Cell::Text(name.clone()),
                Cell::number(*error),
                Cell::Text(if step.took.as_ref() == Some(name) { "taken" } else { "" }.into()),
            ],
            opens: place == 0,
            bound: false,
        })
    });
    Table {
        name: "best-steps",
        title: "Which models are worth averaging".into(),
        note: format!(
            "Greedy forward selection: the model that errs least {on}, then the one with which the mean errs least, as long as \
             that is less than before."
        ),
        columns: vec![Column::text("Mean of"), Column::text("And"), errors, Column::text("")],
        rows: rows.collect(),
        folded: true,
    }
}
