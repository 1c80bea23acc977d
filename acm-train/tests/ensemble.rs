//! An ensemble says the mean of networks that were trained by themselves.

mod campaign;

use acm_datasets::files::table::{Column, read_parquet};
use acm_train::run::record::RunRecord;
use campaign::{Campaign, bytes_below};

/// Seeds of three members of seed 1.
const SEEDS: [u64; 3] = [1, 1 + (1 << 32), 1 + (2 << 32)];

/// Every predicted output, sample after sample.
fn predicted(campaign: &Campaign, out: &str, record: &RunRecord) -> Vec<f64> {
    let table = read_parquet(&campaign.path(out).join(&record.predictions)).unwrap();
    let columns = table.into_iter().filter(|(name, _)| name.starts_with("predicted_"));
    let numbers = columns.flat_map(|(_, column)| match column {
        Column::Number(values) => values,
        Column::Text(_) => panic!("column types"),
    });
    numbers.collect()
}

/// Oracle: three runs without an ensemble, one for each seed, and the mean of their tables.
#[test]
fn the_mean_of_its_members_is_the_prediction() {
    let campaign = Campaign::new();
    let random = ["--set", "training.output_layer=random", "--set", "protocol.validation_fold=0"];
    let seeds = format!("protocol.seeds=[{}, {}, {}]", SEEDS[0], SEEDS[1], SEEDS[2]);
    let alone = campaign.learn("alone", &[&random[..], &["--set", &seeds]].concat());
    let one = ["--set", "training.ensemble=3", "--set", "protocol.seeds=[1]"];
    let [record] = &campaign.learn("together", &[&random[..], &one].concat())[..] else { panic!("one row") };
    assert_eq!(record.members.iter().map(|member| member.seed).collect::<Vec<_>>(), SEEDS);
    assert_eq!((record.parameters, record.factor), (3 * alone[0].parameters, 1.0));
    let each: Vec<Vec<f64>> = alone.iter().map(|record| predicted(&campaign, "alone", record)).collect();
    let together = predicted(&campaign, "together", record);
    assert!(each[0].iter().zip(&each[1]).any(|(a, b)| a != b), "the members differ");
    for (k, mean) in together.iter().enumerate() {
        let oracle = (each[0][k] + each[1][k] + each[2][k]) / 3.0;
        assert!((mean - oracle).abs() < 1e-12, "sample {k}: {mean} and {oracle}");
    }
    for (member, alone) in record.members.iter().zip(&alone) {
        assert_eq!((&member.epochs, member.best_epoch), (&alone.epochs, alone.best_epoch));
    }
}

/// Folds and final runs, stopped in the middle: without a record, and without the last member.
#[test]
fn an_ensemble_goes_on_with_the_member_that_it_lacks() {
    let campaign = Campaign::new();
    let edits = ["--set", "training.ensemble=2", "--set", "protocol.cross_validation=true"];
    let records = campaign.learn("run", &edits);
    assert_eq!(records.len(), 8);
    assert!(records.iter().all(|record| record.members.len() == 2 && (0.0..=1.0).contains(&record.factor)));
    let whole = bytes_below(&campaign.path("run"));
    std::fs::remove_file(campaign.path("run/records/final-seed1.json")).unwrap();
    std::fs::remove_file(campaign.path("run/checkpoints/final-seed1-member1.safetensors")).unwrap();
    campaign.learn("run", &[&edits[..], &["--resume"]].concat());
    assert!(whole == bytes_below(&campaign.path("run")));
}

#[test]
fn an_ensemble_of_none_is_refused() {
    let campaign = Campaign::new();
    let output = campaign.command(&["--set", "training.ensemble=0"]).assert().code(2).get_output().clone();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("training.ensemble") && said.contains("for example 5"), "{said}");
}
