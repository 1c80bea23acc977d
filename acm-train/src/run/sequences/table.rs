//! The table at the end: a line for each row of the question, mean ± standard deviation over seeds, and one for the mean of the
//! networks of all seeds. Of many outputs the mean error and the worst stand there, and each has a line in [`outputs`].

use acm_core::display::{DIGITS, significant};
use acm_datasets::text::terminal::ruled;
use acm_models::NetworkConfig;

use super::{
    record::{DataRecord, SequenceRecord},
    scores::Scores,
};
use crate::config::Elapsed;
use crate::run::evaluation::spread::Spread;
use crate::run::evaluation::summary::count;

/// Largest number of outputs with columns of their own; of more, the mean and the worst are shown.
const MOST_ACROSS: usize = 3;

/// The rows of a question.
pub const ROWS: [Elapsed; 2] = [Elapsed::Measured, Elapsed::One];

/// Mean of the networks of one row, with its scores.
#[derive(Debug, Clone, PartialEq)]
pub struct Together {
    /// Elapsed times that the network received.
    pub elapsed: Elapsed,
    /// Runs whose predictions were averaged.
    pub runs: usize,
    /// Scores on the validation sequences, which chose the epochs.
    pub validation: Scores,
    /// Scores on the test sequences; without a test, those on the validation sequences.
    pub scored: Scores,
}

/// Returns the elapsed times that a network receives, in words.
pub fn told(network: &NetworkConfig, elapsed: Elapsed) -> &'static str {
    match elapsed {
        _ if !network.reads_elapsed() => "which ignores elapsed time",
        Elapsed::Measured => "elapsed time as measured",
        Elapsed::One => "elapsed time 1 at every step",
    }
}

/// Returns the test part, which took no part in learning; the validation part where it was not scored.
pub fn text(data: &DataRecord, records: &[SequenceRecord], together: &[Together]) -> String {
    let labels = records.iter().all(|record| record.scored().accuracy.is_some());
    let names = &data.outputs;
    let loss = if labels { "cross-entropy" } else { "MSE" };
    let score: Vec<String> = match (labels, names.len() > MOST_ACROSS) {
        (true, _) => texts(&["right %"]),
        (false, true) => texts(&["RMSE, mean", "RMSE, worst"]),
        (false, false) => names.iter().map(|output| format!("RMSE {output}")).collect(),
    };
    let losses = [loss.to_string(), format!("{loss}, validation")];
    let last = texts(&["seeds", "parameters", "epochs", "minutes"]);
    let header = [texts(&[""]), score, losses.to_vec(), last].concat();
    let mut rows = vec![];
    for elapsed in ROWS {
        let row: Vec<&SequenceRecord> = records.iter().filter(|record| record.elapsed == elapsed).collect();
        if !row.is_empty() {
            rows.push(line(names, &row));
        }
        rows.extend(together.iter().filter(|mean| mean.elapsed == elapsed).map(|mean| of_mean(names, mean)));
    }
    if let Some(limit) = data.limit_without_time {
        rows.push(texts(&["best possible without elapsed time", &format!("{:.2}", 100.0 * limit)]));
    }
    if let Some(errors) = data.persistence.as_ref().filter(|_| !labels) {
        let mut cells = texts(&["the last value, repeated"]);
        cells.extend(errors_of(names, &[errors]));
        cells.push(significant(mean_square(errors), DIGITS));
        rows.push(cells);
    }
    let kind = if data.synthetic { " — synthetic data" } else { "" };
    let (part, name, role) = match records.iter().all(|record| record.test.is_some()) {
        true => ("test", "Test part", "took no part"),
        false => ("validation", "Validation part", "chose the epochs"),
    };
    let sequences = count(data.sequences.get(part).copied().unwrap_or_default(), "sequence");
    let parts = format!("{name}, {sequences}, which {role}");
    format!("{}{kind}\n\n{parts}\n{}\n{}", data.title, ruled(header, rows, 1), meaning(labels))
}

/// Returns the name of the loss, with its unit.
fn meaning(labels: bool) -> &'static str {
    match labels {
        true => "cross-entropy: mean over all labels, in nats",
        false => "MSE: mean square error over all targets, in the square of the targets' own unit (not standardised)",
    }
}

/// Returns a line for each output and row, as CSV; none where there are labels.
pub fn outputs(data: &DataRecord, records: &[SequenceRecord], together: &[Together]) -> Option<String> {
    let mut text =
        "output,row,RMSE mean,RMSE standard deviation,RMSE of the mean prediction,RMSE of the last value\n".to_string();
    for (o, output) in data.outputs.iter().enumerate() {
        for elapsed in ROWS {
            let of = records.iter().filter(|record| record.elapsed == elapsed);
            let errors: Vec<f64> =
                of.map(|record| record.scored().rmse.as_ref().map(|rmse| rmse[o])).collect::<Option<_>>()?;
            let Some(spread) = Spread::of(&errors) else { continue };
            let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let mean = together.iter().find(|mean| mean.elapsed == elapsed);
            let mean = number(mean.and_then(|mean| Some(mean.scored.rmse.as_ref()?[o])));
            let last = number(data.persistence.as_ref().map(|errors| errors[o]));
            let name = if output.contains([',', '"']) {
                format!("\"{}\"", output.replace('"', "\"\""))
            } else {
                output.clone()
            };
            text += &format!("{name},{},{},{},{mean},{last}\n", elapsed.name(), spread.mean, number(spread.sd));
        }
    }
    Some(text)
}

fn line(names: &[String], row: &[&SequenceRecord]) -> Vec<String> {
    let spread = |values: Vec<f64>| Spread::of(&values).map_or(String::new(), |spread| spread.text(1.0));
    // Not results: how long it took.
    let mean = |values: Vec<f64>, decimals: usize| {
        Spread::of(&values).map_or(String::new(), |spread| format!("{:.decimals$}", spread.mean))
    };
    let of = |value: &dyn Fn(&SequenceRecord) -> f64| row.iter().map(|record| value(record)).collect::<Vec<f64>>();
    let network = &row[0].question.network;
    let mut cells = vec![format!("{}, {}", network.kind(), told(network, row[0].elapsed))];
    match row.iter().map(|record| record.scored().rmse.as_ref()).collect::<Option<Vec<_>>>() {
        None => cells.push(spread(of(&|record| 100.0 * record.scored().accuracy.unwrap_or(f64::NAN)))),
        Some(errors) => cells.extend(errors_of(names, &errors)),
    }
    cells.extend([
        spread(of(&|record| record.scored().loss)),
        spread(of(&|record| record.validation.loss)),
        row.len().to_string(),
        row[0].parameters.to_string(),
        mean(of(&|record| record.epochs.len() as f64), 0),
        mean(of(&|record| record.seconds / 60.0), 1),
    ]);
    cells
}

fn of_mean(names: &[String], mean: &Together) -> Vec<String> {
    let mut cells = vec![format!("mean of these {} predictions", mean.runs)];
    match &mean.scored.rmse {
        None => cells.push(format!("{:.2}", 100.0 * mean.scored.accuracy.unwrap_or(f64::NAN))),
        Some(errors) => cells.extend(errors_of(names, &[errors])),
    }
    cells.extend([significant(mean.scored.loss, DIGITS), significant(mean.validation.loss, DIGITS)]);
    cells
}

/// Returns the RMSE of each output over runs; of many outputs, the mean over outputs and the worst with its name.
fn errors_of(names: &[String], runs: &[&Vec<f64>]) -> Vec<String> {
    let spread = |values: &[f64]| Spread::of(values).map_or(String::new(), |spread| spread.text(1.0));
    let each = |o: usize| runs.iter().map(|errors| errors[o]).collect::<Vec<f64>>();
    if names.len() <= MOST_ACROSS {
        return (0..names.len()).map(|o| spread(&each(o))).collect();
    }
    let means: Vec<f64> = runs.iter().map(|errors| errors.iter().sum::<f64>() / errors.len() as f64).collect();
    let total = |o: &usize| each(*o).iter().sum::<f64>();
    let worst = (0..names.len()).max_by(|a, b| total(a).total_cmp(&total(b))).unwrap_or(0);
    vec![spread(&means), format!("{} ({})", spread(&each(worst)), names[worst])]
}

fn mean_square(errors: &[f64]) -> f64 {
    errors.iter().map(|error| error * error).sum::<f64>() / errors.len().max(1) as f64
}

fn texts(words: &[&str]) -> Vec<String> {
    words.iter().map(ToString::to_string).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. Two runs of four outputs; the second output is the worst, with 5 and 7.
    #[test]
    fn many_outputs_are_a_mean_and_the_worst() {
        let names = ["a", "b", "c", "d"].map(String::from);
        let runs = [&vec![1.0, 5.0, 1.0, 1.0], &vec![1.0, 7.0, 1.0, 1.0]];
        assert_eq!(errors_of(&names, &runs), ["2.25 ± 0.35", "6.0 ± 1.4 (b)"]);
        assert_eq!(errors_of(&names[..1], &[&vec![1.25]]), ["1.25"]);
        assert_eq!(mean_square(&[3.0, 1.0]), 5.0);
    }
}
