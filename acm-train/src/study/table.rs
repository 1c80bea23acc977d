//! The tables of a list of experiments, as text: error of each, and how it differs from what it is compared with.
//!
//! | kind       | one table for each | rows     | compared with         |
//! | ---------- | ------------------ | -------- | --------------------- |
//! | sweep      | base               | settings, best first | the best  |
//! | ablation   | base               | variants | the first variant     |
//! | comparison | variant            | bases    | the nominal model, and the base with the smallest error |
//!
//! Errors are those of the folds in cross-validation, and of the held-out trials in final runs.

use comfy_table::{CellAlignment, Table, presets::UTF8_BORDERS_ONLY};

use super::{
    Kind,
    paired::Difference,
    record::{Runs, StudyRecord},
};
use crate::{
    record::{PartScores, RunRecord, Score, Stage},
    spread::Spread,
    summary::{shown_unit, total_name},
};

/// Rows that are compared with each other.
pub struct Group<'a> {
    /// What they share: a base, or a variant.
    pub title: String,
    /// What each is called, and its runs.
    pub rows: Vec<(&'a str, Runs<'a>)>,
}

/// The tables of a study, each row's runs in the order of the plans.
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

/// The settings of a base, the smallest validation error first.
pub fn ranked<'a>(base: &str, runs: &[Runs<'a>]) -> Vec<Runs<'a>> {
    let mut of: Vec<Runs> = runs.iter().filter(|run| run.member.base == base).copied().collect();
    let error = |run: &Runs| validation_error(run.records).unwrap_or(f64::INFINITY);
    of.sort_by(|a, b| error(a).total_cmp(&error(b)));
    of
}

/// Mean total error of all runs on the trials that chose their epochs.
pub fn validation_error(records: &[RunRecord]) -> Option<f64> {
    let error = |record: &RunRecord| Some(record.validation.estimators.get(&record.experiment.kind())?.rmse_total);
    Some(Spread::of(&records.iter().filter_map(error).collect::<Vec<_>>())?.mean)
}

/// What a run is scored on here: its held-out trials, or its fold.
pub fn scored(record: &RunRecord) -> &PartScores {
    match (record.stage, &record.held_out) {
        (Stage::Final, Some(held_out)) => held_out,
        _ => &record.validation,
    }
}

/// The network's score of a run, or that of another estimator.
pub fn score<'a>(record: &'a RunRecord, estimator: Option<&str>) -> Option<&'a Score> {
    let kind = record.experiment.kind();
    scored(record).estimators.get(estimator.unwrap_or(&kind))
}

/// Total errors of two experiments in pairs of runs. Where one has a single run of a stage, all of the other's are paired
/// with it: it does not depend on the seed.
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

/// All tables, with a line that says so where the data are synthetic.
pub fn text(study: &StudyRecord, runs: &[Runs]) -> String {
    let Some(first) = runs.iter().find_map(|run| run.records.first()) else { return String::new() };
    let synthetic = if first.data.synthetic { " — synthetic data" } else { "" };
    let tables = groups(study, runs).iter().map(|group| table(study, group, first)).collect::<Vec<_>>().join("\n\n");
    format!("{}\n{}{synthetic}\n\n{tables}", study.question, first.data.title)
}

fn table(study: &StudyRecord, group: &Group, first: &RunRecord) -> String {
    let (factor, unit) = shown_unit(&first.data.unit);
    let mut table = Table::new();
    let mut header = vec![String::new(), "runs".into()];
    header.extend(first.outputs.iter().cloned());
    header.push(total_name(first.outputs.len()).into());
    header.extend(comparisons(study.kind, unit));
    table.load_style(UTF8_BORDERS_ONLY).set_header(header);
    let best = group.rows.iter().min_by(|a, b| mean(a.1.records).total_cmp(&mean(b.1.records)));
    let reference = match study.kind {
        Kind::Ablation => group.rows.first(),
        _ => best,
    };
    if study.kind == Kind::Comparison {
        let nominal = group.rows.first().map_or(&[][..], |row| row.1.records);
        table.add_row(row("nominal", nominal, Some("nominal"), factor));
    }
    for (name, runs) in &group.rows {
        let mut cells = row(name, runs.records, None, factor);
        if study.kind == Kind::Comparison {
            cells.push(improvement(runs.records));
        }
        if let Some((reference, base)) = reference {
            let pairs = if reference == name { vec![] } else { pairs(base.records, runs.records) };
            cells.extend(against(study.kind, &pairs, factor));
        }
        table.add_row(cells);
    }
    table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    let part = match first.stage {
        Stage::Final => "held-out trials, which took no part",
        Stage::CrossValidation { .. } => "cross-validation",
    };
    format!("{}: RMSE in {unit}, {part}\n{table}", group.title)
}

fn comparisons(kind: Kind, unit: &str) -> Vec<String> {
    match kind {
        Kind::Comparison => vec!["better than nominal".into(), format!("more than the best, 95 % [{unit}]")],
        Kind::Sweep => vec!["more than the best".into(), format!("95 % [{unit}]")],
        _ => vec!["more than the first".into(), format!("95 % [{unit}]")],
    }
}

fn row(name: &str, records: &[RunRecord], estimator: Option<&str>, factor: f64) -> Vec<String> {
    let scores: Vec<&Score> = records.iter().filter_map(|record| score(record, estimator)).collect();
    let shown = |values: Vec<f64>| Spread::of_constant(&values).map_or("–".into(), |spread| spread.text(factor));
    let outputs = scores.first().map_or(0, |score| score.rmse.len());
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

/// Difference in % of the reference where that is asked for, and in the unit with its interval.
fn against(kind: Kind, pairs: &[(f64, f64)], factor: f64) -> Vec<String> {
    let words = Difference::of(pairs).map(|difference| {
        let base = Spread::of(&pairs.iter().map(|(a, _)| *a).collect::<Vec<_>>()).map_or(f64::NAN, |s| s.mean);
        let interval = match difference.reach {
            Some(reach) => format!("{:+.2} ± {:.2}", factor * difference.mean, factor * reach),
            None => format!("{:+.2}", factor * difference.mean),
        };
        (format!("{:+.2} %", 100.0 * difference.mean / base), interval)
    });
    let (percent, interval) = words.unwrap_or_default();
    if kind == Kind::Comparison { vec![interval] } else { vec![percent, interval] }
}
