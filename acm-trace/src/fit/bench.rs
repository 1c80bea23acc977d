//! Recordings for tests.

use acm_core::effects::instance::Instance;
use acm_core::effects::{Carrier, find};
use acm_core::record::Record;
use acm_core::rig::{Rig, Signal};

use super::state::Placed;
use crate::series::Series;

/// Returns a rig whose signals are between −1 and 1 rad, sampled every 10 ms for 20 s.
pub fn rig(actuators: &[&str], contexts: &[&str], outputs: &[&str]) -> Rig {
    let signal = |name: &&str| Signal { name: name.to_string(), unit: "rad".into(), low: -1.0, high: 1.0 };
    let signals = |names: &[&str]| names.iter().map(signal).collect();
    Rig {
        actuators: signals(actuators),
        contexts: signals(contexts),
        outputs: signals(outputs),
        throttle: None,
        altitude: None,
        payload: None,
        carried: false,
        arm: None,
        step: 0.01,
        duration: 20.0,
    }
}

/// Returns the times of a trial of such a rig.
pub fn time() -> Vec<f64> {
    (0..2000).map(|k| 0.01 * f64::from(k)).collect()
}

/// Returns a reproducible source of numbers spread evenly over a width about zero.
pub fn noise(width: f64) -> impl FnMut() -> f64 {
    let mut state = 1u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        width * ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
    }
}

/// Returns a trial in which every sample is compared and counts; `measured` is row by row.
pub fn series(record: Record, measured: Vec<f64>) -> Series {
    let samples = record.samples();
    Series {
        inter_sample: acm_core::InterSample::Straight,
        name: String::new(),
        rows: (0..samples).collect(),
        is_led: false,
        thin: record.clone(),
        record,
        predicted: None,
        offset: vec![0.0; measured.len()],
        measured,
        counts: vec![true; samples],
        block: vec![0; samples],
        calibrates: false,
    }
}

/// Returns an effect whose first values are given, the others initial guesses; it acts in calibration trials too.
pub fn placed(name: &str, carrier: Carrier, rig: &Rig, theta: &[f64]) -> Placed {
    let instance = Instance::new(find(name).unwrap(), carrier, rig);
    let mut all = instance.initial_guesses(rig).swap_remove(0);
    all[..theta.len()].copy_from_slice(theta);
    Placed { instance, theta: all, in_calibration: true }
}
