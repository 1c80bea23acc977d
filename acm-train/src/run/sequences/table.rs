//! The table at the end: a line for each row of the question, mean ± standard deviation over seeds.

use acm_core::display::{DIGITS, significant};
use acm_datasets::terminal::ruled;

use super::record::{DataRecord, SequenceRecord};
use crate::{
    config::Elapsed,
    run::{spread::Spread, summary::count},
};

/// The test part, which took no part in learning.
pub fn text(data: &DataRecord, records: &[SequenceRecord]) -> String {
    let labels = records.iter().all(|record| record.test.accuracy.is_some());
    let errors = data.outputs.iter().map(|output| format!("RMSE {output}"));
    let scores: Vec<String> = if labels { vec!["right %".into()] } else { errors.collect() };
    let head = |last: &[&str]| last.iter().map(ToString::to_string).collect::<Vec<_>>();
    let header = [head(&[""]), scores, head(&["loss", "seeds", "parameters", "epochs", "minutes"])].concat();
    let mut rows = vec![];
    for elapsed in [Elapsed::Measured, Elapsed::One] {
        let row: Vec<&SequenceRecord> = records.iter().filter(|record| record.elapsed == elapsed).collect();
        if !row.is_empty() {
            rows.push(line(elapsed, &row, labels));
        }
    }
    if let Some(limit) = data.limit_without_time {
        rows.push(head(&["best possible without elapsed time", &format!("{:.2}", 100.0 * limit)]));
    }
    if let Some(errors) = &data.persistence {
        let errors = errors.iter().map(|error| significant(*error, DIGITS));
        rows.push(head(&["the last value, repeated"]).into_iter().chain(errors).collect());
    }
    let tested = data.sequences.get("test").copied().unwrap_or_default();
    let kind = if data.synthetic { " — synthetic data" } else { "" };
    let parts = format!("Test part, {}, which took no part", count(tested, "sequence"));
    format!("{}{kind}\n\n{parts}\n{}", data.title, ruled(header, rows, 1))
}

fn line(elapsed: Elapsed, row: &[&SequenceRecord], labels: bool) -> Vec<String> {
    let spread = |values: Vec<f64>| Spread::of(&values).map_or(String::new(), |spread| spread.text(1.0));
    // Not results: how long it took.
    let mean = |values: Vec<f64>, decimals: usize| {
        Spread::of(&values).map_or(String::new(), |spread| format!("{:.decimals$}", spread.mean))
    };
    let told = match elapsed {
        Elapsed::Measured => "elapsed time as measured",
        Elapsed::One => "elapsed time 1 at every step",
    };
    let of = |value: &dyn Fn(&SequenceRecord) -> f64| row.iter().map(|record| value(record)).collect::<Vec<f64>>();
    let outputs = row[0].test.rmse.as_ref().map_or(0, Vec::len);
    let error = |o: usize| of(&|record| record.test.rmse.as_ref().map_or(f64::NAN, |rmse| rmse[o]));
    let mut cells = vec![format!("{}, {told}", row[0].question.network.kind())];
    match labels {
        true => cells.push(spread(of(&|record| 100.0 * record.test.accuracy.unwrap_or(f64::NAN)))),
        false => cells.extend((0..outputs).map(|o| spread(error(o)))),
    }
    cells.extend([
        spread(of(&|record| record.test.loss)),
        row.len().to_string(),
        row[0].parameters.to_string(),
        mean(of(&|record| record.epochs.len() as f64), 0),
        mean(of(&|record| record.seconds / 60.0), 1),
    ]);
    cells
}
