//! Trials with predictions as a table in SI units, and the manifest of it.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use crate::files::table::Column;
use crate::manifest::{Manifest, Measured, Quantity, Role, Roles, Signal, Sources, Table, Time, TrialName, Vehicle};
use crate::trial::Trial;
use crate::units::Unit;

/// Name of the table.
pub const TABLE: &str = "recordings.parquet";

/// Columns of trial names and times; a signal of the same name gets another.
const TRIAL: &str = "trial";
const TIME: &str = "time";

/// Columns of a trial, with predictions [T×M] in SI.
pub fn columns(manifest: &Manifest, trial: &Trial, predicted: &DMatrix<f64>) -> Vec<(String, Column)> {
    let names = Names::of(manifest);
    let mut all = vec![
        (TRIAL.to_string(), Column::Text(vec![trial.name.clone(); trial.samples()])),
        (TIME.to_string(), Column::Number(trial.time.clone())),
    ];
    let mut add = |names: &[String], values: Option<&DMatrix<f64>>| {
        let Some(values) = values else { return };
        let column = |values: nalgebra::DVectorView<f64>| Column::Number(values.iter().copied().collect());
        all.extend(names.iter().cloned().zip(values.column_iter().map(column)));
    };
    add(&names.actuators, Some(&trial.actuators));
    add(&names.contexts, Some(&trial.context));
    add(&names.outputs, Some(&trial.measured));
    add(&names.predicted, Some(predicted));
    add(&names.vehicle, trial.vehicle.as_ref());
    all
}

/// Manifest of the table: signals, roles, folds and conditions as before, parts of cut trials as trials. `by` names the model.
pub fn manifest(of: &Manifest, trials: &[Trial], by: &str) -> Manifest {
    let names = Names::of(of);
    let signal = |own: &Signal, column: &String| Signal {
        column: column.clone(),
        unit: si(&own.unit),
        name: (own.name() != column).then(|| own.name().to_string()),
        quantity: own.quantity,
        fill: None,
    };
    let signals = |own: &[Signal], columns: &[String]| own.iter().zip(columns).map(|(o, c)| signal(o, c)).collect();
    let measured = |(own, column): (&Measured, &String)| Measured {
        column: column.clone(),
        unit: si(&own.unit),
        name: (own.name() != column).then(|| own.name().to_string()),
        at: own.at,
    };
    let predicted = |(own, column): (&Measured, &String)| Signal {
        column: column.clone(),
        unit: si(&own.unit),
        name: Some(own.name().to_string()),
        ..Signal::default()
    };
    let vehicle = of.vehicle.as_ref().map(|own| Vehicle {
        position: names.vehicle[..own.position.len()].to_vec(),
        unit: si(&own.unit),
        attitude: names.vehicle[own.position.len()..].to_vec(),
        attitude_unit: own.attitude_unit.as_deref().map(si),
    });
    let role = |role: Role| trials.iter().filter(|trial| trial.role == role).map(|trial| trial.name.clone()).collect();
    let provenance = [of.provenance(), &format!("Predictions by {by}.")].join(" ").trim().to_string();
    Manifest {
        source: Sources { text: provenance, list: vec![] },
        provenance: String::new(),
        table: Table {
            files: vec![TABLE.into()],
            trial: TrialName { column: Some(TRIAL.into()), file: None },
            time: Time { column: Some(TIME.into()), unit: Some("s".into()), rate_hz: None },
            ..Table::default()
        },
        actuator: signals(&of.actuator, &names.actuators),
        context: signals(&of.context, &names.contexts),
        measured: of.measured.iter().zip(&names.outputs).map(measured).collect(),
        predicted: of.measured.iter().zip(&names.predicted).map(predicted).collect(),
        vehicle,
        roles: Roles {
            calibration: role(Role::Calibration),
            development: role(Role::Development),
            held_out: role(Role::HeldOut),
            excluded: role(Role::Excluded),
        },
        conditions: conditions(of, trials),
        cut: BTreeMap::new(),
        ..of.clone()
    }
}

/// Conditions of each trial, in SI.
fn conditions(of: &Manifest, trials: &[Trial]) -> BTreeMap<String, BTreeMap<String, Quantity>> {
    let unit = |name: &String| of.conditions.values().find_map(|own| own.get(name)).map(|quantity| si(&quantity.unit));
    let quantity = |(name, value): (&String, &f64)| {
        (name.clone(), Quantity { value: *value, unit: unit(name).unwrap_or_else(|| "1".into()) })
    };
    let own = |trial: &Trial| (trial.name.clone(), trial.conditions.iter().map(quantity).collect());
    trials.iter().filter(|trial| !trial.conditions.is_empty()).map(own).collect()
}

fn si(unit: &str) -> String {
    Unit::parse(unit).map_or("1", |unit| unit.si_name()).to_string()
}

/// Names of the columns, each once.
struct Names {
    actuators: Vec<String>,
    contexts: Vec<String>,
    outputs: Vec<String>,
    predicted: Vec<String>,
    vehicle: Vec<String>,
}

impl Names {
    fn of(manifest: &Manifest) -> Self {
        let mut taken = vec![TRIAL.to_string(), TIME.to_string()];
        let mut free = |name: &str| {
            let mut name = name.to_string();
            while taken.contains(&name) {
                name.push('_');
            }
            taken.push(name.clone());
            name
        };
        let actuators = manifest.actuator.iter().map(|signal| free(signal.name())).collect();
        let contexts = manifest.context.iter().map(|signal| free(signal.name())).collect();
        let outputs = manifest.measured.iter().map(|output| free(output.name())).collect();
        let predicted = manifest.measured.iter().map(|output| free(&format!("predicted_{}", output.name()))).collect();
        let vehicle = manifest.vehicle.iter().flat_map(|own| own.position.iter().chain(&own.attitude));
        Self { actuators, contexts, outputs, predicted, vehicle: vehicle.map(|column| free(column)).collect() }
    }
}
