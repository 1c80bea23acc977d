//! Actuators whose curvature between samples matters for the residual.
//!
//! Halfway between two samples a quartic through the last five differs from the straight line by e(t). An input with a relative error of
//! `rms(e) / std(q)` changes the outputs by about the same share. Where that is small beside the residual share of the outputs, it cannot
//! be detected, and does not matter. A signal of which linear interpolation misses a tenth moves too fast for its samples: it may be held
//! instead, like a random command that changes at every sample.

use acm_core::InterSample;

use crate::case::Case;

/// Smallest ratio of the two shares.
const COUNTS: f64 = 0.5;

/// Share that linear interpolation misses of a signal too fast for its samples: that of a sine with seven samples in a period.
const TOO_FAST: f64 = 0.1;

/// Returns the actuators that may follow a quartic between samples; `missed` has the shares that linear interpolation misses, `left` is
/// the residual share.
pub fn curved(missed: &[f64], left: f64) -> Vec<usize> {
    above(missed, COUNTS * left)
}

/// Returns the actuators that move too fast for their samples, and may be held.
pub fn too_fast(missed: &[f64]) -> Vec<usize> {
    above(missed, TOO_FAST)
}

fn above(missed: &[f64], share: f64) -> Vec<usize> {
    (0..missed.len()).filter(|&a| missed[a] > share).collect()
}

/// Returns the share of each actuator's motion that linear interpolation misses; none where predictions come with the data, which are
/// recorded at samples.
pub fn missed(case: &Case) -> Vec<f64> {
    let actuators = if case.is_predicted() { 0 } else { case.rig.actuators.len() };
    let mut sums = vec![(0.0, 0.0); actuators];
    for trial in case.development.iter().chain(&case.calibration) {
        let (quartic, _) = InterSample::Quartic((0..actuators).collect()).of(&trial.record);
        for (a, (off, moved)) in sums.iter_mut().enumerate() {
            let recorded = &trial.record.actuators[a];
            let mean = recorded.iter().sum::<f64>() / recorded.len().max(1) as f64;
            *moved += recorded.iter().map(|q| (q - mean).powi(2)).sum::<f64>();
            let halfway = quartic.actuators[a].iter().skip(1).step_by(2);
            let straight = recorded.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
            *off += straight.zip(halfway).map(|(straight, q)| (q - straight).powi(2)).sum::<f64>();
        }
    }
    sums.into_iter().map(|(off, moved): (f64, f64)| if moved > 0.0 { (off / moved).sqrt() } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use acm_core::nominal::NominalSpec;
    use acm_core::record::Record;
    use nalgebra::DMatrix;

    use super::*;
    use crate::case::Trial;
    use crate::fit::bench;

    /// Oracle: by hand. Of a sine of n samples in a period a straight line misses 1 − cos(π/n) halfway: 0.0045
    /// of 33 samples, 0.075 of 8, and 0.18 of 5; a ramp has no curve.
    #[test]
    fn of_a_sine_the_straight_line_misses_what_its_samples_tell() {
        let rig = bench::rig(&["slow", "fast", "ramp", "faster"], &[], &["y"]);
        let time: Vec<f64> = (0..600).map(|k| 0.05 * f64::from(k)).collect();
        let sine =
            |n: f64| (0..600).map(|k| (2.0 * std::f64::consts::PI * f64::from(k) / n).sin()).collect::<Vec<f64>>();
        let record = Record::new(time.clone(), vec![sine(33.3), sine(8.1), time, sine(5.1)], vec![], vec![]);
        let trial = Trial {
            name: String::new(),
            record,
            lead: None,
            measured: DMatrix::zeros(600, 1),
            predicted: None,
            offset: None,
        };
        let nominal = NominalSpec::Polynomial { degree: 1 };
        let (at, reported) = (vec![], 0..1);
        let case = Case { rig, nominal, at, reported, calibration: vec![], development: vec![trial] };
        let missed = missed(&case);
        for (a, n) in [(0, 33.3f64), (1, 8.1)] {
            let expected = 1.0 - (std::f64::consts::PI / n).cos();
            assert!((missed[a] / expected - 1.0).abs() < 0.1, "{} for {expected}", missed[a]);
        }
        assert!(missed[2] < 1e-12);
        assert_eq!(curved(&missed, 0.1), [1, 3]);
        assert_eq!(curved(&missed, 0.008), [0, 1, 3]);
        assert_eq!(curved(&missed, 0.6), Vec::<usize>::new());
        assert_eq!(too_fast(&missed), [3]);
    }
}
