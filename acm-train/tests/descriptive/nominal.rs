//! The nominal study of the embedded campaign.

use super::{Table, agrees, close, conduct, study};

/// Oracle: every error computed again from the tables, by loops of this test.
#[test]
fn each_number_can_be_computed_from_the_tables() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("nominal");
    let printed = conduct("nominal.toml", &out);
    let said = study(&out);
    let orders = &said["orders"];
    assert_eq!((&orders["trial"], &orders["plane"]), (&"17".into(), &serde_json::json!(["x", "z"])));
    let tables = ["bins", "orders"].map(|name| Table::read(&out.join(format!("predictions/{name}.parquet"))));
    for row in orders["rows"].as_array().unwrap() {
        for protocol in ["frozen", "refitted"] {
            let estimate = format!("order{}_{protocol}", row["order"]);
            for (table, kind) in tables.iter().zip(["binned", "raw"]) {
                let rows: Vec<usize> = (0..table.numbers("measured_x").len()).collect();
                close(&row[protocol][kind], table.rms("measured", &estimate, &["x", "z"], &rows), &estimate);
            }
        }
    }
    let table = Table::read(&out.join("predictions/calibration.parquet"));
    for model in said["models"].as_array().unwrap() {
        let key = model["key"].as_str().unwrap();
        for (part, estimate) in [("fitted", key.to_string()), ("left_out", format!("left_out_{key}"))] {
            agrees(&model[part]["all"], &table, &estimate, &table.rows(|_| true), &estimate);
            for trial in model[part]["trials"].as_array().unwrap() {
                let rows = table.rows(|name| name == trial["trial"]);
                agrees(&trial["rms"], &table, &estimate, &rows, &format!("{estimate}, trial {}", trial["trial"]));
            }
        }
    }
    let counts = said["models"].as_array().unwrap().iter().map(|model| model["parameters"].as_array().unwrap().len());
    assert_eq!(counts.collect::<Vec<_>>(), [30, 20, 20], "polynomial, strain in two steps, strain joint");
    for part in ["synthetic data", "trial 17", "left out", "Polynomial, degree 3", "30", "20"] {
        assert!(printed.contains(part), "`{part}` is not in\n{printed}");
    }
}

/// Oracle: the bins of the order study, made again from its samples.
#[test]
fn the_bins_are_means_of_the_samples() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("nominal");
    conduct("nominal.toml", &out);
    let [bins, samples] = ["bins", "orders"].map(|name| Table::read(&out.join(format!("predictions/{name}.parquet"))));
    let q = samples.numbers("actuator_q1");
    let (low, high) = q.iter().fold((f64::MAX, f64::MIN), |(low, high), &q| (low.min(q), high.max(q)));
    let mut sums = vec![(0.0, 0.0, 0.0); 40];
    for (row, &q) in q.iter().enumerate() {
        let bin = ((40.0 * (q - low) / (high - low)).floor() as usize).min(39);
        sums[bin].0 += 1.0;
        sums[bin].1 += q;
        sums[bin].2 += samples.numbers("measured_z")[row];
    }
    sums.retain(|sum| sum.0 >= 3.0);
    assert_eq!(bins.numbers("samples"), sums.iter().map(|sum| sum.0).collect::<Vec<_>>());
    for (bin, (n, q, z)) in sums.into_iter().enumerate() {
        assert!((bins.numbers("actuator_q1")[bin] - q / n).abs() < 1e-12);
        assert!((bins.numbers("measured_z")[bin] - z / n).abs() < 1e-12);
    }
}

#[test]
fn the_same_question_gives_the_same_bytes_and_another_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("nominal");
    conduct("nominal.toml", &out);
    let bytes = |name: &str| std::fs::read(out.join(name)).unwrap();
    let files = ["study.json", "predictions/bins.parquet", "predictions/calibration.parquet"];
    let before = files.map(bytes);
    let file = std::path::absolute("../experiments/nominal.toml").unwrap();
    let run = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("acm-train"));
        command.arg("--config").arg(&file).arg("--out").arg(&out).args(arguments).output().unwrap()
    };
    assert!(run(&["--resume"]).status.success());
    assert!(before == files.map(bytes));
    let refused = run(&[]);
    assert!(refused.status.code() == Some(2) && String::from_utf8_lossy(&refused.stderr).contains("--resume"));
    let other = run(&["--resume", "--set", "nominal_study.bins=30"]);
    assert!(String::from_utf8_lossy(&other.stderr).contains("asked.bins is 40 there and 30 here"));
    assert!(before == files.map(bytes));
}
