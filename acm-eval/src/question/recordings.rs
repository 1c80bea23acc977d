//! Conversion of a data set to a case: calibration, development and held-out trials.
//!
//! Without trials of that role the last part of each development trial is held out; without development trials the
//! calibration trials stand for them. Both weaken the conclusion, and the finding says so.

mod clocks;

use acm_core::nominal::NominalSpec;
use acm_datasets::{Campaign, Role, Trial};
use acm_trace::case::{Case, Trial as Recorded};
use acm_trace::holdout::Holdout;

use crate::error::EvalError;

/// Share of a development trial that is held out where no trial has that role.
const LAST_PART: f64 = 0.3;

/// Case, held-out trials, and cautions.
#[derive(Debug)]
pub struct Recordings {
    /// Case that is ready to be traced.
    pub case: Case,
    /// Trials that take no part until the end.
    pub holdout: Holdout,
    /// Cautions in sentences.
    pub cautions: Vec<String>,
    /// Half of the 95 % interval of the offset between the clocks of actuators and outputs, s; 0 where it was not estimated.
    pub clock_interval: f64,
}

/// Sorts the trials of a campaign by their roles.
///
/// # Errors
/// A data set without trials to find an effect on.
pub fn recordings(campaign: &Campaign, nominal: NominalSpec, own_prediction: bool) -> Result<Recordings, EvalError> {
    let mut cautions = campaign.warnings.clone();
    let of = |role: Role| campaign.trials(role).cloned().collect::<Vec<Trial>>();
    let (mut calibration, mut development) = (of(Role::Calibration), of(Role::Development));
    let mut held_out = of(Role::HeldOut);
    if development.is_empty() {
        development = std::mem::take(&mut calibration);
    }
    if development.is_empty() {
        let name = &campaign.manifest.name;
        return Err(EvalError::Data(format!(
            "{name}: no trial has the role `development` or `calibration`; give one in [roles] of the manifest"
        )));
    }
    if calibration.is_empty() {
        cautions.push(
            "No trial only calibrates: the nominal model was fitted to the trials in which the effect was sought."
                .into(),
        );
    }
    let mut last_parts = false;
    if held_out.is_empty() {
        (development, held_out) = development.iter().map(cut).unzip();
        last_parts = true;
        cautions.push(format!(
            "No trial is held out: the last {:.0} % of each development trial took no part instead, which is weaker than trials of \
             their own.",
            100.0 * LAST_PART
        ));
    }
    let clocks = clocks::estimated(campaign);
    cautions.extend(clocks.cautions);
    let used: Vec<&Trial> = calibration.iter().chain(&development).collect();
    let rig = acm_datasets::rig::rig(campaign, &used);
    let all = |trials: &[Trial]| -> Vec<Recorded> {
        trials.iter().map(|trial| recorded(campaign, trial, own_prediction)).collect()
    };
    let mut held_out = all(&held_out);
    if last_parts {
        let first = |trial: &Trial| Some(acm_datasets::rig::record(campaign, trial));
        held_out.iter_mut().zip(&development).for_each(|(last, trial)| last.lead = first(trial));
    }
    let case = Case {
        at: campaign.manifest.marker_places(),
        reported: campaign.tip_columns(),
        calibration: all(&calibration),
        development: all(&development),
        rig,
        nominal,
    };
    Ok(Recordings { case, holdout: Holdout::new(held_out), cautions, clock_interval: clocks.interval })
}

fn recorded(campaign: &Campaign, trial: &Trial, own_prediction: bool) -> Recorded {
    let is_part = trial.name.rsplit_once(':').is_some_and(|(whole, _)| campaign.manifest.cut.contains_key(whole));
    let (past, own) = if is_part { trial.apart_from_past() } else { (None, trial.clone()) };
    let (whole, _) = own.with_unmeasured();
    Recorded {
        name: trial.name.clone(),
        record: acm_datasets::rig::record(campaign, &own),
        lead: past.map(|past| acm_datasets::rig::record(campaign, &past)),
        measured: whole.measured.clone(),
        predicted: whole.predicted.clone().filter(|_| own_prediction),
        offset: None,
    }
}

fn cut(trial: &Trial) -> (Trial, Trial) {
    let samples = trial.samples();
    let first = ((1.0 - LAST_PART) * samples as f64).round() as usize;
    let part = |rows: std::ops::Range<usize>| trial.select(&rows.collect::<Vec<usize>>());
    (part(0..first), part(first..samples))
}
