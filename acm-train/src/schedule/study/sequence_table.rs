//! Table of a list of questions about sequences: error of each, and its difference to the reference.
//!
//! ```text
//! d_s = e_s − e_s(reference)          sweep: mean ± 95 %, ablation and comparison likewise; inputs: mean ± standard error
//! ```
//!
//! e_s is the error on sequence s, mean over seeds. A sweep and an elimination look at the validation part alone.

use std::collections::BTreeMap;

use acm_core::display::{DIGITS, signed, significant, with_spread};
use acm_datasets::text::terminal::ruled;

use super::{
    fold_errors::FoldErrors,
    inputs::{Tried, chosen},
    paired::Difference,
    record::MemberRecord,
};
use crate::config::{Kind, Loss, Question};
use crate::run::evaluation::spread::Spread;
use crate::run::sequences::record::SequenceRecord;

/// A question of the list with its runs.
#[derive(Debug)]
pub struct Row {
    /// Member of the study.
    pub member: MemberRecord,
    /// The question as it was run.
    pub question: Question,
    /// Names of its inputs.
    pub inputs: Vec<String>,
    /// Records of its runs.
    pub records: Vec<SequenceRecord>,
    /// Errors by sequence, one map for each run.
    pub errors: Vec<BTreeMap<String, f64>>,
}

impl Row {
    /// Returns the runs of the question itself, not of its control.
    fn own(&self) -> impl Iterator<Item = (&SequenceRecord, &BTreeMap<String, f64>)> {
        self.records.iter().zip(&self.errors).filter(move |(record, _)| record.elapsed == self.question.elapsed)
    }

    /// Returns the mean loss of the validation part over seeds, in the square of the targets' unit; infinite where
    /// there is none.
    pub fn validation_error(&self) -> f64 {
        let losses: Vec<f64> = self.own().map(|(record, _)| record.validation.loss).collect();
        Spread::of(&losses).map_or(f64::INFINITY, |spread| spread.mean)
    }

    /// Returns the inputs, and the error of each sequence, mean over seeds.
    pub fn tried(&self) -> Tried {
        let runs: Vec<&BTreeMap<String, f64>> = self.own().map(|(_, errors)| errors).collect();
        let names = runs.first().map(|errors| errors.keys().collect::<Vec<_>>()).unwrap_or_default();
        let mean = |name: &String| runs.iter().map(|errors| errors[name]).sum::<f64>() / runs.len() as f64;
        Tried { inputs: self.inputs.clone(), errors: FoldErrors(names.into_iter().map(mean).collect()) }
    }
}

/// Returns the indices of rows, the smallest validation error first.
pub fn ranked(rows: &[&Row]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..rows.len()).collect();
    places.sort_by(|a, b| rows[*a].validation_error().total_cmp(&rows[*b].validation_error()));
    places
}

/// Returns a table for each base, of a comparison for each variant.
pub fn text(kind: Kind, question: &str, rows: &[Row]) -> String {
    let key = |row: &Row| match kind {
        Kind::Comparison => row.member.variant.clone(),
        _ => row.member.base.clone(),
    };
    let mut titles: Vec<String> = vec![];
    rows.iter().map(key).for_each(|title| {
        if !titles.contains(&title) {
            titles.push(title);
        }
    });
    let group = |title: &String| rows.iter().filter(|row| key(row) == *title).collect::<Vec<_>>();
    let tables: Vec<String> = titles.iter().map(|title| table(kind, title, &group(title))).collect();
    format!("{question}\n\n{}", tables.join("\n\n"))
}

fn table(kind: Kind, title: &str, rows: &[&Row]) -> String {
    let order = if kind == Kind::Sweep { ranked(rows) } else { (0..rows.len()).collect() };
    let sets: Vec<Tried> = rows.iter().map(|row| row.tried()).collect();
    let least = ranked(rows)[0];
    let best = if kind == Kind::Inputs { least_mean(&sets) } else { least };
    let reference = if kind == Kind::Ablation { 0 } else { best };
    let tested = rows.iter().all(|row| row.records.iter().all(|record| record.test.is_some()));
    let mut header = vec![String::new(), loss(rows).to_string() + ", validation"];
    header.extend(tested.then(|| format!("{}, test", loss(rows))));
    let than = if kind == Kind::Ablation { "the first" } else { "the best" };
    let spread = if kind == Kind::Inputs { "± standard error" } else { "95 %" };
    header.push(format!("more than {than}, {spread}"));
    header.push(if kind == Kind::Inputs { String::new() } else { "minutes".into() });
    let winner = (kind == Kind::Inputs).then(|| chosen(&sets));
    let line = |&place: &usize| {
        let row = rows[place];
        let mut cells = vec![name(kind, row)];
        cells.push(shown(row, |record| record.validation.loss));
        cells.extend(tested.then(|| shown(row, |record| record.scored().loss)));
        cells.push(if place == reference { String::new() } else { more(kind, &sets[place], &sets[reference]) });
        cells.push(match winner {
            Some(winner) if winner == place => "chosen".into(),
            Some(_) if sets[place].as_good_as(&sets[best]) => "as good".into(),
            Some(_) => String::new(),
            None => shown(row, |record| record.seconds / 60.0).split(' ').next().unwrap_or_default().into(),
        });
        cells
    };
    let part = if tested { "test part" } else { "validation part, which chooses; nobody looked at the test part" };
    let units = sets.first().map_or(0, |set| set.errors.0.len());
    let note = format!("{title}: {part}; differences over {units} sequences");
    format!("{note}\n{}", ruled(header, order.iter().map(line).collect(), 1))
}

fn name(kind: Kind, row: &Row) -> String {
    match kind {
        Kind::Comparison => row.member.base.clone(),
        Kind::Inputs => row.inputs.join(" "),
        _ => row.member.variant.clone(),
    }
}

fn loss(rows: &[&Row]) -> &'static str {
    let labels = rows.iter().any(|row| row.question.loss == Loss::CrossEntropy);
    if labels { "cross-entropy" } else { "MSE" }
}

fn least_mean(sets: &[Tried]) -> usize {
    (0..sets.len()).min_by(|a, b| sets[*a].mean().total_cmp(&sets[*b].mean())).unwrap_or(0)
}

fn shown(row: &Row, of: impl Fn(&SequenceRecord) -> f64) -> String {
    let values: Vec<f64> = row.own().map(|(record, _)| of(record)).collect();
    Spread::of(&values).map_or(String::new(), |spread| spread.text(1.0))
}

fn more(kind: Kind, own: &Tried, reference: &Tried) -> String {
    let (mean, reach) = match kind {
        Kind::Inputs => own.more_than(reference),
        _ => {
            let pairs: Vec<(f64, f64)> = reference.errors.0.iter().copied().zip(own.errors.0.iter().copied()).collect();
            Difference::of(&pairs).map_or((f64::NAN, None), |difference| (difference.mean, difference.reach))
        }
    };
    signed(mean, reach.map_or_else(|| significant(mean, DIGITS), |reach| with_spread(mean, Some(reach))))
}
