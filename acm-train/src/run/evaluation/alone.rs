//! Scores of the nominal model alone on held-out trials, without training.

use std::collections::BTreeSet;

use nalgebra::DMatrix;

use super::score::TrialPrediction;
use crate::run::data::scored::Scored;
use crate::run::error::RunError;
use crate::run::nominal::group;
use crate::run::plan::Plan;
use crate::run::record::{CalibrationPair, Stage};
use crate::run::setting::Setting;

/// Predicts the held-out trials of some plans by the nominal model alone, at the targets of a run; `predicted` is
/// `nominal`. Where each fold has a calibration of its own, the mean over those of all plans.
///
/// # Errors
/// A trial that cannot be read.
pub fn held_out(setting: &Setting, plans: &[Plan]) -> Result<Vec<TrialPrediction>, RunError> {
    let Some(last) = plans.iter().find(|plan| plan.stage == Stage::Final) else { return Ok(vec![]) };
    let held_out = &last.split.held_out;
    let groups: BTreeSet<String> = plans.iter().map(|plan| group(&setting.data.manifest, plan)).collect();
    let mut mean: Vec<TrialPrediction> = vec![];
    for name in &groups {
        let one = of(setting, &setting.nominal.calibrations[name], held_out)?;
        match mean.is_empty() {
            true => mean = one,
            false => mean.iter_mut().zip(&one).for_each(|(sum, one)| {
                sum.nominal += &one.nominal;
                sum.polynomial += &one.polynomial;
            }),
        }
    }
    for trial in &mut mean {
        trial.nominal /= groups.len() as f64;
        trial.polynomial /= groups.len() as f64;
        trial.predicted = trial.nominal.clone();
    }
    Ok(mean)
}

fn of(setting: &Setting, pair: &CalibrationPair, names: &[String]) -> Result<Vec<TrialPrediction>, RunError> {
    let scored = Scored::new(setting, pair, names, setting.experiment.windows.evaluation_stride)?;
    let nothing = DMatrix::zeros(scored.windows().len(), setting.data.manifest.tip_columns().len());
    Ok(scored.predictions(nothing).collect::<Result<_, _>>()?)
}
