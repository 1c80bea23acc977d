//! Time to gather the windows of a batch, as every step of a fit does before it computes anything.
//!
//! | benchmark | one call                                                                        | counted |
//! | `gather`  | (B, W): B windows of W samples and 5 channels, elapsed times, 3 targets of the last sample | windows |
//!
//! Windows are drawn in a fit's shuffled order from 20 trials of 1,000 samples, batch after batch, into buffers that are
//! used again. `cargo bench --profile dev -p acm-train --bench gather`, on one core with `taskset -c 1` before it; what a
//! whole step takes says the example `training_step`.

use acm_datasets::{Series, WindowSpec, windows};
use acm_models::Keep;
use acm_train::learn::examples::batch::Batch;
use acm_train::learn::examples::order::order;
use acm_train::learn::{Scalers, WindowSet};
use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use nalgebra::DMatrix;

const TRIALS: usize = 20;
const SAMPLES: usize = 1000;
const CHANNELS: usize = 5;
const OUTPUTS: usize = 3;

fn main() {
    divan::main();
}

/// W as a CfC reads them, and one sample as a perceptron does.
#[divan::bench(args = [(64, 50), (256, 50), (64, 1), (256, 1)])]
fn gather(bencher: Bencher, (count, steps): (usize, usize)) {
    let set = set(steps);
    let order = order(set.len(), 1, 0);
    let mut batches = order.chunks_exact(count).cycle();
    let mut batch = Batch::default();
    bencher.counter(ItemsCount::new(count)).bench_local(|| {
        let chosen = batches.next().expect("more windows than a batch");
        set.gather(black_box(chosen), Keep::Last, &mut batch);
        black_box(&batch);
    });
}

fn set(steps: usize) -> WindowSet {
    let series: Vec<Series> = (0..TRIALS).map(series).collect();
    let windows = windows(&series, &WindowSpec { length: steps, reach: steps, stride: 1 });
    WindowSet::new(&series, windows, steps, &Scalers::of(&series))
}

fn series(trial: usize) -> Series {
    let wave = |columns: usize| {
        DMatrix::from_fn(SAMPLES, columns, |k, c| (0.01 * k as f64 * (1 + c) as f64 + trial as f64).sin())
    };
    let nominal = DMatrix::zeros(SAMPLES, OUTPUTS);
    Series {
        trial: format!("trial {trial}"),
        time: (0..SAMPLES).map(|k| 0.1 * k as f64).collect(),
        elapsed: vec![0.1; SAMPLES],
        inputs: wave(CHANNELS),
        target: wave(OUTPUTS),
        measured: wave(OUTPUTS),
        nominal,
        segments: std::iter::once(0..SAMPLES).collect(),
        slopes: DMatrix::zeros(0, 0),
    }
}
