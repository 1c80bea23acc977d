//! Intervals of 95 % cover the truth in about that share of campaigns, and are no wider than they must be.

use acm_trace::trace::Options;

use crate::bench::{FORCE_NOISE, Recorded, closed_with, covers, effect, force, parameter, press_case};
use crate::effects::{delayed, rubbing};

const SEEDS: u64 = 20;

/// Of `SEEDS` campaigns: how many intervals cover the truth, and their mean half-width.
fn covered(name: &str, value: &str, truth: f64, case: impl Fn(u64) -> Recorded) -> (u64, f64) {
    let options = Options { only: Some(vec![name.into()]), samples: 800, ..Options::default() };
    let (mut count, mut reach) = (0, 0.0);
    for seed in 0..SEEDS {
        let finding = closed_with(case(100 + seed), &options).finding;
        let parameter = parameter(effect(&finding, name), value);
        count += u64::from(covers(parameter, truth));
        reach += 0.5 * (parameter.interval[1] - parameter.interval[0]) / SEEDS as f64;
    }
    println!("{name}: {count} of {SEEDS} intervals cover {truth}, ± {reach:.4}");
    (count, reach)
}

/// White noise alone would give ± 1.96 σ / (√N · root mean square of the slope of the force): 1.3 ms with the 750
/// samples that are looked at.
#[test]
fn intervals_of_a_dead_time_cover_it() {
    let (count, reach) = covered("dead_time", "delay", 0.2, |seed| {
        press_case(seed, |drive| {
            drive.after(|time, motion| delayed(time, motion, 0.2))[0].iter().map(|q| force(*q)).collect()
        })
    });
    assert!((16..=SEEDS).contains(&count) && reach < 0.004, "{count} of {SEEDS}, ± {reach} s");
}

/// White noise alone would give ± 1.96 σ/√N, were friction alone unknown.
#[test]
fn intervals_of_friction_cover_it() {
    let (count, reach) = covered("coulomb_friction", "friction_force", 0.5, |seed| {
        press_case(seed, |drive| {
            let rubbing = rubbing(&drive.time, &drive.motion[0], 0.02);
            drive.q()[0].iter().zip(rubbing).map(|(q, z)| force(*q) + 0.5 * z).collect()
        })
    });
    assert!((16..=SEEDS).contains(&count) && reach < 0.5 * FORCE_NOISE, "{count} of {SEEDS}, ± {reach} N");
}
