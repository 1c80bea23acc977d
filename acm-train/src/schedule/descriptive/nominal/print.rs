//! The tables of a nominal study for the terminal.

use std::path::Path;

use acm_core::display::Display;

use super::record::{Errors, ModelRow, NominalStudy, OrderRow, TrialErrors};
use crate::run::evaluation::summary::in_unit;
use crate::schedule::descriptive::show::{cell, cells, display, header, heads, table, title};

/// Writes all tables, and the folder that they were written to.
pub fn text(record: &NominalStudy, root: &Path) -> String {
    let mut parts = vec![title(&record.data), orders(record), models(record), trials(record)];
    parts.extend(record.notes.iter().map(|note| format!("note: {note}")));
    parts.push(format!("study.json, predictions: {}", root.display()));
    parts.join("\n\n")
}

fn of_models(record: &NominalStudy) -> Display {
    display(&record.data, record.models.iter().map(|model| &model.fitted.all))
}

fn orders(record: &NominalStudy) -> String {
    let (study, display) = (&record.orders, of_models(record));
    let row = |row: &OrderRow| {
        let values = [row.frozen.binned, row.frozen.raw, row.refitted.binned, row.refitted.raw];
        [vec![row.order.to_string()], values.map(|value| cell(value, &display)).to_vec()].concat()
    };
    let [u, v] = &study.plane;
    let title = format!(
        "Strain orders on trial {}, fitted to {} bins of {} samples: {u}–{v} RMSE{}",
        study.trial,
        study.bins,
        study.samples,
        in_unit(&display)
    );
    let heads = ["order", "map frozen\nbinned", "\nraw", "map refitted\nbinned", "\nraw"];
    table(&title, &header(&heads, vec![]), study.rows.iter().map(row).collect(), 1)
}

fn models(record: &NominalStudy) -> String {
    let display = of_models(record);
    let row = |model: &ModelRow, errors: &Errors, on: &str| {
        let first = vec![model.label.clone(), on.to_string(), model.parameters.len().to_string()];
        [first, cells(&errors.all, &display)].concat()
    };
    let mut rows: Vec<Vec<String>> = record.models.iter().map(|model| row(model, &model.fitted, "fitted")).collect();
    let left_out = record.models.iter().filter_map(|model| Some(row(model, model.left_out.as_ref()?, "left out")));
    rows.extend(left_out);
    let title =
        format!("All calibration trials, fitted to them and with each left out in turn: RMSE{}", in_unit(&display));
    table(&title, &header(&["model", "trials", "parameters"], heads(&record.data, &record.outputs)), rows, 2)
}

fn trials(record: &NominalStudy) -> String {
    let display = of_models(record);
    let mut columns: Vec<(String, &Errors)> =
        record.models.iter().map(|model| (format!("{}\nfitted", model.key), &model.fitted)).collect();
    let left_out = |model: &'_ ModelRow| format!("{}\nleft out", model.key);
    columns.extend(record.models.iter().filter_map(|model| Some((left_out(model), model.left_out.as_ref()?))));
    let Some((_, first)) = columns.first() else { return String::new() };
    let row = |(place, trial): (usize, &TrialErrors)| {
        let value = |errors: &Errors| cell(errors.trials[place].rms.total, &display);
        [vec![trial.trial.clone()], columns.iter().map(|(_, errors)| value(errors)).collect()].concat()
    };
    let rows = first.trials.iter().enumerate().map(row).collect();
    let heads = columns.iter().map(|(head, _)| head.clone()).collect();
    table(&format!("Trial by trial: RMSE over all outputs{}", in_unit(&display)), &header(&["trial"], heads), rows, 1)
}
