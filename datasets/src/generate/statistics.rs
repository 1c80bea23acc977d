//! Statistics of the campaign, compared with those of the paper.
//!
//! Errors are root mean squares of distances in mm. The nominal model is calibrated on the trials with rotors off and
//! is the manifest's; hover trials are reduced to the calibrated domain first. The order study is made on the
//! calibration trial whose second actuator is held nearest to zero (trial 17), with the actuation map frozen from
//! the linear fit. The paper's figures were measured on a real vehicle, these on a simulated one.

use acm_core::calibration::{CalibrationError, order_study};
use acm_core::{NominalModel, NominalSpec, calibrate};
use serde::{Deserialize, Serialize};

use crate::{Campaign, DataError, DomainFilter, Role, Trial, domain_filter};

/// One statistic of both campaigns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StatisticRow {
    /// Name of the statistic.
    pub name: String,
    /// Real campaign, as published, mm.
    pub paper_mm: f64,
    /// Synthetic campaign, mm.
    pub twin_mm: f64,
}

impl StatisticRow {
    /// Relative difference to the paper, 1.
    pub fn deviation(&self) -> f64 {
        self.twin_mm / self.paper_mm - 1.0
    }
}

/// Why there are no statistics.
#[derive(Debug, thiserror::Error)]
pub enum StatisticsError {
    /// The data cannot be used.
    #[error(transparent)]
    Data(#[from] DataError),
    /// The nominal model cannot be calibrated.
    #[error("the nominal model cannot be calibrated: {0}")]
    Calibration(#[from] CalibrationError),
    /// Only a continuum arm has these statistics.
    #[error("these statistics need a continuum arm; the manifest has no [arm]")]
    NoArm,
    /// They are those of two actuators, of which the second is held in a trial.
    #[error("these statistics need two actuators, of which the second is held in each trial; the manifest has {0}")]
    Actuators(usize),
    /// No trial has a role that is asked about.
    #[error("these statistics need {0} trials; name some in [roles] of the manifest")]
    NoTrials(&'static str),
}

/// Bins of the first actuator in the order study, as in the paper.
const BINS: usize = 40;
/// The paper's errors by strain order, mm: constant, linear, quadratic, cubic.
const ORDERS: [(&str, f64); 4] = [("constant", 94.72), ("linear", 13.84), ("quadratic", 13.03), ("cubic", 13.03)];

/// All statistics of a campaign that was read from disk.
///
/// # Errors
/// The campaign has no arm, other than two actuators, or no held-out trials, or the nominal model cannot be calibrated on it.
pub fn statistics(campaign: &Campaign) -> Result<Vec<StatisticRow>, StatisticsError> {
    let NominalSpec::Strain(arm) = campaign.nominal_spec() else { return Err(StatisticsError::NoArm) };
    if campaign.manifest.actuator.len() != 2 {
        return Err(StatisticsError::Actuators(campaign.manifest.actuator.len()));
    }
    if campaign.trials(Role::HeldOut).next().is_none() {
        return Err(StatisticsError::NoTrials("held_out"));
    }
    let calibration: Vec<&Trial> = campaign.trials(Role::Calibration).collect();
    let mut rows = Vec::new();
    if let Some(trial) = calibration.iter().min_by(|a, b| held(a).total_cmp(&held(b))) {
        let study = order_study(&campaign.observations(&[*trial]), &arm, &[0, 1, 2, 3], BINS)?;
        for (found, (order, paper_mm)) in study.iter().zip(ORDERS) {
            rows.push(row(&format!("trial {}, {order} strain", trial.name), paper_mm, found.frozen_rmse));
        }
    }
    let rest = campaign.observations(&calibration);
    let strain = calibrate(&NominalSpec::Strain(arm), &rest)?;
    let polynomial = calibrate(&NominalSpec::Polynomial { degree: 3 }, &rest)?;
    rows.push(row("rotors off, strain model", 25.19, strain.rms_total));
    rows.push(row("rotors off, cubic polynomial", 24.87, polynomial.rms_total));
    let held_out = in_domain(campaign, &[Role::HeldOut])?;
    let hover = in_domain(campaign, &[Role::Development, Role::HeldOut])?;
    rows.push(row("hover, trials 1–12", 44.05, error(campaign, &strain.model, &hover)));
    rows.push(row("hover, held-out trials 10–12", 44.94, error(campaign, &strain.model, &held_out)));
    Ok(rows)
}

/// Samples of the hover trials that lie in the calibrated domain; the paper keeps 13,922 of its own.
///
/// # Errors
/// A hull of more than two actuators.
pub fn samples_in_domain(campaign: &Campaign) -> Result<usize, DataError> {
    let hover = in_domain(campaign, &[Role::Development, Role::HeldOut])?;
    Ok(hover.iter().map(Trial::samples).sum())
}

fn row(name: &str, paper_mm: f64, twin_m: f64) -> StatisticRow {
    StatisticRow { name: name.into(), paper_mm, twin_mm: 1e3 * twin_m }
}

/// Mean distance of the second actuator from zero, rad.
fn held(trial: &Trial) -> f64 {
    trial.actuators.column(1).abs().mean()
}

fn in_domain(campaign: &Campaign, roles: &[Role]) -> Result<Vec<Trial>, DataError> {
    let calibration: Vec<&Trial> = campaign.trials(Role::Calibration).collect();
    let trials: Vec<&Trial> = campaign.trials.iter().filter(|trial| roles.contains(&trial.role)).collect();
    domain_filter(DomainFilter::Hull, &calibration, &trials)
}

/// Root mean square distance between model and measurement, m.
fn error(campaign: &Campaign, model: &NominalModel, trials: &[Trial]) -> f64 {
    let data = campaign.observations(&trials.iter().collect::<Vec<_>>());
    let residual = data.measured - model.predict(&data.actuators);
    (residual.norm_squared() / residual.nrows() as f64).sqrt()
}
