//! Time of a single step: the latency of an estimator's network.
//!
//! ```text
//! taskset -c 1 cargo bench --profile dev -p acm-kernels --bench step -- [STEPS]
//! ```
//!
//! H = 32, C = 5, O = 3; CfC with a backbone of 64 units. Each step is timed by the clock by itself, so the clock's
//! own 20 to 40 ns are in the figures.

use std::hint::black_box;
use std::time::Instant;

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, Kernel, Level, MlpShape, Shape};

fn main() {
    let count = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let count: usize = count.map_or(1_000_000, |text| text.parse().expect("a number of steps"));
    let activation = Activation::LecunTanh;
    let cfc = CfcShape { units: 32, mode: CfcMode::Default, backbone_units: 64, backbone_layers: 1, activation };
    let bodies = [
        ("cfc", Body::Cfc(cfc)),
        ("gru", Body::Gru(GruShape { units: 32, layers: 1 })),
        ("mlp", Body::Mlp(MlpShape { hidden: vec![64, 64], activation: Activation::Relu })),
    ];
    println!("| network | level | median ns | p99 ns | worst ns |");
    println!("| --- | --- | --- | --- | --- |");
    for (name, body) in bodies {
        for level in Level::available() {
            let shape = Shape { body: body.clone(), inputs: 5, outputs: 3 };
            let kernel = Kernel::with_level(&shape, level).expect("sizes are positive");
            let parameters: Vec<_> = (0..kernel.parameters()).map(|i| 0.2 * (i as f32).sin()).collect();
            let mut stepper = kernel.stepper(&parameters);
            let mut predictions = [0.0; 3];
            let mut times = Vec::with_capacity(count);
            for i in 0..count {
                let inputs = [0.1, -0.3, 0.5, (i as f32 * 0.1).sin(), 0.2];
                let start = Instant::now();
                stepper.step(black_box(&inputs), black_box(0.1), &mut predictions);
                times.push(start.elapsed().as_nanos());
                black_box(&predictions);
            }
            times.sort_unstable();
            let (median, rare, worst) = (times[count / 2], times[count * 99 / 100], times[count - 1]);
            println!("| {name} | {level:?} | {median} | {rare} | {worst} |");
        }
    }
}
