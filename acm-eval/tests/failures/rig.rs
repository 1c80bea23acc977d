//! Recordings as a user would bring them: a folder with one CSV a trial and a manifest.

use std::fmt::Write;

use tempfile::TempDir;

use crate::motion::Random;

/// A column: its name and unit.
pub type Column = [&'static str; 2];

/// What one trial recorded.
pub struct Trial {
    /// First letter: `c` calibration, `d` development, `h` held out.
    pub name: String,
    /// s `[N]`.
    pub time: Vec<f64>,
    /// Actuators, contexts, outputs, in the order of the rig; `[N]` each.
    pub columns: Vec<Vec<f64>>,
}

impl Trial {
    /// The k-th trial of a part.
    pub fn new(part: char, k: usize, time: &[f64], columns: Vec<Vec<f64>>) -> Self {
        Self { name: format!("{part}{k}"), time: time.to_vec(), columns }
    }
}

/// Letter and number of so many development trials, then held-out ones.
pub fn parts(development: usize, held_out: usize) -> impl Iterator<Item = (char, usize)> {
    (0..development + held_out).map(move |k| (if k < development { 'd' } else { 'h' }, k))
}

/// What is recorded, and the trials.
pub struct Rig {
    /// Commanded or read back.
    pub actuators: Vec<Column>,
    /// What else is known.
    pub contexts: Vec<Column>,
    /// Measured.
    pub outputs: Vec<Column>,
    /// Further lines of the manifest: `[arm]`.
    pub more: String,
    /// All trials.
    pub trials: Vec<Trial>,
}

impl Rig {
    /// One actuator `q` in `from`, one output `y` in `to`.
    pub fn one_to_one(from: &'static str, to: &'static str, trials: Vec<Trial>) -> Self {
        let (actuators, outputs) = (vec![["q", from]], vec![["y", to]]);
        Self { actuators, contexts: vec![], outputs, more: String::new(), trials }
    }

    /// Writes the folder.
    pub fn write(&self) -> TempDir {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("manifest.toml"), self.manifest()).unwrap();
        for trial in &self.trials {
            std::fs::write(folder.path().join(format!("{}.csv", trial.name)), self.table(trial)).unwrap();
        }
        folder
    }

    fn manifest(&self) -> String {
        let mut text = String::from(HEAD);
        for (kind, columns) in [("actuator", &self.actuators), ("context", &self.contexts), ("measured", &self.outputs)]
        {
            for [name, unit] in columns {
                writeln!(text, "[[{kind}]]\ncolumn = \"{name}\"\nunit = \"{unit}\"\nname = \"{name}\"").unwrap();
            }
        }
        writeln!(text, "{}\n[roles]", self.more).unwrap();
        for (part, role) in [('c', "calibration"), ('d', "development"), ('h', "held_out")] {
            let of_part = self.trials.iter().filter(|trial| trial.name.starts_with(part));
            let names: Vec<String> = of_part.map(|trial| format!("{:?}", trial.name)).collect();
            if !names.is_empty() {
                writeln!(text, "{role} = [{}]", names.join(", ")).unwrap();
            }
        }
        text
    }

    fn table(&self, trial: &Trial) -> String {
        let columns = [&self.actuators, &self.contexts, &self.outputs];
        let names: Vec<&str> = columns.into_iter().flatten().map(|[name, _]| *name).collect();
        assert_eq!(names.len(), trial.columns.len(), "columns of {}", trial.name);
        let mut text = format!("t,{}\n", names.join(","));
        for (k, t) in trial.time.iter().enumerate() {
            let row: Vec<String> = trial.columns.iter().map(|column| column[k].to_string()).collect();
            writeln!(text, "{t},{}", row.join(",")).unwrap();
        }
        text
    }
}

/// A signal with white noise of standard deviation `sd`.
pub fn noisy(random: &mut Random, sd: f64, clean: impl IntoIterator<Item = f64>) -> Vec<f64> {
    clean.into_iter().map(|x| x + sd * random.normal()).collect()
}

const HEAD: &str = r#"
name      = "rig"
title     = "A rig of a test"
licence   = "CC0"
source    = "written by a test"
synthetic = true

[table]
files = ["*.csv"]
trial = { file = "(.*)" }
time  = { column = "t", unit = "s" }

"#;
