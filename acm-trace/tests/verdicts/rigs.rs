//! Rigs that are no arm: a force, predictions that come with the data, one record, outputs of different units, six
//! actuators.

use acm_core::nominal::NominalSpec;
use acm_core::record::Record;
use acm_trace::case::Trial;
use acm_trace::finding::Verdict;
use nalgebra::DMatrix;

use crate::bench::{
    Bench, FORCE_NOISE, Recorded, STEP, about, covers, effect, force, found, is_near, names, parameter, press,
    press_case, told,
};
use crate::effects::{delayed, lagged, loose, rubbing};
use crate::motion::{random, wandering};

/// f = f_0 + f_1 p: two pressures in training, two others held out.
#[test]
fn friction_grows_with_pressure() {
    let bench = press(vec![["pressure", "bar"]]);
    let trial = |part: &str, k: usize, pressure: f64| {
        let drive = bench.drive(k, 250, 21, &[pressure]);
        let friction = 0.4 + 1.5 * pressure;
        let rubbing = rubbing(&drive.time, &drive.motion[0], 0.01);
        let y = drive.q()[0].iter().zip(rubbing).map(|(q, z)| force(*q) + friction * z).collect();
        bench.trial(part, &drive, &[y])
    };
    let development = (0..8).map(|k| trial("d", k, [0.2, 0.8][k % 2])).collect();
    let held_out = vec![trial("u", 8, 0.5), trial("u", 9, 1.0)];
    let finding = found(bench.case(vec![], development, held_out));
    assert_eq!(finding.verdict, Verdict::Named, "{}", told(&finding));
    assert_eq!(names(&finding), ["dahl_friction"], "{}", told(&finding));
    let friction = effect(&finding, "dahl_friction");
    let slope = friction.parameters.iter().find(|parameter| parameter.depends_on.is_some()).unwrap();
    assert_eq!(slope.depends_on.as_deref(), Some("pressure"));
    assert!((slope.value / 1.5 - 1.0).abs() < 0.05, "{slope:?}");
    assert_eq!((friction.carrier.as_deref(), finding.errors.unit.as_str()), (Some("q1"), "N"));
    assert!(is_near(&finding, FORCE_NOISE), "{}", told(&finding));
}

#[test]
fn a_lag_that_predictions_lack() {
    let bench = press(vec![]);
    let columns = |q: &[f64]| vec![q.iter().map(|q| (1.4 * q).sin() * 8.0).collect::<Vec<f64>>()];
    let trial = |part: &str, k: usize| {
        let drive = bench.drive(k, 250, 22, &[]);
        let mut trial = bench.trial(part, &drive, &columns(&drive.after(|time, motion| lagged(time, motion, 0.4))[0]));
        trial.predicted = Some(DMatrix::from_columns(&[columns(&drive.q()[0])[0].clone().into()]));
        trial
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    assert!(case.case.is_predicted());
    let given = acm_trace::case::Case { nominal: NominalSpec::None, ..case.case };
    let finding = found(Recorded { case: given, ..case });
    assert_eq!(finding.verdict, Verdict::Named, "{}", told(&finding));
    let tau = parameter(effect(&finding, "actuator_lag"), "tau");
    assert!(covers(tau, 0.4) && (tau.value - 0.4).abs() < 0.02, "{tau:?}");
    assert!(is_near(&finding, FORCE_NOISE), "{}", told(&finding));
}

/// Rows of a record, as a trial.
pub fn part(whole: &Trial, name: &str, rows: std::ops::Range<usize>) -> Trial {
    let of = |columns: &[Vec<f64>]| columns.iter().map(|column| column[rows.clone()].to_vec()).collect();
    let (record, measured) = (&whole.record, whole.measured.rows(rows.start, rows.len()).into_owned());
    let record = Record::new(record.time[rows.clone()].to_vec(), of(&record.actuators), of(&record.contexts), vec![]);
    Trial { name: name.into(), record, lead: None, measured, predicted: None, offset: None }
}

/// The first 100 s are there to search in, the last 50 s are held out.
#[test]
fn a_single_record_is_cut_in_time() {
    let bench = press(vec![]);
    let drive = bench.drive(0, 1500, 23, &[]);
    let y: Vec<f64> = drive.after(|time, motion| delayed(time, motion, 0.25))[0].iter().map(|q| force(*q)).collect();
    let whole = bench.trial("r", &drive, &[y]);
    let finding =
        found(bench.case(vec![], vec![part(&whole, "first", 0..1000)], vec![part(&whole, "last", 1000..1500)]));
    assert_eq!((finding.verdict, names(&finding)), (Verdict::Named, vec!["dead_time"]), "{}", told(&finding));
    let delay = parameter(effect(&finding, "dead_time"), "delay");
    assert!(covers(delay, 0.25) && (delay.value - 0.25).abs() < 0.01, "{delay:?}");
    assert!(finding.cautions.iter().any(|caution| caution.contains("regions of time")), "{:?}", finding.cautions);
    assert!(about().cautions.is_empty());
    let of_trials = found(press_case(23, |drive| drive.q()[0].iter().map(|q| force(*q)).collect()));
    assert!(of_trials.cautions.is_empty(), "{:?}", of_trials.cautions);
}

/// One record with a play and a slow signal that shifts the output: what either leaves by itself is slow, and any slow
/// candidate explains much of that by chance. Beside the other both are significant.
#[test]
fn two_causes_in_one_record_are_found_together() {
    let bench = press(vec![["warmth", "K"]]);
    let mut drive = bench.drive(0, 450, 27, &[0.0]);
    drive.contexts[0] = wandering(&mut random(28), 450, STEP, 1.0, 20.0);
    let loose = drive.after(|time, motion| loose(time, motion, 0.15)).swap_remove(0);
    let y = loose.iter().zip(&drive.contexts[0]).map(|(q, c)| force(*q) + 3.0 * c).collect();
    let whole = bench.trial("r", &drive, &[y]);
    let finding = found(bench.case(vec![], vec![part(&whole, "first", 0..300)], vec![part(&whole, "last", 300..450)]));
    let first = &finding.steps[1];
    assert!(!first.accepted && first.gain < first.by_chance, "the first effect is no longer doubtful: {first:?}");
    let mut named = names(&finding);
    named.sort_unstable();
    assert_eq!(named, ["backlash", "context_term"], "{}", told(&finding));
    assert!(is_near(&finding, FORCE_NOISE), "{}", told(&finding));
}

#[test]
fn outputs_of_three_units() {
    let bench = Bench {
        actuators: 2,
        contexts: vec![],
        outputs: vec![["angle", "rad"], ["travel", "m"], ["force", "N"]],
        nominal: NominalSpec::Polynomial { degree: 2 },
        noise: vec![2e-3, 1e-4, 0.05],
    };
    let outputs = |q: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let of = |formula: fn(f64, f64) -> f64| q[0].iter().zip(&q[1]).map(|(a, b)| formula(*a, *b)).collect();
        vec![of(|a, b| 0.5 * a + 0.1 * b * b), of(|a, b| 0.02 * b + 0.01 * a * b), of(|a, b| 9.0 * a - 6.0 * b + 2.0)]
    };
    let trial = |part: &str, k: usize| {
        let drive = bench.drive(k, 250, 24, &[]);
        bench.trial(part, &drive, &outputs(&drive.after(|time, motion| loose(time, motion, 0.07))))
    };
    let case = bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect());
    // Each in shares of its range.
    let noise =
        bench.noise.iter().zip(&case.case.rig.outputs).map(|(sd, output)| (sd / (output.high - output.low)).powi(2));
    let noise = noise.sum::<f64>().sqrt();
    let finding = found(case);
    assert_eq!((finding.verdict, names(&finding)), (Verdict::Named, vec!["backlash"]), "{}", told(&finding));
    for name in ["width_q1", "width_q2"] {
        let width = parameter(effect(&finding, "backlash"), name);
        assert!((width.value / 0.07 - 1.0).abs() < 0.05, "{width:?}");
    }
    assert_eq!(finding.errors.unit.as_str(), "of each range");
    assert!(is_near(&finding, noise), "{}", told(&finding));
}

#[test]
fn six_actuators_without_any_context() {
    let bench = Bench {
        actuators: 6,
        contexts: vec![],
        outputs: vec![["x", "m"], ["y", "m"], ["z", "m"]],
        nominal: NominalSpec::Polynomial { degree: 1 },
        noise: vec![1e-3; 3],
    };
    let outputs = |q: &[Vec<f64>]| -> Vec<Vec<f64>> {
        let of = |o: usize| {
            let weight = |a: usize| 0.05 * (1.3 * (a * 3 + o) as f64 + 0.4).cos();
            (0..q[0].len()).map(|t| (0..6).map(|a| weight(a) * q[a][t]).sum::<f64>()).collect()
        };
        (0..3).map(of).collect()
    };
    let trial = |part: &str, k: usize| {
        let drive = bench.drive(k, 250, 25, &[]);
        bench.trial(part, &drive, &outputs(&drive.after(|time, motion| delayed(time, motion, 0.3))))
    };
    let finding =
        found(bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect()));
    assert_eq!((finding.verdict, names(&finding)), (Verdict::Named, vec!["dead_time"]), "{}", told(&finding));
    let delay = parameter(effect(&finding, "dead_time"), "delay");
    assert!(covers(delay, 0.3) && (delay.value - 0.3).abs() < 0.02, "{delay:?}");
    assert_eq!(finding.errors.unit.as_str(), "m");
}
