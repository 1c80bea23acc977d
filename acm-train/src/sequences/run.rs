//! The runs of a question, side by side: each from its plan to its record and its table of predictions.

use std::{collections::BTreeMap, sync::Mutex, time::Instant};

use acm_core::display::{DIGITS, significant};
use acm_datasets::{
    sequences::{Sequence, SequenceSet},
    table::{Column, write_parquet},
};
use acm_models::Keep;
use nalgebra::DMatrix;

use super::{
    plan::Plan,
    question::Question,
    record::{self, DataRecord, FORMAT, SequenceRecord},
    scores::{scores, targets},
};
use crate::{
    error::TrainError,
    folder::RunFolder,
    hashed,
    job::Request,
    learn::{
        Control, Ended, Fitted, Loss, Scalers, SequenceExamples, Task, device, fit,
        sequences::{predict, scalers},
    },
    queue::{lock, side_by_side},
    versions::versions,
};

/// Runs what is not finished, and returns all records in the order of the plans.
///
/// # Errors
/// A run fails, or somebody asks to stop; finished runs are kept, and unfinished ones are checkpointed.
pub fn run(
    question: &Question,
    data: &DataRecord,
    set: &SequenceSet,
    plans: &[Plan],
    folder: &RunFolder,
    request: &Request,
) -> Result<Vec<SequenceRecord>, TrainError> {
    let runs = Runs { question, data, set, folder, request, scalers: scalers(set, question.loss) };
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
            Err(TrainError::Stopped { folder: request.out.into(), finished, planned })
        }
        _ => Ok(records),
    }
}

/// Brings one run to its record; `None` where somebody asked to stop.
///
/// # Errors
/// The run fails.
pub fn one(
    question: &Question,
    data: &DataRecord,
    set: &SequenceSet,
    plan: &Plan,
    folder: &RunFolder,
    request: &Request,
) -> Result<Option<SequenceRecord>, TrainError> {
    Runs { question, data, set, folder, request, scalers: scalers(set, question.loss) }.one(plan)
}

/// What all runs share.
struct Runs<'a> {
    question: &'a Question,
    data: &'a DataRecord,
    set: &'a SequenceSet,
    folder: &'a RunFolder,
    request: &'a Request<'a>,
    scalers: Scalers,
}

impl Runs<'_> {
    fn finished(&self, plan: &Plan) -> Result<Option<SequenceRecord>, TrainError> {
        let path = self.folder.record(&plan.id);
        if !path.exists() {
            return Ok(None);
        }
        let record = record::read(&path)?;
        hashed::same_file(&self.folder.predictions(&plan.id), &record.predictions_sha256, &path)?;
        // The words of a question may change.
        let asked = Question { question: record.question.question.clone(), ..self.question.clone() };
        match record.question == asked && record.data.hash == self.data.hash {
            true => Ok(Some(record)),
            false => Err(TrainError::Changed { file: path, why: "it is of another question, or of other data".into() }),
        }
    }

    /// Trains one network, going on from its checkpoint where there is one, and looks at the test part once; `None` where
    /// somebody asked to stop.
    fn one(&self, plan: &Plan) -> Result<Option<SequenceRecord>, TrainError> {
        let start = Instant::now();
        let shown = self.request.progress.begin(&plan.id, plan.training.epochs);
        let task = Task {
            network: &self.question.network,
            training: &plan.training,
            supervise: Keep::Every,
            seed: plan.seed,
            device: &device(&self.question.device)?,
        };
        let mut observer = |epoch: &_| {
            shown.epoch(epoch);
            if self.request.stop.asked() { Control::Stop } else { Control::Continue }
        };
        let (training, validation) =
            (self.examples(&self.set.training, plan), self.examples(&self.set.validation, plan));
        let checkpoint = self.folder.checkpoint(&plan.id);
        let fitted = fit(&task, &training, &validation, Some(&checkpoint), &mut observer);
        let fitted = fitted.map_err(|error| error.in_run(&plan.id))?;
        if fitted.ended == Ended::Asked {
            shown.end(&format!("stopped after epoch {}", fitted.epochs.len()));
            return Ok(None);
        }
        let record = self.finish(plan, fitted, start)?;
        shown.end(&outcome(&record));
        Ok(Some(record))
    }

    fn examples(&self, sequences: &[Sequence], plan: &Plan) -> SequenceExamples {
        SequenceExamples::new(sequences, &self.scalers, plan.elapsed, self.question.loss)
    }

    fn finish(&self, plan: &Plan, fitted: Fitted, start: Instant) -> Result<SequenceRecord, TrainError> {
        let predicted = |sequences: &[Sequence]| {
            self.scalers.targets.restore(&predict(&fitted.network, &self.examples(sequences, plan)))
        };
        let (chosen_by, tested) = (predicted(&self.set.validation), predicted(&self.set.test));
        let predictions = format!("predictions/{}.parquet", plan.id).into();
        let parts = [("validation", &*self.set.validation, &chosen_by), ("test", &self.set.test, &tested)];
        let path = self.folder.predictions(&plan.id);
        write_parquet(&path, &self.columns(&parts))?;
        let score = |sequences: &[Sequence], predicted: &DMatrix<f64>| {
            scores(sequences.len(), predicted, &targets(sequences), self.question.loss)
        };
        let record = SequenceRecord {
            format: FORMAT,
            id: plan.id.clone(),
            elapsed: plan.elapsed,
            seed: plan.seed,
            question: self.question.clone(),
            data: self.data.clone(),
            versions: versions(),
            parameters: fitted.network.parameter_count(),
            epochs: fitted.epochs,
            best_epoch: fitted.best_epoch,
            seconds: start.elapsed().as_secs_f64(),
            validation: score(&self.set.validation, &chosen_by),
            test: score(&self.set.test, &tested),
            predictions,
            predictions_sha256: hashed::of_file(&path)?,
        };
        hashed::write(&self.folder.record(&plan.id), &record)?;
        Ok(record)
    }

    /// `part`, `sequence`, `step` (from 1), then `label` and `logit`, or `target` and `predicted`; with the name of the
    /// output behind these where there are several.
    fn columns(&self, parts: &[(&str, &[Sequence], &DMatrix<f64>)]) -> Vec<(String, Column)> {
        let rows: Vec<(&str, &Sequence, usize)> = parts
            .iter()
            .flat_map(|(part, sequences, _)| sequences.iter().map(move |sequence| (*part, sequence)))
            .flat_map(|(part, sequence)| (0..sequence.targets.nrows()).map(move |row| (part, sequence, row)))
            .collect();
        let step =
            |(_, sequence, row): &(_, &Sequence, usize)| (sequence.steps() - sequence.targets.nrows() + row + 1) as f64;
        let mut columns: BTreeMap<usize, (String, Column)> = BTreeMap::new();
        let mut add = |name: String, column| columns.insert(columns.len(), (name, column));
        add("part".into(), Column::Text(rows.iter().map(|(part, ..)| part.to_string()).collect()));
        add("sequence".into(), Column::Text(rows.iter().map(|(_, sequence, _)| sequence.name.clone()).collect()));
        add("step".into(), Column::Number(rows.iter().map(step).collect()));
        let (asked, answered) =
            if self.question.loss == Loss::CrossEntropy { ("label", "logit") } else { ("target", "predicted") };
        for (o, output) in self.set.outputs.iter().enumerate() {
            let name = |what: &str| if self.set.outputs.len() == 1 { what.into() } else { format!("{what}_{output}") };
            let answers =
                parts.iter().flat_map(|(.., predicted)| predicted.column(o).iter().copied().collect::<Vec<_>>());
            add(name(asked), Column::Number(rows.iter().map(|(_, one, row)| one.targets[(*row, o)]).collect()));
            add(name(answered), Column::Number(answers.collect()));
        }
        columns.into_values().collect()
    }
}

fn outcome(record: &SequenceRecord) -> String {
    let test = &record.test;
    let right = match (test.accuracy, &test.rmse) {
        (Some(accuracy), _) => format!("{:.2} % right", 100.0 * accuracy),
        (None, Some(rmse)) => {
            let errors: Vec<String> = rmse.iter().map(|error| significant(*error, DIGITS)).collect();
            format!("RMSE {}", errors.join(" "))
        }
        (None, None) => String::new(),
    };
    format!("best epoch {} of {}, test {right}, {:.1} s", record.best_epoch, record.epochs.len(), record.seconds)
}
