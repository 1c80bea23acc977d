//! Plants whose inputs are commands: held between samples, bent, or with a dead zone about a rest that is not zero.

use std::ops::Range;

use acm_core::nominal::NominalSpec;
use acm_core::record::Record;
use acm_trace::case::Trial;
use acm_trace::finding::Finding;
use nalgebra::DMatrix;
use rand::RngExt;

use crate::bench::{Bench, STEP, effect, found, is_near, names, parameter, press, told};
use crate::effects::{emptied, lagged_after, twice_lagged, warmed};
use crate::motion::{Motion, normal, random};

const NOISE: f64 = 0.01;

fn straight() -> Bench {
    Bench { nominal: NominalSpec::Polynomial { degree: 1 }, noise: vec![NOISE], ..press(vec![]) }
}

/// Traces six trials, with two more held out.
fn traced(trial: impl Fn(&str, usize) -> Trial) -> Finding {
    let of = |part: &str, trials: Range<usize>| trials.map(|k| trial(part, k)).collect();
    found(straight().case(vec![], of("d", 0..6), of("u", 6..8)))
}

/// A command in steps, each of a number of samples out of a range, and a lag of 0.25 s behind it: held from sample to sample, or straight.
fn commanded(is_held: bool, rests: &Range<usize>) -> Finding {
    traced(|name, k| {
        let mut draw = random(7000 + k as u64);
        let (mut q, mut left) = (vec![], 0);
        for t in 0..300 {
            left = if left == 0 { draw.random_range(rests.clone()) } else { left - 1 };
            q.push(if left == 0 || t == 0 { draw.random_range(-1.0..1.0) } else { q[t - 1] });
        }
        let (mut z, mut y) = (q[0], vec![q[0]]);
        for pair in q.windows(2) {
            // One step of a held input, or a thousand of one that goes straight.
            z = match is_held {
                true => pair[0] + (z - pair[0]) * (-STEP / 0.25f64).exp(),
                false => (0..1000).fold(z, |z, n| {
                    let x = pair[0] + (pair[1] - pair[0]) * (f64::from(n) + 0.5) / 1000.0;
                    x + (z - x) * (-STEP / 1000.0 / 0.25).exp()
                }),
            };
            y.push(z);
        }
        let measured = DMatrix::from_fn(300, 1, |t, _| 4.0 * y[t] + NOISE * normal(&mut draw));
        let record = Record::new((0..300).map(|t| STEP * f64::from(t)).collect(), vec![q], vec![], vec![]);
        Trial { name: format!("{name}{k}"), record, lead: None, measured, predicted: None, offset: None }
    })
}

#[test]
fn a_command_is_held_between_samples_where_that_predicts_better() {
    // The second changes at every sample or every other.
    for (is_held, rests) in [(true, 3..14), (false, 3..14), (true, 0..2), (false, 0..2)] {
        let finding = commanded(is_held, &rests);
        let held: &[&str] = if is_held { &["q1"] } else { &[] };
        assert_eq!(finding.zero_order_hold, held, "{}", told(&finding));
        assert_eq!(names(&finding), ["actuator_lag"], "{}", told(&finding));
        let tau = parameter(effect(&finding, "actuator_lag"), "tau");
        assert!((tau.value / 0.25 - 1.0).abs() < 0.01, "{tau:?}");
        assert!(is_near(&finding, NOISE), "{}", told(&finding));
    }
}

/// A voltage of four sines, the fastest of six samples in a period, from rest, and a lag of 0.25 s behind it. Oracle: the closed form
/// behind each, z = A (sin(ωt + φ − α) + …) with its transient.
#[test]
fn what_bends_between_samples_follows_a_quartic() {
    let tau: f64 = 0.25;
    let finding = traced(|name, k| {
        let mut draw = random(7100 + k as u64);
        let sines: Vec<[f64; 3]> = [0.31, 0.62, 0.83, 1.02]
            .map(|f| {
                [
                    2.0 * std::f64::consts::PI * f / (6.0 * STEP),
                    draw.random_range(0.2..0.5),
                    draw.random_range(0.0..6.2),
                ]
            })
            .to_vec();
        let sum = |of: &dyn Fn(&[f64; 3]) -> f64| sines.iter().map(of).sum::<f64>();
        let drives = |t: f64| sum(&|[w, size, phase]| size * (w * t + phase).sin());
        let follows = |t: f64| {
            sum(&|[w, size, phase]| {
                let (behind, less) = ((w * tau).atan(), size / (w * tau).hypot(1.0));
                less * ((w * t + phase - behind).sin() - (phase - behind).sin() * (-t / tau).exp())
                    + size * phase.sin() * (-t / tau).exp()
            })
        };
        let time: Vec<f64> = (0..400).map(|t| STEP * f64::from(t)).collect();
        let measured = DMatrix::from_fn(400, 1, |t, _| 4.0 * follows(time[t]) + NOISE * normal(&mut draw));
        let q = time.iter().map(|t| drives(*t)).collect();
        let record = Record::new(time, vec![q], vec![], vec![]);
        Trial { name: format!("{name}{k}"), record, lead: None, measured, predicted: None, offset: None }
    });
    assert_eq!(finding.quartic_interpolation, ["q1"], "{}", told(&finding));
    assert_eq!(names(&finding), ["actuator_lag"], "{}", told(&finding));
    let lag = parameter(effect(&finding, "actuator_lag"), "tau");
    assert!((lag.value / tau - 1.0).abs() < 0.01, "{lag:?}");
    assert!((finding.errors.after.value / NOISE - 1.0).abs() < 0.3, "{}", told(&finding));
}

/// A valve rests at 5.3 V, and opens 0.6 V beyond; its spool follows after 0.3 s.
#[test]
fn a_valve_has_a_dead_zone_about_its_rest() {
    let finding = traced(|name, k| {
        let mut drive = straight().drive(k, 400, 71, &[]);
        drive.motion[0] = Motion::of(&[[5.0, 0.0, std::f64::consts::FRAC_PI_2]]).with(3.0, &drive.motion[0]);
        let flow = |q: f64| (q - 5.9).max(0.0) - (4.7 - q).max(0.0);
        straight().trial(name, &drive, &[lagged_after(&drive.time, &drive.motion[0], 0.3, flow)])
    });
    let mut found = names(&finding);
    found.sort_unstable();
    assert_eq!(found, ["actuator_lag", "dead_zone"], "{}", told(&finding));
    let zone = effect(&finding, "dead_zone");
    for (name, truth) in [("half_width_q1", 0.6), ("rest_q1", 5.3)] {
        assert!((parameter(zone, name).value / truth - 1.0).abs() < 0.02, "{name}: {}", told(&finding));
    }
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// Two lags of a tenth of a trial: as an oscillator its period is two thirds of the trial.
#[test]
fn a_slow_plant_of_second_order_is_found() {
    let finding = traced(|name, k| {
        let drive = straight().drive(k, 400, 73, &[]);
        let tau = 0.1 * drive.time[399];
        straight().trial(name, &drive, &[twice_lagged(&drive.time, &drive.motion[0], tau)])
    });
    assert_eq!(names(&finding), ["second_order_lag"], "{}", told(&finding));
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// Two vessels in a row empty through orifices.
#[test]
fn a_vessel_empties_into_another() {
    let finding = traced(|name, k| {
        let drive = straight().drive(k, 400, 74, &[]);
        straight().trial(name, &drive, &[emptied(&drive.time, &drive.motion[0], [4.0, 1.5], f64::INFINITY)])
    });
    assert_eq!(names(&finding), ["outflow"; 2], "{}", told(&finding));
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// Two vessels in a row, of which the lower one catches a third of what the upper one spills.
#[test]
fn vessels_overflow_into_another() {
    const BRIM: f64 = 1.7;
    let finding = traced(|name, k| {
        let drive = straight().drive(k, 400, 75, &[]);
        straight().trial(name, &drive, &[emptied(&drive.time, &drive.motion[0], [4.0, 1.5], BRIM)])
    });
    assert_eq!(names(&finding), ["overflow"; 2], "{}", told(&finding));
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}

/// A heater whose power is the square of its voltage, and that loses heat by T + T²: the hotter, the faster.
#[test]
fn a_heater_is_bent_before_a_lag_that_depends_on_its_state() {
    let finding = traced(|name, k| {
        let mut drive = straight().drive(k, 500, 72, &[]);
        drive.motion[0] = Motion::of(&[[1.0, 0.0, std::f64::consts::FRAC_PI_2]]).with(1.0, &drive.motion[0]);
        straight().trial(name, &drive, &[warmed(&drive.time, &drive.motion[0], 4.0)])
    });
    let mut found = names(&finding);
    found.sort_unstable();
    assert_eq!(found, ["input_nonlinearity", "state_dependent_lag"], "{}", told(&finding));
    assert!(is_near(&finding, NOISE), "{}", told(&finding));
}
