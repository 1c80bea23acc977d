//! Oracle: what is planted, in closed form, and noise.

use acm_core::record::Record;
use acm_trace::diagnose::followed::followed;
use nalgebra::DMatrix;

use crate::campaign::{Campaign, SMALL, Shape};

/// Change of the outputs by an effect: 10 mm in the first output, in proportion to the first actuator.
fn changes(campaign: &Campaign) -> Vec<DMatrix<f64>> {
    let outputs = campaign.rig.outputs.len();
    let of =
        |r: &Record| DMatrix::from_fn(r.samples(), outputs, |t, o| if o == 0 { 0.01 * r.actuators[0][t] } else { 0.0 });
    campaign.records.iter().map(of).collect()
}

/// Five in a hundred, as p says; more than eleven come up once in a hundred.
#[test]
fn noise_follows_no_effect() {
    let shape = Shape { trials: 6, samples: 100, outputs: 2, ..SMALL };
    let follows = |seed: &u64| {
        let campaign = Campaign::new(shape, *seed).noise(1e-3, 0.9);
        followed(&campaign.remainder(), &changes(&campaign), 7).p <= 0.05
    };
    let rate = (0..100).filter(follows).count();
    assert!(rate <= 11, "{rate} %");
}

/// Twice the noise: a product of the change and the other actuator follows, of its full size; a vibration, which the effect knows nothing of,
/// does not.
#[test]
fn what_follows_an_effect_is_found_and_nothing_else() {
    let planted = |of: fn(&Record, usize) -> f64| {
        let of = move |_: usize, r: &Record| (0..r.samples()).map(|t| of(r, t)).collect::<Vec<f64>>();
        let campaign = Campaign::new(SMALL, 11).noise(1e-3, 0.0).on_output(0, of);
        let clean = Campaign::new(SMALL, 11).on_output(0, of);
        let size = clean.remainder().mean_square().sqrt();
        (followed(&campaign.remainder(), &changes(&campaign), 7), size)
    };
    let (product, size) = planted(|r, t| 0.004 * r.actuators[0][t] * r.actuators[1][t]);
    assert!(product.p <= 0.05 && (0.8..=1.1).contains(&(product.rms / size)), "{product:?} of {size}");
    let (vibration, size) = planted(|r, t| 0.004 * (9.0 * r.time[t]).sin());
    assert!(vibration.rms < 0.1 * size, "{vibration:?} of {size}");
}
