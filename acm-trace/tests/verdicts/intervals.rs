//! Intervals of 95 % cover the truth in about that share of campaigns.

use acm_trace::trace::Options;

use crate::bench::{closed_with, covers, effect, force, parameter, press_case};
use crate::effects::delayed;

#[test]
fn intervals_of_a_dead_time_cover_it() {
    let options = Options { only: vec!["dead_time".into()], samples: 800, ..Options::default() };
    let seeds = 20;
    let covered = |seed: &u64| {
        let case = press_case(100 + seed, |drive| {
            drive.after(|time, motion| delayed(time, motion, 0.2))[0].iter().map(|q| force(*q)).collect()
        });
        let finding = closed_with(case, &options).finding;
        covers(parameter(effect(&finding, "dead_time"), "delay"), 0.2)
    };
    let count = (0..seeds).filter(covered).count();
    assert!(10 * count >= 8 * seeds as usize, "{count} of {seeds}");
}
