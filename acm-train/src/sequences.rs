//! Sequences that are no trials of a robot: benchmarks of irregular sampling, with labels or with numbers to predict.
//!
//! ```text
//! file ─► Question ─► SequenceSet ─► a network for each row and seed ─► test part, once ─► SequenceRecord ─► table
//!         question    acm-datasets   learn::fit, run                                       record           table
//! ```
//!
//! There is no nominal model and no campaign. A question has one row, or two where a `[control]` asks the same network
//! again with other news of time. The run folder is that of an experiment (`experiment.toml`, `records/`, `predictions/`,
//! `checkpoints/`), and has a `study.json` in the place of `nominal.json`.

mod constant;
mod plan;
pub mod question;
pub mod record;
mod run;
pub mod scores;
mod table;

use acm_datasets::sequences::{SequenceSet, bit_stream, table as tables};

use crate::{
    engine::{self, Answer, Engine},
    error::TrainError,
    experiment::{Source, find_folder},
    folder::RunFolder,
    job::Request,
    open::{Planned, What},
    sequences::{
        question::{Data, Question},
        record::{DataRecord, StudyRecord},
    },
    study,
    summary::count,
};

/// Conducts a question about sequences, and returns the table to print.
///
/// # Errors
/// Anything in [`TrainError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(mut source: Source, request: &Request) -> Result<String, TrainError> {
    let question = question::read(&mut source)?;
    let set = set(&question, &source, request)?;
    let warnings = constant::look(&set, question.loss)?;
    let data = DataRecord::new(&question, &set);
    let folder = RunFolder::hold(request.out, request.hold())?;
    let (format, kind) = (record::FORMAT, study::Kind::Sequences);
    let study = StudyRecord { format, kind, question: question.question.clone(), config: source.file_name(), data };
    folder.adopt_question(&question, &study)?;
    let plans = plan::plans(&question);
    let parts = study.data.sequences.iter().map(|(part, n)| format!("{n} {part}")).collect::<Vec<_>>().join(", ");
    request.progress.note(&format!("{}: {parts} sequences, {}", study.data.title, count(plans.len(), "run")));
    warnings.iter().for_each(|warning| request.progress.note(warning));
    let mut planned = Planned::none();
    let what = What::Question(Box::new(question.clone()));
    planned.add(request.out, &folder, source.path(), what, plans.iter().map(|plan| plan.id.clone()));
    if let Engine::Slurm(slurm) = request.engine {
        match slurm.bring(&planned, request)? {
            Answer::Waiting(text) => return Ok(text),
            Answer::Finished(()) if request.engine.only_looks() => return Ok(engine::nothing_to_submit(plans.len())),
            Answer::Finished(()) => {}
        }
    }
    let records = run::run(&question, &study.data, &set, &plans, &folder, request)?;
    let root = request.out.display();
    Ok(format!("{}\n\nrecords and predictions: {root}", table::text(&study.data, &records)))
}

/// Brings the run of one plan to its record, in a folder that holds the question already; whether it came so far.
///
/// # Errors
/// There is no such plan, the sequences have changed, or the run fails.
pub fn one(
    question: &Question,
    source: &Source,
    plan: &str,
    folder: &RunFolder,
    request: &Request,
) -> Result<bool, TrainError> {
    let set = set(question, source, request)?;
    let data = DataRecord::new(question, &set);
    let before = record::read_study(&folder.path("study.json"))?.data.hash;
    let changed = |what: String| TrainError::Usage {
        what,
        help: "put the former data back, or begin anew with --out DIR".into(),
    };
    if before != data.hash {
        return Err(changed(format!("the sequences have changed: hash {before}, now {}", data.hash)));
    }
    let plans = plan::plans(question);
    let found = plans.iter().find(|known| known.id == plan);
    let plan = found.ok_or_else(|| changed(format!("{plan} is not planned any more")))?;
    run::one(question, &data, &set, plan, folder, request).map(|record| record.is_some())
}

/// The sequences that a question is about.
fn set(question: &Question, source: &Source, request: &Request) -> Result<SequenceSet, TrainError> {
    let set = match &question.data {
        Data::BitStreamXor(asked) => bit_stream::generate(asked),
        Data::Table(asked) => {
            let found = request.data.map(Into::into).or_else(|| find_folder(&asked.folder, source.path()));
            let folder = found.ok_or_else(|| {
                let what = format!("`data.folder` is {:?}, and there is no such folder", asked.folder);
                let help = "name a folder, as seen from the current directory or from the experiment file";
                Box::new(source.complaint(&["data".into(), "folder".into()], what, help))
            })?;
            tables::read(asked, &folder, question.rules())?
        }
    };
    let empty = set.parts().into_iter().find(|(_, sequences)| sequences.is_empty()).map(|(part, _)| part);
    match empty {
        None => Ok(set),
        Some(part) => Err(TrainError::Unusable {
            what: format!("the {part} part has no sequences"),
            help: "give more sequences, or change the shares in [data] (or the column that names the parts)".into(),
        }),
    }
}
