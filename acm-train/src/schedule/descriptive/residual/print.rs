//! The tables of a residual study for the terminal.

use std::path::Path;

use super::record::{ResidualStudy, Slice, TrialResidual};
use crate::run::evaluation::summary::in_unit;
use crate::schedule::descriptive::rms::Rms;
use crate::schedule::descriptive::show::{cells, display, header, heads, table, title};

/// Writes all tables, and the folder that they were written to.
pub fn text(record: &ResidualStudy, root: &Path) -> String {
    let mut parts = vec![title(&record.data), groups(record), trials(record)];
    parts.extend(record.notes.iter().map(|note| format!("note: {note}")));
    parts.push(format!("study.json, predictions: {}", root.display()));
    parts.join("\n\n")
}

/// Writes all samples, roles, altitudes and slices, one row each.
fn groups(record: &ResidualStudy) -> String {
    let display = display(&record.data, [&record.overall]);
    let row = |name: String, trials: String, rms: &Rms| {
        [vec![name, trials, rms.samples.to_string()], cells(rms, &display)].concat()
    };
    let mut rows = vec![row("all".into(), record.trials.len().to_string(), &record.overall)];
    rows.extend(record.roles.iter().map(|role| row(role.role.replace('_', " "), role.trials.join(" "), &role.rms)));
    for group in &record.altitudes {
        rows.push(row(format!("altitude {:.2} m", group.altitude), group.trials.join(" "), &group.rms));
    }
    for slice in record.slices.iter().filter(|_| record.slices.len() > 1) {
        rows.push(row(record.held(slice), slice.trials.join(" "), &slice.rms));
    }
    let title = format!("Residual = measured − nominal: root mean square{}", in_unit(&display));
    table(&title, &header(&["of", "trials", "samples"], heads(&record.data, &record.outputs)), rows, 2)
}

fn trials(record: &ResidualStudy) -> String {
    let display = display(&record.data, [&record.overall]);
    let row = |trial: &TrialResidual| {
        let altitude = trial.altitude.map_or(String::new(), |altitude| format!("{altitude:.3}"));
        let first = vec![trial.trial.clone(), trial.role.replace('_', " "), altitude, trial.rms.samples.to_string()];
        [first, cells(&trial.rms, &display)].concat()
    };
    let title = format!("Trial by trial: root mean square residual{}", in_unit(&display));
    let first = header(&["trial", "role", "altitude [m]", "samples"], heads(&record.data, &record.outputs));
    table(&title, &first, record.trials.iter().map(row).collect(), 2)
}

impl ResidualStudy {
    /// Writes the held values of a slice: `q2 = 1.20 rad`.
    pub fn held(&self, slice: &Slice) -> String {
        let others = self.actuators.iter().zip(&slice.actuators).enumerate().filter(|(a, _)| *a != self.swept);
        // Rounded first, so that a noisy zero has no sign.
        let shown = |value: f64| (100.0 * value).round() / 100.0 + 0.0;
        let named = others.map(|(_, (a, value))| format!("{} = {:.2} {}", a.name, shown(*value), a.unit));
        let named: Vec<String> = named.collect();
        if named.is_empty() { "all".into() } else { named.join(", ") }
    }
}
