//! Errors, means, spreads and differences of the study tables, from the tables of predictions alone.
//!
//! Oracle: the definitions, in loops over rows; quantiles of Student's distribution from printed tables. Nothing of the
//! evaluator is used but the reader of Parquet files.

use std::path::Path;

use acm_datasets::files::table::{Column, read_parquet};

use super::{conducted::folder, csv::Csv};

/// 97.5 % quantiles of Student's distribution with 2 and 5 degrees of freedom.
const T2: f64 = 4.302_652_729_7;
const T5: f64 = 2.570_581_836_6;

/// RMSE in mm of x, y, z and of the distance, of `estimate` on a part of a run.
fn errors(run: &Path, id: &str, part: &str, estimate: &str) -> [f64; 4] {
    let table = read_parquet(&run.join(format!("predictions/{id}.parquet"))).unwrap();
    let column = |name: &str| &table.iter().find(|(known, _)| known == name).unwrap().1;
    let Column::Text(parts) = column("part") else { panic!("part is text") };
    let number = |name: String| match column(&name) {
        Column::Number(values) => values.clone(),
        Column::Text(_) => panic!("{name} is text"),
    };
    let mut squares = [0.0; 4];
    let rows: Vec<usize> = (0..parts.len()).filter(|&row| parts[row] == part).collect();
    for (o, output) in ["x", "y", "z"].into_iter().enumerate() {
        let (measured, estimated) = (number(format!("measured_{output}")), number(format!("{estimate}_{output}")));
        for &row in &rows {
            let error = 1e3 * (measured[row] - estimated[row]);
            squares[o] += error * error;
            squares[3] += error * error;
        }
    }
    squares.map(|sum| (sum / rows.len() as f64).sqrt())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn sd(values: &[f64]) -> f64 {
    (values.iter().map(|v| (v - mean(values)).powi(2)).sum::<f64>() / (values.len() - 1) as f64).sqrt()
}

fn close(found: f64, expected: f64, what: &str) {
    assert!(
        (found - expected).abs() < 1e-6 * expected.abs().max(1.0),
        "{what}: {found} in the table, {expected} again"
    );
}

/// The 3-D error, then x, y and z, each mean and sd.
fn check_errors(csv: &Csv, row: &[String], runs: &[[f64; 4]], what: &str) {
    for (heading, component) in [("3-D [mm]", 3), ("x [mm]", 0), ("y [mm]", 1), ("z [mm]", 2)] {
        let values: Vec<f64> = runs.iter().map(|errors| errors[component]).collect();
        close(csv.number(row, heading, 0), mean(&values), &format!("{what}, {heading}"));
        close(csv.number(row, &format!("sd of {heading}"), 0), sd(&values), &format!("{what}, sd of {heading}"));
    }
}

/// Difference b − a in pairs, with its interval.
fn check_difference(csv: &Csv, row: &[String], a: &[[f64; 4]], b: &[[f64; 4]], t: f64, what: &str) {
    let differences: Vec<f64> = a.iter().zip(b).map(|(a, b)| b[3] - a[3]).collect();
    let reach = t * sd(&differences) / (differences.len() as f64).sqrt();
    let base = mean(&a.iter().map(|errors| errors[3]).collect::<Vec<_>>());
    close(csv.number(row, "Difference [mm]", 0), mean(&differences), what);
    close(csv.number(row, "Difference [%]", 0), 100.0 * mean(&differences) / base, what);
    close(csv.number(row, "95 % from [mm]", 0), mean(&differences) - reach, what);
    close(csv.number(row, "to [mm]", 0), mean(&differences) + reach, what);
}

#[test]
fn the_ablation() {
    let csv = Csv::read(folder(), "ablation-ablation");
    let runs = |id: &str| -> Vec<[f64; 4]> {
        let run = folder().join("ablation/runs").join(id);
        let ids = (0..3).flat_map(|fold| [1, 2].map(|seed| format!("fold{fold}-seed{seed}")));
        ids.map(|id| errors(&run, &id, "validation", "predicted")).collect()
    };
    let all = runs("mlp-all-inputs");
    assert_eq!(csv.rows.len(), 3);
    for (name, id) in [
        ("all inputs", "mlp-all-inputs"),
        ("without throttle", "mlp-without-throttle"),
        ("q2 shuffled", "mlp-q2-shuffled"),
    ] {
        let (row, runs) = (csv.row(&["MLP", name]), runs(id));
        check_errors(&csv, row, &runs, name);
        if id != "mlp-all-inputs" {
            check_difference(&csv, row, &all, &runs, T5, name);
        }
    }
}

#[test]
fn the_sweep() {
    let csv = Csv::read(folder(), "sweep-settings");
    let member = |hidden: &str, rate: &str| -> Vec<[f64; 4]> {
        let run = folder().join(format!("sweep/runs/mlp-hidden-{hidden}-learning-rate-{rate}"));
        (0..3).map(|fold| errors(&run, &format!("fold{fold}-seed1"), "validation", "predicted")).collect()
    };
    let best = csv.rows[0].clone();
    let of = |row: &[String]| member(row[1].trim_matches(['[', ']']), &row[2]);
    let mut before = 0.0;
    for row in &csv.rows {
        let runs = of(row);
        check_errors(&csv, row, &runs, &row[..3].join(" "));
        let error = mean(&runs.iter().map(|errors| errors[3]).collect::<Vec<_>>());
        assert!(error >= before, "the smallest error stands first");
        before = error;
        if *row != best {
            check_difference(&csv, row, &of(&best), &runs, T2, &row[..3].join(" "));
        }
    }
    assert_eq!(csv.rows.len(), 4);
}

#[test]
fn the_comparison() {
    let run = |base: &str, variant: &str| folder().join(format!("comparison/runs/{base}-trials-{variant}"));
    let of = |base: &str, variant: &str, seeds: &[u64], estimate: &str| -> Vec<[f64; 4]> {
        let held_out = |seed| errors(&run(base, variant), &format!("final-seed{seed}"), "held_out", estimate);
        seeds.iter().map(held_out).collect()
    };
    let totals = |errors: &[[f64; 4]]| errors.iter().map(|e| e[3]).collect::<Vec<f64>>();
    let main = Csv::read(folder(), "comparison-errors");
    let mlp = of("mlp", "10-12", &[1, 2, 3], "predicted");
    check_errors(&main, main.row(&["MLP"]), &mlp, "MLP");
    let nominal = of("mlp", "10-12", &[1], "nominal")[0];
    close(main.number(main.row(&["Nominal"]), "3-D [mm]", 0), nominal[3], "nominal");
    let gains: Vec<f64> = totals(&mlp).iter().map(|total| 100.0 * (1.0 - total / nominal[3])).collect();
    close(main.number(main.row(&["MLP"]), "Improvement [%]", 0), mean(&gains), "improvement");
    let protocols = Csv::read(folder(), "comparison-protocols");
    let pairs = Csv::read(folder(), "comparison-pairs");
    for variant in ["10-12", "1-3"] {
        let title = format!("trials {}", variant.replace('-', "–"));
        let heading = format!("{title} [mm]");
        let mlp = totals(&of("mlp", variant, &[1, 2, 3], "predicted"));
        let ridge = of("ridge", variant, &[1], "predicted")[0][3];
        close(protocols.number(protocols.row(&["MLP"]), &heading, 0), mean(&mlp), &heading);
        close(protocols.number(protocols.row(&["Ridge"]), &heading, 0), ridge, &heading);
        let (better, worse, sign) = if ridge < mean(&mlp) { ("Ridge", "MLP", 1.0) } else { ("MLP", "Ridge", -1.0) };
        let differences: Vec<f64> = mlp.iter().map(|error| sign * (error - ridge)).collect();
        let row = pairs.row(&[&title, better, worse]);
        let reach = T2 * sd(&differences) / 3.0_f64.sqrt();
        close(pairs.number(row, "by [mm]", 0), mean(&differences), &title);
        close(pairs.number(row, "95 % from [mm]", 0), mean(&differences) - reach, &title);
        close(pairs.number(row, "to [mm]", 0), mean(&differences) + reach, &title);
    }
}
