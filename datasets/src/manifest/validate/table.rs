//! Tables: files, names of trials, time.

use super::Check;
use crate::ingest::recording::csv::signs::wrong_sign;
use crate::manifest::{Manifest, Time, TrialName};
use crate::units::Dimension;

/// Rates that recordings have, Hz: a sample in eleven days to one in a microsecond.
const RATES: std::ops::RangeInclusive<f64> = 1e-6..=1e6;

impl Check<'_> {
    pub(super) fn table(&mut self, manifest: &Manifest) {
        let table = &manifest.table;
        if table.files.is_empty() {
            self.say(&["table"], "`files` is missing in [table]; name the data files, e.g. files = [\"*.csv\"]");
        }
        self.patterns(&["table", "files"], &table.files);
        self.patterns(&["table", "ignore"], &table.ignore);
        if let Some(folder) = table.folder.as_deref().filter(|f| f.is_empty() || leaves_folder(f)) {
            self.say(
                &["table", "folder"],
                format!("{folder:?} leaves the shared data; write a path below it, such as \"data/arm\""),
            );
        }
        self.signs(&["table"], table.separator.as_deref(), table.decimal.as_deref());
        self.trial_name(&table.trial);
        self.clock_of(&["table", "time"], &table.time);
        self.periodic(&["table"], &table.angles, &table.counters, manifest);
        let columns: Vec<String> = manifest.signal_columns().into_iter().map(|(_, _, column, _)| column).collect();
        for (i, four) in table.quaternions.iter().enumerate() {
            if let Some(part) = four.iter().find(|part| !columns.contains(part)) {
                let message = format!("{part:?} is declared nowhere; declare it, or delete the quaternion here");
                self.say(&["table", "quaternions", &i.to_string()], message);
            }
        }
    }

    /// Separators of cells and before fractions.
    pub(super) fn signs(&mut self, key: &[&str], separator: Option<&str>, decimal: Option<&str>) {
        if let Some(wrong) = wrong_sign(separator, decimal) {
            let message = format!("{} {:?} cannot be used; {}", wrong.key, wrong.value, wrong.remedy);
            self.say(&[key, &[wrong.key]].concat(), message);
        }
    }

    pub(super) fn patterns(&mut self, list: &[&str], patterns: &[String]) {
        for (i, pattern) in patterns.iter().enumerate() {
            let number = i.to_string();
            let key = [list, &[number.as_str()]].concat();
            if let Err(e) = glob::Pattern::new(pattern) {
                self.say(&key, format!("the pattern {pattern:?} is malformed ({}); correct it", e.msg));
            }
            if leaves_folder(pattern) {
                self.say(&key, format!("the pattern {pattern:?} leaves the data folder; make it relative to it"));
            }
        }
    }

    fn trial_name(&mut self, trial: &TrialName) {
        let key = ["table", "trial"];
        match (&trial.column, &trial.file) {
            (Some(_), Some(_)) => self.say(&key, "`trial` has both `column` and `file`; delete one of them"),
            (None, Some(_)) => self.file_pattern(&["table", "trial", "file"], trial),
            (Some(column), None) if column.is_empty() => self.say(&key, "`column` is empty; name the column"),
            _ => {}
        }
    }

    pub(super) fn file_pattern(&mut self, key: &[&str], trial: &TrialName) {
        let Some(pattern) = &trial.file else { return };
        match regex::Regex::new(pattern) {
            Err(e) => {
                let reason = e.to_string();
                let reason = reason.lines().last().unwrap_or_default().to_string();
                let message =
                    format!("{pattern:?} is no regular expression ({reason}); write one such as \"run_(.*)\"");
                self.say(key, message);
            }
            Ok(regex) if regex.captures_len() < 2 => {
                let message =
                    format!("{pattern:?} has no group; put the trial's name in parentheses, as in \"run_(.*)\"");
                self.say(key, message);
            }
            Ok(_) => {}
        }
    }

    pub(super) fn clock_of(&mut self, key: &[&str], time: &Time) {
        if let Some(rate) = time.rate_hz.filter(|rate| !RATES.contains(rate)) {
            let message = match rate.is_finite() && rate > 0.0 {
                true => format!(
                    "rate_hz is {rate:e}, and no recording has more than 1e6 or fewer than 1e-6 samples a second; \
                     give the samples per second"
                ),
                false => format!("rate_hz is {rate}; give a finite rate above 0"),
            };
            self.say(&[key, &["rate_hz"]].concat(), message);
        }
        match (&time.column, &time.unit, time.rate_hz) {
            (None, _, None) => {
                let forms = "{ column = \"t\", unit = \"s\" } or { rate_hz = 20.0 }";
                self.say(key, format!("`time` is missing in [table]; say time = {forms}"));
            }
            (None, Some(_), Some(_)) => self.say(key, "`unit` without `column`; name the column or delete `unit`"),
            (Some(_), None, Some(_)) => {
                self.say(key, "`column` and `rate_hz` without `unit`; add unit = \"sample\", or delete rate_hz");
            }
            // dates, and columns of a type of time, carry their unit
            (Some(_), None, None) => {}
            (Some(_), Some(unit), rate) => match self.unit(&[key, &["unit"]].concat(), unit) {
                Some(Dimension::Sample) if rate.is_none() => {
                    self.say(key, "time counts samples; add rate_hz, the samples per second");
                }
                Some(Dimension::Time) if rate.is_some() => {
                    self.say(key, "the file has time stamps and `rate_hz` is given too; delete rate_hz");
                }
                Some(Dimension::Sample | Dimension::Time) | None => {}
                Some(_) => {
                    self.say(&[key, &["unit"]].concat(), format!("{unit:?} is no unit of time; use s, ms or sample"));
                }
            },
            (None, None, Some(_)) => {}
        }
    }
}

fn leaves_folder(path: &str) -> bool {
    path.starts_with(['/', '\\', '~']) || path.contains(':') || path.split(['/', '\\']).any(|part| part == "..")
}
