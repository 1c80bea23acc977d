//! Oracle: planted dependence on the inputs is found, and noise is found as rarely as p says.

use std::time::Instant;

use acm_core::record::Record;
use acm_trace::diagnose::probe::probe;

use crate::campaign::{Campaign, LARGE, SMALL, Shape};

/// How far play of half-width `width` holds back.
fn held_back(width: f64, q: &[f64]) -> Vec<f64> {
    let mut held = q[0];
    q.iter()
        .map(|&q| {
            held = if q > held + width {
                q - width
            } else if q < held - width {
                q + width
            } else {
                held
            };
            held - q
        })
        .collect()
}

fn rate_of_false_alarms(shape: Shape, phi: f64, seeds: u64) -> f64 {
    let alarm = |seed: &u64| probe(&Campaign::new(shape, *seed).noise(1e-3, phi).remainder(), 7).p <= 0.05;
    (0..seeds).filter(alarm).count() as f64 / seeds as f64
}

/// Five in a hundred, within what a hundred seeds can tell: more than eleven come up once in a hundred.
#[test]
fn noise_is_not_predicted() {
    let small = Shape { trials: 6, samples: 100, outputs: 2, ..SMALL };
    let one_record = Shape { trials: 1, samples: 600, blocks: 8, outputs: 1, ..SMALL };
    for (shape, phi) in [(small, 0.0), (small, 0.9), (one_record, 0.0), (one_record, 0.9), (one_record, 0.99)] {
        let rate = rate_of_false_alarms(shape, phi, 100);
        println!("{} trials, {phi}: {rate}", shape.trials);
        assert!(rate <= 0.11, "{rate} at {phi}");
    }
}

fn found(campaign: Campaign, what: &str) {
    let found = probe(&campaign.remainder(), 7);
    println!("{what}: {found:?}");
    assert!(found.p <= 0.05 && found.explained > found.by_chance, "{what}: {found:?}");
}

/// Each as large as the noise, or less.
#[test]
fn planted_structure_is_found() {
    let noise = || Campaign::new(SMALL, 11).noise(3e-3, 0.5);
    found(noise().on_actuator(0, |_, r| held_back(0.05, &r.actuators[0])), "play in q1");
    let product =
        |_: usize, r: &Record| r.actuators[0].iter().zip(&r.actuators[1]).map(|(a, b)| 0.02 * a * b).collect();
    found(noise().on_actuator(0, product), "q1 q2");
    found(noise().on_output(2, |_, r| r.contexts[0].iter().map(|c| 0.03 * (c - 0.6)).collect()), "throttle");
    let late = |_: usize, r: &Record| {
        let mut slow = 0.0;
        r.contexts[0]
            .iter()
            .map(|c| {
                slow += 0.1 * (c - 0.6 - slow);
                0.05 * slow
            })
            .collect()
    };
    found(noise().on_output(0, late), "throttle with a lag");
    found(noise().on_actuator(1, |_, r| r.actuators[1].iter().map(|q| 0.02 * (9.0 * q).sin()).collect()), "encoder");
}

/// What creeps behind q1 for seconds is not to be had from q1 and its rate of the moment.
#[test]
fn memory_is_explained() {
    let creep = |_: usize, r: &Record| {
        let mut slow = r.actuators[0][0];
        let behind = |q: &f64| {
            slow += 0.2 / 3.0 * (q - slow);
            0.05 * slow
        };
        r.actuators[0].iter().map(behind).collect()
    };
    let found = probe(&Campaign::new(SMALL, 17).noise(1e-4, 0.0).on_actuator(0, creep).remainder(), 7);
    println!("{found:?}");
    assert!(found.explained > 0.85, "{found:?}");
}

/// A dependence that is all there is, is explained and has its size.
#[test]
fn a_clear_structure_is_explained() {
    let clear = Campaign::new(LARGE, 12).noise(1e-4, 0.0);
    let clear = clear.on_output(0, |_, r| r.actuators[0].iter().map(|q| 0.01 * q * q).collect());
    let start = Instant::now();
    let found = probe(&clear.remainder(), 7);
    println!("{found:?} in {:?}", start.elapsed());
    let centred: Vec<f64> = clear.records.iter().flat_map(|r| r.actuators[0].iter().map(|q| 0.01 * q * q)).collect();
    let mean = centred.iter().sum::<f64>() / centred.len() as f64;
    let size = (centred.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / centred.len() as f64).sqrt();
    assert!(found.explained > 0.9 && found.p <= 0.05);
    assert!((found.rms / size - 1.0).abs() < 0.1, "{} {size}", found.rms);
}

/// A single output, twelve actuators, no contexts; too little to tell.
#[test]
fn any_rig_will_do() {
    let many = Shape { actuators: 12, contexts: 0, outputs: 1, ..SMALL };
    let product = |_: usize, r: &Record| r.actuators[3].iter().map(|q| 0.1 * q * q).collect();
    found(Campaign::new(many, 13).noise(3e-3, 0.0).on_actuator(3, product), "q4² of twelve");
    let short = Shape { trials: 2, samples: 10, ..SMALL };
    assert_eq!(probe(&Campaign::new(short, 14).noise(1e-3, 0.0).remainder(), 7).p, 1.0);
    assert_eq!(probe(&Campaign::new(SMALL, 15).remainder(), 7).p, 1.0);
}

/// The same bits on one thread as on three.
#[test]
fn threads_change_nothing() {
    let campaign = Campaign::new(SMALL, 16).noise(1e-3, 0.5);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| probe(&campaign.remainder(), 7))
    };
    assert_eq!(on(1), on(3));
}
