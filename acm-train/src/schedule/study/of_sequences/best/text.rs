//! Printed result of a choice among questions about sequences: all candidates, the choice with its reason, the test score.

use std::path::Path;

use acm_core::display::{DIGITS, plain, signed, significant, with_spread};
use acm_datasets::text::{hint::command, terminal::ruled};

use super::record::{BestOfSequences, Tested};
use crate::run::evaluation::summary::count;
use crate::run::sequences::scores::Scores;
use crate::schedule::study::best::candidate::{Candidate, chosen};
use crate::schedule::study::best::text::reason;

/// Writes the printed text; the study is in `out`.
pub fn of(record: &BestOfSequences, out: &Path) -> String {
    let synthetic = if record.sequences.synthetic { " — synthetic data" } else { "" };
    let root = out.display();
    let page = command("acm-eval", "report", out, "");
    format!(
        "{}\n{}{synthetic}\n\n{}\n\n{}\n\n{}\n\nrecords and predictions: {root}\na page: {page}",
        record.question,
        record.sequences.title,
        candidates(record),
        why(record),
        tested(record)
    )
}

/// Writes the chosen model, and why it was chosen, in a sentence.
pub fn why(record: &BestOfSequences) -> String {
    // The prediction without a network is the first candidate.
    if record.candidates[0].chosen {
        return format!(
            "Use {}: neither a network nor a regression is better by more than chance (95 %).",
            record.candidates[0].name()
        );
    }
    reason(&record.candidates, "", |error| format!("{} {}", record.loss, significant(error, DIGITS)))
}

fn candidates(record: &BestOfSequences) -> String {
    let header = ["", &record.loss, "more than the best, ± standard error", "numbers", ""].map(String::from);
    let row = |candidate: &Candidate| {
        let more = match candidate.more {
            0.0 => String::new(),
            more => signed(more, with_spread(more, candidate.standard_error)),
        };
        let error = significant(candidate.mean, DIGITS);
        vec![candidate.name(), error, more, candidate.numbers.to_string(), candidate.mark().into()]
    };
    format!(
        "Validation part, {}; the simplest within one standard error of the best, or 1 %, is chosen;\na network \
         only where it is better than none by more than chance (95 %)\n{}",
        count(record.units, "sequence"),
        ruled(header.to_vec(), record.candidates.iter().map(row).collect(), 1)
    )
}

fn tested(record: &BestOfSequences) -> String {
    let Some(tested) = &record.test else { return "The test part was not scored: test is false.".into() };
    let Tested { winner, constant, constant_name, .. } = tested;
    let labels = winner.accuracy.is_some();
    let mut header = vec![String::new(), record.loss.clone()];
    header.extend(labels.then(|| "right %".to_string()));
    header.push("better".into());
    let row = |name: &str, scores: &Scores| {
        let mut cells = vec![name.to_string(), significant(scores.loss, DIGITS)];
        cells.extend(scores.accuracy.map(|share| plain(100.0 * share, 2)));
        let gain = 100.0 * (1.0 - scores.loss / constant.loss);
        cells.push(if std::ptr::eq(scores, constant) { String::new() } else { format!("{} %", plain(gain, 1)) });
        cells
    };
    let rows = vec![row(constant_name, constant), row(&chosen(&record.candidates).name(), winner)];
    let sequences = count(winner.sequences, "sequence");
    format!("Test part, {sequences}, which took no part; the winner alone and once\n{}", ruled(header, rows, 1))
}
