//! Development samples at which the calibrated nominal model says something: those whose actuators the calibration trials cover.
//!
//! Beyond, a polynomial of the actuators is extrapolated, and its error is as large as that of any effect. Effects act on the
//! whole record; only samples that are covered are compared.

use acm_core::rig::Rig;

use crate::case::{Case, Trial};
use crate::fit::form::BEYOND;
use crate::series::Series;

/// The box of actuators that calibration trials cover.
#[derive(Debug, Clone, PartialEq)]
pub struct Covered {
    /// Lowest and highest value of each actuator, [`BEYOND`] half ranges from the middle.
    ranges: Vec<(f64, f64)>,
}

impl Covered {
    /// Returns the box of a case; none where the development trials calibrate, or predictions come with the data.
    pub fn of(case: &Case) -> Option<Self> {
        if case.is_predicted() || case.calibration.is_empty() {
            return None;
        }
        let range = |a: usize| {
            let values = || case.calibration.iter().flat_map(|trial| &trial.record.actuators[a]).copied();
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            let (middle, half) = (0.5 * (low + high), 0.5 * BEYOND * (high - low));
            (middle - half, middle + half)
        };
        Some(Self { ranges: (0..case.rig.actuators.len()).map(range).collect() })
    }

    /// Returns whether sample `t` lies in the box.
    fn holds(&self, actuators: &[Vec<f64>], t: usize) -> bool {
        self.ranges.iter().zip(actuators).all(|(range, q)| range.0 <= q[t] && q[t] <= range.1)
    }

    /// Returns the number of samples of a trial that lie in the box.
    fn samples(&self, trial: &Trial) -> usize {
        (0..trial.record.samples()).filter(|&t| self.holds(&trial.record.actuators, t)).count()
    }

    /// Takes trials without any sample in the box out of a case, and returns what a reader has to know where the box does not hold all
    /// samples. Where none would be left, the case stays as it is.
    pub fn confine(&self, case: &mut Case) -> Confined {
        let all: usize = case.development.iter().map(|trial| trial.record.samples()).sum();
        let inside: usize = case.development.iter().map(|trial| self.samples(trial)).sum();
        if inside == all {
            return Confined { takes_out: false, caution: None };
        }
        let beyond = self.beyond(&case.rig, &case.development);
        let share = 100.0 * (all - inside) as f64 / all as f64;
        if inside == 0 {
            let caution = format!("The calibration trials cover no development sample ({beyond}): {ADVICE}.");
            return Confined { takes_out: false, caution: Some(caution) };
        }
        case.development.retain(|trial| self.samples(trial) > 0);
        let caution = format!(
            "{share:.0} % of the development samples take no part, since the calibration trials do not cover them ({beyond}): {ADVICE}."
        );
        Confined { takes_out: true, caution: Some(caution) }
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
        let leaves = |(a, range): (usize, &(f64, f64))| {
            let values = || trials.iter().flat_map(move |trial| &trial.record.actuators[a]).copied();
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
            let signal = &rig.actuators[a];
            let text = || {
                let [low, high, from, to] =
                    [low, high, range.0, range.1].map(|value| format!("{value:.3}").replace('-', "−"));
                format!("{} goes from {low} to {high} {}, covered is {from} to {to}", signal.name, signal.unit)
            };
            (low < range.0 || high > range.1).then(text)
        };
        self.ranges.iter().enumerate().filter_map(leaves).collect::<Vec<_>>().join("; ")
    }
}

/// What helps.
const ADVICE: &str = "record calibration trials there, or give these trials the role of calibration";

/// Result of confining a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Confined {
    /// Whether samples are taken out.
    pub takes_out: bool,
    /// A caveat for the reader.
    pub caution: Option<String>,
}

#[cfg(test)]
mod tests {
    use acm_core::nominal::NominalSpec;
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
        let nominal = NominalSpec::Polynomial { degree: 1 };
        let rig = bench::rig(&["q"], &[], &["y"]);
        Case { rig, nominal, at: vec![], reported: 0..1, calibration, development }
    }

    /// Oracle: by hand. A range of 0 to 2 covers −0.25 to 2.25: of two trials one has three samples there, the other has none.
    #[test]
    fn samples_beyond_the_calibration_take_no_part() {
        let mut case = case(&[0.0, 2.0, 1.0], &[&[-0.2, 2.2, 2.3, 1.0], &[4.0, 5.0]]);
        let covered = Covered::of(&case).unwrap();
        let confined = covered.confine(&mut case);
        assert!(confined.takes_out);
        let caution = confined.caution.unwrap();
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

    /// Oracle: by hand. What lies inside has no caution; where nothing would be left, everything stays; without calibration trials
    /// there is no box.
    #[test]
    fn nothing_is_taken_out_of_what_is_covered_or_has_nothing_else() {
        let inside = &mut case(&[0.0, 2.0], &[&[0.5, 1.5]]);
        let confined = Covered::of(inside).unwrap().confine(inside);
        assert_eq!(confined, Confined { takes_out: false, caution: None });
        let outside = &mut case(&[0.0, 0.0], &[&[0.5, 1.5]]);
        let confined = Covered::of(outside).unwrap().confine(outside);
        assert!(!confined.takes_out && confined.caution.is_some());
        assert_eq!(outside.development.len(), 1);
        assert_eq!(Covered::of(&case(&[], &[&[0.5]])), None);
    }
}
