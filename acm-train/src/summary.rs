//! The table at the end of a job: each estimator's error before and after, mean ± standard deviation over runs.

use comfy_table::{CellAlignment, Table, presets::UTF8_BORDERS_ONLY};

use crate::{
    record::{PartScores, RunRecord, Score, Stage},
    spread::Spread,
};

/// One table per part that was scored: the folds of cross-validation, then validation and held-out trials of the final
/// runs; with a line that says so where the data are synthetic.
pub fn text(records: &[&RunRecord]) -> String {
    let Some(first) = records.first() else { return String::new() };
    let of_stage = |is_final: bool| -> Vec<&RunRecord> {
        records.iter().copied().filter(|r| (r.stage == Stage::Final) == is_final).collect()
    };
    let (folds, seeds) = (of_stage(false), of_stage(true));
    let validation = |records: &[&RunRecord]| records.iter().map(|r| r.validation.clone()).collect::<Vec<_>>();
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
    format!("{}{kind}\n\n{}", first.data.title, parts.join("\n\n"))
}

fn part(record: &RunRecord, title: &str, scores: &[PartScores], floors: bool) -> String {
    if scores.is_empty() {
        return String::new();
    }
    let (scale, unit) = shown_unit(&record.data.unit);
    let mut table = Table::new();
    table.load_style(UTF8_BORDERS_ONLY).set_header(header(record));
    let kind = record.experiment.kind();
    for name in ["nominal", "polynomial", kind.as_str()] {
        let of_runs: Vec<&Score> = scores.iter().filter_map(|s| s.estimators.get(name)).collect();
        table.add_row(row(name, &of_runs, scale, scores));
    }
    if let (true, Some(f)) = (floors, &record.data.floors) {
        let outputs = record.outputs.len();
        table.add_row(floor("memoryless floor", f.memoryless_mm, &f.memoryless_component_mm, outputs));
        table.add_row(floor("oracle floor", f.oracle_mm, &f.oracle_component_mm, outputs));
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    format!("{title}: RMSE in {unit}\n{table}")
}

fn header(record: &RunRecord) -> Vec<String> {
    let outputs = record.outputs.iter().cloned();
    let tail = [
        total_name(record.outputs.len()).to_string(),
        format!("R² {}", record.outputs.join(" ")),
        "better than nominal".into(),
    ];
    std::iter::once(String::new()).chain(outputs).chain(tail).collect()
}

fn row(name: &str, runs: &[&Score], scale: f64, scores: &[PartScores]) -> Vec<String> {
    let outputs = runs.first().map_or(0, |s| s.rmse.len());
    let shown = |values: Vec<f64>| Spread::of(&values).map_or(String::new(), |spread| spread.text(scale));
    let mean = |values: &[f64]| Spread::of(values).map_or(f64::NAN, |spread| spread.mean);
    let each = |o: usize| shown(runs.iter().map(|s| s.rmse[o]).collect());
    let total = shown(runs.iter().map(|s| s.rmse_total).collect());
    let r2 = (0..outputs).map(|o| format!("{:.2}", mean(&runs.iter().map(|s| s.r2[o]).collect::<Vec<_>>())));
    let gains: Vec<f64> =
        runs.iter().zip(scores).filter_map(|(s, part)| gain(s, part.estimators.get("nominal")?)).collect();
    let gain = match name {
        "nominal" => String::new(),
        _ if gains.is_empty() => String::new(),
        _ => format!("{:+.1} %", mean(&gains)),
    };
    let tail = [total, r2.collect::<Vec<_>>().join(" "), gain];
    std::iter::once(name.to_string()).chain((0..outputs).map(each)).chain(tail).collect()
}

/// By how much the error is smaller than the nominal one, %.
fn gain(score: &Score, nominal: &Score) -> Option<f64> {
    (nominal.rmse_total > 0.0).then(|| 100.0 * (1.0 - score.rmse_total / nominal.rmse_total))
}

fn floor(name: &str, total_mm: f64, component_mm: &[f64], outputs: usize) -> Vec<String> {
    let each = (0..outputs).map(|o| component_mm.get(o).map_or(String::new(), |value| format!("{value:.2}")));
    std::iter::once(name.to_string()).chain(each).chain([format!("{total_mm:.2}")]).collect()
}

/// The root of the mean squared distance: `3-D` for a place in space.
pub fn total_name(outputs: usize) -> &'static str {
    if outputs == 3 { "3-D" } else { "total" }
}

/// `1 seed`, `5 seeds`.
pub fn count(n: usize, noun: &str) -> String {
    if n == 1 { format!("1 {noun}") } else { format!("{n} {noun}s") }
}

/// Lengths are shown in mm; anything else as it is.
pub fn shown_unit(unit: &str) -> (f64, &str) {
    if unit == "m" { (1000.0, "mm") } else { (1.0, unit) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metres_are_shown_in_millimetres_and_newtons_in_newtons() {
        assert_eq!(shown_unit("m"), (1000.0, "mm"));
        assert_eq!(shown_unit("N"), (1.0, "N"));
    }
}
