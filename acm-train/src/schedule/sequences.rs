//! A question about sequences ([`crate::run::sequences`]): its runs side by side, then the table.

use std::sync::Mutex;

use acm_datasets::sequences::{SequenceSet, bit_stream, table as tables};

use super::engine::answer::{Answer, nothing_to_submit};
use super::engine::elsewhere;
use super::engine::queue::{lock, side_by_side};
use super::error::ScheduleError;
use super::open::{Planned, What};
use super::request::Request;
use crate::config::{Kind, Question, QuestionData, Source, find_folder_with, read_question};
use crate::run::RunError;
use crate::run::evaluation::summary::count;
use crate::run::sequences::plan::{self, Plan};
use crate::run::sequences::record::{self, DataRecord, SequenceRecord, StudyRecord};
use crate::run::sequences::train::Runs;
use crate::run::sequences::{constant, table, together};
use crate::store::{RunFolder, atomic};

/// Runs a question about sequences, and returns the table to print.
///
/// # Errors
/// Anything in [`ScheduleError`]; finished runs are kept, and unfinished ones are checkpointed.
pub fn conduct(mut source: Source, request: &Request) -> Result<String, ScheduleError> {
    let question = read_question(&mut source)?;
    match answer(&question, &source, request, true)? {
        Answer::Waiting(text) => Ok(text),
        Answer::Finished(answered) if request.engine.only_looks() => Ok(nothing_to_submit(answered.planned)),
        Answer::Finished(Answered { data, set, records, folder, .. }) => report(&data, &set, &records, &folder),
    }
}

/// A question with all its records.
pub struct Answered {
    /// The sequences, in words.
    pub data: DataRecord,
    /// Sequences of the question.
    pub set: SequenceSet,
    /// Records in the order of the plans.
    pub records: Vec<SequenceRecord>,
    /// Folder of the runs.
    pub folder: RunFolder,
    /// Runs that are planned.
    pub planned: usize,
}

/// Runs a question until its runs have their records; `told` is whether its data are described first.
///
/// # Errors
/// As [`conduct`].
pub fn answer(
    question: &Question,
    source: &Source,
    request: &Request,
    told: bool,
) -> Result<Answer<Answered>, ScheduleError> {
    let set = set(question, source, request)?;
    let mut warnings = constant::look(&set, question.loss)?;
    if let (QuestionData::Table(tables), true) = (&question.data, question.reads_elapsed()) {
        warnings.extend(tables.implausible_step(&set));
    }
    let data = DataRecord::new(question, &set);
    let folder = RunFolder::hold(request.out, request.hold())?;
    let (format, kind) = (record::FORMAT, Kind::Sequences);
    let study = StudyRecord { format, kind, question: question.question.clone(), config: source.file_name(), data };
    folder.adopt_question(question, &study)?;
    let plans = plan::plans(question);
    if told {
        let parts = study.data.sequences.iter().map(|(part, n)| format!("{n} {part}")).collect::<Vec<_>>().join(", ");
        request.progress.note(&format!("{}: {parts} sequences, {}", study.data.title, count(plans.len(), "run")));
        warnings.iter().for_each(|warning| request.progress.note(warning));
    }
    let mut planned = Planned::none();
    let what = What::Question(Box::new(question.clone()));
    planned.add(request.out, &folder, source.path(), what, plans.iter().map(|plan| (plan.id.clone(), false)));
    if let Answer::Waiting(text) = elsewhere(&planned, request)? {
        return Ok(Answer::Waiting(text));
    }
    let records = match request.engine.only_looks() {
        true => vec![],
        false => run(&runs(question, &study.data, &set, &folder, request), &plans, request)?,
    };
    Ok(Answer::Finished(Answered { data: study.data, set, records, folder, planned: plans.len() }))
}

/// Returns the table, and the errors of each output in a file where there are several.
fn report(
    data: &DataRecord,
    set: &SequenceSet,
    records: &[SequenceRecord],
    folder: &RunFolder,
) -> Result<String, ScheduleError> {
    let together = together(folder.root(), set, records)?;
    let text = table::text(data, records, &together);
    let root = folder.root().display();
    let outputs = table::outputs(data, records, &together).filter(|_| data.outputs.len() > 1);
    let Some(outputs) = outputs else { return Ok(format!("{text}\n\nrecords and predictions: {root}")) };
    let file = folder.path("outputs.csv");
    atomic::write(&file, outputs.as_bytes())?;
    Ok(format!("{text}\n\nerrors of each target: {}\nrecords and predictions: {root}", file.display()))
}

/// Computes the run of one plan, in a folder that holds the question already, and returns whether it finished.
///
/// # Errors
/// There is no such plan, the sequences have changed, or the run fails.
pub fn one(
    question: &Question,
    source: &Source,
    plan: &str,
    folder: &RunFolder,
    request: &Request,
) -> Result<bool, ScheduleError> {
    let set = set(question, source, request)?;
    let data = DataRecord::new(question, &set);
    let before = record::read_study(&folder.path("study.json"))?.data.hash;
    let changed = |what: String| ScheduleError::Usage {
        what,
        help: "put the former data back, or start again with --out DIR".into(),
    };
    if before != data.hash {
        return Err(changed(format!("the sequences have changed: hash {before}, now {}", data.hash)));
    }
    let plans = plan::plans(question);
    let found = plans.iter().find(|known| known.id == plan);
    let plan = found.ok_or_else(|| changed(format!("{plan} is not planned any more")))?;
    Ok(runs(question, &data, &set, folder, request).one(plan)?.is_some())
}

fn runs<'a>(
    question: &'a Question,
    data: &'a DataRecord,
    set: &'a SequenceSet,
    folder: &'a RunFolder,
    request: &Request<'a>,
) -> Runs<'a> {
    Runs::new(question, data, set, folder, request.progress, request.stop)
}

/// Runs what is not finished, and returns all records in the order of the plans.
///
/// # Errors
/// A run fails, or the user stops it; finished runs are kept, and unfinished ones are checkpointed.
fn run(runs: &Runs, plans: &[Plan], request: &Request) -> Result<Vec<SequenceRecord>, ScheduleError> {
    let done = plans.iter().map(|plan| runs.finished(plan)).collect::<Result<Vec<_>, _>>()?;
    let open: Vec<usize> = (0..plans.len()).filter(|&i| done[i].is_none()).collect();
    let records = Mutex::new(done);
    side_by_side(open.len(), request, |next| {
        let record = runs.one(&plans[open[next]])?;
        lock(&records)[open[next]] = record;
        Ok(())
    })?;
    let records: Vec<SequenceRecord> = lock(&records).drain(..).flatten().collect();
    match (records.len(), plans.len()) {
        (finished, planned) if finished < planned => {
            Err(ScheduleError::Stopped { folder: request.out.into(), finished, planned })
        }
        _ => Ok(records),
    }
}

/// Returns the sequences that a question is about.
fn set(question: &Question, source: &Source, request: &Request) -> Result<SequenceSet, ScheduleError> {
    let set = match &question.data {
        QuestionData::BitStreamXor(asked) => bit_stream::generate(asked),
        QuestionData::Table(asked) => {
            let named = || find_folder_with(&asked.folder, source.path(), |folder| asked.lies_in(folder));
            let found = request.data.map(Into::into).or_else(named);
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
        Some(part) => Err(RunError::Unusable {
            what: format!("the {part} part has no sequences"),
            help: "give more sequences, or change the shares in [data] (or the column that names the parts)".into(),
        }
        .into()),
    }
}
