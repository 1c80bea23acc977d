//! The rig of a data set, and each trial as a record of columns, for the physics.
//!
//! | part of the rig  | comes from                                                                        |
//! | ---------------- | --------------------------------------------------------------------------------- |
//! | actuators        | `[[actuator]]`                                                                    |
//! | contexts         | `[[context]]`, then the conditions that no trial in use lacks, by name            |
//! | outputs          | `[[measured]]`, all of them                                                       |
//! | ranges           | the trials that a model is fitted to                                              |
//! | throttle and so on | `quantity` of a context signal, or else its name ([`quantity`])                 |
//! | mounting         | `[arm]`: its length, and which way is down                                        |
//! | acceleration     | the second difference of `[vehicle] position` ([`acceleration`])                  |
//!
//! A record begins at its trial's first sample, also where the trial is a part of a longer one: what an effect
//! remembers of the time before is not known.

mod acceleration;
mod quantity;

use acm_core::record::Record;
use acm_core::rig::{Mounting, Rig, Signal};
use nalgebra::DMatrix;

use crate::campaign::Campaign;
use crate::manifest::{self, PhysicalQuantity, Role};
use crate::preprocessing::segments::median_step;
use crate::trial::Trial;
use crate::units::Unit;

/// The rig of a campaign; ranges, step and duration are those of the trials in use.
pub fn rig(campaign: &Campaign, used: &[&Trial]) -> Rig {
    let manifest = &campaign.manifest;
    let signals = |signals: &[manifest::Signal], part: &dyn Fn(&Trial) -> &DMatrix<f64>| -> Vec<Signal> {
        let named = signals.iter().enumerate();
        named.map(|(j, s)| signal(s.name(), &s.unit, used, |trial| range(part(trial), j))).collect()
    };
    let conditions = conditions(campaign);
    let constants = conditions.iter().map(|name| {
        let constant = |trial: &Trial| trial.conditions.get(name).map(|value| (*value, *value));
        signal(name, &condition_unit(campaign, name), used, constant)
    });
    let mut contexts = signals(&manifest.context, &|trial| &trial.context);
    contexts.extend(constants);
    let outputs = manifest.measured.iter().enumerate();
    let of = |wanted| quantity::find(wanted, &manifest.context, &contexts);
    Rig {
        actuators: signals(&manifest.actuator, &|trial| &trial.actuators),
        outputs: outputs.map(|(j, m)| signal(m.name(), &m.unit, used, |trial| range(&trial.measured, j))).collect(),
        throttle: of(PhysicalQuantity::Throttle),
        altitude: of(PhysicalQuantity::Altitude),
        payload: of(PhysicalQuantity::Payload),
        carried: used.iter().any(|trial| moves(trial)),
        arm: manifest.arm.as_ref().map(|arm| Mounting { length: arm.length.si(), down: arm.down().unit() }),
        step: step(used),
        duration: used.iter().map(|trial| trial.duration()).fold(0.0, f64::max),
        contexts,
    }
}

/// Returns a trial as an effect sees it: the samples of [`Trial::with_unmeasured`]. A condition that an excluded trial lacks
/// counts as 0.
pub fn record(campaign: &Campaign, trial: &Trial) -> Record {
    let (trial, _) = trial.with_unmeasured();
    let columns = |matrix: &DMatrix<f64>| matrix.column_iter().map(|c| c.iter().copied().collect()).collect();
    let mut contexts: Vec<Vec<f64>> = columns(&trial.context);
    let constant = |name: &String| vec![trial.conditions.get(name).copied().unwrap_or(0.0); trial.samples()];
    contexts.extend(conditions(campaign).iter().map(constant));
    let acceleration = trial.vehicle.as_ref().map_or(vec![], |vehicle| {
        (0..3).map(|axis| acceleration::of(&trial.time, vehicle.column(axis).as_slice())).collect()
    });
    Record::new(trial.time.clone(), columns(&trial.actuators), contexts, acceleration)
}

/// Conditions that every trial in use has and no context signal is called, by name.
fn conditions(campaign: &Campaign) -> Vec<String> {
    let mut used = campaign.trials.iter().filter(|trial| trial.role != Role::Excluded);
    let Some(first) = used.next() else { return vec![] };
    let mut names: Vec<String> = first.conditions.keys().cloned().collect();
    for trial in used {
        names.retain(|name| trial.conditions.contains_key(name));
    }
    names.retain(|name| campaign.manifest.context.iter().all(|context| context.name() != name));
    names
}

/// Unit in which a condition is written where it is written first.
fn condition_unit(campaign: &Campaign, name: &str) -> String {
    let written = campaign.manifest.conditions.values().find_map(|constants| constants.get(name));
    written.map_or("1".into(), |quantity| quantity.unit.clone())
}

fn signal(name: &str, unit: &str, used: &[&Trial], range: impl Fn(&Trial) -> Option<(f64, f64)>) -> Signal {
    let ranges = used.iter().filter_map(|trial| range(trial));
    let (low, high) = ranges.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0.0, 0.0));
    let unit = Unit::parse(unit).map_or(unit, |u| u.si_name());
    Signal { name: name.into(), unit: unit.into(), low, high }
}

/// Smallest and largest value of a column; none where there are no samples.
fn range(columns: &DMatrix<f64>, j: usize) -> Option<(f64, f64)> {
    columns.column(j).iter().map(|value| (*value, *value)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
}

/// Whether a carrier is recorded that does not stand still.
fn moves(trial: &Trial) -> bool {
    let travels =
        |vehicle: &DMatrix<f64>| (0..3).any(|axis| range(vehicle, axis).is_some_and(|(low, high)| low < high));
    trial.vehicle.as_ref().is_some_and(travels)
}

/// Median time between samples, s; of an even number the lower middle one, and 0 where no trial has two samples.
pub fn step(used: &[&Trial]) -> f64 {
    let (mut time, mut trials) = (Vec::new(), Vec::new());
    for trial in used {
        let first = time.len();
        time.extend_from_slice(&trial.with_unmeasured().0.time);
        trials.push(first..time.len());
    }
    median_step(&time, &trials)
}
