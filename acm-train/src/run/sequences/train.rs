//! The runs of a question, from plan to record and table of predictions.

use std::{collections::BTreeMap, time::Instant};

use acm_core::display::{DIGITS, significant};
use acm_datasets::files::table::{Column, write_parquet};
use acm_datasets::sequences::{Sequence, SequenceSet};
use acm_models::Keep;
use nalgebra::DMatrix;

use super::{
    plan::Plan,
    record::{self, DataRecord, FORMAT, SequenceRecord},
    scores::{scores, targets},
};
use crate::config::{Loss, Question, device};
use crate::learn::examples::sequences::predict;
use crate::learn::{Control, Ended, Epoch, Fitted, Learned, SequenceExamples, Task, ensemble};
use crate::run::error::RunError;
use crate::run::progress::Progress;
use crate::run::record::Member;
use crate::run::record::versions::versions;
use crate::run::stop::Stop;
use crate::store::{RunFolder, StoreError, hashed};

/// Settings that all runs share.
pub struct Runs<'a> {
    question: &'a Question,
    data: &'a DataRecord,
    set: &'a SequenceSet,
    folder: &'a RunFolder,
    progress: &'a Progress,
    stop: &'a Stop,
    learned: Learned,
}

impl<'a> Runs<'a> {
    /// Returns the runs of a question to `set` in `folder`; `progress` observes them, and `stop` may end them early.
    pub fn new(
        question: &'a Question,
        data: &'a DataRecord,
        set: &'a SequenceSet,
        folder: &'a RunFolder,
        progress: &'a Progress,
        stop: &'a Stop,
    ) -> Self {
        let learned = Learned::new(set, question.loss, question.nominal, question.scale);
        Self { question, data, set, folder, progress, stop, learned }
    }

    /// Returns the record of a run that is finished.
    ///
    /// # Errors
    /// There is a file, and it is no record, or one of another question; or its table of predictions is not as it was written.
    pub fn finished(&self, plan: &Plan) -> Result<Option<SequenceRecord>, StoreError> {
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
            false => Err(StoreError::Changed { file: path, why: "it is of another question, or of other data".into() }),
        }
    }

    /// Trains one network, going on from its checkpoint where there is one, and looks at the test part once; `None` where
    /// the user stopped it.
    ///
    /// # Errors
    /// The loss is not finite, the checkpoint is of another run, or the file system refuses.
    pub fn one(&self, plan: &Plan) -> Result<Option<SequenceRecord>, RunError> {
        let start = Instant::now();
        let shown = self.progress.begin(&plan.id, plan.training.epochs);
        let fitted = self.fit(plan, &mut |epoch| shown.epoch(epoch))?;
        if ensemble::ended(&fitted) == Ended::Asked {
            shown.end(&format!("stopped after epoch {}", fitted.last().map_or(0, |last| last.epochs.len())));
            return Ok(None);
        }
        let record = self.finish(plan, fitted, start)?;
        shown.end(&outcome(&record));
        Ok(Some(record))
    }

    /// Returns the predictions of a finished run for the test part [N×O], from its checkpoint; `None` where the user stopped it.
    ///
    /// # Errors
    /// As [`Self::one`].
    pub fn predict_test(&self, plan: &Plan) -> Result<Option<DMatrix<f64>>, RunError> {
        let fitted = self.fit(plan, &mut |_| ())?;
        Ok((ensemble::ended(&fitted) != Ended::Asked).then(|| self.predicted(plan, &fitted, &self.set.test)))
    }

    /// Fits the networks of a plan, going on from their checkpoints.
    fn fit(&self, plan: &Plan, shown: &mut dyn FnMut(&Epoch)) -> Result<Vec<Fitted>, RunError> {
        let task = Task {
            network: &self.question.network,
            training: &plan.training,
            supervise: Keep::Every,
            seed: plan.seed,
            device: &device(&self.question.device)?,
        };
        let mut observer = |epoch: &Epoch| {
            shown(epoch);
            if self.stop.asked() { Control::Stop } else { Control::Continue }
        };
        let (training, validation) =
            (self.examples(&self.set.training, plan), self.examples(&self.set.validation, plan));
        let checkpoint = self.folder.checkpoint(&plan.id);
        let fitted = ensemble::fit_members(&task, &training, &validation, &checkpoint, &mut observer);
        Ok(fitted.map_err(|error| error.in_run(&plan.id))?)
    }

    /// Returns the mean prediction of some networks, in the targets' units.
    fn predicted(&self, plan: &Plan, fitted: &[Fitted], sequences: &[Sequence]) -> DMatrix<f64> {
        let examples = self.examples(sequences, plan);
        let all = fitted.iter().map(|one| predict(&one.network, &examples));
        self.learned.restore(&ensemble::mean(all), sequences)
    }

    fn examples(&self, sequences: &[Sequence], plan: &Plan) -> SequenceExamples {
        SequenceExamples::new(sequences, &self.learned, plan.elapsed)
    }

    fn finish(&self, plan: &Plan, fitted: Vec<Fitted>, start: Instant) -> Result<SequenceRecord, RunError> {
        let predicted = |sequences: &[Sequence]| self.predicted(plan, &fitted, sequences);
        let chosen_by = predicted(&self.set.validation);
        let tested = self.question.test.then(|| predicted(&self.set.test));
        let predictions = format!("predictions/{}.parquet", plan.id).into();
        let mut parts = vec![("validation", &*self.set.validation, &chosen_by)];
        parts.extend(tested.as_ref().map(|tested| ("test", &*self.set.test, tested)));
        let path = self.folder.predictions(&plan.id);
        write_parquet(&path, &columns(self.question.loss, &self.set.outputs, &parts))?;
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
            parameters: fitted.iter().map(|one| one.network.parameter_count()).sum(),
            epochs: fitted[0].epochs.clone(),
            best_epoch: fitted[0].best_epoch,
            members: members(plan.seed, &fitted),
            seconds: start.elapsed().as_secs_f64(),
            validation: score(&self.set.validation, &chosen_by),
            test: tested.as_ref().map(|tested| score(&self.set.test, tested)),
            predictions,
            predictions_sha256: hashed::of_file(&path)?,
        };
        hashed::write(&self.folder.record(&plan.id), &record)?;
        Ok(record)
    }
}

/// Returns the columns `part`, `sequence`, `step` (from 1), then `label` and `logit`, or `target` and `predicted`;
/// with the name of the output behind these where there are several.
pub fn columns(loss: Loss, outputs: &[String], parts: &[(&str, &[Sequence], &DMatrix<f64>)]) -> Vec<(String, Column)> {
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
    let asked = if loss == Loss::CrossEntropy { "label" } else { "target" };
    for (o, output) in outputs.iter().enumerate() {
        let answers = parts.iter().flat_map(|(.., predicted)| predicted.column(o).iter().copied().collect::<Vec<_>>());
        let targets = rows.iter().map(|(_, one, row)| one.targets[(*row, o)]).collect();
        add(named(asked, outputs, output), Column::Number(targets));
        add(answer(loss, outputs, output), Column::Number(answers.collect()));
    }
    columns.into_values().collect()
}

/// Returns the name of the column of a network's output of an output.
pub fn answer(loss: Loss, outputs: &[String], output: &str) -> String {
    named(if loss == Loss::CrossEntropy { "logit" } else { "predicted" }, outputs, output)
}

fn named(what: &str, outputs: &[String], output: &str) -> String {
    if outputs.len() == 1 { what.into() } else { format!("{what}_{output}") }
}

/// Returns the networks of an ensemble; none where there is one.
fn members(seed: u64, fitted: &[Fitted]) -> Vec<Member> {
    let member = |(m, one): (usize, &Fitted)| Member {
        seed: ensemble::seed(seed, m),
        epoch_zero: one.zero,
        epochs: one.epochs.clone(),
        best_epoch: one.best_epoch,
    };
    if fitted.len() == 1 { vec![] } else { fitted.iter().enumerate().map(member).collect() }
}

fn outcome(record: &SequenceRecord) -> String {
    let (part, scores) = (if record.test.is_some() { "test" } else { "validation" }, record.scored());
    let right = match scores.accuracy {
        Some(accuracy) => format!("{:.2} % right", 100.0 * accuracy),
        None => format!("MSE {}", significant(scores.loss, DIGITS)),
    };
    let (best, epochs, seconds) = (record.best_epoch, record.epochs.len(), record.seconds);
    format!("best epoch {best} of {epochs}, {part} {right}, {seconds:.1} s")
}
