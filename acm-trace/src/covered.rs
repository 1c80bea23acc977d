//! Samples at which the calibrated nominal model says something.
//!
//! Calibration trials that hold an actuator at no more values than the degree of the nominal form leave its polynomial open: beyond these
//! values its error is as large as that of any effect. Effects act on the whole record; only samples that are covered are compared.

use acm_core::nominal::NominalSpec;
use acm_core::rig::Rig;

use crate::case::{Case, Trial};
use crate::fit::form::BEYOND;
use crate::search::nuisance::held::clusters;
use crate::series::Series;

/// The box of actuators that calibration trials cover.
#[derive(Debug, Clone, PartialEq)]
pub struct Covered {
    /// Lowest and highest value of each actuator, [`BEYOND`] half ranges from the middle; without bounds where the trials determine the
    /// polynomial.
    ranges: Vec<(f64, f64)>,
}

impl Covered {
    /// Returns the box of a case; none where the development trials calibrate, or predictions come with the data.
    fn of(case: &Case) -> Option<Self> {
        let degree = match &case.nominal {
            NominalSpec::Strain(arm) => arm.degree,
            NominalSpec::Polynomial { degree } => *degree,
            NominalSpec::None => return None,
        };
        let calibrates = !case.is_predicted() && !case.calibration.is_empty();
        let range = |a: usize| {
            let (low, high) = range(&case.calibration, a);
            let held = clusters(
                case.calibration.iter().flat_map(|trial| trial.record.actuators[a].clone()).collect(),
                high - low,
            );
            if high > low && (held == 1 || held > degree) {
                return (f64::NEG_INFINITY, f64::INFINITY);
            }
            let (middle, half) = (0.5 * (low + high), 0.5 * BEYOND * (high - low));
            (middle - half, middle + half)
        };
        calibrates.then(|| Self { ranges: (0..case.rig.actuators.len()).map(range).collect() })
    }

    /// Takes trials of which the box holds too little out of a case. Returns the box where it takes samples out, and what a reader has to
    /// know where it does not hold all of them. Where no trial would be left, the case stays as it is.
    pub fn confine(case: &mut Case) -> (Option<Self>, Option<String>) {
        let Some(covered) = Self::of(case) else { return (None, None) };
        let all: usize = case.development.iter().map(|trial| trial.record.samples()).sum();
        let beyond = covered.beyond(&case.rig, &case.development);
        if beyond.is_empty() {
            return (None, None);
        }
        let is_held = |trial: &Trial| covered.samples(trial) as f64 > HELD * trial.record.samples() as f64;
        let inside: usize =
            case.development.iter().filter(|trial| is_held(trial)).map(|trial| covered.samples(trial)).sum();
        if inside == 0 {
            let caution = format!("The calibration trials hardly cover the development trials ({beyond}): {ADVICE}.");
            return (None, Some(caution));
        }
        case.development.retain(is_held);
        let share = 100.0 * (all - inside) as f64 / all as f64;
        let caution = format!(
            "{share:.0} % of the development samples take no part, since the calibration trials do not cover them ({beyond}): {ADVICE}."
        );
        (Some(covered), Some(caution))
    }

    /// Returns whether sample `t` lies in the box.
    fn holds(&self, actuators: &[Vec<f64>], t: usize) -> bool {
        self.ranges.iter().zip(actuators).all(|(range, q)| range.0 <= q[t] && q[t] <= range.1)
    }

    /// Returns the number of samples of a trial that lie in the box.
    fn samples(&self, trial: &Trial) -> usize {
        (0..trial.record.samples()).filter(|&t| self.holds(&trial.record.actuators, t)).count()
    }

    /// Lets only samples in the box count.
    pub fn take_out(&self, series: &mut [Series]) {
        for series in series {
            let actuators = &series.thin.actuators;
            series.counts.iter_mut().enumerate().for_each(|(k, counts)| *counts &= self.holds(actuators, k));
        }
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

/// Returns what a reader has to know where held-out trials leave the actuators of all trials that models are fitted to.
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

/// Share of samples beyond that is not worth a word, %.
const LITTLE: f64 = 1.0;

/// What helps.
const ADVICE: &str = "record calibration trials there, or give these trials the role of calibration";

/// Share of a trial that the box has to hold more of: with less, the warm-up may leave nothing of it.
const HELD: f64 = 0.1;

/// Returns the lowest and the highest value of an actuator.
fn range<'t>(trials: impl IntoIterator<Item = &'t Trial>, actuator: usize) -> (f64, f64) {
    let values = trials.into_iter().flat_map(|trial| &trial.record.actuators[actuator]);
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (value.min(low), value.max(high)))
}

#[cfg(test)]
mod tests {
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
        let nominal = NominalSpec::Polynomial { degree: 3 };
        let rig = bench::rig(&["q"], &[], &["y"]);
        Case { rig, nominal, at: vec![], reported: 0..1, calibration, development }
    }

    /// Oracle: by hand. Three values leave a cubic open. From 0 to 2 they cover −0.25 to 2.25: of two trials one has three samples there, the other has none.
    #[test]
    fn samples_beyond_the_calibration_take_no_part() {
        let mut case = case(&[0.0, 2.0, 1.0], &[&[-0.2, 2.2, 2.3, 1.0], &[4.0, 5.0]]);
        let (covered, caution) = Covered::confine(&mut case);
        let (covered, caution) = (covered.unwrap(), caution.unwrap());
        assert!(
            caution.starts_with("50 % of the development samples") && caution.contains("q goes from −0.200 to 5.000"),
            "{caution}"
        );
        assert_eq!(case.development.len(), 1);
        let mut series = vec![Series::new(&case.development[0], 1)];
        series[0].counts.fill(true);
        covered.take_out(&mut series);
        assert_eq!(series[0].counts, [true, true, false, true]);
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

    /// Oracle: by hand. A sweep determines the cubic everywhere. What lies inside has no caution; where nothing would be left, everything stays; without calibration trials
    /// there is no box.
    #[test]
    fn nothing_is_taken_out_of_what_is_covered_or_has_nothing_else() {
        let confined = |mut case: Case| {
            let (covered, caution) = Covered::confine(&mut case);
            (covered.is_some(), caution.is_some(), case.development.len())
        };
        assert_eq!(confined(case(&[0.0, 2.0], &[&[0.5, 1.5]])), (false, false, 1));
        assert_eq!(confined(case(&[0.0, 0.0], &[&[0.5, 1.5]])), (false, true, 1));
        assert_eq!(confined(case(&[], &[&[0.5]])), (false, false, 1));
        let sweep: Vec<f64> = (0..21).map(|k| 0.1 * f64::from(k)).collect();
        assert_eq!(confined(case(&sweep, &[&[0.5, 9.0]])), (false, false, 1));
    }
}
