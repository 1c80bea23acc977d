//! Inputs of a model: the columns of a trial.

use crate::manifest::Manifest;
use crate::trial::Trial;
use crate::units::Unit;

/// Columns of a trial, named as in results: `time` in s; actuators, contexts and conditions in the units of the manifest.
#[derive(Debug, Clone, PartialEq)]
pub struct Given {
    /// Name of the trial.
    pub trial: String,
    /// Names with T values each.
    pub columns: Vec<(String, Vec<f64>)>,
    /// Number of outputs M.
    pub outputs: usize,
}

impl Given {
    /// Of a trial.
    pub fn of(manifest: &Manifest, trial: &Trial) -> Self {
        let mut columns = vec![("time".to_string(), trial.time.clone())];
        for (signals, values) in [(&manifest.actuator, &trial.actuators), (&manifest.context, &trial.context)] {
            for (signal, values) in signals.iter().zip(values.column_iter()) {
                columns.push((signal.name().into(), in_unit(&signal.unit, values.iter().copied())));
            }
        }
        for (name, value) in &trial.conditions {
            let written = manifest.conditions.values().find_map(|own| own.get(name));
            let unit = written.map_or("1", |quantity| quantity.unit.as_str());
            columns.push((name.clone(), in_unit(unit, std::iter::repeat_n(*value, trial.samples()))));
        }
        Self { trial: trial.name.clone(), columns, outputs: trial.measured.ncols() }
    }

    /// Number of samples T.
    pub fn samples(&self) -> usize {
        self.columns[0].1.len()
    }
}

/// SI values in a unit.
fn in_unit(unit: &str, values: impl Iterator<Item = f64>) -> Vec<f64> {
    let factor = Unit::parse(unit).map_or(1.0, |unit| unit.factor());
    values.map(|value| value / factor).collect()
}
