//! Oracle: the event that was planted, with its share; and inputs, noise and drift, which are no events.

use std::f64::consts::TAU;
use std::time::Instant;

use acm_core::record::Record;
use acm_trace::diagnose::events::events;
use acm_trace::finding::Event;

use crate::campaign::{Campaign, LARGE, SMALL, Shape};

fn of(campaign: &Campaign) -> Vec<Event> {
    let found = events(&campaign.remainder());
    println!("{found:?}");
    found
}

fn slip(trial: usize, at: f64, size: f64) -> impl Fn(usize, &Record) -> Vec<f64> {
    move |k, r| r.time.iter().map(|t| if k == trial && *t >= at { size } else { 0.0 }).collect()
}

/// The angle in words such as `q1 slips by 6.88° at …`, in rad.
fn angle(what: &str, before: &str) -> f64 {
    let degrees = what.strip_prefix(before).and_then(|rest| rest.split_once('°')).unwrap_or_else(|| panic!("{what}")).0;
    degrees.replace('−', "-").parse::<f64>().unwrap().to_radians()
}

/// In many trials, and in one alone.
#[test]
fn a_slip_is_found_where_it_happened() {
    let many = Campaign::new(LARGE, 1).noise(2e-3, 0.0).on_actuator(0, slip(6, 31.4, 0.12));
    let found = of(&many);
    assert_eq!(found[0].kind, "slip");
    assert!(found[0].share > 0.85);
    assert!((angle(&found[0].what, "q1 slips by ") - 0.12).abs() < 0.005, "{found:?}");
    assert!(found[0].what.contains(" at 31.") && found[0].what.ends_with("s of trial 7"));
    let one = Shape { trials: 1, samples: 500, blocks: 8, ..SMALL };
    let found = of(&Campaign::new(one, 2).noise(2e-3, 0.0).on_actuator(1, slip(0, 40.0, 0.1)));
    assert_eq!(found[0].kind, "slip");
    assert!(found[0].share > 0.85 && (angle(&found[0].what, "q2 slips by ") - 0.1).abs() < 0.01, "{found:?}");
}

/// Two in coloured noise: the larger one is named, with its share of all.
#[test]
fn the_larger_slip_is_named() {
    let two = Campaign::new(LARGE, 3)
        .noise(1e-3, 0.9)
        .on_actuator(0, slip(2, 20.0, 0.10))
        .on_actuator(1, slip(9, 25.0, -0.20));
    let found = of(&two);
    assert_eq!(found[0].kind, "slip");
    assert!((angle(&found[0].what, "q2 slips by ") + 0.2).abs() < 0.01 && found[0].what.ends_with("trial 10"));
}

/// Phases of their own in each trial, between the frequencies of the coarse search, with noise above it.
#[test]
fn a_line_is_found_at_its_frequency() {
    let line = |k: usize, r: &Record| r.time.iter().map(|t| 1e-3 * (TAU * 1.2345 * t + k as f64).sin()).collect();
    let campaign = Campaign::new(LARGE, 4).noise(1e-3, 0.0).on_output(0, line);
    let start = Instant::now();
    let found = of(&campaign);
    println!("in {:?}", start.elapsed());
    assert_eq!((found.len(), found[0].kind.as_str()), (1, "spectral line"));
    assert!(found[0].share > 0.9 && found[0].what.contains("\u{a0}mm at 1.23 Hz"), "{found:?}");
    let amplitude: f64 = found[0].what["a line of ".len()..].split_whitespace().next().unwrap().parse().unwrap();
    assert!((amplitude - 1.0).abs() < 0.07, "{amplitude}");
    assert!(!found[0].what.contains("as q"));
}

/// One long record, a line below a lobe of the noise's, in coloured noise.
#[test]
fn a_line_is_found_in_one_long_record() {
    let long = Shape { trials: 1, samples: 20_000, step: 0.01, outputs: 1, ..SMALL };
    let line = |_: usize, r: &Record| r.time.iter().map(|t| 1e-3 * (TAU * 7.77 * t).sin()).collect();
    let campaign = Campaign::new(long, 5).noise(1e-3, 0.9).on_output(0, line);
    let start = Instant::now();
    let found = of(&campaign);
    println!("in {:?}", start.elapsed());
    let line = found.iter().find(|event| event.kind == "spectral line").unwrap();
    assert!((0.28..0.38).contains(&line.share) && line.what.contains("7.77 Hz"), "{found:?}");
}

/// A signal that moves at that frequency is named.
#[test]
fn a_line_of_an_input_says_so() {
    let mut driven = Campaign::new(SMALL, 6).noise(1e-4, 0.0);
    for record in &mut driven.records {
        record.actuators[0] = record.time.iter().map(|t| (TAU * 0.5 * t).sin()).collect();
    }
    let found = of(&driven.on_output(0, |_, r| r.actuators[0].iter().map(|q| 1e-3 * q).collect()));
    assert!(found[0].what.contains("0.500 Hz, as q1 has"), "{found:?}");
}

/// Means of the trials: one off, an actuator off in one, each off.
#[test]
fn offsets_are_told_apart() {
    let noise = |seed: u64| Campaign::new(SMALL, seed).noise(1e-3, 0.5);
    let one = of(&noise(7).on_output(1, |k, r| vec![if k == 2 { 5e-3 } else { 0.0 }; r.samples()]));
    assert_eq!(one[0].kind, "offset of one trial");
    let size: f64 = one[0].what["trial 3 is off by ".len()..].split_whitespace().next().unwrap().parse().unwrap();
    // The mean of 250 samples with this correlation is known to 0.11 mm, and so is the median of the others.
    assert!(one[0].what.starts_with("trial 3 ") && (size - 5.0).abs() < 0.5, "{one:?}");
    let zero = of(&noise(8).on_actuator(0, |k, r| vec![if k == 1 { 0.08 } else { 0.0 }; r.samples()]));
    assert_eq!(zero[0].kind, "offset of one trial");
    assert!(
        (angle(&zero[0].what, "q1 is off by ") - 0.08).abs() < 0.005 && zero[0].what.ends_with("trial 2"),
        "{zero:?}"
    );
    let each = of(&noise(9).on_output(0, |k, r| vec![[3e-3, -4e-3, 5e-3, -2e-3][k]; r.samples()]));
    assert_eq!(each[0].kind, "offset of each trial");
    let common = of(&noise(7).on_output(1, |k, r| vec![if k == 2 { 9e-3 } else { 4e-3 }; r.samples()]));
    assert_eq!(common[0].what, one[0].what);
    let none = of(&noise(10).on_output(0, |_, r| vec![5e-3; r.samples()]));
    assert!(none.iter().all(|event| !event.kind.starts_with("offset")), "{none:?}");
}

/// White and slow noise, a drift, and a dependence on an input: at most one in ten has an event of a tenth.
#[test]
fn noise_and_structure_are_no_events() {
    let one = Shape { trials: 1, samples: 1000, blocks: 8, ..SMALL };
    let mut false_alarms = 0;
    for seed in 0..20 {
        let sets = [
            Campaign::new(SMALL, seed).noise(1e-3, 0.0),
            Campaign::new(SMALL, seed).noise(1e-3, 0.95),
            Campaign::new(one, seed).noise(1e-3, 0.0),
            Campaign::new(one, seed).noise(1e-3, 0.95),
            Campaign::new(SMALL, seed).noise(1e-3, 0.0).on_output(0, |_, r| r.time.iter().map(|t| 1e-4 * t).collect()),
            Campaign::new(SMALL, seed)
                .noise(1e-3, 0.0)
                .on_actuator(0, |_, r| r.actuators[0].iter().zip(&r.actuators[1]).map(|(a, b)| 0.05 * a * b).collect()),
        ];
        for (k, set) in sets.iter().enumerate() {
            let found = events(&set.remainder());
            if found.iter().any(|event| event.share > 0.1) {
                println!("seed {seed}, set {k}: {found:?}");
                false_alarms += 1;
            }
        }
    }
    assert!(false_alarms <= 12, "{false_alarms} of 120");
}

/// The same bits on one thread as on three; nothing at all has no events.
#[test]
fn threads_change_nothing() {
    let campaign = Campaign::new(SMALL, 11).noise(1e-3, 0.5).on_actuator(0, slip(1, 20.0, 0.05));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| events(&campaign.remainder()))
    };
    assert_eq!(on(1), on(3));
    assert!(events(&Campaign::new(SMALL, 12).remainder()).is_empty());
}

/// Slow noise in one record has no slip: steps of its size are everywhere.
#[test]
fn slow_noise_does_not_slip() {
    let one = Shape { trials: 1, samples: 600, blocks: 8, outputs: 1, ..SMALL };
    for (phi, most) in [(0.9, 4), (0.99, 15)] {
        let slips = |seed: &u64| {
            let found = events(&Campaign::new(one, *seed).noise(1e-3, phi).remainder());
            found.iter().any(|event| event.kind == "slip" && event.share > 0.1)
        };
        let alarms = (0..100).filter(slips).count();
        println!("{phi}: {alarms}");
        assert!(alarms <= most, "{alarms} of 100 at {phi}");
    }
}
