//! A training that goes wrong says so: what is no number stops with the batch and the trials it came from and keeps the last
//! good epoch; what cannot come to anything is told before training begins.

mod campaign;

use std::fs;

use acm_train::run::record::read_records;
use campaign::{Campaign, EXPERIMENT, TRIALS};

fn run(campaign: &Campaign, text: &str, arguments: &[&str]) -> (i32, String) {
    campaign.write("tiny.toml", text);
    let output = campaign.command(arguments).output().unwrap();
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[track_caller]
fn says(message: &str, parts: &[&str]) {
    let missing: Vec<&&str> = parts.iter().filter(|part| !message.contains(**part)).collect();
    assert!(missing.is_empty() && !message.contains("panicked"), "without {missing:?}:\n{message}");
}

/// The table of a trial with one column rewritten.
fn rewrite(campaign: &Campaign, trial: &str, column: usize, value: impl Fn(usize, f64) -> f64) {
    let file = format!("data/{trial}.csv");
    let text = String::from_utf8(campaign.read(&file)).unwrap();
    let (header, body) = text.split_once('\n').unwrap();
    let rows = body.lines().enumerate().map(|(k, line)| {
        let mut cells: Vec<String> = line.split(',').map(String::from).collect();
        cells[column] = value(k, cells[column].parse().unwrap()).to_string();
        cells.join(",") + "\n"
    });
    campaign.write(&file, &format!("{header}\n{}", rows.collect::<String>()));
}

/// The rows of a trial with the outputs of some emptied.
fn lose(campaign: &Campaign, trial: &str, lost: impl Fn(usize) -> bool) {
    let file = format!("data/{trial}.csv");
    let text = String::from_utf8(campaign.read(&file)).unwrap();
    let row = |(k, line): (usize, &str)| match k > 0 && lost(k - 1) {
        true => line.split(',').take(4).collect::<Vec<_>>().join(",") + ",,,\n",
        false => line.to_string() + "\n",
    };
    campaign.write(&file, &text.lines().enumerate().map(row).collect::<String>());
}

/// The rate rises from epoch to epoch until the decay of the weights makes them grow.
fn diverging() -> String {
    let grow =
        "epochs = 200\nlearning_rate = 10.0\nwarm_up = 200\npatience = 0\noptimizer = \"adamw\"\nweight_decay = 10.0";
    EXPERIMENT.replace("epochs = 3", grow).replace("seeds = [1, 2]", "seeds = [1]")
}

#[test]
fn a_loss_that_is_no_number_stops_with_batch_and_trial_and_keeps_the_last_good_epoch() {
    let campaign = Campaign::new();
    let (code, message) = run(&campaign, &diverging(), &[]);
    assert_eq!(code, 3, "{message}");
    says(
        &message,
        &[
            "final-seed1, epoch ",
            ", batch ",
            " of 11: ",
            "is not finite",
            "trial d2, trial d3",
            "kept in the checkpoint",
            "clip_norm = 1.0",
        ],
    );
    let kept = fs::read(campaign.path("runs/tiny/checkpoints/final-seed1.safetensors")).unwrap_or_default();
    assert!(!kept.is_empty(), "{message}");
    assert!(!campaign.path("runs/tiny/records/final-seed1.json").exists());
    // the last good epoch goes on to the same end, and nowhere else
    let (code, again) = run(&campaign, &diverging(), &["--resume"]);
    let reason = |text: &str| text.split("final-seed1, epoch ").nth(1).map(String::from);
    assert_eq!((code, reason(&again)), (3, reason(&message)));
}

#[test]
fn a_target_that_never_changes_is_refused_before_training() {
    let campaign = Campaign::with(|trial, k| if trial == 0 { campaign::tip(trial, k) } else { [0.3, -0.1, 0.0] });
    // so that no two trials hold the same values
    for (i, trial) in TRIALS.iter().enumerate().skip(1) {
        rewrite(&campaign, trial, 3, |_, wind| wind + i as f64);
    }
    let text = EXPERIMENT.replace("[protocol]", "[nominal]\nmodel = \"none\"\n[protocol]\nvalidation_fold = 0");
    let (code, message) = run(&campaign, &text, &[]);
    assert_eq!(code, 3, "{message}");
    says(&message, &["the target is constant over the training part (d2, d3)", "x is 0.3", "y is -0.1", "[nominal]"]);
    assert!(!campaign.path("runs/tiny/checkpoints/final-seed1.safetensors").exists());
}

/// The data's own prediction is what is measured, so that nothing is left: told, and no fault.
#[test]
fn a_nominal_model_that_misses_nothing_is_told() {
    let campaign = Campaign::new();
    let own = ["x", "y", "z"].map(|c| format!("[[predicted]]\ncolumn = \"{c}\"\nunit = \"m\"\n")).concat();
    campaign.write("data/manifest.toml", &campaign::MANIFEST.replace("[roles]", &format!("{own}[roles]")));
    let (code, message) = run(&campaign, EXPERIMENT, &[]);
    assert_eq!(code, 0, "{message}");
    says(&message, &["warning: the nominal model leaves nothing to learn on d2, d3", "equals what is measured"]);
}

#[test]
fn an_input_that_never_changes_is_a_warning() {
    let campaign = Campaign::new();
    for trial in &TRIALS[1..4] {
        rewrite(&campaign, trial, 3, |_, _| 0.25);
    }
    let (code, message) = run(&campaign, EXPERIMENT, &[]);
    assert_eq!(code, 0, "{message}");
    says(&message, &["warning: input `wind` is 0.25 in all training trials (d2, d3)", "inputs.channels"]);
}

#[test]
fn held_out_trials_far_outside_are_a_warning_with_both_ranges() {
    let campaign = Campaign::new();
    let (code, message) = run(&campaign, EXPERIMENT, &[]);
    assert_eq!(code, 0, "{message}");
    assert!(!message.contains("warning"), "{message}");
    rewrite(&campaign, "h2", 3, |_, wind| 2.0 + wind);
    let (code, message) = run(&campaign, EXPERIMENT, &["--out", "other"]);
    assert_eq!(code, 0, "{message}");
    says(
        &message,
        &[
            "warning: input `wind` goes from 2.",
            "in the held-out trials h2,",
            "1.365 · 10⁻⁵ to 0.9546 in the training trials",
        ],
    );
}

#[test]
fn folds_and_windows_that_leave_nothing_are_refused_with_their_key() {
    let campaign = Campaign::new();
    let folds = EXPERIMENT.replace("seeds = [1, 2]", "folds = [[\"d1\", \"d2\", \"d3\"]]");
    let (code, message) = run(&campaign, &folds, &[]);
    assert_eq!(code, 2, "{message}");
    says(&message, &["tiny.toml:21", "leaves none to learn from", "leave at least one trial out"]);
    let long = EXPERIMENT.replace("length = 5\nreach  = 5", "length = 91\nreach = 91");
    let (code, message) = run(&campaign, &long, &[]);
    assert_eq!(code, 2, "{message}");
    says(&message, &["tiny.toml:10:1", "windows.reach", "91", "90 samples"]);
    // the calibration covers little of what the others do
    rewrite(&campaign, "c1", 1, |_, q| q / 100.0);
    let (code, message) = run(&campaign, &EXPERIMENT.replace("\"none\"", "\"box\""), &[]);
    assert_eq!(code, 2, "{message}");
    says(&message, &["windows.reach", "the domain filter left out", "widen inputs.domain_filter"]);
}

/// Steps of 1 s are no gaps, and the record notes which gap was used; a gap that is given is taken as it is.
#[test]
fn a_slow_process_is_learned_from() {
    let campaign = Campaign::new();
    TRIALS.iter().for_each(|trial| rewrite(&campaign, trial, 0, |_, t| 10.0 * t));
    let (code, message) = run(&campaign, EXPERIMENT, &[]);
    assert_eq!(code, 0, "{message}");
    let windows = &read_records(&campaign.path("runs/tiny")).unwrap()[0].experiment.windows;
    assert!((windows.gap() - 5.0).abs() < 1e-9, "{}", windows.gap());
    let (code, message) = run(&campaign, EXPERIMENT, &["--out", "short", "--set", "windows.max_gap=0.5"]);
    assert_eq!(code, 2, "{message}");
    says(&message, &["windows.reach", "1 samples without a gap over 0.5 s"]);
}

/// Windows of five samples hold the inputs of those without an output. Oracle: by hand. Samples 1, 4, …, 88 of 90 lack it: of the 86
/// windows, which end at 4 to 89, 29 are not scored.
#[test]
fn windows_reach_over_samples_without_an_output() {
    let campaign = Campaign::new();
    TRIALS.iter().for_each(|trial| lose(&campaign, trial, |k| k % 3 == 1));
    for target in ["last", "every"] {
        let text = EXPERIMENT.replace("reach  = 5", &format!("reach = 5\ntarget = \"{target}\""));
        let (code, message) = run(&campaign, &text, &["--out", target]);
        assert_eq!(code, 0, "{message}");
        for record in read_records(&campaign.path(target)).unwrap() {
            let scored = record.held_out.unwrap();
            let samples: Vec<usize> = scored.trials["h1"].values().map(|score| score.samples).collect();
            assert!(!samples.is_empty() && samples.iter().all(|count| *count == 57), "{samples:?}");
            assert_eq!(record.data.trials["h1"].samples, 60);
        }
    }
}
