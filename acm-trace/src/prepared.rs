//! Preparation of a case: the nominal model calibrated, trials thinned and cut into blocks, and the effects that the
//! trials can show.

use acm_core::calibration::CalibrationError;
use acm_core::effects::Carrier;
use acm_core::effects::instance::Instance;
use acm_core::response::Response;
use nalgebra::Vector3;

use crate::case::{Case, Trial};
use crate::covered::left_open;
use crate::fit::problem::Base;
use crate::nominal_fit::{self, Nominal};
use crate::options::Options;
use crate::series::{Series, number_blocks};

/// The parts of a case that do not change during the search.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// Case to be explained.
    pub case: Case,
    /// Nominal model as calibrated.
    pub nominal: Nominal,
    /// Trials that an effect is found on.
    pub development: Vec<Series>,
    /// Trials that calibrate; empty where there are none of their own.
    pub calibration: Vec<Series>,
    /// Stride of the samples that a quick look at a candidate uses.
    pub every: usize,
    /// Whether blocks are trials.
    pub by_trial: bool,
    /// Weight of each output.
    pub weight: Vec<f64>,
    /// Effects that may be found, in every way that they can act.
    pub library: Vec<Instance>,
    /// The nominal model as a function of the actuators.
    pub response: Response,
    /// Caution about the trials, for the report.
    pub caution: Option<String>,
}

/// Calibrates the nominal model and prepares every trial.
///
/// # Errors
/// A calibration that is impossible.
pub fn prepare(mut case: Case, options: &Options) -> Result<Prepared, CalibrationError> {
    let caution = left_open(&case);
    let nominal = nominal_fit::calibrate_nominal(&mut case, caution.is_some())?;
    let every = decimation(&case);
    let mut development = thinned(&case.development, &case, options, every);
    let by_trial = number_blocks(&mut development);
    let mut calibration = thinned(&case.calibration, &case, options, every);
    number_blocks(&mut calibration);
    calibration.iter_mut().for_each(|series| series.calibrates = true);
    let allowed = |instance: &Instance| {
        let name = instance.effect().name().to_string();
        options.only.as_ref().is_none_or(|only| only.contains(&name)) && !options.without.contains(&name)
    };
    let own = options.own.iter().flat_map(|own| Instance::all_own(own, &case.rig));
    let all = Instance::all(&case.rig).into_iter().chain(own);
    let library = all.filter(allowed).filter(|i| is_covered(i, &case)).collect();
    let weight = weights(&case);
    let down = case.rig.arm.as_ref().map(|arm| arm.down);
    let response = Response::new(nominal.in_use().clone(), None, down);
    Ok(Prepared { case, nominal, development, calibration, every, by_trial, weight, library, response, caution })
}

/// Number of bins of an actuator's range, and the share of them that must be visited for an effect that is periodic in
/// the actuator.
const BINS: (usize, f64) = (25, 0.7);

/// Smallest number of trials in which a drift must be seen. In fewer, any slow change explains as much.
const DRIFTING_TRIALS: usize = 3;

/// Returns whether the trials can determine an effect. One that is periodic in an actuator needs its range to be covered, or the fit
/// oscillates where nothing was recorded; a drift must restart in several trials.
fn is_covered(instance: &Instance, case: &Case) -> bool {
    let traits = instance.effect().traits();
    match instance.carrier() {
        Carrier::Actuator(a) if traits.is_periodic => {
            let all = || case.development.iter().flat_map(|trial| &trial.record.actuators[a]).copied();
            let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
            let mut seen = [false; BINS.0];
            for q in all() {
                let bin = (BINS.0 as f64 * (q - low) / (high - low)) as usize;
                seen[bin.min(BINS.0 - 1)] = true;
            }
            seen.iter().filter(|seen| **seen).count() as f64 >= BINS.1 * BINS.0 as f64
        }
        _ if traits.is_drift => case.development.len() >= DRIFTING_TRIALS,
        _ => true,
    }
}

/// Number of samples of all trials that suffices for a quick look at a candidate.
const QUICK: usize = 5000;

/// Largest root mean square error of linear interpolation between the samples that are kept, as a share of their spread.
const MISSED: f64 = 0.01;

/// Returns the stride of a quick look: as large as [`QUICK`] allows, if the actuators are smooth enough.
fn decimation(case: &Case) -> usize {
    let trials = || case.development.iter().chain(&case.calibration);
    let most = (trials().map(|trial| trial.record.samples()).sum::<usize>() / QUICK).max(1);
    let is_smooth =
        |every: &usize| trials().flat_map(|trial| &trial.record.actuators).all(|q| missed(q, *every) < MISSED);
    (2..=most).rev().find(is_smooth).unwrap_or(1)
}

/// Returns the root mean square error of linear interpolation between every `every`-th sample, over the spread of all.
fn missed(q: &[f64], every: usize) -> f64 {
    let mean = q.iter().sum::<f64>() / q.len().max(1) as f64;
    let spread = q.iter().map(|q| (q - mean).powi(2)).sum::<f64>();
    let between = q.windows(every + 1).step_by(every).flat_map(|part| {
        let slope = (part[every] - part[0]) / every as f64;
        part.iter().enumerate().map(move |(k, q)| q - part[0] - slope * k as f64)
    });
    let missed = between.map(|miss| miss * miss).sum::<f64>();
    if spread > 0.0 { (missed / spread).sqrt() } else { 0.0 }
}

/// Takes every k-th sample, so that as many numbers are compared as `samples` of three outputs have; k is a multiple of
/// `every`.
fn thinned(trials: &[Trial], case: &Case, options: &Options, every: usize) -> Vec<Series> {
    let total: usize = trials.iter().map(|trial| trial.measured_rows().len()).sum();
    let numbers = total * case.rig.outputs.len().max(2);
    let stride = numbers.div_ceil(3 * options.samples.max(1)).max(1).div_ceil(every) * every;
    trials.iter().map(|trial| Series::new(trial, stride)).collect()
}

/// Returns weights of one for outputs of one unit; else weights that make the range of each output 1.
fn weights(case: &Case) -> Vec<f64> {
    let outputs = &case.rig.outputs;
    if outputs.iter().all(|output| output.unit == outputs[0].unit) {
        return vec![1.0; outputs.len()];
    }
    outputs.iter().map(|output| 1.0 / output.span().max(f64::MIN_POSITIVE)).collect()
}

impl Prepared {
    /// Returns the prediction that effects are added to; none where the nominal model is a polynomial, which is fitted
    /// with them.
    pub fn base(&self) -> Option<Base<'_>> {
        let strain = self.nominal.stand_in.as_ref().map(|g| Base { stands_for: g, strain: Some(&self.response) });
        strain.or(self.nominal.stands_for.as_ref().map(|g| Base { stands_for: g, strain: None }))
    }

    /// Returns whether the actuators' clock may be corrected. Otherwise the search includes nothing that concerns time.
    pub fn may_correct_clock(&self) -> bool {
        self.library.iter().any(|instance| instance.effect().name() == "dead_time")
    }

    /// Returns the direction of gravity in the measurement frame; none without an arm.
    pub fn down(&self) -> Option<Vector3<f64>> {
        self.case.rig.arm.as_ref().map(|arm| arm.down)
    }

    /// Returns whether all outputs are lengths.
    pub fn is_length(&self) -> bool {
        self.case.rig.outputs.iter().all(|output| output.unit == "m")
    }

    /// Returns the unit of the errors: that of all outputs, or the range of each.
    pub fn unit(&self) -> String {
        let outputs = &self.case.rig.outputs;
        let one = outputs.iter().all(|output| output.unit == outputs[0].unit);
        if one { outputs[0].unit.clone() } else { "of each range".into() }
    }
}
