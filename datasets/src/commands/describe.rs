//! `acm-data describe`: what a data set holds, in tables and lines.

use std::fmt::Write;

use acm_datasets::units::Unit;
use acm_datasets::{Campaign, DataError, Role, Trial, median_step, segments};
use comfy_table::{CellAlignment, Table, presets};
use nalgebra::DMatrix;

use super::braille;
use crate::Set;

/// Characters and lines of a drawn signal.
const WIDTH: usize = 60;
const HEIGHT: usize = 2;

pub fn run(set: &Set, text: &mut String) -> Result<(), DataError> {
    let campaign = Campaign::read(&set.folder, set.data.as_deref())?;
    head(&campaign, text);
    let _ = writeln!(text, "\nTrials\n{}", trials(&campaign, set.max_gap));
    let _ = writeln!(text, "\nRanges (SI)\n{}", ranges(&campaign));
    draw(&campaign, text);
    for warning in &campaign.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    Ok(())
}

fn head(campaign: &Campaign, text: &mut String) {
    let manifest = &campaign.manifest;
    let synthetic = if manifest.synthetic { " — SYNTHETIC, made by a simulation" } else { "" };
    let _ = writeln!(text, "{}: {}{synthetic}", manifest.name, manifest.title);
    let _ = writeln!(text, "licence {} · source {}", or_dash(&manifest.licence), or_dash(&manifest.source));
    let _ = writeln!(text, "files in {} · sha256 {}", campaign.folder.display(), &campaign.hash[..12]);
    if let Some(arm) = &manifest.arm {
        let _ = writeln!(text, "nominal model: strain model of an arm of {} {}", arm.length.value, arm.length.unit);
    } else if manifest.predicted.is_empty() {
        let _ = writeln!(text, "nominal model: polynomial");
    } else {
        let _ = writeln!(text, "nominal model: the set's own prediction");
    }
    let folds: Vec<String> = campaign.folds().iter().map(|f| f.join(" ")).collect();
    let _ = writeln!(text, "validation trials of the folds: {}", or_dash(&folds.join(" | ")));
}

fn or_dash(text: &str) -> &str {
    if text.is_empty() { "–" } else { text }
}

/// A table whose first `words` columns are text; the others are numbers.
pub fn table(header: &[&str], words: usize) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_BORDERS_ONLY).set_header(header.to_vec());
    for column in table.column_iter_mut().skip(words) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

fn trials(campaign: &Campaign, max_gap: f64) -> Table {
    let mut table = table(&["trial", "role", "samples", "duration s", "rate Hz", "gaps", "longest s", "left out"], 2);
    for role in Role::ALL {
        for trial in campaign.trials(role) {
            let parts = segments(&trial.time, max_gap);
            let step = median_step(&trial.time, &parts);
            let longest = trial.time.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
            let left_out: Vec<String> = trial.dropped.iter().map(|(why, n)| format!("{n} {why}")).collect();
            table.add_row([
                trial.name.clone(),
                role.name().replace('_', " "),
                trial.samples().to_string(),
                format!("{:.1}", trial.duration()),
                if step > 0.0 { format!("{:.2}", 1.0 / step) } else { "–".into() },
                parts.len().saturating_sub(1).to_string(),
                format!("{longest:.3}"),
                or_dash(&left_out.join(", ")).to_string(),
            ]);
        }
    }
    table
}

/// Name, unit and values of every signal.
fn signals(campaign: &Campaign) -> Vec<(String, &'static str, &'static str, Values)> {
    let manifest = &campaign.manifest;
    let unit = |name: &str| Unit::parse(name).map_or("1", |u| u.si_name());
    let mut signals: Vec<(String, &str, &str, Values)> = Vec::new();
    for (i, s) in manifest.actuator.iter().enumerate() {
        signals.push((s.name().into(), "actuator", unit(&s.unit), Values { of: |t| &t.actuators, column: i }));
    }
    for (i, s) in manifest.context.iter().enumerate() {
        signals.push((s.name().into(), "context", unit(&s.unit), Values { of: |t| &t.context, column: i }));
    }
    for (i, s) in manifest.measured.iter().enumerate() {
        signals.push((s.name().into(), "measured", unit(&s.unit), Values { of: |t| &t.measured, column: i }));
    }
    signals
}

struct Values {
    of: fn(&Trial) -> &DMatrix<f64>,
    column: usize,
}

impl Values {
    fn in_trial<'a>(&self, trial: &'a Trial) -> &'a [f64] {
        let matrix = (self.of)(trial);
        &matrix.as_slice()[self.column * matrix.nrows()..(self.column + 1) * matrix.nrows()]
    }

    fn range(&self, trials: &[Trial]) -> (f64, f64) {
        let values = || trials.iter().flat_map(|t| self.in_trial(t).iter().copied());
        (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
    }
}

fn ranges(campaign: &Campaign) -> Table {
    let mut table = table(&["signal", "kind", "unit", "least", "mean", "greatest"], 3);
    for (name, kind, unit, values) in signals(campaign) {
        let (least, greatest) = values.range(&campaign.trials);
        let all = || campaign.trials.iter().flat_map(|t| values.in_trial(t));
        let mean = all().sum::<f64>() / all().count().max(1) as f64;
        let number = |x: f64| format!("{x:.5}");
        table.add_row([name, kind.into(), unit.into(), number(least), number(mean), number(greatest)]);
    }
    table
}

/// Every signal of every trial, between its least and greatest value in the set.
fn draw(campaign: &Campaign, text: &mut String) {
    let signals = signals(campaign);
    let names = signals.iter().map(|s| s.0.chars().count()).max().unwrap_or(0);
    let ranges: Vec<(f64, f64)> = signals.iter().map(|s| s.3.range(&campaign.trials)).collect();
    for trial in &campaign.trials {
        let _ = writeln!(text, "\n{} ({}, {:.1} s)", trial.name, trial.role.name().replace('_', " "), trial.duration());
        for ((name, _, unit, values), range) in signals.iter().zip(&ranges) {
            let lines = braille::draw(&trial.time, values.in_trial(trial), WIDTH, HEIGHT, *range);
            let labels = [(name.as_str(), format!("{:.4} {unit}", range.1)), ("", format!("{:.4}", range.0))];
            for (line, (name, limit)) in lines.iter().zip(labels) {
                let _ = writeln!(text, "  {name:names$} {line} {limit}");
            }
        }
    }
}
