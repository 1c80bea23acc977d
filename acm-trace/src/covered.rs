//! Where trials determine a model, and where it extrapolates.
//!
//! Calibration trials with no more values of an actuator than the degree of the nominal form do not determine its polynomial: beyond these
//! values its error is as large as that of any effect.

use acm_core::nominal::NominalSpec;
use acm_core::rig::Rig;

use crate::case::{Case, Trial};
use crate::fit::form::BEYOND;
use crate::search::nuisance::held::clusters;

/// A box of actuators.
#[derive(Debug, Clone, PartialEq)]
struct Covered {
    /// Lowest and highest value of each actuator; infinite where the trials determine the polynomial everywhere.
    ranges: Vec<(f64, f64)>,
}

/// Returns a caution where development trials leave the box in which the calibration trials determine a strain model: up to [`BEYOND`]
/// half ranges from its middle for an actuator with no more values than the degree of its polynomial.
pub fn left_open(case: &Case) -> Option<String> {
    let NominalSpec::Strain(arm) = &case.nominal else { return None };
    if case.is_predicted() || case.calibration.is_empty() {
        return None;
    }
    let range = |a: usize| {
        let (low, high) = range(&case.calibration, a);
        let values = case.calibration.iter().flat_map(|trial| trial.record.actuators[a].clone());
        let held = clusters(values.collect(), high - low);
        if high > low && (held == 1 || held > arm.degree) {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        let (middle, half) = (0.5 * (low + high), 0.5 * BEYOND * (high - low));
        (middle - half, middle + half)
    };
    let covered = Covered { ranges: (0..case.rig.actuators.len()).map(range).collect() };
    let beyond = covered.beyond(&case.rig, &case.development);
    (!beyond.is_empty()).then(|| {
        format!(
            "The calibration trials leave the nominal model open where development trials go ({beyond}). There it was fitted to the \
             development trials, which show what it lacks as well: record calibration trials there, or give these trials the role of \
             calibration."
        )
    })
}

impl Covered {
    /// Returns whether sample `t` lies in the box.
    fn holds(&self, actuators: &[Vec<f64>], t: usize) -> bool {
        self.ranges.iter().zip(actuators).all(|(range, q)| range.0 <= q[t] && q[t] <= range.1)
    }

    /// Returns the number of samples of a trial that lie in the box.
    fn samples(&self, trial: &Trial) -> usize {
        (0..trial.record.samples()).filter(|&t| self.holds(&trial.record.actuators, t)).count()
    }

    /// Describes the actuators that leave the box.
    fn beyond(&self, rig: &Rig, trials: &[Trial]) -> String {
        let leaves = |(a, covered): (usize, &(f64, f64))| {
            let (low, high) = range(trials, a);
            let signal = &rig.actuators[a];
            let text = || {
                let [low, high, from, to] =
                    [low, high, covered.0, covered.1].map(|value| format!("{value:.3}").replace('-', "−"));
                format!("{} goes from {low} to {high} {}, covered is {from} to {to}", signal.name, signal.unit)
            };
            (low < covered.0 || high > covered.1).then(text)
        };
        self.ranges.iter().enumerate().filter_map(leaves).collect::<Vec<_>>().join("; ")
    }
}

/// Returns a caution where held-out trials leave the range of all trials that models are fitted to.
pub fn extrapolated(case: &Case, held_out: &[Trial]) -> Option<String> {
    let widened = |a: usize| {
        let (own, other) = (range(case.calibration.iter().chain(&case.development), a), range(held_out, a));
        let margin = 0.5 * (BEYOND - 1.0) * (own.1.max(other.1) - own.0.min(other.0));
        (own.0 - margin, own.1 + margin)
    };
    let fitted_to = Covered { ranges: (0..case.rig.actuators.len()).map(widened).collect() };
    let all: usize = held_out.iter().map(|trial| trial.record.samples()).sum();
    let inside: usize = held_out.iter().map(|trial| fitted_to.samples(trial)).sum();
    let share = 100.0 * (all - inside) as f64 / all.max(1) as f64;
    (share >= LITTLE).then(|| {
        let beyond = fitted_to.beyond(&case.rig, held_out);
        format!(
            "{share:.0} % of the held-out samples lie beyond the trials that models are fitted to ({beyond}): their error is one of \
             extrapolation. Give a trial that goes there the role of development or calibration."
        )
    })
}

/// Smallest reported share of samples outside, %.
const LITTLE: f64 = 1.0;

/// Returns the lowest and the highest value of an actuator.
fn range<'t>(trials: impl IntoIterator<Item = &'t Trial>, actuator: usize) -> (f64, f64) {
    let values = trials.into_iter().flat_map(|trial| &trial.record.actuators[actuator]);
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (value.min(low), value.max(high)))
}

#[cfg(test)]
mod tests {
    use acm_core::ArmSpec;
    use acm_core::record::Record;
    use nalgebra::DMatrix;

    use super::*;
    use crate::fit::bench;

    fn trial(name: &str, q: &[f64]) -> Trial {
        let time = (0..q.len()).map(|t| t as f64).collect();
        let record = Record::new(time, vec![q.to_vec()], vec![], vec![]);
        let measured = DMatrix::zeros(q.len(), 1);
        Trial { name: name.into(), record, lead: None, measured, predicted: None, offset: None }
    }

    fn case(calibration: &[f64], development: &[&[f64]]) -> Case {
        let calibration = if calibration.is_empty() { vec![] } else { vec![trial("c", calibration)] };
        let development = development.iter().enumerate().map(|(k, q)| trial(&k.to_string(), q)).collect();
        let nominal = NominalSpec::Strain(ArmSpec::default());
        let rig = bench::rig(&["q"], &[], &["y"]);
        Case { rig, nominal, at: vec![], reported: 0..1, calibration, development }
    }

    /// Oracle: by hand. Three values leave a cubic open. From 0 to 2 they cover −0.25 to 2.25.
    #[test]
    fn development_trials_beyond_a_calibration_that_leaves_the_model_open_are_told() {
        let case = case(&[0.0, 2.0, 1.0], &[&[-0.2, 2.2, 2.3, 1.0], &[4.0, 5.0]]);
        let caution = left_open(&case).unwrap();
        assert!(caution.contains("q goes from −0.200 to 5.000 rad, covered is −0.250 to 2.250"), "{caution}");
    }

    /// Oracle: by hand. All trials together go from 0 to 8, so that up to one beyond 0 to 4 is within the margin: of five samples two are not.
    #[test]
    fn held_out_samples_beyond_all_others_are_told() {
        let case = case(&[0.0, 1.0], &[&[2.0, 4.0]]);
        let caution = extrapolated(&case, &[trial("a", &[0.5, 4.9, 5.1]), trial("b", &[3.0, 8.0])]).unwrap();
        assert!(
            caution.starts_with("40 % of the held-out samples") && caution.contains("q goes from 0.500 to 8.000"),
            "{caution}"
        );
        assert_eq!(extrapolated(&case, &[trial("a", &[0.5, 4.4])]), None);
        assert_eq!(extrapolated(&case, &[]), None);
    }

    /// Oracle: by hand. A sweep determines the cubic everywhere. What lies inside leaves nothing open; without calibration trials, or with a
    /// polynomial that is fitted to all trials, there is no box.
    #[test]
    fn nothing_is_open_that_is_covered_or_fitted_to_all_trials() {
        assert_eq!(left_open(&case(&[0.0, 1.0, 2.0], &[&[0.5, 1.5]])), None);
        assert_eq!(left_open(&case(&[], &[&[0.5, 9.0]])), None);
        let sweep: Vec<f64> = (0..21).map(|k| 0.1 * f64::from(k)).collect();
        assert_eq!(left_open(&case(&sweep, &[&[0.5, 9.0]])), None);
        let polynomial = NominalSpec::Polynomial { degree: 3 };
        assert_eq!(left_open(&Case { nominal: polynomial, ..case(&[0.0, 1.0, 2.0], &[&[0.5, 9.0]]) }), None);
    }
}
