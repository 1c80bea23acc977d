//! Tables against hand arithmetic on made-up runs (see `fixture`).

mod fixture;

use std::path::Path;

use acm_eval::report::Report;
use fixture::{Fixture, write};

fn report(fixtures: &[(&Fixture, &str)], root: &Path) -> Report {
    let folders: Vec<_> = fixtures.iter().map(|(fixture, name)| write(fixture, root, name)).collect();
    Report::of(&folders, "acm-eval report".into()).unwrap()
}

/// The fields of the row of a CSV table that starts with `start`.
fn row(csv: &str, start: &str) -> Vec<f64> {
    let line = csv.lines().find(|line| line.starts_with(start)).unwrap_or_else(|| panic!("no row {start} in\n{csv}"));
    line[start.len()..].split(',').skip(1).map(|field| field.parse().unwrap_or(f64::NAN)).collect()
}

fn csv(report: &Report, table: &str) -> String {
    report.chapters[0].tables.iter().find(|found| found.name == table).expect("table").csv()
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() < 1e-9 || (f.is_nan() && e.is_nan()), "{found:?} is not {expected:?}");
    }
}

/// Oracle: hand arithmetic. Seeds 1, 2, 3 have errors 1, 2, 3 times (0.5, 1, 1, 1.5)·√2.5 mm: mean 2 times, sd 1 time.
#[test]
fn errors_are_mean_and_sample_sd_over_seeds_in_mm() {
    let root = tempfile::tempdir().unwrap();
    let csv = csv(&report(&[(&Fixture::default(), "cfc")], root.path()), "errors");
    let heading = "Model,x [mm],sd of x [mm],y [mm],sd of y [mm],z [mm],sd of z [mm],3-D [mm],sd of 3-D [mm],\
                   Improvement [%],sd of Improvement [%]";
    assert_eq!(csv.lines().next().unwrap(), heading);
    let none = f64::NAN;
    close(&row(&csv, "Nominal"), &[3.0, none, 4.0, none, 12.0, none, 13.0, none, none, none]);
    close(&row(&csv, "Polynomial"), &[0.0, none, 3.0, none, 4.0, none, 5.0, none, 100.0 * 8.0 / 13.0, none]);
    let r = 2.5_f64.sqrt();
    let gone = [1.0, 2.0, 3.0].map(|s| 100.0 * (1.0 - 1.5 * s * r / 13.0));
    let sd = 100.0 * 1.5 * r / 13.0;
    close(&row(&csv, "CfC"), &[r, 0.5 * r, 2.0 * r, r, 2.0 * r, r, 3.0 * r, 1.5 * r, gone[1], sd]);
}

/// Oracle: R² = 1 − e²/r² for zero-mean sines: x of the network is 1 − (0.5·s)²·2.5/9.
#[test]
fn r2_is_mean_and_sample_sd_over_seeds() {
    let root = tempfile::tempdir().unwrap();
    let csv = csv(&report(&[(&Fixture::default(), "cfc")], root.path()), "explained");
    let r2 = [1.0, 2.0, 3.0].map(|s: f64| 1.0 - 0.25 * s * s * 2.5 / 9.0);
    let mean = r2.iter().sum::<f64>() / 3.0;
    let sd = (r2.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
    close(&row(&csv, "CfC")[..2], &[mean, sd]);
}

/// Oracle: on trial 10 the 3D error is 1.5·s mm, on trial 11 twice that.
#[test]
fn each_held_out_trial_has_its_own_rows() {
    let root = tempfile::tempdir().unwrap();
    let csv = csv(&report(&[(&Fixture::default(), "cfc")], root.path()), "trials");
    close(&row(&csv, "10,CfC")[..9], &[120.0, 1.0, 0.5, 2.0, 1.0, 2.0, 1.0, 3.0, 1.5]);
    close(&row(&csv, "11,CfC")[7..9], &[6.0, 3.0]);
    close(&row(&csv, "11,Nominal")[7..9], &[13.0, f64::NAN]);
}

/// Oracle: folds 0 and 1 have errors of 1.5 and 3 mm on trial 7: mean 2.25, sd 1.5/√2.
#[test]
fn folds_have_a_column_each_and_a_mean() {
    let root = tempfile::tempdir().unwrap();
    let folds = Fixture { seeds: vec![], folds: 2, ..Fixture::default() };
    let report = report(&[(&folds, "cfc")], root.path());
    close(&row(&csv(&report, "folds"), "CfC")[..4], &[1.5, 3.0, 2.25, 1.5 / 2.0_f64.sqrt()]);
    assert!(!report.chapters[0].tables.iter().any(|table| table.name == "errors"), "nothing was held out");
}

/// Baselines that are the same for all runs have one row; each network has its own. Bold is what seeds tell apart.
#[test]
fn several_runs_share_one_table() {
    let root = tempfile::tempdir().unwrap();
    let gru = Fixture { kind: "gru", gain: 2.0, ..Fixture::default() };
    let report = report(&[(&gru, "gru"), (&Fixture::default(), "cfc")], root.path());
    let csv = csv(&report, "errors");
    let labels: Vec<&str> = csv.lines().skip(1).map(|line| line.split(',').next().unwrap()).collect();
    assert_eq!(labels, ["Nominal", "Polynomial", "GRU", "CfC", "Memoryless floor", "Oracle floor"]);
    let r = 2.5_f64.sqrt();
    close(&row(&csv, "GRU")[6..8], &[6.0 * r, 3.0 * r]);
    close(&row(&csv, "Memoryless floor")[..8], &[1.25, f64::NAN, 1.5, f64::NAN, 1.6, f64::NAN, 2.5, f64::NAN]);
    // Seeds 1, 2 and 3 err by s and 2·s: the differences to GRU, 1.5·√2.5·(1, 2, 3) mm, have an interval that holds zero.
    let html = acm_eval::page::html(&report);
    assert!(
        html.contains("4.7 ± 2.4") && !html.contains("<b>4.7 ± 2.4</b>"),
        "the seeds do not tell GRU and CfC apart"
    );
}

/// Outside baselines have rows and colours of their own, beside networks.
#[test]
fn outside_baselines_are_named_in_words() {
    let root = tempfile::tempdir().unwrap();
    let [ridge, trees] = ["ridge", "boosted_trees"].map(|kind| Fixture { kind, seeds: vec![1], ..Fixture::default() });
    let report = report(&[(&ridge, "ridge"), (&trees, "trees"), (&Fixture::default(), "cfc")], root.path());
    let csv = csv(&report, "errors");
    let r = 2.5_f64.sqrt();
    for label in ["Ridge on lagged inputs", "Boosted trees"] {
        close(&row(&csv, label)[6..8], &[1.5 * r, f64::NAN]);
    }
    let runs = ["ridge", "trees", "cfc"].map(|name| acm_eval::run::Run::read(&root.path().join(name)).unwrap());
    let section = &acm_eval::section::sections(runs.into()).unwrap()[0];
    let colours: std::collections::BTreeSet<_> = section.estimators.iter().map(|e| e.colour).collect();
    assert_eq!(colours.len(), 5, "nominal, polynomial, three that learn");
    let html = acm_eval::page::html(&report);
    assert!(html.contains("a ridge regression is a penalty") && html.contains("boosted trees is a round"));
}

/// Two runs of one kind are distinguished by the names of their folders.
#[test]
fn runs_of_one_kind_carry_their_names() {
    let root = tempfile::tempdir().unwrap();
    let short = Fixture { gain: 1.25, ..Fixture::default() };
    let csv = csv(&report(&[(&Fixture::default(), "cfc"), (&short, "cfc-short")], root.path()), "errors");
    assert!(csv.contains("\nCfC (cfc),") && csv.contains("\nCfC (cfc-short),"), "{csv}");
}

#[test]
fn calibration_has_units_and_digits_that_its_sd_justifies() {
    let root = tempfile::tempdir().unwrap();
    let report = report(&[(&Fixture::default(), "cfc")], root.path());
    let html = acm_eval::page::html(&report);
    assert!(html.contains("1.235 ± 0.012") && html.contains("rad/(m·q)"));
    assert!(csv(&report, "calibration").contains("A1[q1],1.23456,0.0123,rad/(m·q)"));
    assert!(csv(&report, "stages").contains("parameters settled"));
}

#[test]
fn samples_are_counted_by_role_and_reason() {
    let root = tempfile::tempdir().unwrap();
    let csv = csv(&report(&[(&Fixture::default(), "cfc")], root.path()), "data");
    let expected = "Trial,Role,Samples used,Dropped: outside hull\n17,calibration,20,0\n7,development,120,3\n\
                    10,held out,120,0\n11,held out,120,4\nall,,380,7\n";
    assert_eq!(csv, expected);
}
