//! Tables of a list of experiments: error of each, and its difference to the reference.
//!
//! | kind       | one table for each | rows     | compared with         |
//! | ---------- | ------------------ | -------- | --------------------- |
//! | sweep      | base               | settings, best first | the best  |
//! | ablation   | base               | variants | the first variant     |
//! | comparison | variant            | bases    | the nominal model, and the base with the smallest error |
//!
//! Errors are those of the folds in cross-validation, and of the held-out trials in final runs.

use acm_core::display::{Display, plain, signed, with_spread};
use acm_datasets::text::terminal::{MOST_ACROSS, ruled};

use super::{
    paired::Difference,
    record::{Runs, StudyRecord},
};
use crate::config::Kind;
use crate::run::evaluation::spread::Spread;
use crate::run::evaluation::summary::{display, in_unit, total_name};
use crate::run::record::{PartScores, RunRecord, Score, Stage};

/// Rows that are compared with each other.
pub struct Group<'a> {
    /// Name of the common base or variant.
    pub title: String,
    /// Name and runs of each row.
    pub rows: Vec<(&'a str, Runs<'a>)>,
}

/// Returns the tables of a study, each row's runs in the order of the plans.
pub fn groups<'a>(study: &'a StudyRecord, runs: &[Runs<'a>]) -> Vec<Group<'a>> {
    let key = |run: &Runs<'a>| match study.kind {
        Kind::Comparison => run.member.variant.as_str(),
        _ => run.member.base.as_str(),
    };
    let mut titles: Vec<&str> = vec![];
    runs.iter().map(key).for_each(|title| {
        if !titles.contains(&title) {
            titles.push(title);
        }
    });
    let group = |title: &str| {
        let of: Vec<Runs> = match study.kind {
            Kind::Sweep => ranked(title, runs),
            _ => runs.iter().filter(|run| key(run) == title).copied().collect(),
        };
        let name = |run: &Runs<'a>| match study.kind {
            Kind::Comparison => run.member.base.as_str(),
            _ => run.member.variant.as_str(),
        };
        Group { title: title.to_string(), rows: of.iter().map(|run| (name(run), *run)).collect() }
    };
    titles.into_iter().map(group).collect()
}

/// Returns the settings of a base, the smallest validation error first.
pub fn ranked<'a>(base: &str, runs: &[Runs<'a>]) -> Vec<Runs<'a>> {
    let mut of: Vec<Runs> = runs.iter().filter(|run| run.member.base == base).copied().collect();
    let error = |run: &Runs| validation_error(run.records).unwrap_or(f64::INFINITY);
    of.sort_by(|a, b| error(a).total_cmp(&error(b)));
    of
}

/// Returns the mean total error of all runs on the trials that chose their epochs.
pub fn validation_error(records: &[RunRecord]) -> Option<f64> {
    let error = |record: &RunRecord| Some(record.validation.estimators.get(&record.experiment.kind())?.rmse_total);
    Some(Spread::of(&records.iter().filter_map(error).collect::<Vec<_>>())?.mean)
}

/// Returns the scores of a run: on its held-out trials, or on its fold.
pub fn scored(record: &RunRecord) -> &PartScores {
    match (record.stage, &record.held_out) {
        (Stage::Final, Some(held_out)) => held_out,
        _ => &record.validation,
    }
}

/// Returns the network's score of a run, or that of another estimator.
pub fn score<'a>(record: &'a RunRecord, estimator: Option<&str>) -> Option<&'a Score> {
    let kind = record.experiment.kind();
    scored(record).estimators.get(estimator.unwrap_or(&kind))
}

/// Pairs the total errors of two experiments by run. Where one has a single run of a stage, all of the other's are
/// paired with it: it does not depend on the seed.
pub fn pairs(a: &[RunRecord], b: &[RunRecord]) -> Vec<(f64, f64)> {
    let total = |record: &RunRecord| Some(score(record, None)?.rmse_total);
    let partner = |record: &RunRecord, among: &[RunRecord]| {
        let stage: Vec<&RunRecord> = among.iter().filter(|other| other.stage == record.stage).collect();
        let same = stage.iter().find(|other| other.seed == record.seed).copied();
        same.or(if let [only] = stage.as_slice() { Some(only) } else { None }).and_then(total)
    };
    if a.len() >= b.len() {
        a.iter().filter_map(|record| Some((total(record)?, partner(record, b)?))).collect()
    } else {
        b.iter().filter_map(|record| Some((partner(record, a)?, total(record)?))).collect()
    }
}

/// Writes all tables, with a line that says so where the data are synthetic.
pub fn text(study: &StudyRecord, runs: &[Runs]) -> String {
    let Some(first) = runs.iter().find_map(|run| run.records.first()) else { return String::new() };
    let synthetic = if first.data.synthetic { " — synthetic data" } else { "" };
    let tables = groups(study, runs).iter().map(|group| table(study, group, first)).collect::<Vec<_>>().join("\n\n");
    format!("{}\n{}{synthetic}\n\n{tables}", study.question, first.data.title)
}

fn table(study: &StudyRecord, group: &Group, first: &RunRecord) -> String {
    let records = group.rows.iter().flat_map(|(_, runs)| runs.records);
    let display = display(&first.data.unit, records.map(scored));
    // Of many outputs, each has its column on the page alone.
    let outputs = if first.outputs.len() > MOST_ACROSS { 0 } else { first.outputs.len() };
    let best = group.rows.iter().min_by(|a, b| mean(a.1.records).total_cmp(&mean(b.1.records)));
    let reference = match study.kind {
        Kind::Ablation => group.rows.first(),
        _ => best,
    };
    let mut rows = vec![];
    if study.kind == Kind::Comparison {
        let nominal = group.rows.first().map_or(&[][..], |row| row.1.records);
        rows.push(row("nominal", nominal, Some("nominal"), &display, outputs));
    }
    for (name, runs) in &group.rows {
        let mut cells = row(name, runs.records, None, &display, outputs);
        if study.kind == Kind::Comparison {
            cells.push(improvement(runs.records));
        }
        if let Some((reference, base)) = reference {
            let pairs = if reference == name { vec![] } else { pairs(base.records, runs.records) };
            cells.extend(against(study.kind, &pairs, display.factor));
        }
        rows.push(cells);
    }
    let part = match first.stage {
        Stage::Final => "held-out trials, which took no part",
        Stage::CrossValidation { .. } => "cross-validation",
    };
    let table = ruled(header(study.kind, first, outputs, &display), rows, 1);
    format!("{}: RMSE{}, {part}\n{table}", group.title, in_unit(&display))
}

fn header(kind: Kind, first: &RunRecord, outputs: usize, display: &Display) -> Vec<String> {
    let total = total_name(&first.data.unit, first.outputs.len()).to_string();
    let head = [String::new(), "runs".into()].into_iter().chain(first.outputs.iter().take(outputs).cloned());
    head.chain([total]).chain(comparisons(kind, display)).collect()
}

fn comparisons(kind: Kind, display: &Display) -> Vec<String> {
    match kind {
        Kind::Comparison => vec!["better than nominal".into(), display.label("more than the best, 95 %")],
        Kind::Sweep => vec!["more than the best".into(), display.label("95 %")],
        _ => vec!["more than the first".into(), display.label("95 %")],
    }
}

fn row(name: &str, records: &[RunRecord], estimator: Option<&str>, display: &Display, outputs: usize) -> Vec<String> {
    let scores: Vec<&Score> = records.iter().filter_map(|record| score(record, estimator)).collect();
    let shown =
        |values: Vec<f64>| Spread::of_constant(&values).map_or("–".into(), |spread| spread.text(display.factor));
    let outputs = scores.first().map_or(0, |score| score.rmse.len().min(outputs));
    let each = |o: usize| shown(scores.iter().map(|score| score.rmse[o]).collect());
    let count = if estimator.is_some() { String::new() } else { records.len().to_string() };
    let total = shown(scores.iter().map(|score| score.rmse_total).collect());
    [name.to_string(), count].into_iter().chain((0..outputs).map(each)).chain([total]).collect()
}

fn mean(records: &[RunRecord]) -> f64 {
    let totals: Vec<f64> = records.iter().filter_map(|record| Some(score(record, None)?.rmse_total)).collect();
    Spread::of(&totals).map_or(f64::INFINITY, |spread| spread.mean)
}

fn improvement(records: &[RunRecord]) -> String {
    let gain = |record: &RunRecord| {
        let (own, nominal) = (score(record, None)?, score(record, Some("nominal"))?);
        Some(100.0 * (1.0 - own.rmse_total / nominal.rmse_total))
    };
    let gains: Vec<f64> = records.iter().filter_map(gain).collect();
    Spread::of_constant(&gains).map_or(String::new(), |spread| format!("{} %", spread.text(1.0)))
}

/// Returns the difference in % of the reference where that is requested, and in the unit with its interval.
fn against(kind: Kind, pairs: &[(f64, f64)], factor: f64) -> Vec<String> {
    let words = Difference::of(pairs).map(|difference| {
        let base = Spread::of(&pairs.iter().map(|(a, _)| *a).collect::<Vec<_>>()).map_or(f64::NAN, |s| s.mean);
        let (mean, percent) = (factor * difference.mean, 100.0 * difference.mean / base);
        let interval = signed(mean, with_spread(mean, difference.reach.map(|reach| factor * reach)));
        (format!("{} %", signed(percent, plain(percent, 2))), interval)
    });
    let (percent, interval) = words.unwrap_or_default();
    if kind == Kind::Comparison { vec![interval] } else { vec![percent, interval] }
}
