//! The manifest of a frame, in the words of `manifest.toml`.
//!
//! ```text
//! time="t", trial="trial", actuators=["q1"], outputs=["x"], units={"x": "mm"}, held_out=["run4"]
//!     ─▶ [table] time, trial · [[actuator]] · [[measured]] · [roles]
//! ```

use std::collections::BTreeSet;

use pyo3::prelude::*;
use toml::{Table, Value};

use crate::{
    errors::usage,
    settings::{list, table},
};

/// The one file of the set.
pub const FILE: &str = "frame.parquet";

/// What of a frame is what.
pub struct Columns<'py> {
    /// Column of time, or a table of the manifest.
    pub time: Bound<'py, PyAny>,
    /// Column of the trials' names; one trial where it is none.
    pub trial: Option<String>,
    /// Names, names with units, or tables of the manifest.
    pub actuators: Bound<'py, PyAny>,
    /// The same.
    pub outputs: Bound<'py, PyAny>,
    /// The same.
    pub context: Option<Bound<'py, PyAny>>,
    /// The same.
    pub predicted: Option<Bound<'py, PyAny>>,
    /// Units by column.
    pub units: Option<Bound<'py, PyAny>>,
    /// Trials by role.
    pub calibration: Option<Vec<String>>,
    /// All that have no other role where it is none.
    pub development: Option<Vec<String>>,
    /// As above.
    pub held_out: Option<Vec<String>>,
    /// As above.
    pub excluded: Option<Vec<String>>,
    /// Further keys of the manifest.
    pub manifest: Option<Bound<'py, PyAny>>,
}

impl Columns<'_> {
    /// The manifest of a frame whose trials have these `names`; `timed` says that its column of time has a type of time.
    ///
    /// # Errors
    /// Something that is no name, list or table.
    pub fn manifest(&self, names: &[String], timed: impl Fn(&str) -> bool) -> PyResult<Table> {
        let units = self.units.as_ref().map(table).transpose()?.unwrap_or_default();
        let unit = |column: &str, usual: &str| units.get(column).cloned().unwrap_or_else(|| usual.into());
        let mut read = Table::new();
        read.insert("files".into(), vec![FILE].into());
        let time = match self.time.extract::<String>() {
            Ok(column) if timed(&column) => Table::from_iter([("column".to_string(), Value::from(column))]),
            Ok(column) => {
                let unit = unit(&column, "s");
                Table::from_iter([("column".to_string(), Value::from(column)), ("unit".into(), unit)])
            }
            Err(_) => table(&self.time)?,
        };
        read.insert("time".into(), time.into());
        if let Some(trial) = &self.trial {
            let trial = Table::from_iter([("column".to_string(), Value::from(trial.clone()))]);
            read.insert("trial".into(), trial.into());
        }
        let mut manifest = Table::from_iter([("table".to_string(), Value::from(read))]);
        let signals = [
            ("actuator", Some(&self.actuators)),
            ("context", self.context.as_ref()),
            ("measured", Some(&self.outputs)),
            ("predicted", self.predicted.as_ref()),
        ];
        for (key, signals) in signals {
            if let Some(signals) = signals {
                manifest.insert(key.into(), of_signals(signals, &unit)?.into());
            }
        }
        manifest.insert("roles".into(), self.roles(names).into());
        if let Some(more) = &self.manifest {
            merge(&mut manifest, table(more)?);
        }
        Ok(manifest)
    }

    fn roles(&self, names: &[String]) -> Table {
        let of = |role: &Option<Vec<String>>| role.clone().unwrap_or_default();
        let (calibration, held_out, excluded) = (of(&self.calibration), of(&self.held_out), of(&self.excluded));
        let taken: BTreeSet<&String> = calibration.iter().chain(&held_out).chain(&excluded).collect();
        let rest = || names.iter().filter(|name| !taken.contains(name)).cloned().collect();
        let development = self.development.clone().unwrap_or_else(rest);
        let roles = [
            ("calibration", calibration),
            ("development", development),
            ("held_out", held_out),
            ("excluded", excluded),
        ];
        let named = roles.into_iter().filter(|(_, trials)| !trials.is_empty());
        named.map(|(role, trials)| (role.to_string(), Value::from(trials))).collect()
    }
}

/// Tables of signals: of a list of names or tables, or of names with their units.
fn of_signals(signals: &Bound<'_, PyAny>, unit: &impl Fn(&str, &str) -> Value) -> PyResult<Vec<Value>> {
    let signal = |column: &str, unit: Value| {
        Value::from(Table::from_iter([("column".to_string(), Value::from(column)), ("unit".into(), unit)]))
    };
    if let Ok(units) = table(signals) {
        return Ok(units.into_iter().map(|(column, unit)| signal(&column, unit)).collect());
    }
    let one = |member: Value| match member {
        Value::String(column) => Ok(signal(&column, unit(&column, "1"))),
        Value::Table(table) => Ok(Value::Table(table)),
        other => Err(usage(format!("{other} is no signal; give its column, or a dictionary as in [[actuator]]"))),
    };
    list(signals)?.into_iter().map(one).collect()
}

/// Further keys: tables are put together, everything else is replaced.
fn merge(into: &mut Table, more: Table) {
    for (key, value) in more {
        match (into.get_mut(&key), value) {
            (Some(Value::Table(own)), Value::Table(more)) => merge(own, more),
            (_, value) => drop(into.insert(key, value)),
        }
    }
}

/// Every text in a manifest: whatever column it names is among them.
pub fn texts(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::String(text) => drop(found.insert(text.clone())),
        Value::Array(members) => members.iter().for_each(|member| texts(member, found)),
        Value::Table(table) => table.values().for_each(|member| texts(member, found)),
        _ => {}
    }
}
