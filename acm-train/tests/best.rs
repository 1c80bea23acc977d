//! Which model to use, on campaigns with planted truth: an average where it beats both members, the nominal model where there is
//! nothing to learn, the loop's model where that is the truth. Held-out trials choose nothing.
//!
//! What other trials have beside the polynomial of the calibration trial is planted ([`campaign`]): x follows the wind, y follows
//! q1, each by about 10 mm. A base that sees the wind alone explains x, one that sees q1 alone y, and their mean half of both.

mod campaign;

use std::{fs, path::Path};

use acm_core::{
    NominalSpec,
    augmented::AugmentedModel,
    calibrate,
    effects::{Carrier, instance::Term},
};
use acm_datasets::files::table::{Column, read_parquet};
use acm_datasets::rig::rig;
use acm_datasets::{Role, Trial};
use acm_train::run::evaluation::intervals;
use acm_train::run::nominal::augmented::origin;
use acm_train::schedule::study::best::candidate::Candidate;
use acm_train::schedule::study::best::record::{BestRecord, WINNER, read};
use acm_train::store::hashed;
use campaign::{Campaign, inputs};

const STUDY: &str = r#"
study    = "best"
question = "Which model shall I use?"
[set]
nominal.degree = 3
[[base]]
name       = "wind"
experiment = "tiny.toml"
set        = { baseline.kind = "ridge", baseline.lags = 1, inputs.channels = ["wind"] }
[[base]]
name       = "q1"
experiment = "tiny.toml"
set        = { baseline.kind = "ridge", baseline.lags = 1, inputs.channels = ["q1"] }
"#;

const NETWORK: &str = r#"
[[base]]
name       = "GRU"
experiment = "tiny.toml"
[[base]]
name       = "trees"
experiment = "tiny.toml"
set.baseline.kind = "boosted_trees"
"#;

/// The polynomial of the calibration trial.
fn still(trial: usize, k: usize) -> [f64; 3] {
    let [q1, q2, _] = inputs(trial, k);
    [0.2 * q1, 0.15 * q2, 0.05 * q1 * q2]
}

/// The same, with x by the wind and y by q1 beside it in all but the calibration trial.
fn planted(trial: usize, k: usize) -> [f64; 3] {
    let ([q1, _, wind], [x, y, z]) = (inputs(trial, k), still(trial, k));
    let moved = f64::from(u8::from(trial > 0));
    [x + 0.03 * wind, y + 0.012 * moved * q1, z]
}

/// With noise of 2 mm in all but the calibration trial, by splitmix64.
fn noisy(trial: usize, k: usize) -> [f64; 3] {
    let noise = |o: u64| {
        let mut z = ((trial * campaign::SAMPLES + k) as u64 * 3 + o + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let [x, y, z] = still(trial, k);
    let size = if trial > 0 { 0.002 } else { 0.0 };
    [x + size * noise(0), y + size * noise(1), z + size * noise(2)]
}

/// Three samples late.
fn late(trial: usize, k: usize) -> [f64; 3] {
    still(trial, k.saturating_sub(3))
}

fn search(campaign: &Campaign, study: &str, out: &str, more: &[&str]) -> (BestRecord, String) {
    campaign.write("best.toml", study);
    let mut command = campaign.program();
    let output = command.args(["--config", "best.toml", "--out", out]).args(more).assert().success();
    let text = String::from_utf8(output.get_output().stdout.clone()).unwrap();
    (read(&campaign.path(out)).unwrap(), text)
}

fn refused(campaign: &Campaign, study: &str, parts: &[&str]) {
    campaign.write("best.toml", study);
    let output = campaign.program().args(["--config", "best.toml", "--out", "refused"]).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(output.status.code(), Some(2), "{told}");
    parts.iter().for_each(|part| assert!(told.contains(part), "no {part:?} in {told}"));
}

fn named<'r>(record: &'r BestRecord, members: &[&str]) -> &'r Candidate {
    let found = record.candidates.iter().find(|candidate| candidate.members == members);
    found.unwrap_or_else(|| panic!("no {members:?} in {:?}", record.candidates))
}

/// Columns of a table of predictions by name, of one part.
fn table(path: &Path, part: &str) -> impl Fn(&str) -> Vec<f64> + use<> {
    let columns = read_parquet(path).unwrap();
    let parts = columns.iter().find_map(|(name, column)| match column {
        Column::Text(text) if name == "part" => Some(text.clone()),
        _ => None,
    });
    let rows: Vec<usize> =
        parts.unwrap().iter().enumerate().filter(|(_, found)| *found == part).map(|(row, _)| row).collect();
    move |wanted: &str| {
        let values = columns.iter().find_map(|(name, column)| match column {
            Column::Number(values) if name == wanted => Some(values),
            _ => None,
        });
        rows.iter().map(|&row| values.unwrap()[row]).collect()
    }
}

/// Oracle: half of both errors is left, so that e² = (e_wind² + e_q1²)/4 on any trial, and the held-out error is that of the
/// mean of the members' own tables, by hand.
#[test]
fn an_average_that_beats_both_members_is_chosen() {
    let campaign = Campaign::with(planted);
    let (record, text) = search(&campaign, STUDY, "best", &[]);
    assert_eq!(record.chosen().members, ["wind", "q1"], "{text}");
    let (wind, q1, mean) = (named(&record, &["wind"]), named(&record, &["q1"]), record.chosen());
    for fold in 0..3 {
        let half = (wind.errors.0[fold].hypot(q1.errors.0[fold])) / 2.0;
        assert!((mean.errors.0[fold] / half - 1.0).abs() < 0.15, "{} and {half} on fold {fold}", mean.errors.0[fold]);
    }
    assert_eq!(record.steps[0].took.as_deref(), Some("q1"), "{:?}", record.steps);
    let mut square = 0.0;
    let of = |member: &str, seed: usize| {
        table(&campaign.path(&format!("best/runs/final-{member}/predictions/final-seed{seed}.parquet")), "held_out")
    };
    let runs = [of("wind", 1), of("wind", 2), of("q1", 1), of("q1", 2)];
    let mut samples = 0;
    for output in ["x", "y", "z"] {
        let measured = runs[0](&format!("measured_{output}"));
        let said = runs.each_ref().map(|run| run(&format!("predicted_{output}")));
        samples = measured.len();
        square += (0..samples)
            .map(|t| (measured[t] - said.iter().map(|values| values[t]).sum::<f64>() / 4.0).powi(2))
            .sum::<f64>();
    }
    let (expected, scores) = ((square / samples as f64).sqrt(), record.winner.held_out.as_ref().unwrap());
    assert!((scores.estimators[WINNER].rmse_total / expected - 1.0).abs() < 1e-12, "{expected}");
    assert!(scores.estimators[WINNER].rmse_total < 0.8 * scores.estimators["nominal"].rmse_total);
    assert!(text.contains("Use mean of wind, q1") && text.contains("synthetic data"), "{text}");
    let table = table(&campaign.path("best/predictions/best.parquet"), "held_out");
    assert_eq!(table("predicted_x").len(), samples);
}

/// Oracle: the errors of the mean of the members' own tables, by hand. Three trials were left out, so the level is 3/4: about as
/// much of the trials is covered, and less by half of the width; and of the held-out samples as many as it says.
#[test]
fn the_average_has_an_interval_of_its_own() {
    let campaign = Campaign::with(planted);
    let (record, text) = search(&campaign, STUDY, "best", &[]);
    assert_eq!(record.chosen().members, ["wind", "q1"], "{text}");
    let intervals = intervals::read(&campaign.path("best")).unwrap().unwrap();
    assert_eq!((intervals.level, intervals.units, intervals.unit.as_str()), (0.75, 3, "trial"));
    assert!(text.contains("75 % intervals, from 3 trials left out in turn"), "{text}");
    let errors = |output: &str, fold: usize| -> Vec<f64> {
        let [wind, q1] = ["wind", "q1"].map(|base| {
            table(&campaign.path(&format!("best/runs/{base}/predictions/fold{fold}-seed1.parquet")), "validation")
        });
        let (measured, said) = (wind(&format!("measured_{output}")), format!("predicted_{output}"));
        let mean = wind(&said).into_iter().zip(q1(&said)).map(|(a, b)| (a + b) / 2.0);
        mean.zip(measured).map(|(said, measured)| (said - measured).abs()).collect()
    };
    let share = |errors: &[f64], width: f64| {
        errors.iter().filter(|error| **error <= width).count() as f64 / errors.len() as f64
    };
    let best = table(&campaign.path("best/predictions/best.parquet"), "held_out");
    for of in intervals.outputs.iter().filter(|of| of.output != "z") {
        let covered = |width: f64| (0..3).map(|fold| share(&errors(&of.output, fold), width)).sum::<f64>() / 3.0;
        let (whole, half) = (covered(of.half_width), covered(0.5 * of.half_width));
        assert!((whole - 0.75).abs() < 0.1 && half < 0.6, "{of:?} covers {whole}, half of it {half}");
        let (said, measured) = (best(&format!("predicted_{}", of.output)), best(&format!("measured_{}", of.output)));
        let left: Vec<f64> = said.iter().zip(&measured).map(|(said, measured)| (said - measured).abs()).collect();
        assert!((share(&left, of.half_width) - of.held_out.unwrap()).abs() < 1e-12, "{of:?}");
    }
}

/// The same without averages: one of the two, which is worse.
#[test]
fn without_averages_a_single_one_is_chosen() {
    let campaign = Campaign::with(planted);
    let (averaged, _) = search(&campaign, STUDY, "averaged", &[]);
    let (single, _) = search(&campaign, &format!("{STUDY}[best]\naverage = 1\n"), "single", &[]);
    assert_eq!(single.chosen().members.len(), 1);
    assert!(single.steps.is_empty() && single.chosen().mean > 1.05 * averaged.chosen().mean);
    let errors = |record: &BestRecord| record.candidates[..3].iter().map(|one| one.errors.clone()).collect::<Vec<_>>();
    assert!(errors(&single) == errors(&averaged) && single.candidates.len() == 3);
}

#[test]
fn where_there_is_nothing_to_learn_the_nominal_model_is_chosen() {
    let campaign = Campaign::with(noisy);
    let (record, text) = search(&campaign, &format!("{STUDY}{NETWORK}"), "best", &[]);
    assert_eq!(record.chosen().members, ["nominal"], "{text}");
    assert_eq!(record.chosen().numbers, 0);
    let scores = &record.winner.held_out.as_ref().unwrap().estimators;
    assert_eq!(scores[WINNER], scores["nominal"]);
    assert!(
        !campaign
            .path("best/runs")
            .read_dir()
            .unwrap()
            .any(|entry| { entry.unwrap().file_name().to_string_lossy().starts_with("final") }),
        "something was trained to the end"
    );
}

/// Measured outputs of held-out trials times 1000: every fold, candidate and step keeps its bits.
#[test]
fn held_out_trials_choose_nothing() {
    let (campaign, scaled) = (Campaign::with(planted), Campaign::with(planted));
    for trial in ["h1", "h2"] {
        let file = format!("data/{trial}.csv");
        let text = String::from_utf8(scaled.read(&file)).unwrap();
        let row = |line: &str| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let times = |(c, cell): (usize, &f64)| (if c < 4 { *cell } else { 1000.0 * cell }).to_string();
            cells.iter().enumerate().map(times).collect::<Vec<_>>().join(",")
        };
        let rows: Vec<String> = text.lines().skip(1).map(row).collect();
        scaled.write(&file, &format!("t,q1,q2,wind,x,y,z\n{}\n", rows.join("\n")));
    }
    let study = format!("{STUDY}{NETWORK}");
    let ((a, _), (b, _)) = (search(&campaign, &study, "best", &[]), search(&scaled, &study, "best", &[]));
    assert_ne!(a.data.hash, b.data.hash);
    assert!(a.candidates == b.candidates && a.steps == b.steps && a.optimism == b.optimism);
    let error = |record: &BestRecord| record.winner.held_out.as_ref().unwrap().estimators[WINNER].rmse_total;
    assert!(error(&b) > 100.0 * error(&a), "the held-out trials were not scaled");
    let weights = |of: &Campaign| of.read("best/runs/gru/checkpoints/fold0-seed1.safetensors");
    assert!(weights(&campaign) == weights(&scaled));
}

/// The same bits on one job and on three, and after a stop in the middle.
#[test]
fn jobs_and_stops_change_no_bit() {
    let campaign = Campaign::with(planted);
    let study = format!("{STUDY}{NETWORK}");
    search(&campaign, &study, "one", &["--jobs", "1"]);
    search(&campaign, &study, "three", &["--jobs", "3"]);
    let said = |out: &str| {
        (campaign.read(&format!("{out}/best.json")), campaign.read(&format!("{out}/predictions/best.parquet")))
    };
    assert!(said("one") == said("three"));
    fs::remove_file(campaign.path("three/best.json")).unwrap();
    fs::remove_file(campaign.path("three/runs/gru/records/fold1-seed2.json")).unwrap();
    fs::remove_dir_all(campaign.path("three/runs/final-trees")).unwrap();
    search(&campaign, &study, "three", &["--resume"]);
    assert!(said("one") == said("three"), "going on gives other bits");
}

#[test]
fn without_final_runs_nothing_is_trained_to_the_end_and_no_held_out_trial_is_read() {
    let campaign = Campaign::with(planted);
    let (record, text) =
        search(&campaign, &format!("{STUDY}[set.protocol]\ncross_validation = true\nfinal = false\n"), "best", &[]);
    assert_eq!((record.winner.held_out, record.winner.predictions), (None, None));
    assert!(!campaign.path("best/runs/final-q1").exists() && text.contains("No held-out trial was read"), "{text}");
}

/// The model with the dead time that was planted, as a closed loop saves it.
fn save(campaign: &Campaign) {
    let data = acm_datasets::Campaign::read(&campaign.path("data"), None).unwrap();
    let calibration: Vec<&Trial> = data.trials(Role::Calibration).collect();
    let fitted = calibrate(&NominalSpec::Polynomial { degree: 3 }, &data.observations(&calibration)).unwrap();
    let all: Vec<&Trial> = data.trials.iter().collect();
    let (effect, values) = ("dead_time".into(), vec![0.3]);
    let dead_time = Term { effect, carrier: Carrier::Rig, context: None, values, definition: None };
    let model = AugmentedModel::new(rig(&data, &all), fitted.model, None, None, vec![dead_time]).unwrap();
    let model = model.clone().with_origin(origin(&model, &data));
    campaign.write("model.json", str::from_utf8(&hashed::encode(&model).unwrap()).unwrap());
}

/// A campaign whose tip is late in all but the calibration trial, with the model that knows.
fn delayed() -> Campaign {
    let campaign = Campaign::with(|trial, k| if trial > 0 { late(trial, k) } else { still(trial, k) });
    save(&campaign);
    campaign
}

/// Planted: the delay is the whole truth, and one number tells it.
#[test]
fn the_loops_model_is_chosen_where_it_is_the_truth() {
    let campaign = delayed();
    let (record, text) = search(&campaign, &format!("{STUDY}[best]\nloop = \"model.json\"\n"), "best", &[]);
    let names: Vec<String> = record.candidates[..6].iter().map(Candidate::name).collect();
    assert_eq!(names, ["nominal", "wind", "q1", "loop", "wind + loop", "q1 + loop"]);
    assert_eq!((record.chosen().members.as_slice(), record.chosen().numbers), (&["loop".to_string()][..], 1), "{text}");
    let scores = &record.winner.held_out.as_ref().unwrap().estimators;
    assert!(scores[WINNER].rmse_total < 1e-9 && scores["nominal"].rmse_total > 0.02, "{scores:?}");
    assert!(text.contains("fitted on trials that the folds leave out"), "{text}");
}

/// With a model for each fold, the same model here: nothing is flattered, and the errors are the same.
#[test]
fn a_model_of_the_loop_for_each_fold_takes_its_place_there() {
    let campaign = delayed();
    let (whole, _) = search(&campaign, &format!("{STUDY}[best]\nloop = \"model.json\"\n"), "whole", &[]);
    let each = "[best]\nloop = \"model.json\"\nloop_folds = [\"model.json\", \"model.json\", \"model.json\"]\n";
    let (folds, text) = search(&campaign, &format!("{STUDY}{each}"), "folds", &[]);
    assert!(folds.candidates == whole.candidates && folds.notes.is_empty(), "{text}");
    assert!(campaign.path("folds/runs/wind-loop-fold2/records/fold0-seed1.json").exists());
    refused(
        &campaign,
        &format!("{STUDY}{}", each.replacen("\"model.json\", ", "", 2)),
        &["names 1 models", "d1 | d2 | d3"],
    );
}

#[test]
fn what_cannot_be_compared_is_refused_with_its_place() {
    let campaign = Campaign::new();
    let other = STUDY.replace("inputs.channels = [\"q1\"] }", "inputs.channels = [\"q1\"], windows.reach = 7 }");
    refused(&campaign, &other, &["another `windows.reach` than the first", "[set]"]);
    refused(
        &campaign,
        &format!("{STUDY}[best]\nloop = \"lost.json\"\n"),
        &["`best.loop` is \"lost.json\"", "acm-eval close-loop"],
    );
    refused(&campaign, &STUDY.replace("\"wind\"\nexp", "\"loop\"\nexp"), &["without anything learned"]);
    refused(&campaign, &format!("{STUDY}[best]\naverage = 0\n"), &["best.average", "1 to 8"]);
    refused(&campaign, &format!("{STUDY}[[variant]]\nname = \"a\"\n"), &["variant", "under the same folds"]);
}
