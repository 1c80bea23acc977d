//! Poses of the nominal arm along held-out trials: `poses.json`, beside the records, from which a page draws the arm.
//!
//! ```text
//! points[t][k] = p(q(t), L·k/(K − 1)),   k = 0 … K − 1
//! ```
//!
//! | symbol   | meaning                                                      | shape     | unit |
//! | `q(t)`   | actuator coordinates at a sample that was scored              | A         | SI   |
//! | `p`      | the calibrated backbone ([`acm_core::StrainModel::pose`])     | 3         | m    |
//! | `L`      | length of the arm                                             |           | m    |
//! | `points` | from base to tip, in the measurement frame                    | T × K × 3 | m    |
//!
//! Of each trial every k-th scored sample is kept. Only nominal models that are an arm have poses.

mod loads;

use std::path::Path;

use acm_core::{NominalModel, StrainModel};
use acm_datasets::files::table::{Column, read_parquet};
use acm_datasets::{DataError, Trial};
use serde::{Deserialize, Serialize};

pub use loads::{Load, Place};

use super::group;
use crate::run::plan::Plan;
use crate::run::record::{RunRecord, Stage};
use crate::run::setting::Setting;
use crate::store::{StoreError, hashed};

/// Name of the file.
pub const FILE: &str = "poses.json";

/// The number in [`Poses::format`].
pub const FORMAT: u32 = 1;

/// Largest number of trials.
const TRIALS: usize = 3;
/// Samples of a trial, at most.
const SAMPLES: usize = 200;
/// Points along an arm.
const POINTS: usize = 17;
/// Resolution of positions, in parts of a metre: they are drawn, and nothing is computed from them.
const PARTS: f64 = 1e6;

/// Poses of the first final run of an experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Poses {
    /// Version of this format, [`FORMAT`].
    pub format: u32,
    /// The run whose nominal model and held-out trials they are of.
    pub run: String,
    /// First held-out trials of the run.
    pub trials: Vec<TrialPoses>,
}

/// Poses along one trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrialPoses {
    /// Name of the trial.
    pub trial: String,
    /// Time stamps of the table of predictions, s.
    pub time: Vec<f64>,
    /// Points from base to tip for each time, m.
    pub points: Vec<Vec<[f64; 3]>>,
    /// Recorded loads on the arm, which the nominal model does not include.
    pub loads: Vec<Load>,
}

/// Computes the poses of the records in the folder `run`; none without a final run, or where the nominal model is no
/// arm.
///
/// # Errors
/// A trial or a table cannot be read.
pub fn of(setting: &Setting, plans: &[Plan], records: &[&RunRecord], run: &Path) -> Result<Option<Poses>, DataError> {
    let first = records.iter().find(|record| record.stage == Stage::Final);
    let planned = first.and_then(|record| Some((record, plans.iter().find(|plan| plan.id == record.id)?)));
    let Some((record, plan)) = planned else { return Ok(None) };
    let Some(arm) = arm(setting, plan) else { return Ok(None) };
    let scored = scored(&run.join(&record.predictions))?;
    let shown: Vec<String> = record.split.held_out.iter().take(TRIALS).cloned().collect();
    let trials = setting.data.trials(&shown).map(|trial| {
        let trial = trial?;
        let rows = rows(&trial, &scored);
        Ok(TrialPoses {
            trial: trial.name.clone(),
            time: rows.iter().map(|&row| trial.time[row]).collect(),
            points: rows.iter().map(|&row| backbone(arm, &trial, row)).collect(),
            loads: loads::of(setting.data, &trial, &rows),
        })
    });
    let trials = trials.collect::<Result<Vec<_>, DataError>>()?;
    Ok(Some(Poses { format: FORMAT, run: record.id.clone(), trials }))
}

/// Reads the poses of the folder `run`; none where there are none.
///
/// # Errors
/// The file cannot be read, or was changed.
pub fn read(run: &Path) -> Result<Option<Poses>, StoreError> {
    let path = run.join(FILE);
    path.is_file().then(|| hashed::read(&path, FORMAT)).transpose()
}

/// Returns the nominal arm of a plan, where its nominal model is one.
fn arm<'a>(setting: &Setting<'a>, plan: &Plan) -> Option<&'a StrainModel> {
    let pair = setting.nominal.calibrations.get(&group(&setting.data.manifest, plan))?;
    match &pair.nominal.as_ref()?.model {
        NominalModel::Strain(arm) => Some(arm),
        _ => None,
    }
}

/// Returns the trial and time of every sample that was scored on held-out trials.
fn scored(table: &Path) -> Result<Vec<(String, f64)>, DataError> {
    let mut columns = read_parquet(table)?;
    let damaged =
        |name: &str| DataError::Damaged { path: table.into(), reason: format!("there is no column `{name}`") };
    let mut take = |name: &str| {
        let place = columns.iter().position(|(known, _)| known == name).ok_or_else(|| damaged(name))?;
        Ok::<Column, DataError>(columns.swap_remove(place).1)
    };
    let (trials, parts, times) = (take("trial")?, take("part")?, take("time")?);
    let (Some(trials), Some(parts), Some(times)) = (trials.text(), parts.text(), times.numbers()) else {
        return Err(damaged("trial, part or time"));
    };
    let rows = trials.iter().zip(parts).zip(times).filter(|((_, part), _)| *part == "held_out");
    Ok(rows.map(|((trial, _), time)| (trial.clone(), *time)).collect())
}

/// Returns the samples of a trial that were scored: every k-th, so that there are [`SAMPLES`] at most.
fn rows(trial: &Trial, scored: &[(String, f64)]) -> Vec<usize> {
    let of_trial = scored.iter().filter(|(name, _)| *name == trial.name);
    let at = |time: f64| {
        let row = trial.time.partition_point(|stamp| *stamp < time);
        trial.time.get(row).is_some_and(|stamp| *stamp == time).then_some(row)
    };
    let rows: Vec<usize> = of_trial.filter_map(|(_, time)| at(*time)).collect();
    let step = rows.len().div_ceil(SAMPLES).max(1);
    rows.into_iter().step_by(step).collect()
}

fn backbone(arm: &StrainModel, trial: &Trial, row: usize) -> Vec<[f64; 3]> {
    let q: Vec<f64> = trial.actuators.row(row).iter().copied().collect();
    let length = arm.arm().length;
    let at = |k: usize| arm.pose(&q, length * k as f64 / (POINTS - 1) as f64).position;
    // Adding 0 takes the sign of a rounded zero away.
    (0..POINTS).map(|k| at(k).map(|value| (value * PARTS).round() / PARTS + 0.0).into()).collect()
}
