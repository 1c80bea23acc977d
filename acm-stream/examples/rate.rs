//! Rows per second that an estimator answers, for comparison with Python in `acm-python/tests/speed.py`.
//!
//!     cargo run -p acm-stream --example rate -- FILE [ROWS]
//!
//! FILE is what `acm-eval stream RUN --save FILE` wrote. Every input is 0.4 sin(0.7 t), in SI units, at 20 Hz.

use std::time::Instant;

use acm_stream::{Estimator, Parts};

const STEP: f64 = 0.05;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().expect("a file that acm-eval stream --save wrote");
    let rows: usize = arguments.next().map_or(100_000, |rows| rows.parse().expect("a number of rows"));
    let parts = Parts::from_json(&std::fs::read(file).expect("a file")).expect("an estimator");
    let (width, mut estimator) = (parts.width(), Estimator::new(parts).expect("parts that fit"));
    let inputs: Vec<f64> =
        (0..rows).flat_map(|k| std::iter::repeat_n(0.4 * (0.7 * STEP * k as f64).sin(), width)).collect();
    let mut answers = Vec::with_capacity(rows);
    let begun = Instant::now();
    for row in inputs.chunks(width) {
        answers.push(estimator.step(row, STEP).expect("a sample")[0]);
    }
    let seconds = begun.elapsed().as_secs_f64();
    assert!(answers.iter().all(|answer| answer.is_finite()));
    println!("{}", rows as f64 / seconds);
}
