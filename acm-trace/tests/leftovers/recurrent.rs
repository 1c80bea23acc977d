//! Oracle: the share of the variance that was planted, in closed form; and noise, which is found as rarely as p says.

use std::f64::consts::TAU;
use std::time::Instant;

use acm_core::record::Record;
use acm_trace::diagnose::probe::probe;
use acm_trace::diagnose::recurrent::recurrent;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use crate::campaign::{Campaign, LARGE, SMALL, Shape, normal};

/// Sines of the actuator: frequency in Hz, amplitude.
const SINES: [(f64, f64); 3] = [(0.083, 1.0), (0.137, 0.8), (0.211, 0.6)];

/// Time constant of what is planted, s.
const SLOW: f64 = 1.5;

/// An actuator of three sines whose phases differ from trial to trial; what a filter of first order makes of it, by hand.
struct Sines {
    campaign: Campaign,
    /// [trial][T].
    filtered: Vec<Vec<f64>>,
}

fn sines(shape: Shape, seed: u64) -> Sines {
    let mut campaign = Campaign::new(shape, seed);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut filtered = vec![];
    for record in &mut campaign.records {
        let phases: [f64; 3] = std::array::from_fn(|_| random.random_range(0.0..TAU));
        let sum = |t: f64, tau: f64| -> f64 {
            let wave = |((f, a), phase): (&(f64, f64), &f64)| {
                let late = TAU * f * tau;
                a / (1.0 + late * late).sqrt() * (TAU * f * t + phase - late.atan()).sin()
            };
            SINES.iter().zip(&phases).map(wave).sum()
        };
        let mut actuators = record.actuators.clone();
        actuators[0] = record.time.iter().map(|t| sum(*t, 0.0)).collect();
        filtered.push(record.time.iter().map(|t| sum(*t, SLOW)).collect());
        *record = Record::new(record.time.clone(), actuators, record.contexts.clone(), vec![]);
    }
    Sines { campaign, filtered }
}

/// Variance of x² for a sum of sines of unrelated frequencies: E x⁴ − (E x²)² = (Σ A²)²/2 − 3/8 Σ A⁴.
fn variance_of_square(amplitudes: &[f64]) -> f64 {
    let power = |p: i32| amplitudes.iter().map(|a| a.powi(p)).sum::<f64>();
    power(2).powi(2) / 2.0 - 3.0 / 8.0 * power(4)
}

/// The square of a slow filter of an actuator: share = var/(var + σ²). A network may take no more than that, and takes most.
#[test]
fn the_square_of_a_slow_state_is_explained() {
    let late = |f: f64| TAU * f * SLOW;
    let amplitudes = SINES.map(|(f, a)| a / (1.0 + late(f).powi(2)).sqrt());
    let variance = variance_of_square(&amplitudes);
    for (noise_ratio, least) in [(0.05, 0.85), (1.0, 0.7)] {
        let Sines { campaign, filtered } = sines(LARGE, 31);
        let scale = 0.01 / variance.sqrt();
        let sd = 0.01 * f64::sqrt(noise_ratio);
        let campaign = campaign.noise(sd, 0.0).on_output(0, |k, _| filtered[k].iter().map(|x| scale * x * x).collect());
        let mut remainder = campaign.remainder();
        // One output, so that the share is that of the planted one.
        let rig = acm_core::rig::Rig { outputs: remainder.rig.outputs[..1].to_vec(), ..remainder.rig.clone() };
        for trial in &mut remainder.trials {
            trial.residual = trial.residual.iter().step_by(3).copied().collect();
        }
        remainder.rig = &rig;
        let share = 1.0 / (1.0 + noise_ratio);
        let begun = Instant::now();
        let found = recurrent(&remainder, 7);
        println!("{found:?} of {share} in {:?}, regression {:?}", begun.elapsed(), probe(&remainder, 7));
        assert!(found.finds() && found.explained < share + 0.04, "{found:?} of {share}");
        assert!(found.explained > least * share, "{found:?} of {share}");
    }
}

/// Output of a relay that switches up above 0.8 and down below −0.8: a state that holds what happened. It is ±1, so its variance
/// is 1 but for the square of its mean.
#[test]
fn hysteresis_is_seen() {
    let mut campaign = sines(SMALL, 32).campaign;
    let sd = 0.01;
    let relay = |_: usize, r: &Record| {
        let mut state = 1.0;
        let switched = |q: &f64| {
            if q.abs() > 0.8 {
                state = q.signum();
            }
            sd * state
        };
        r.actuators[0].iter().map(switched).collect::<Vec<f64>>()
    };
    campaign = campaign.noise(sd, 0.0);
    for output in 0..3 {
        campaign = campaign.on_output(output, relay);
    }
    let found = recurrent(&campaign.remainder(), 7);
    println!("{found:?}");
    assert!(
        found.finds() && found.explained > 0.25 && found.explained < 0.53,
        "half of the variance is planted: {found:?}"
    );
}

/// A sum of many cosines with random phases, amplitude falling as 1/f: as slow as what a structure may look like.
fn coloured(campaign: &mut Campaign, sd: f64, seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let outputs = campaign.rig.outputs.len();
    for (record, residual) in campaign.records.iter().zip(&mut campaign.residuals) {
        for m in 0..outputs {
            let waves: Vec<(f64, f64, f64)> = (1..=40)
                .map(|k| (0.02 * f64::from(k), sd * normal(&mut random) / f64::from(k), random.random_range(0.0..TAU)))
                .collect();
            for (t, row) in record.time.iter().zip(residual.chunks_exact_mut(outputs)) {
                row[m] += waves.iter().map(|(f, a, phase)| a * (TAU * f * t + phase).cos()).sum::<f64>();
            }
        }
    }
}

/// Five in a hundred, within what sixty seeds can tell: more than nine come up once in two hundred.
#[test]
fn noise_is_not_predicted() {
    let small = Shape { trials: 6, samples: 100, outputs: 2, ..SMALL };
    let one_record = Shape { trials: 1, samples: 600, blocks: 8, outputs: 1, ..SMALL };
    for (shape, phi) in [(small, 0.0), (small, 0.9), (one_record, 0.0), (one_record, 0.95)] {
        let alarm = |seed: &u64| recurrent(&Campaign::new(shape, *seed).noise(1e-3, phi).remainder(), 7).finds();
        let alarms = (0..60).filter(alarm).count();
        println!("{} trials, {phi}: {alarms}", shape.trials);
        assert!(alarms <= 9, "{alarms} of 60 at {phi}");
    }
    let alarm = |seed: &u64| {
        let mut campaign = Campaign::new(small, *seed);
        coloured(&mut campaign, 1e-3, *seed);
        recurrent(&campaign.remainder(), 7).finds()
    };
    let alarms = (0..60).filter(alarm).count();
    println!("random phases: {alarms}");
    assert!(alarms <= 9, "{alarms} of 60 with random phases");
}

/// Nothing passes from one trial to the next: trials in another order say the same.
#[test]
fn each_trial_begins_anew() {
    let Sines { campaign, filtered } = sines(SMALL, 33);
    let campaign = campaign.noise(3e-3, 0.0).on_output(0, |k, _| filtered[k].iter().map(|x| 0.01 * x * x).collect());
    let forward = campaign.remainder();
    let mut backward = campaign.remainder();
    backward.trials.reverse();
    for ask in [probe, recurrent] {
        let (one, other) = (ask(&forward, 7).explained, ask(&backward, 7).explained);
        assert!(one > 0.1 && (one - other).abs() < 1e-6, "{one} and {other}");
    }
}

/// The same bits on one thread as on three.
#[test]
fn threads_change_nothing() {
    let campaign = Campaign::new(SMALL, 16).noise(1e-3, 0.5);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| recurrent(&campaign.remainder(), 7))
    };
    assert_eq!(on(1), on(3));
}

/// Too little to tell, no signal that varies, values that are missing.
#[test]
fn any_record_will_do() {
    let short = Shape { trials: 2, samples: 10, ..SMALL };
    assert_eq!(recurrent(&Campaign::new(short, 14).noise(1e-3, 0.0).remainder(), 7).p, 1.0);
    assert_eq!(recurrent(&Campaign::new(SMALL, 15).remainder(), 7).p, 1.0);
    let mut still = Campaign::new(Shape { contexts: 0, ..SMALL }, 16).noise(1e-3, 0.0);
    for record in &mut still.records {
        let time = record.time.clone();
        *record = Record::new(time.clone(), vec![vec![0.3; time.len()]; 2], vec![], vec![]);
    }
    assert!(!recurrent(&still.remainder(), 7).finds());
    let mut gaps = Campaign::new(SMALL, 17).noise(1e-3, 0.0);
    gaps.records[1].contexts[0][40] = f64::NAN;
    let found = recurrent(&gaps.remainder(), 7);
    assert!(found.explained.is_finite() && found.by_chance.is_finite(), "{found:?}");
}
