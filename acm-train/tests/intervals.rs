//! Intervals hold what they are said to hold, of errors whose distribution is planted.

mod campaign;

use acm_train::run::evaluation::intervals::{self, Intervals};
use acm_train::store::hashed;
use campaign::{Campaign, inputs};

/// Half the width of the planted error, m.
const WIDTH: f64 = 0.02;

/// Uniform on [−1, 1), by splitmix64.
fn noise(index: usize) -> f64 {
    let mut z = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as f64 / (1u64 << 63) as f64 - 1.0
}

/// A polynomial of the actuators, and uniform noise in all trials but the calibration trial.
fn tip(trial: usize, k: usize) -> [f64; 3] {
    let [q1, q2, _] = inputs(trial, k);
    let white = |o: usize| if trial == 0 { 0.0 } else { WIDTH * noise(3 * (1000 * trial + k) + o) };
    [0.2 * q1 + white(0), 0.15 * q2 + white(1), 0.05 * q1 * q2 + white(2)]
}

fn intervals(campaign: &Campaign, edits: &[&str]) -> (Option<Intervals>, String) {
    let output = campaign.command(&[&["--out", "run"], edits].concat()).assert().success().get_output().clone();
    let path = campaign.path("run").join(intervals::FILE);
    let read = path.is_file().then(|| hashed::read(&path, intervals::FORMAT).unwrap());
    (read, String::from_utf8(output.stdout).unwrap())
}

/// Oracle: |e| is uniform from 0 to WIDTH, and three trials attain three quarters.
#[test]
fn three_trials_left_out_hold_three_quarters() {
    let campaign = Campaign::with(tip);
    let (found, text) = intervals(&campaign, &["--set", "protocol.seeds=[1, 2, 3]", "--set", "training.epochs=2"]);
    let found = found.unwrap();
    assert_eq!((found.level, found.units, found.unit.as_str()), (0.75, 3, "trial"));
    for of in &found.outputs {
        assert!((of.half_width / (0.75 * WIDTH) - 1.0).abs() < 0.15, "{of:?}");
        assert!((of.left_out - 0.75).abs() < 0.03, "{of:?}");
        assert!((of.held_out.unwrap() - 0.75).abs() < 0.12, "{of:?}");
    }
    assert!(
        text.contains("75 % intervals, from 3 trials left out in turn (75 % is the most that so few attain)"),
        "{text}"
    );
    assert!(text.contains("held-out samples that it holds"), "{text}");
}

/// One final run leaves out one trial: its blocks of time are the units.
#[test]
fn the_only_trial_left_out_is_cut_into_blocks_of_time() {
    let campaign = Campaign::with(tip);
    let edits =
        ["--set", "protocol.seeds=[1]", "--set", "protocol.cross_validation=false", "--set", "training.epochs=2"];
    let (found, text) = intervals(&campaign, &edits);
    let found = found.unwrap();
    assert_eq!((found.level, found.units, found.unit.as_str()), (0.9, 9, "block of time"));
    for of in &found.outputs {
        assert!(of.half_width > 0.8 * WIDTH && of.half_width < 1.15 * WIDTH, "{of:?}");
    }
    assert!(text.contains("90 % intervals, from 9 blocks of time left out in turn:"), "{text}");
}

/// Without a final run there is nothing to have an interval.
#[test]
fn a_cross_validation_alone_has_no_intervals() {
    let campaign = Campaign::with(tip);
    let edits =
        ["--set", "protocol.final=false", "--set", "protocol.cross_validation=true", "--set", "training.epochs=2"];
    let (found, text) = intervals(&campaign, &edits);
    assert!(found.is_none() && !text.contains("intervals"), "{text}");
}

/// Final runs that leave out one fold after the other tell whether it is worth it, without a cross-validation of its own.
#[test]
fn final_runs_of_several_seeds_have_a_verdict() {
    let campaign = Campaign::new();
    let edits = ["--set", "protocol.seeds=[1, 2, 3]", "--set", "protocol.cross_validation=false"];
    let long = ["--set", "training.epochs=30", "--set", "training.learning_rate=0.01", "--set", "network.units=8"];
    let (_, text) = intervals(&campaign, &[&edits[..], &long].concat());
    assert!(text.contains("The gru is worth it here") && text.contains("over 3 folds left out in turn"), "{text}");
}
