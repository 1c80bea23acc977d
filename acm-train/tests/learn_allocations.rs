//! Training allocates by the epoch, not by the step.

use acm_datasets::{Series, WindowSpec, windows};
use acm_models::{CfcConfig, GruConfig, Keep, MlpConfig, NetworkConfig};
use acm_train::{
    config::{TrainingConfig, device},
    learn::{Control, Scalers, Task, WindowSet, fit},
};
use nalgebra::DMatrix;

const LENGTH: usize = 5;

fn recording(samples: usize, phase: f64) -> Series {
    let wave = |k: usize, c: usize| (0.3 * k as f64 * (1.0 + c as f64) + phase).sin();
    let target = DMatrix::from_fn(samples, 1, |k, _| wave(k, 0) * wave(k, 1));
    Series {
        trial: format!("phase {phase}"),
        nominal: DMatrix::zeros(samples, 1),
        measured: target.clone(),
        segments: vec![0..samples],
        slopes: DMatrix::zeros(0, 0),
        time: (0..samples).map(|k| 0.1 * k as f64).collect(),
        elapsed: vec![0.1; samples],
        inputs: DMatrix::from_fn(samples, 2, wave),
        target,
    }
}

/// Allocations of three epochs in batches of `batch` windows, on the calling thread, which is the only one.
fn allocations(network: &NetworkConfig, supervise: Keep, batch: usize) -> u64 {
    let spec = WindowSpec { length: LENGTH, reach: LENGTH, stride: 1 };
    let series = [recording(260, 0.0)];
    let scalers = Scalers::of(&series);
    let set = || WindowSet::new(&series, windows(&series, &spec), LENGTH, &scalers);
    let (training, validation) = (set(), set());
    let config = TrainingConfig { epochs: 3, batch, ..TrainingConfig::default() };
    let task = Task { network, training: &config, supervise, seed: 1, device: &device("flex").unwrap() };
    let counted = allocation_counter::measure(|| {
        fit(&task, &training, &validation, None, &mut |_| Control::Continue).unwrap();
    });
    counted.count_total
}

/// Oracle: an allocator that counts. 256 windows in 4 steps an epoch, and in 32.
#[test]
fn steps_allocate_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
    let _pool = pool.expect("a pool of this thread");
    let networks = [
        NetworkConfig::Mlp(MlpConfig { hidden: vec![16], ..MlpConfig::default() }),
        NetworkConfig::Gru(GruConfig::default().with_units(8)),
        NetworkConfig::Cfc(CfcConfig { units: 8, backbone_units: 12, ..CfcConfig::default() }),
    ];
    for network in &networks {
        for supervise in [Keep::Last, Keep::Every] {
            let [few, many] = [64, 8].map(|batch| allocations(network, supervise, batch));
            // The smaller batch may need a buffer less, and its buffers may grow in fewer turns.
            assert!(many <= few, "{} {supervise:?}: {few} in 12 steps, {many} in 96", network.kind());
        }
    }
}
