//! Chapter of `study = "best"` over sequences: all candidates on the validation part, the steps to an average, and the winner on
//! the test part.

use std::path::Path;

use acm_train::run::record::Versions;
use acm_train::run::sequences::scores::Scores;
use acm_train::schedule::study::best::candidate::{Candidate, chosen};
use acm_train::schedule::study::best::record::FILE;
use acm_train::schedule::study::of_sequences::best::record::{BestOfSequences, Tested};
use acm_train::schedule::study::of_sequences::best::text::why;
use maud::{Markup, html};
use serde::Deserialize;

use super::{Chapter, best::steps, sequences::stamp};
use crate::{
    error::EvalError,
    json::versioned,
    tables::{Cell, Column, Row, Table},
};

/// Returns whether the answer of a study is about sequences.
///
/// # Errors
/// There is an answer, and it cannot be read.
pub fn is_one(folder: &Path) -> Result<bool, EvalError> {
    #[derive(Deserialize)]
    struct Asked {
        #[serde(default)]
        sequences: Option<serde::de::IgnoredAny>,
    }
    let file = folder.join(FILE);
    Ok(file.is_file() && versioned::<Asked>(&file)?.sequences.is_some())
}

/// Returns the chapter.
///
/// # Errors
/// The answer is damaged.
pub fn chapter(folder: &Path, slug: String) -> Result<Chapter, EvalError> {
    let record: BestOfSequences = versioned(&folder.join(FILE))?;
    let Versions { acm, burn, commit } = &record.versions;
    let commit = commit.as_ref().map_or(String::new(), |commit| format!(", commit {commit}"));
    let command = format!("acm-train --config {}", record.config);
    let steps = steps(&record.steps, Column::significant(&record.loss), "on the validation part");
    let tested = record.test.as_ref().map(|tested| test(&record, tested));
    let tables: Vec<Table> = [Some(candidates(&record)), tested, Some(steps)].into_iter().flatten().collect();
    Ok(Chapter {
        slug,
        title: "Which model to use".into(),
        data: stamp(&record.sequences),
        missing: vec![],
        lead: lead(&record),
        notes: vec![],
        questions: vec![(String::new(), record.question.clone())],
        main: tables[0].name,
        tables,
        figures: vec![],
        provenance: vec![
            ("Made by", html! { code { (command) } ", in " code { (folder.display()) } }),
            ("Versions", html! { "acm " (acm) ", burn " (burn) (commit) }),
        ],
    })
}

fn lead(record: &BestOfSequences) -> Markup {
    html! {
        p.lead { (why(record)) }
        @if let Some(tested) = &record.test {
            p.lead {
                "On the test part, which took no part, its " (record.loss) " is " b { (format!("{:.3}", tested.winner.loss)) }
                ", that of " (tested.constant_name) " " (format!("{:.3}", tested.constant.loss)) "."
            }
        }
    }
}

fn candidates(record: &BestOfSequences) -> Table {
    let row = |candidate: &Candidate| Row {
        cells: vec![
            Cell::Text(candidate.name()),
            Cell::number(candidate.mean),
            Cell::number(candidate.more),
            candidate.standard_error.map_or(Cell::Empty, Cell::number),
            Cell::Count(candidate.numbers),
            Cell::Text(candidate.mark().into()),
        ],
        opens: candidate.members.len() == 2,
        bound: false,
    };
    Table {
        name: "best",
        title: "Which model".into(),
        note: format!(
            "{} on the {} sequences of the validation part, mean over sequences; the test part was not read. Differences to the \
             best are paired by sequence. Of the models within one standard error of the best, or 1 % of its error, the one with \
             the fewest fitted numbers is chosen, and a network only where it is better than none by more than chance (95 %).",
            record.loss, record.units
        ),
        columns: vec![
            Column::text("Model"),
            Column::significant(&record.loss),
            Column::significant("More than the best"),
            Column::significant("Standard error"),
            Column::number("Fitted numbers", "", 0),
            Column::text(""),
        ],
        rows: record.candidates.iter().map(row).collect(),
        folded: false,
    }
}

fn test(record: &BestOfSequences, tested: &Tested) -> Table {
    let labels = tested.winner.accuracy.is_some();
    let mut columns = vec![Column::text("Model"), Column::significant(&record.loss)];
    match labels {
        true => columns.push(Column::number("Right", "%", 2)),
        false => columns.extend(record.sequences.outputs.iter().map(|o| Column::significant(format!("RMSE {o}")))),
    }
    let row = |name: String, scores: &Scores| {
        let mut cells = vec![Cell::Text(name), Cell::number(scores.loss)];
        cells.extend(scores.accuracy.map(|share| Cell::number(100.0 * share)));
        cells.extend(scores.rmse.iter().flatten().map(|error| Cell::number(*error)));
        Row { cells, ..Row::default() }
    };
    Table {
        name: "best-test",
        title: "The winner on the test part".into(),
        note: format!(
            "{} sequences. Only the winner was scored there, once, after it had been chosen.",
            tested.winner.sequences
        ),
        columns,
        rows: vec![
            row(tested.constant_name.clone(), &tested.constant),
            row(chosen(&record.candidates).name(), &tested.winner),
        ],
        folded: false,
    }
}
