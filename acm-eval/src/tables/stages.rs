//! Stages of the nominal model's calibration, one row each, and the polynomial it is compared with.

use acm_core::{Calibration, StopReason};

use super::{Cell, Column, Row, Table};
use crate::section::{Section, calibrations};

/// Returns the table with the stages of each calibration in rows, then the comparator's.
pub fn table(section: &Section) -> Option<Table> {
    let total = section.total();
    let mut columns = vec![Column::text("Calibrated on"), Column::text("Model"), Column::text("Stage")];
    columns.push(Column::measure(format!("RMS {total}"), &section.display));
    columns.extend(coordinates(section).iter().map(|output| Column::measure(output, &section.display)));
    columns.extend(["Samples", "Iterations", "Starts"].map(|title| Column::number(title, "", 0)));
    columns.push(Column::text("Stopped"));
    let mut rows = Vec::new();
    for (label, pair) in calibrations(section) {
        let first = rows.len();
        rows.extend(pair.nominal.iter().flat_map(|nominal| stages(section, &label, "nominal", nominal)));
        rows.extend(stages(section, &label, "polynomial", &pair.polynomial));
        if let Some(row) = rows.get_mut(first) {
            row.opens = first > 0;
        }
    }
    let table = Table {
        name: "stages",
        title: "Calibration of the nominal model".into(),
        note: note(section),
        columns,
        rows,
        folded: false,
    };
    (!table.rows.is_empty()).then(|| table.say_once())
}

/// Returns the outputs, where they are all that was calibrated on; with several markers there is no room for every
/// coordinate.
fn coordinates(section: &Section) -> &[String] {
    let fits = |calibration: &Calibration| calibration.rms.len() == section.outputs.len();
    let all = calibrations(section).iter().all(|(_, pair)| pair.nominal.iter().all(fits) && fits(&pair.polynomial));
    if all { &section.outputs } else { &[] }
}

fn note(section: &Section) -> String {
    let what = match coordinates(section) {
        [] => "Root mean square distance to all measured markers on the calibration trials, after each stage.",
        _ => "Root mean square error on the calibration trials, after each stage; by coordinate after the last one.",
    };
    format!("{what} The nominal model was fixed before any network was trained.")
}

fn stages(section: &Section, label: &str, model: &str, calibration: &Calibration) -> Vec<Row> {
    let last = calibration.stages.len().saturating_sub(1);
    let row = |(index, stage): (usize, &acm_core::Stage)| {
        let mut cells = vec![Cell::Text(label.into()), Cell::Text(model.into()), Cell::Text(stage.name.clone())];
        cells.push(Cell::number(stage.rms));
        let by_coordinate =
            calibration.rms.iter().map(|&rms| if index == last { Cell::number(rms) } else { Cell::Empty });
        cells.extend(by_coordinate.take(coordinates(section).len()));
        cells.extend([Cell::Count(calibration.samples), Cell::Count(stage.iterations), Cell::Count(stage.starts)]);
        cells.push(Cell::Text(because(stage.stopped).into()));
        Row { cells, ..Row::default() }
    };
    calibration.stages.iter().enumerate().map(row).collect()
}

fn because(stopped: StopReason) -> &'static str {
    match stopped {
        StopReason::CostConverged => "error settled",
        StopReason::StepConverged => "parameters settled",
        StopReason::GradientConverged => "gradient is zero",
        StopReason::ExactFit => "exact fit",
        StopReason::ClosedForm => "solved in one go",
        StopReason::IterationLimit => "NOT CONVERGED: iterations ran out",
        StopReason::NotFinite => "NOT CONVERGED: start is not finite",
    }
}
