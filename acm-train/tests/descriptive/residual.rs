//! The residual study of the embedded campaign.

use super::{Table, agrees, close, conduct, study};

/// Oracle: the campaign's plan, 1–12 hover: four altitudes in threes, three slices of q2 in turn.
const ALTITUDES: [(f64, [&str; 3]); 4] =
    [(0.98, ["10", "11", "12"]), (1.30, ["1", "2", "3"]), (1.65, ["4", "5", "6"]), (2.00, ["7", "8", "9"])];

/// Oracle: every number computed again from the table, by loops of this test.
#[test]
fn each_number_can_be_computed_from_the_table() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("residual");
    let printed = conduct("residual.toml", &out);
    let (said, table) = (study(&out), Table::read(&out.join("predictions/residual.parquet")));
    agrees(&said["overall"], &table, "nominal", &table.rows(|_| true), "overall");
    for (role, names) in [("development", 1..=9), ("held_out", 10..=12)] {
        let rows = table.rows(|name| names.contains(&name.parse().unwrap()));
        let part = said["roles"].as_array().unwrap().iter().find(|part| part["role"] == role).unwrap();
        agrees(&part["rms"], &table, "nominal", &rows, role);
    }
    for trial in said["trials"].as_array().unwrap() {
        let rows = table.rows(|name| name == trial["trial"]);
        agrees(&trial["rms"], &table, "nominal", &rows, "trial");
        let mean = |values: &[f64]| rows.iter().map(|&row| values[row]).sum::<f64>() / rows.len() as f64;
        close(&trial["altitude"], mean(table.numbers("altitude")), "altitude");
        close(&trial["mean"][2], mean(table.numbers("measured_z")) - mean(table.numbers("nominal_z")), "mean");
    }
    let groups = said["altitudes"].as_array().unwrap();
    assert_eq!(groups.len(), 4);
    for (group, (altitude, trials)) in groups.iter().zip(ALTITUDES) {
        assert_eq!(group["trials"], serde_json::json!(trials));
        assert!((group["altitude"].as_f64().unwrap() - altitude).abs() < 0.02, "{group}");
        agrees(&group["rms"], &table, "nominal", &table.rows(|name| trials.contains(&name)), "altitude");
    }
    for part in ["synthetic data", "Held-out trials are among", "altitude 1.65 m", "q2 = 2.80 rad"] {
        assert!(printed.contains(part), "`{part}` is not in\n{printed}");
    }
}

/// Oracle: bins made again from the table; the same limits for all slices.
#[test]
fn the_curves_are_means_and_spreads_in_bins() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("residual");
    conduct("residual.toml", &out);
    let (said, table) = (study(&out), Table::read(&out.join("predictions/residual.parquet")));
    let (count, least) = (24, 10);
    let q = table.numbers("actuator_q1");
    let (low, high) = q.iter().fold((f64::MAX, f64::MIN), |(low, high), &q| (low.min(q), high.max(q)));
    let width = (high - low) / count as f64;
    close(&said["middle"], 0.5 * (low + high), "middle");
    let slices = said["slices"].as_array().unwrap();
    assert_eq!(slices.len(), 3);
    for (place, slice) in slices.iter().enumerate() {
        let rows = table.rows(|name| (name.parse::<usize>().unwrap() - 1) % 3 == place);
        agrees(&slice["rms"], &table, "nominal", &rows, "slice");
        let mut members = vec![vec![]; count];
        for row in rows {
            // Encoders count in steps, so samples lie on the limits: the quotient is the documented one.
            members[((q[row] - low) / width).floor().min(count as f64 - 1.0) as usize].push(row);
        }
        members.retain(|bin| bin.len() >= least);
        let bins = slice["bins"].as_array().unwrap();
        assert_eq!(bins.len(), members.len());
        for (bin, rows) in bins.iter().zip(&members) {
            let n = rows.len() as f64;
            close(&bin["q"], rows.iter().map(|&row| q[row]).sum::<f64>() / n, "q");
            for (o, output) in ["x", "y", "z"].into_iter().enumerate() {
                let (measured, nominal) =
                    (table.numbers(&format!("measured_{output}")), table.numbers(&format!("nominal_{output}")));
                let mean = rows.iter().map(|&row| measured[row] - nominal[row]).sum::<f64>() / n;
                let squares: f64 = rows.iter().map(|&row| (measured[row] - nominal[row] - mean).powi(2)).sum();
                close(&bin["mean"][o], mean, "mean");
                close(&bin["sd"][o], (squares / (n - 1.0)).sqrt(), "sd");
            }
        }
    }
}

/// Oracle: an arm of 0.62 m that begins at the attachment and ends where the nominal model says the tip is. A bin is
/// curved, so the mean of its tips is off by some millimetres.
#[test]
fn the_arms_reach_from_the_base_to_the_nominal_tip() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("residual");
    conduct("residual.toml", &out);
    let (said, table) = (study(&out), Table::read(&out.join("predictions/residual.parquet")));
    let arms = said["backbones"].as_array().unwrap();
    assert_eq!(arms.len(), 3 * 5);
    for arm in arms {
        let points: Vec<[f64; 3]> = serde_json::from_value(arm["points"].clone()).unwrap();
        let length: f64 = points.windows(2).map(|pair| distance(&pair[0], &pair[1])).sum();
        assert!(distance(&points[0], &[0.0; 3]) < 1e-12 && (length - 0.62).abs() < 2e-3, "{length}");
        let slice = arm["slice"].as_u64().unwrap() as usize;
        let q = said["slices"][slice]["bins"][arm["bin"].as_u64().unwrap() as usize]["q"].as_f64().unwrap();
        let near = |row: &usize| (table.numbers("actuator_q1")[*row] - q).abs() < 0.02;
        let rows: Vec<usize> =
            table.rows(|name| (name.parse::<usize>().unwrap() - 1) % 3 == slice).into_iter().filter(near).collect();
        let mean = |o: &str| {
            let nominal = table.numbers(&format!("nominal_{o}"));
            rows.iter().map(|&row| nominal[row]).sum::<f64>() / rows.len() as f64
        };
        let off = distance(points.last().unwrap(), &["x", "y", "z"].map(mean));
        assert!(!rows.is_empty() && off < 0.015, "slice {slice}, q = {q}: {off} m");
    }
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|o| (a[o] - b[o]).powi(2)).sum::<f64>().sqrt()
}
