//! Speed of the physics of the paper's arm: 0.62 m, linear strain, cubic actuation map, two actuators, one marker at the tip.
//!
//! | benchmark            | one call                                                                   | counted   |
//! | `tip_of_one_pose`    | actuators to strain to tip, one sample alone                               | –         |
//! | `tip_and_slopes_of_one_pose` | tip, slopes with all 26 parameters and both actuators, one sample alone | –    |
//! | `tips`               | tips of N samples side by side, on all threads                             | samples   |
//! | `tips_and_slopes`    | tips of N samples, slopes with 20 parameters and both actuators            | samples   |
//! | `calibration`        | six starts, both steps, the joint polish: 20 parameters, 10,538 samples    | –         |
//!
//! `cargo bench --profile dev -p acm-core`, in the profile that the programs are built in; on one core with
//! `RAYON_NUM_THREADS=1 taskset -c 1` before it.

use acm_core::registration::RegistrationSpec;
use acm_core::response::Response;
use acm_core::{ArmSpec, NominalModel, NominalSpec, Observations, StrainModel, calibrate};
use divan::Bencher;
use divan::counter::ItemsCount;
use nalgebra::DMatrix;

const SAMPLES: usize = 10_538;

fn main() {
    divan::main();
}

fn arm() -> ArmSpec {
    let registration = RegistrationSpec::Fixed { rotation: [0.0; 3], translation: [0.0; 3] };
    ArmSpec { registration, ..ArmSpec::default() }
}

fn model() -> StrainModel {
    let model = StrainModel::new(&arm(), 2, &[1.0]).expect("the paper's arm");
    let mut theta = model.parameters().to_vec();
    theta[1] = 0.9;
    theta[9] = 1.2;
    theta[14] = -0.03;
    theta[18..20].copy_from_slice(&[-0.6, 0.8]);
    model.with_parameters(&theta)
}

/// A slow sweep of both actuators through ±2.8 rad.
fn actuators(samples: usize) -> DMatrix<f64> {
    DMatrix::from_fn(samples, 2, |t, a| 2.8 * (t as f64 * [0.013, 0.0007][a]).sin())
}

#[divan::bench]
fn tip_of_one_pose(bencher: Bencher) {
    let (model, mut out) = (model(), [0.0; 3]);
    let mut scratch = model.scratch();
    bencher.bench_local(|| {
        model.predict(divan::black_box(&[1.3, -0.7]), &mut scratch, &mut out);
        out
    });
}

#[divan::bench]
fn tip_and_slopes_of_one_pose(bencher: Bencher) {
    let (model, mut out, mut by_actuator) = (model(), [0.0; 3], [0.0; 6]);
    let (theta, mut scratch) = (model.parameters(), model.scratch());
    let mut slopes = vec![0.0; 3 * theta.len()];
    bencher.bench_local(|| {
        let q = divan::black_box(&[1.3, -0.7]);
        model.jacobians_with(theta, q, &mut scratch, &mut out, &mut slopes, &mut by_actuator);
        out
    });
}

#[divan::bench(args = [1_000, SAMPLES])]
fn tips(bencher: Bencher, samples: usize) {
    let (model, actuators) = (NominalModel::Strain(model()), actuators(samples));
    bencher.counter(ItemsCount::new(samples)).bench_local(|| model.predict(divan::black_box(&actuators)));
}

#[divan::bench(args = [1_000, 10_000])]
fn tips_and_slopes(bencher: Bencher, samples: usize) {
    let response = Response::new(NominalModel::Strain(model()), None, None);
    let actuators = actuators(samples);
    let columns: Vec<Vec<f64>> = actuators.column_iter().map(|column| column.iter().copied().collect()).collect();
    let rows: Vec<usize> = (0..samples).collect();
    bencher.counter(ItemsCount::new(samples)).bench_local(|| response.linearised_at(divan::black_box(&columns), &rows));
}

#[divan::bench(sample_count = 10, sample_size = 1)]
fn calibration(bencher: Bencher) {
    let actuators = actuators(SAMPLES);
    let clean = NominalModel::Strain(model()).predict(&actuators);
    let measured = DMatrix::from_fn(SAMPLES, 3, |t, o| clean[(t, o)] + 0.005 * (t as f64 * 1.7 + o as f64).sin());
    let data = Observations { actuators, measured, at: vec![1.0] };
    bencher.bench_local(|| calibrate(&NominalSpec::Strain(arm()), &data));
}
