//! Oracle: the closed-form continuous-time network in double precision, straight from its equations.

use acm_stream::{Estimator, StateRule};

use crate::robots::{FIRST, cfc, parts, polynomial, trial};

const UNITS: usize = 8;
const WIDTH: usize = 12;

/// W x + b, with parameters taken from the front of a list: weights [outputs][inputs], then biases.
fn affine(rest: &mut &[f32], outputs: usize, x: &[f64]) -> Vec<f64> {
    let (weights, others) = rest.split_at(outputs * x.len());
    let (biases, others) = others.split_at(outputs);
    *rest = others;
    let row =
        |(row, bias): (&[f32], &f32)| f64::from(*bias) + row.iter().zip(x).map(|(w, x)| f64::from(*w) * x).sum::<f64>();
    weights.chunks(x.len()).zip(biases).map(row).collect()
}

/// h' and the prediction.
fn step(weights: &[f32], u: &[f64], h: &[f64], elapsed: f64) -> (Vec<f64>, f64) {
    let mut rest = weights;
    let eta = [u, h].concat();
    let psi: Vec<f64> = affine(&mut rest, WIDTH, &eta).iter().map(|x| 1.7159 * (0.666 * x).tanh()).collect();
    let [n_1, n_2, n_a, n_b] = [0; 4].map(|_| affine(&mut rest, UNITS, &psi));
    let unit = |i: usize| {
        let alpha = 1.0 / (1.0 + (-(n_a[i] * elapsed + n_b[i])).exp());
        (1.0 - alpha) * n_1[i].tanh() + alpha * n_2[i].tanh()
    };
    let h: Vec<f64> = (0..UNITS).map(unit).collect();
    let prediction = affine(&mut rest, 1, &h)[0];
    assert!(rest.is_empty());
    (h, prediction)
}

#[test]
fn the_answer_follows_the_equations() {
    let (trial, parts) = (trial(), parts(cfc(UNITS, WIDTH), StateRule::Running));
    let mut estimator = Estimator::new(parts.clone()).expect("parts that fit");
    let found = trial.through(&mut estimator);
    let coefficients = polynomial().coefficients().clone();
    for segment in trial.segments() {
        let mut h = vec![0.0; UNITS];
        for t in segment.clone() {
            let ([q1, q2, temperature], first) = (trial.inputs[t], t == segment.start);
            let elapsed = if first { FIRST } else { trial.time[t] - trial.time[t - 1] };
            let rate = if first { 0.0 } else { (q1 - trial.inputs[t - 1][0]) / elapsed };
            let u = [(q1 - 0.1) / 0.7, (q2 + 0.2) / 0.4, rate / 0.6, (temperature - 300.0) / 3.0];
            let (next, prediction) = step(&parts.weights, &u, &h, elapsed);
            h = next;
            let monomials = [1.0, q1, q2, q1 * q1, q1 * q2, q2 * q2];
            let nominal: f64 = monomials.iter().zip(coefficients.column(1).iter()).map(|(m, c)| m * c).sum();
            let off = (found[t][0] - (nominal + 0.03 * prediction + 0.002)).abs();
            assert!(off < 1e-5 * 0.03, "{off:.1e} at sample {t}");
        }
    }
    assert_eq!(estimator.history(), 83);
}
