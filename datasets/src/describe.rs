//! What a data set holds, in tables and lines, and that nothing is wrong with it: what `acm-data describe` and `acm-data check` print.

mod braille;
mod clocks;
mod picture;
pub mod table;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use acm_core::display::significant;
use comfy_table::Table;
use nalgebra::DMatrix;

use crate::error::DataError;
use crate::join::How;
use crate::manifest::{Manifest, Role};
use crate::preprocessing::segments::{max_gap, median_step, segments, usual_step};
use crate::recordings::Recordings;
use crate::trial::{DropReason, Trial};
use crate::units::Unit;

use self::table::table;

/// Characters and lines of a drawn signal.
const WIDTH: usize = 60;
const HEIGHT: usize = 2;

/// Of more trials than these, some of each role are listed and drawn.
const MANY: usize = 200;
/// So many.
const LISTED: usize = 20;
/// Names that are shown of a longer list.
const NAMED: usize = 30;

/// Trials, ranges, clocks and drawn signals of a set that was opened from `folder`; a longer step in time than `given` seconds is a
/// gap, or what [`max_gap`] says. With `picture`, an SVG of its several sources on one clock is written there.
///
/// # Errors
/// A trial that is read again and cannot be; a picture of a set of one source, or one that cannot be written.
pub fn description(
    data: &Recordings,
    folder: &Path,
    given: Option<f64>,
    picture: Option<&Path>,
) -> Result<String, DataError> {
    if let Some(file) = picture.filter(|_| data.alignments.is_empty()) {
        let (file, folder) = (file.display(), folder.display());
        let what = format!(
            "{folder}: a picture for {file} shows several sources on one clock, and the set has one; leave --picture out"
        );
        return Err(DataError::Usage(what));
    }
    let mut text = String::new();
    let seen = Seen::of(data, given)?;
    head(data, &mut text);
    let _ = writeln!(text, "\nTrials\n{}", seen.trials());
    gaps(data, given, &mut text);
    let _ = writeln!(text, "\nRanges (SI)\n{}", seen.ranges());
    if !data.alignments.is_empty() {
        let _ = writeln!(text, "\nClocks\n{}", clocks::table(data));
        recognised(data, &mut text);
        let _ = writeln!(text);
    }
    draw(data, &seen, &mut text)?;
    if let Some(file) = picture {
        let (drawn, of, file) = (picture::write(data, file)?, data.entries.len(), file.display());
        let _ = writeln!(text, "{file}: {drawn} of {of} trials on the common clock");
    }
    warned(data, &mut text);
    Ok(text)
}

/// That a set which was opened has no problems, with what was recognised and what looks wrong and may be right.
pub fn checked(data: &Recordings) -> String {
    let mut text = String::new();
    recognised(data, &mut text);
    warned(data, &mut text);
    let (samples, trials) = (data.samples(), data.entries.len());
    let count = |lost: bool| -> usize {
        let dropped = data.entries.iter().flat_map(|entry| &entry.dropped);
        dropped.filter(|(reason, _)| (**reason == DropReason::MissingMarker) == lost).map(|(_, count)| count).sum()
    };
    let without = match count(true) {
        0 => String::new(),
        lost => format!("{lost} without an output (only their inputs are used), "),
    };
    let (name, dropped) = (&data.manifest.name, count(false));
    let _ = writeln!(text, "{name}: {trials} trials, {samples} samples, {without}{dropped} left out: no problems");
    text
}

/// What a gap is, where it is not half a second in all trials.
fn gaps(data: &Recordings, given: Option<f64>, text: &mut String) {
    let Some(slowest) = data.entries.iter().max_by(|a, b| a.max_gap.total_cmp(&b.max_gap)) else { return };
    let (longest, name) = (slowest.max_gap, &slowest.name);
    let _ = match given {
        Some(_) => writeln!(text, "gap: a step in time over {longest} s"),
        None if slowest.max_gap > max_gap(None, 0.0) => {
            writeln!(
                text,
                "gap: a step in time over five usual steps of the trial, at least 0.5 s ({longest} s in {name})"
            )
        }
        None => return,
    };
}

/// What was recognised in the files of several sources, and how their clocks stand.
pub fn recognised(data: &Recordings, text: &mut String) {
    for note in &data.notes {
        let _ = writeln!(text, "{note}");
    }
    for alignment in data.alignments.iter().filter(|alignment| alignment.how != How::Same) {
        let _ = writeln!(text, "trial `{}` · {alignment}", alignment.trial);
    }
}

fn warned(data: &Recordings, text: &mut String) {
    for warning in &data.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
}

fn head(data: &Recordings, text: &mut String) {
    let manifest = &data.manifest;
    let synthetic = if manifest.synthetic { " — SYNTHETIC, made by a simulation" } else { "" };
    let _ = writeln!(text, "{}{synthetic}", manifest.heading());
    let _ = writeln!(text, "licence {} · source {}", or_dash(&manifest.licence), or_dash(manifest.provenance()));
    let _ = writeln!(text, "files in {} · sha256 {}", data.folder.display(), &data.hash[..12]);
    if let Some(arm) = &manifest.arm {
        let _ = writeln!(text, "nominal model: strain model of an arm of {} {}", arm.length.value, arm.length.unit);
    } else if manifest.predicted.is_empty() {
        let _ = writeln!(text, "nominal model: polynomial");
    } else {
        let _ = writeln!(text, "nominal model: the set's own prediction");
    }
    let folds = data.folds();
    let listed: Vec<String> = folds.validation.iter().map(|fold| named(fold)).collect();
    let _ = writeln!(text, "folds: {folds}: {}", or_dash(&listed.join(" | ")));
}

/// The names, or the first few and how many more.
fn named(names: &[String]) -> String {
    match names.len() {
        few if few <= NAMED => names.join(" "),
        many => format!("{} and {} more", names[..NAMED].join(" "), many - NAMED),
    }
}

fn or_dash(text: &str) -> &str {
    if text.is_empty() { "–" } else { text }
}

/// What one pass over the trials shows.
struct Seen {
    signals: Vec<Signal>,
    /// Cells of the table, by role.
    rows: BTreeMap<usize, Vec<[String; 8]>>,
    /// How many trials have no row, by role.
    more: BTreeMap<usize, usize>,
    /// Trials that are listed, by index.
    listed: Vec<usize>,
}

/// A signal with its name and its range so far.
struct Signal {
    name: String,
    kind: &'static str,
    unit: &'static str,
    of: fn(&Trial) -> &DMatrix<f64>,
    column: usize,
    least: f64,
    greatest: f64,
    sum: f64,
    count: usize,
}

impl Seen {
    fn of(data: &Recordings, given: Option<f64>) -> Result<Self, DataError> {
        let (rows, more, listed) = (BTreeMap::new(), BTreeMap::new(), Vec::new());
        let mut seen = Self { signals: signals(&data.manifest), rows, more, listed };
        let most = if data.entries.len() > MANY { LISTED } else { MANY };
        for (index, trial) in data.all().enumerate() {
            let trial = trial?;
            seen.signals.iter_mut().for_each(|signal| signal.see(&trial));
            let place = Role::ALL.iter().position(|role| *role == trial.role).unwrap_or(0);
            let rows = seen.rows.entry(place).or_default();
            match rows.len() < most {
                true => {
                    rows.push(row(&trial, given));
                    seen.listed.push(index);
                }
                false => *seen.more.entry(place).or_insert(0) += 1,
            }
        }
        Ok(seen)
    }

    fn trials(&self) -> Table {
        let header = ["trial", "role", "samples", "duration s", "rate Hz", "gaps", "longest s", "left out"];
        let mut table = table(&header, 2);
        for (role, rows) in &self.rows {
            rows.iter().for_each(|row| {
                table.add_row(row.clone());
            });
            if let Some(more) = self.more.get(role) {
                table.add_row([format!("{more} more"), rows[0][1].clone()]);
            }
        }
        table
    }

    fn ranges(&self) -> Table {
        let mut table = table(&["signal", "kind", "unit", "least", "mean", "greatest"], 3);
        for signal in &self.signals {
            let number = |x: f64| significant(x, 4);
            let mean = signal.sum / signal.count.max(1) as f64;
            let (least, greatest) = (number(signal.least), number(signal.greatest));
            let unit = signal.unit.to_string();
            table.add_row([signal.name.clone(), signal.kind.into(), unit, least, number(mean), greatest]);
        }
        table
    }
}

fn row(trial: &Trial, given: Option<f64>) -> [String; 8] {
    let (whole, _) = trial.with_unmeasured();
    let time = &whole.time;
    let parts = segments(time, max_gap(given, usual_step(time)));
    let step = median_step(time, &parts);
    let longest = time.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
    let left_out: Vec<String> = trial.dropped.iter().map(|(why, n)| format!("{n} {why}")).collect();
    [
        trial.name.clone(),
        trial.role.name().replace('_', " "),
        trial.samples().to_string(),
        format!("{:.1}", trial.duration()),
        if step > 0.0 { format!("{:.2}", 1.0 / step) } else { "–".into() },
        parts.len().saturating_sub(1).to_string(),
        format!("{longest:.3}"),
        or_dash(&left_out.join(", ")).to_string(),
    ]
}

impl Signal {
    fn new(kind: &'static str, name: &str, unit: &str, of: fn(&Trial) -> &DMatrix<f64>, column: usize) -> Self {
        let unit = Unit::parse(unit).map_or("1", |u| u.si_name());
        let (least, greatest) = (f64::INFINITY, f64::NEG_INFINITY);
        Self { name: name.into(), kind, unit, of, column, least, greatest, sum: 0.0, count: 0 }
    }

    fn in_trial<'a>(&self, trial: &'a Trial) -> &'a [f64] {
        let matrix = (self.of)(trial);
        &matrix.as_slice()[self.column * matrix.nrows()..(self.column + 1) * matrix.nrows()]
    }

    fn see(&mut self, trial: &Trial) {
        let values = self.in_trial(trial);
        self.least = values.iter().copied().fold(self.least, f64::min);
        self.greatest = values.iter().copied().fold(self.greatest, f64::max);
        self.sum = values.iter().fold(self.sum, |sum, value| sum + value);
        self.count += values.len();
    }
}

/// Every signal of a set.
fn signals(manifest: &Manifest) -> Vec<Signal> {
    let actuators = manifest.actuator.iter().enumerate();
    let context = manifest.context.iter().enumerate();
    let measured = manifest.measured.iter().enumerate();
    (actuators.map(|(i, s)| Signal::new("actuator", s.name(), &s.unit, |t| &t.actuators, i)))
        .chain(context.map(|(i, s)| Signal::new("context", s.name(), &s.unit, |t| &t.context, i)))
        .chain(measured.map(|(i, s)| Signal::new("measured", s.name(), &s.unit, |t| &t.measured, i)))
        .collect()
}

/// Every signal of every trial that is listed, between its least and greatest value in the set.
fn draw(data: &Recordings, seen: &Seen, text: &mut String) -> Result<(), DataError> {
    let names = seen.signals.iter().map(|s| s.name.chars().count()).max().unwrap_or(0);
    for trial in data.trials(seen.listed.iter().copied()) {
        let trial = trial?;
        let _ = writeln!(text, "\n{} ({}, {:.1} s)", trial.name, trial.role.name().replace('_', " "), trial.duration());
        for signal in &seen.signals {
            let range = (signal.least, signal.greatest);
            let lines = braille::draw(&trial.time, signal.in_trial(&trial), WIDTH, HEIGHT, range);
            let upper = format!("{} {}", significant(signal.greatest, 4), signal.unit);
            let labels = [(signal.name.as_str(), upper), ("", significant(signal.least, 4))];
            for (line, (name, limit)) in lines.iter().zip(labels) {
                let _ = writeln!(text, "  {name:names$} {line} {limit}");
            }
        }
    }
    Ok(())
}
