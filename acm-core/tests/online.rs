//! A model with effects sample by sample is the model that predicts whole trials. Nothing is allocated on the way.

use acm_core::augmented::{AugmentedModel, OnlineModel, Sample};
use acm_core::effects::Carrier;
use acm_core::effects::instance::{Instance, Term};
use acm_core::polynomial::Polynomial;
use acm_core::record::Record;
use acm_core::rig::{Mounting, Rig, Signal};
use acm_core::static_map::StaticMap;
use acm_core::{ArmSpec, InterSample, NominalModel, StrainModel};
use nalgebra::{DMatrix, Vector3};

const SAMPLES: usize = 200;

fn signal(name: &str, low: f64, high: f64) -> Signal {
    Signal { name: name.into(), unit: "1".into(), low, high }
}

/// A hanging arm with two markers, carried by a vehicle.
fn rig() -> Rig {
    Rig {
        actuators: vec![signal("q1", -1.0, 1.0), signal("q2", -0.5, 0.8)],
        contexts: vec![signal("throttle", 0.2, 0.7), signal("altitude", 0.1, 2.0)],
        outputs: ["x1", "y1", "z1", "x2", "y2", "z2"].map(|name| signal(name, -0.5, 0.5)).to_vec(),
        throttle: Some(0),
        altitude: Some(1),
        payload: None,
        carried: true,
        arm: Some(Mounting { length: 0.6, down: -Vector3::z() }),
        step: 0.1,
        duration: 30.0,
    }
}

fn wave(time: f64, signal: &Signal, k: usize) -> f64 {
    let turn = (0.7 * time + k as f64).sin() + 0.4 * (2.3 * time - 1.3 * k as f64).cos();
    signal.low + 0.5 * signal.span() * (1.0 + turn / 1.4)
}

fn record(rig: &Rig) -> Record {
    let time: Vec<f64> = (0..SAMPLES).map(|k| 3.0 + 0.1 * (k as f64 + 0.4 * (0.618 * k as f64).fract())).collect();
    let columns = |signals: &[Signal], first: usize| -> Vec<Vec<f64>> {
        let column = |(k, s): (usize, &Signal)| time.iter().map(|t| wave(*t, s, first + k)).collect();
        signals.iter().enumerate().map(column).collect()
    };
    let axes = vec![signal("a", -2.0, 2.0); 3];
    let columns = (columns(&rig.actuators, 0), columns(&rig.contexts, 5), columns(&axes, 9));
    Record::new(time, columns.0, columns.1, columns.2)
}

/// A guess from the middle of the grid of an effect, or one that grows with a context.
fn term(rig: &Rig, name: &str, carrier: Carrier, context: Option<Carrier>) -> Term {
    let effect = acm_core::effects::find(name).unwrap_or_else(|| panic!("no effect {name}"));
    let plain = Instance::new(effect, carrier, rig);
    let instance = context.and_then(|context| plain.with_context(context, rig)).unwrap_or(plain);
    let guesses = instance.initial_guesses(rig);
    let mut values = guesses[guesses.len() / 2].clone();
    let own = instance.own_parameters();
    values[own..].iter_mut().zip(&instance.parameters()[own..]).for_each(|(value, spec)| *value = 0.3 * spec.scale);
    instance.term(&values)
}

/// Effects of every place, in the order in which they are given, which is not that of their action.
fn effects(rig: &Rig) -> Vec<Term> {
    let (throttle, altitude) = (Carrier::Context(0), Carrier::Context(1));
    let plain = [
        ("measurement_lag", Carrier::Rig),
        ("measurement_drift", Carrier::Rig),
        ("output_hysteresis", Carrier::Actuator(0)),
        ("output_bouc_wen", Carrier::Actuator(0)),
        ("dahl_friction", altitude),
        ("context_lag", altitude),
        ("misregistration", Carrier::Rig),
        ("base_tilt", Carrier::Rig),
        ("marker_offset", Carrier::Rig),
        ("ground_effect", altitude),
        ("wake_lag", throttle),
        ("tip_load", Carrier::Rig),
        ("creep", Carrier::Rig),
        ("second_order_lag", Carrier::Rig),
        ("prandtl_ishlinskii", Carrier::Rig),
        ("coupling", Carrier::Rig),
        ("zero_drift", Carrier::Rig),
        ("dead_time", Carrier::Rig),
    ];
    let mut terms: Vec<Term> = plain.map(|(name, carrier)| term(rig, name, carrier, None)).to_vec();
    terms.push(term(rig, "backlash", Carrier::Rig, Some(throttle)));
    terms.push(term(rig, "dry_friction", Carrier::Rig, Some(Carrier::Actuator(1))));
    terms
}

fn arm() -> NominalModel {
    let model = StrainModel::new(&ArmSpec { length: 0.6, ..ArmSpec::default() }, 2, &[0.6, 1.0]).expect("an arm");
    let theta: Vec<f64> = (0..model.parameters().len()).map(|j| 0.8 * (1.7 * j as f64).sin()).collect();
    NominalModel::Strain(model.with_parameters(&theta))
}

fn static_map(outputs: usize) -> StaticMap {
    let powers = [vec![0, 0], vec![1, 0], vec![0, 2], vec![1, 1]];
    let coefficients = DMatrix::from_fn(4, outputs, |j, o| 0.01 * (o as f64 - 0.4 * j as f64));
    StaticMap::from_powers(vec![-1.0, -1.0], vec![1.0, 1.0], &powers, &coefficients)
}

/// Everything sample by sample, from time stamps and values of the record.
fn online(model: &mut OnlineModel, record: &Record, predicted: Option<&DMatrix<f64>>) -> DMatrix<f64> {
    let at = |columns: &[Vec<f64>], t: usize| -> Vec<f64> { columns.iter().map(|column| column[t]).collect() };
    let mut all = DMatrix::zeros(record.samples(), model.outputs());
    let mut out = vec![0.0; model.outputs()];
    for t in 0..record.samples() {
        let (actuators, contexts) = (at(&record.actuators, t), at(&record.contexts, t));
        let acceleration = at(&record.acceleration, t);
        let predicted: Vec<f64> = predicted.map_or(vec![], |own| own.row(t).iter().copied().collect());
        let sample = Sample {
            time: record.time[t],
            actuators: &actuators,
            contexts: &contexts,
            acceleration: &acceleration,
            predicted: &predicted,
        };
        let counted = allocation_counter::measure(|| model.step(&sample, &mut out));
        assert_eq!(counted.count_total, 0, "allocations at sample {t}");
        all.row_mut(t).copy_from_slice(&out);
    }
    all
}

/// Oracle: the prediction of the whole trial. A second trial is as the first.
#[test]
fn a_stream_predicts_as_the_whole() {
    let rig = rig();
    let record = record(&rig);
    let map = static_map(6);
    let model = AugmentedModel::new(rig.clone(), arm(), None, Some(map), effects(&rig)).expect("a model");
    let whole = model.predict(&record, None);
    let plain = AugmentedModel::new(rig, arm(), None, None, vec![]).expect("a model").predict(&record, None);
    assert!((&whole - &plain).amax() > 0.05, "the effects do something");
    let mut stream = OnlineModel::new(&model).expect("a stream");
    for trial in 0..2 {
        let off = (online(&mut stream, &record, None) - &whole).amax();
        assert!(off < 1e-12, "trial {trial}: off by {off:.1e} m");
        stream.restart();
    }
}

/// Oracle: the prediction of trials that end at the sample.
#[test]
fn rates_of_change_are_those_known_by_then() {
    let rig = rig();
    let record = record(&rig);
    let terms = vec![term(&rig, "viscous_slip", Carrier::Rig, None)];
    let model = AugmentedModel::new(rig, arm(), None, None, terms).expect("a model");
    let found = online(&mut OnlineModel::new(&model).expect("a stream"), &record, None);
    for end in (1..60).step_by(5) {
        let until = |columns: &[Vec<f64>]| columns.iter().map(|column| column[..end].to_vec()).collect::<Vec<_>>();
        let (actuators, contexts) = (until(&record.actuators), until(&record.contexts));
        let short = Record::new(record.time[..end].to_vec(), actuators, contexts, until(&record.acceleration));
        let off = (model.predict(&short, None).row(end - 1) - found.row(end - 1)).amax();
        assert!(off < 1e-12, "sample {end}: off by {off:.1e} m");
    }
}

/// Oracle: the prediction of the whole trial, where the nominal one comes with the data.
#[test]
fn a_prediction_that_comes_with_the_data() {
    let rig = Rig { arm: None, carried: false, ..rig() };
    let mut record = record(&rig);
    record.acceleration.clear();
    let q = DMatrix::from_fn(SAMPLES, 2, |t, a| record.actuators[a][t]);
    let own =
        DMatrix::from_fn(SAMPLES, 6, |t, o| 0.1 * q[(t, 0)] * q[(t, 1)] + 0.02 * (q[(t, 1)] * 4.0 + o as f64).sin());
    let g = Polynomial::fit(&q, &own, 2).polynomial;
    let nominal = NominalModel::Polynomial(g.clone());
    let terms = vec![term(&rig, "actuator_lag", Carrier::Rig, None), term(&rig, "measurement_lag", Carrier::Rig, None)];
    let model = AugmentedModel::new(rig, nominal, Some(g), None, terms).expect("a model");
    let off = (online(&mut OnlineModel::new(&model).expect("a stream"), &record, Some(&own))
        - model.predict(&record, Some(&own)))
    .amax();
    assert!(off < 1e-12, "off by {off:.1e}");
}

/// The record with an actuator that moves in steps, each of some samples.
fn stepping(rig: &Rig) -> Record {
    let mut record = record(rig);
    let steps = (0..SAMPLES).map(|t| record.actuators[0][t - t % 7]).collect();
    record.actuators[0] = steps;
    Record::new(record.time, record.actuators, record.contexts, record.acceleration)
}

/// Oracle: a lag behind a constant input, z = q + (z₀ − q) e^{−t/τ}, from sample to sample; the prediction of the whole for a stream. A
/// file keeps what is held.
#[test]
fn held_actuators_jump_at_the_next_sample() {
    let rig = Rig { arm: None, carried: false, ..rig() };
    let mut record = stepping(&rig);
    record.acceleration.clear();
    let tau = 0.23;
    let lag = Term { values: vec![tau], ..term(&rig, "actuator_lag", Carrier::Rig, None) };
    let q = DMatrix::from_fn(SAMPLES, 2, |t, a| record.actuators[a][t]);
    let first = DMatrix::from_fn(SAMPLES, 6, |t, _| q[(t, 0)]);
    let nominal = NominalModel::Polynomial(Polynomial::fit(&q, &first, 1).polynomial);
    let straight = AugmentedModel::new(rig.clone(), nominal, None, None, vec![lag]).expect("a model");
    let held = straight.clone().with_inter_sample(&InterSample::Held(vec![0]));
    let found = held.predict(&record, None);
    let mut z = record.actuators[0][0];
    for t in 1..SAMPLES {
        let q = record.actuators[0][t - 1];
        z = q + (z - q) * (-(record.time[t] - record.time[t - 1]) / tau).exp();
        // What is added ahead of a jump takes a thousandth of an interval.
        assert!((found[(t, 0)] - z).abs() < 5e-4, "{t}: {} for {z}", found[(t, 0)]);
    }
    assert!((&found - straight.predict(&record, None)).amax() > 0.05, "it matters");
    let read: AugmentedModel = serde_json::from_str(&serde_json::to_string(&held).expect("JSON")).expect("a model");
    assert_eq!((read.inter_sample(), read.predict(&record, None)), (InterSample::Held(vec![0]), found));
    let wrong = serde_json::to_string(&held)
        .expect("JSON")
        .replace("\"zero_order_hold\":[\"q1\"]", "\"zero_order_hold\":[\"q9\"]");
    let why = serde_json::from_str::<AugmentedModel>(&wrong).expect_err("no such actuator").to_string();
    assert!(why.contains("`zero_order_hold` names q9"), "{why}");
}

/// Oracle: the closed form of a lag behind a sine, z = A sin(ωt − φ) + (z₀ + A sin φ) e^{−t/τ}, of which a period has nine samples, unevenly spaced. A straight
/// line misses 6 % between them, two such pieces a quarter of it.
#[test]
fn actuators_may_follow_a_quartic_between_samples() {
    let rig = Rig { arm: None, carried: false, ..rig() };
    let (tau, omega, h): (f64, f64, f64) = (0.23, 3.5, 0.2);
    let time: Vec<f64> = (0..SAMPLES).map(|t| h * (t as f64 + 0.2 * (t as f64).sin())).collect();
    let sine: Vec<f64> = time.iter().map(|t| (omega * t).sin()).collect();
    let record = Record::new(time.clone(), vec![sine; 2], vec![time.clone(); rig.contexts.len()], vec![]);
    let lag = Term { values: vec![tau], ..term(&rig, "actuator_lag", Carrier::Rig, None) };
    let q = DMatrix::from_fn(SAMPLES, 2, |t, a| (t as f64 + a as f64).cos());
    let first = DMatrix::from_fn(SAMPLES, 6, |t, _| q[(t, 0)]);
    let nominal = NominalModel::Polynomial(Polynomial::fit(&q, &first, 1).polynomial);
    let straight = AugmentedModel::new(rig, nominal, None, None, vec![lag]).expect("a model");
    let curved = straight.clone().with_inter_sample(&InterSample::Quartic(vec![0]));
    let (phase, size) = ((omega * tau).atan(), 1.0 / (1.0 + (omega * tau).powi(2)).sqrt());
    let lagged = |t: f64| size * ((omega * t - phase).sin() + phase.sin() * (-t / tau).exp());
    let off = |model: &AugmentedModel| {
        let found = model.predict(&record, None);
        (20..SAMPLES).map(|t| (found[(t, 0)] - lagged(time[t])).abs()).fold(0.0, f64::max)
    };
    let [curved_off, straight_off] = [off(&curved), off(&straight)];
    assert!(straight_off > 0.02 && 4.0 * curved_off < straight_off, "{curved_off:.1e} and {straight_off:.1e}");
    let text = serde_json::to_string(&curved).expect("JSON");
    let read: AugmentedModel = serde_json::from_str(&text).expect("a model");
    assert_eq!(read.inter_sample(), InterSample::Quartic(vec![0]));
    assert_eq!(read.predict(&record, None), curved.predict(&record, None));
    let wrong = text.replace("\"quartic_interpolation\":[\"q1\"]", "\"quartic_interpolation\":[\"q9\"]");
    let why = serde_json::from_str::<AugmentedModel>(&wrong).expect_err("no such actuator").to_string();
    assert!(why.contains("`quartic_interpolation` names q9"), "{why}");
}

/// Oracle: the prediction of the whole trial, and a stream that never met a sample that was taken back.
#[test]
fn a_stream_does_the_same_between_samples() {
    let rig = rig();
    let record = stepping(&rig);
    let model = AugmentedModel::new(rig.clone(), arm(), None, Some(static_map(6)), effects(&rig)).expect("a model");
    for inter_sample in [InterSample::Held(vec![0]), InterSample::Quartic(vec![1]), InterSample::Quartic(vec![0, 1])] {
        streams(&model.clone().with_inter_sample(&inter_sample), &record);
    }
}

fn streams(model: &AugmentedModel, record: &Record) {
    let whole = model.predict(record, None);
    let mut stream = OnlineModel::new(model).expect("a stream");
    let off = (online(&mut stream, record, None) - &whole).amax();
    assert!(off < 1e-12, "off by {off:.1e} m");
    stream.restart();
    let (mut snapshot, mut out) = (stream.snapshot(), vec![0.0; 6]);
    for t in 0..SAMPLES {
        let at = |columns: &[Vec<f64>]| columns.iter().map(|column| column[t]).collect::<Vec<_>>();
        let (actuators, contexts, acceleration) =
            (at(&record.actuators), at(&record.contexts), at(&record.acceleration));
        let (time, predicted) = (record.time[t], &[][..]);
        let sample =
            Sample { time, actuators: &actuators, contexts: &contexts, acceleration: &acceleration, predicted };
        stream.save(&mut snapshot);
        stream.step(&Sample { actuators: &[0.9, 0.9], ..sample }, &mut out);
        stream.restore(&snapshot);
        stream.step(&sample, &mut out);
        let off = out.iter().zip(whole.row(t).iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "sample {t}: off by {off:.1e} m");
    }
}

/// Oracle: a stream that never met the sample that was taken back.
#[test]
fn a_step_can_be_taken_back() {
    let rig = rig();
    let record = record(&rig);
    let mut terms = effects(&rig);
    terms.extend(
        [("viscous_slip", Carrier::Rig), ("inertia", Carrier::Actuator(1))].map(|(e, c)| term(&rig, e, c, None)),
    );
    let model = AugmentedModel::new(rig, arm(), None, Some(static_map(6)), terms).expect("a model");
    let (mut clean, mut spoiled) =
        (OnlineModel::new(&model).expect("a stream"), OnlineModel::new(&model).expect("a stream"));
    let mut snapshot = spoiled.snapshot();
    let (mut expected, mut found) = (vec![0.0; model.rig().outputs.len()], vec![0.0; model.rig().outputs.len()]);
    for trial in 0..2 {
        for t in 0..record.samples() {
            let at = |columns: &[Vec<f64>]| columns.iter().map(|column| column[t]).collect::<Vec<f64>>();
            let (actuators, contexts, acceleration) =
                (at(&record.actuators), at(&record.contexts), at(&record.acceleration));
            let (time, predicted) = (record.time[t], &[][..]);
            let sample =
                Sample { time, actuators: &actuators, contexts: &contexts, acceleration: &acceleration, predicted };
            let huge = vec![if t % 2 == 0 { 1e300 } else { 7.0 }; actuators.len()];
            let bad = Sample { actuators: &huge, ..sample };
            let counted = allocation_counter::measure(|| {
                spoiled.save(&mut snapshot);
                spoiled.step(&bad, &mut found);
                spoiled.restore(&snapshot);
            });
            assert_eq!(counted.count_total, 0, "allocations at sample {t}");
            clean.step(&sample, &mut expected);
            spoiled.step(&sample, &mut found);
            assert_eq!(found, expected, "trial {trial}, sample {t}");
        }
        clean.restart();
        spoiled.restart();
    }
}

/// Oracle: the model without the correction on actuators that were shifted by hand. A file keeps it, and is as before
/// without; a stream refuses it in words.
#[test]
fn a_clock_correction_is_for_whole_trials() {
    let rig = rig();
    let record = record(&rig);
    let terms = vec![term(&rig, "actuator_lag", Carrier::Rig, None), term(&rig, "viscous_slip", Carrier::Rig, None)];
    let plain = AugmentedModel::new(rig, arm(), None, None, terms).expect("a model");
    let late = 0.37;
    let model = plain.clone().with_clock_correction(late);
    assert_eq!((plain.clock_correction(), model.clock_correction()), (0.0, late));
    let shifted = |q: &Vec<f64>| -> Vec<f64> {
        let at = |t: &f64| {
            let after = record.time.iter().position(|time| *time > t + late);
            after.map_or(q[SAMPLES - 1], |k| {
                let share = (t + late - record.time[k - 1]) / (record.time[k] - record.time[k - 1]);
                q[k - 1] * (1.0 - share) + q[k] * share
            })
        };
        record.time.iter().map(at).collect()
    };
    let actuators = record.actuators.iter().map(shifted).collect();
    let moved = Record::new(record.time.clone(), actuators, record.contexts.clone(), record.acceleration.clone());
    let found = model.predict(&record, None);
    assert!((&found - plain.predict(&moved, None)).amax() < 1e-12);
    assert!((&found - plain.predict(&record, None)).amax() > 1e-3, "the correction does something");

    let text = serde_json::to_string(&model).expect("JSON");
    let read: AugmentedModel = serde_json::from_str(&text).expect("a model");
    assert_eq!((read.clock_correction(), read.predict(&record, None)), (late, found));
    assert!(!serde_json::to_string(&plain).expect("JSON").contains("clock_correction"));

    let refusal = OnlineModel::new(&model).expect_err("refused").to_string();
    assert!(refusal.contains("take 0.37 s off the actuators' time stamps before streaming"), "{refusal}");
    assert!(OnlineModel::new(&model.with_clock_correction(0.0)).is_ok());
}
