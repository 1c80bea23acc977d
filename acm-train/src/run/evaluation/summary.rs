//! The table at the end of a job: each estimator's error before and after, mean ± standard deviation over runs.

use acm_core::display::{DIGITS, Display, plain, signed, significant};
use acm_datasets::text::terminal::{MOST_ACROSS, ruled, turned};
use comfy_table::Table;

use super::spread::Spread;
use crate::run::record::{PartScores, RunRecord, Score, Stage};

/// Writes one table per part that was scored: the folds of cross-validation, then validation and held-out trials of the
/// final runs; with a line that says so where the data are synthetic.
pub fn text(records: &[&RunRecord]) -> String {
    let Some(first) = records.first() else { return String::new() };
    let of_stage = |is_final: bool| -> Vec<&RunRecord> {
        records.iter().copied().filter(|r| (r.stage == Stage::Final) == is_final).collect()
    };
    let (folds, seeds) = (of_stage(false), of_stage(true));
    let validation = |records: &[&RunRecord]| {
        let validated = records.iter().filter(|record| !record.split.has_no_validation());
        validated.map(|record| record.validation.clone()).collect::<Vec<_>>()
    };
    let held_out: Vec<PartScores> = seeds.iter().filter_map(|r| r.held_out.clone()).collect();
    let mut parts = vec![
        part(first, &format!("Cross-validation, {}", count(folds.len(), "fold")), &validation(&folds), false),
        part(
            first,
            &format!("Validation trials, which chose the epoch, {}", count(seeds.len(), "seed")),
            &validation(&seeds),
            false,
        ),
        part(
            first,
            &format!("Held-out trials, which took no part, {}", count(held_out.len(), "seed")),
            &held_out,
            true,
        ),
    ];
    parts.retain(|table| !table.is_empty());
    let kind = if first.data.synthetic { " — synthetic data" } else { "" };
    let folds = first.folds.as_ref().map_or(String::new(), |folds| format!("\nfolds: {}", folds.made));
    let names = names_of_trials(first).map_or(String::new(), |sentence| format!("\n{sentence}"));
    let inputs = format!("inputs: {}{names}", first.channels.join(", "));
    format!("{}{kind}{folds}\n{inputs}\n\n{}", first.data.title, parts.join("\n\n"))
}

/// Returns the inputs that a network could take for the name of a trial, in a sentence; none where there are none.
pub fn names_of_trials(record: &RunRecord) -> Option<String> {
    let known = &record.data.constant;
    let values = |name: &String| Some(format!("{name} ({} values)", known.get(name)?));
    let names: Vec<String> = record.channels.iter().filter_map(values).collect();
    let be = if names.len() == 1 { "is" } else { "are" };
    let sentence = || {
        format!(
            "constant within trials {be} {}: a network can take the value for the name of a trial",
            names.join(", ")
        )
    };
    (!names.is_empty()).then(sentence)
}

fn part(record: &RunRecord, title: &str, scores: &[PartScores], floors: bool) -> String {
    if scores.is_empty() {
        return String::new();
    }
    let display = display(&record.data.unit, scores);
    let kind = record.experiment.kind();
    let mut rows: Vec<Row> = ["nominal", "polynomial", kind.as_str()]
        .into_iter()
        .map(|name| Row::of(name, scores, &display, record.outputs.len()))
        .collect();
    if let (true, Some(f)) = (floors, &record.data.floors) {
        let floor = |name, total, each: &[f64]| Row::floor(name, total, each, &display, record.outputs.len());
        rows.push(floor("memoryless floor", f.memoryless_mm, &f.memoryless_component_mm));
        rows.push(floor("oracle floor", f.oracle_mm, &f.oracle_component_mm));
    }
    let table = if record.outputs.len() > MOST_ACROSS { down(record, rows) } else { across(record, rows) };
    format!("{title}: RMSE{}\n{table}", in_unit(&display))
}

/// Returns a row for each model.
fn across(record: &RunRecord, rows: Vec<Row>) -> Table {
    let total = total_name(&record.data.unit, record.outputs.len()).to_string();
    let tail = [total, format!("R² {}", record.outputs.join(" ")), "better than nominal".into()];
    let header = std::iter::once(String::new()).chain(record.outputs.iter().cloned()).chain(tail).collect();
    let line = |row: Row| [vec![row.name], row.rmse, vec![row.total, row.r2.join(" "), row.gain]].concat();
    ruled(header, rows.into_iter().map(line).collect(), 1)
}

/// Returns a row for each output, and for each model a column with its error and one with its R².
fn down(record: &RunRecord, rows: Vec<Row>) -> Table {
    let total = total_name(&record.data.unit, record.outputs.len()).to_string();
    let tail = [total, "better than nominal".into()];
    let header = std::iter::once(String::new()).chain(record.outputs.iter().cloned()).chain(tail).collect();
    let columns = rows.into_iter().flat_map(|row| {
        let r2 = (!row.r2.is_empty()).then(|| [vec![format!("R² {}", row.name)], row.r2].concat());
        [[vec![row.name], row.rmse, vec![row.total, row.gain]].concat()].into_iter().chain(r2)
    });
    let (header, lines) = turned(header, &columns.collect::<Vec<_>>());
    ruled(header, lines, 1)
}

/// One model, as shown.
struct Row {
    name: String,
    rmse: Vec<String>,
    total: String,
    /// Coefficients of determination; a floor has none.
    r2: Vec<String>,
    gain: String,
}

impl Row {
    fn of(name: &str, scores: &[PartScores], display: &Display, outputs: usize) -> Self {
        let runs: Vec<&Score> = scores.iter().filter_map(|part| part.estimators.get(name)).collect();
        let spread = |value: &dyn Fn(&Score) -> f64| Spread::of(&runs.iter().map(|s| value(s)).collect::<Vec<_>>());
        let error = |value: &dyn Fn(&Score) -> f64| spread(value).map_or(String::new(), |s| s.text(display.factor));
        let r2 = |o: usize| spread(&|s: &Score| s.r2[o]).map_or(String::new(), |spread| plain(spread.mean, 2));
        let gains: Vec<f64> = runs
            .iter()
            .zip(scores)
            .filter(|_| name != "nominal")
            .filter_map(|(score, part)| gain(score, part.estimators.get("nominal")?))
            .collect();
        let gain = Spread::of(&gains).map_or(String::new(), |s| format!("{} %", signed(s.mean, plain(s.mean, 1))));
        Self {
            name: name.into(),
            rmse: (0..outputs).map(|o| error(&|s: &Score| s.rmse[o])).collect(),
            total: error(&|s: &Score| s.rmse_total),
            r2: (0..outputs).map(r2).collect(),
            gain,
        }
    }

    /// Returns a bound that the simulator of the data knows.
    fn floor(name: &str, total_mm: f64, component_mm: &[f64], display: &Display, outputs: usize) -> Self {
        let shown = |mm: &f64| significant(1e-3 * mm * display.factor, DIGITS);
        let rmse = (0..outputs).map(|o| component_mm.get(o).map_or(String::new(), shown)).collect();
        Self { name: name.into(), rmse, total: shown(&total_mm), r2: vec![], gain: String::new() }
    }
}

/// Returns the reduction of the error relative to the nominal model, %.
fn gain(score: &Score, nominal: &Score) -> Option<f64> {
    (nominal.rmse_total > 0.0).then(|| 100.0 * (1.0 - score.rmse_total / nominal.rmse_total))
}

/// Returns how errors of these parts are shown: with one prefix, by the largest of them.
pub fn display<'p>(unit: &str, parts: impl IntoIterator<Item = &'p PartScores>) -> Display {
    let totals = parts.into_iter().flat_map(|part| part.estimators.values().map(|score| score.rmse_total));
    Display::of(unit, totals.filter(|total| total.is_finite()).fold(0.0, f64::max))
}

/// Writes ` in mm`; nothing where errors are plain numbers.
pub fn in_unit(display: &Display) -> String {
    if display.symbol.is_empty() { String::new() } else { format!(" in {}", display.symbol) }
}

/// Returns the name of the root mean squared distance: `3-D` for a position in space.
pub fn total_name(unit: &str, outputs: usize) -> &'static str {
    if unit == "m" && outputs == 3 { "3-D" } else { "total" }
}

/// Writes `1 seed`, `5 seeds`.
pub fn count(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_position_has_three_dimensions() {
        assert_eq!([total_name("m", 3), total_name("N*m", 3), total_name("m", 2)], ["3-D", "total", "total"]);
    }
}
