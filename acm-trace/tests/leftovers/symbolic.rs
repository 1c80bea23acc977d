//! Oracle: the formula that was planted.

use std::time::Instant;

use acm_core::record::Record;
use acm_trace::diagnose::symbolic::symbolic;
use acm_trace::finding::Symbolic;
use nalgebra::DMatrix;

use crate::campaign::{Campaign, LARGE, SMALL, Shape};

fn product(r: &Record, size: f64) -> Vec<f64> {
    r.actuators[0].iter().zip(&r.actuators[1]).map(|(a, b)| size * a * b).collect()
}

fn formula_of(campaign: &Campaign) -> Option<Symbolic> {
    let found = symbolic(&campaign.remainder(), &[]);
    println!("{:?}", found.as_ref().map(|found| (&found.formula, found.error)));
    found
}

/// One term, in white and in coloured noise of the same size.
#[test]
fn a_product_on_an_actuator_is_one_term() {
    for (seed, phi) in [(1, 0.0), (2, 0.9), (3, 0.0), (4, 0.9), (5, 0.95)] {
        let noisy = Campaign::new(LARGE, seed).noise(6e-3, phi).on_actuator(0, |_, r| product(r, -0.09));
        let found = formula_of(&noisy).unwrap();
        let terms: Vec<(&str, &str)> = found.terms.iter().map(|t| (t.on.as_str(), t.term.as_str())).collect();
        assert_eq!(terms, [("Δq1", "q1·q2")], "{}", found.formula);
        assert!((found.terms[0].coefficient / -0.09 - 1.0).abs() < 0.1);
        assert!(found.formula.starts_with("Δq1 = −0.0") && found.formula.ends_with("·q1·q2"));
    }
}

/// Two terms on different places; without noise the coefficients are exact.
#[test]
fn two_terms_are_two_terms() {
    let two = Campaign::new(LARGE, 6)
        .noise(1e-4, 0.0)
        .on_actuator(1, |_, r| r.actuators[1].iter().map(|q| 0.03 * q * q).collect())
        .on_output(2, |_, r| r.contexts[0].iter().map(|c| 0.05 * (c - 0.6)).collect());
    let found = formula_of(&two).unwrap();
    assert!(found.formula.starts_with("Δq2 = 0.03") && found.formula.contains("Δz = 0.0"), "{}", found.formula);
    assert!(found.error < 1.1 * two.floor, "{} {}", found.error, two.floor);
    assert!((found.terms[0].coefficient / 0.03 - 1.0).abs() < 0.01);
}

type Planted<'a> = (&'a str, Box<dyn Fn(usize, &Record) -> Vec<f64>>);

/// Each of these is found under its name.
#[test]
fn terms_have_their_names() {
    let speed = |r: &Record, a: usize| {
        let rates = &r.actuator_rates[a];
        (rates.iter().map(|v| v * v).sum::<f64>() / rates.len() as f64).sqrt()
    };
    let planted: Vec<Planted> = vec![
        ("q1³", Box::new(|_, r: &Record| r.actuators[0].iter().map(|q| 0.02 * q.powi(3)).collect())),
        (
            "sgn(dq1/dt)",
            Box::new(move |_, r: &Record| {
                let speed = speed(r, 0);
                r.actuator_rates[0].iter().map(|v| 0.04 * (v / (0.02 * speed)).tanh()).collect()
            }),
        ),
        ("q1·t", Box::new(|_, r: &Record| r.actuators[0].iter().zip(&r.time).map(|(q, t)| 0.002 * q * t).collect())),
        (
            "(throttle − 0.600)·q1",
            Box::new(|_, r: &Record| {
                r.actuators[0].iter().zip(&r.contexts[0]).map(|(q, c)| 0.6 * q * (c - 0.6)).collect()
            }),
        ),
    ];
    for (name, of) in planted {
        let found = formula_of(&Campaign::new(LARGE, 8).noise(4e-3, 0.5).on_actuator(0, of)).unwrap();
        assert_eq!(found.terms.len(), 1, "{name}: {}", found.formula);
        assert_eq!((found.terms[0].on.as_str(), found.terms[0].term.as_str()), ("Δq1", name));
    }
}

/// Noise has no formula, be it slow or white, in many trials or in one.
#[test]
fn noise_has_no_formula() {
    let one = Shape { trials: 1, samples: 1000, blocks: 8, ..SMALL };
    let mut spoken = 0;
    for seed in 0..20 {
        for (shape, phi) in [(SMALL, 0.0), (SMALL, 0.95), (one, 0.0), (one, 0.95)] {
            spoken += usize::from(formula_of(&Campaign::new(shape, seed).noise(1e-3, phi)).is_some());
        }
    }
    assert!(spoken <= 2, "{spoken} of 80");
}

/// What calibration absorbs is no formula: a zero offset and a gain of q1, beside a product.
#[test]
fn what_calibration_absorbs_is_left_to_it() {
    let campaign = Campaign::new(LARGE, 9)
        .noise(2e-3, 0.0)
        .on_actuator(0, |_, r| r.actuators[0].iter().map(|q| 0.3 + 0.2 * q).collect())
        .on_actuator(0, |_, r| product(r, -0.09));
    let remainder = campaign.remainder();
    let absorbed: Vec<DMatrix<f64>> = (0..campaign.records.len())
        .map(|k| {
            DMatrix::from_fn(remainder.trials[k].residual.len(), 2, |row, column| {
                let slope = campaign.slopes[k][row * 2];
                if column == 0 { slope } else { slope * campaign.records[k].actuators[0][row / 3] }
            })
        })
        .collect();
    let start = Instant::now();
    let found = symbolic(&remainder, &absorbed).unwrap();
    println!("{} in {:?}", found.formula, start.elapsed());
    assert_eq!(found.terms.len(), 1, "{}", found.formula);
    assert!((found.terms[0].coefficient / -0.09 - 1.0).abs() < 0.03, "{}", found.formula);
    let plain = formula_of(&campaign).unwrap();
    assert_eq!(plain.terms.len(), 3, "{}", plain.formula);
}

/// Four trials with an output of 1.0, 1.2, 0.8 and 1.1 mm: each is predicted by the mean of the other three, and by
/// hand the root mean square of these errors is 0.197 mm; about the mean of all four it would be 0.148 mm.
#[test]
fn the_error_is_that_of_blocks_left_out() {
    let shape = Shape { actuators: 1, contexts: 0, outputs: 1, ..SMALL };
    let level = |k: usize, r: &Record| vec![[1.0e-3, 1.2e-3, 0.8e-3, 1.1e-3][k]; r.samples()];
    let found = formula_of(&Campaign::new(shape, 12).on_output(0, level)).unwrap();
    assert_eq!(found.formula, "Δx = 0.00102");
    assert!((found.error - 0.197_203e-3).abs() < 1e-8, "{}", found.error);
}

/// Twelve actuators: the pair is found among sixty-six.
#[test]
fn a_pair_among_twelve() {
    let many = Shape { actuators: 12, contexts: 1, ..LARGE };
    let pair = |_: usize, r: &Record| r.actuators[4].iter().zip(&r.actuators[9]).map(|(a, b)| 0.2 * a * b).collect();
    let campaign = Campaign::new(many, 10).noise(5e-3, 0.0).on_actuator(4, pair);
    let start = Instant::now();
    let found = formula_of(&campaign).unwrap();
    println!("in {:?}", start.elapsed());
    assert_eq!(found.terms.len(), 1);
    assert_eq!(found.terms[0].term, "q5·q10");
}

/// The same bits on one thread as on three.
#[test]
fn threads_change_nothing() {
    let campaign = Campaign::new(SMALL, 11).noise(1e-3, 0.5).on_actuator(0, |_, r| product(r, 0.02));
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| symbolic(&campaign.remainder(), &[]))
    };
    assert_eq!(on(1), on(3));
}
