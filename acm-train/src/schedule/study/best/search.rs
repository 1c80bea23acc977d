//! State of a search: its models in cross-validation, and their predictions of each fold.

use super::{
    asked::{LOOP, NOMINAL},
    candidate::{Measured, Single},
    entrant::{self, Entrant, Loop},
    forecast,
};
use crate::run::record::RunRecord;
use crate::schedule::engine::answer::Answer;
use crate::schedule::error::ScheduleError;
use crate::schedule::ready::Campaigns;
use crate::schedule::study::batch::Batches;
use crate::schedule::study::eliminate::settled;
use crate::schedule::study::record::folder;

/// State of a search; see the head of this file.
pub struct Search<'a> {
    /// The loop's model, where one is named.
    pub upon: Option<Loop>,
    /// The compared items.
    pub entrants: Vec<Entrant>,
    /// Runs of the entrants.
    pub batches: Batches<'a>,
    /// Data that were read.
    pub campaigns: Campaigns,
}

impl Search<'_> {
    /// Chooses inputs where that is requested, and trains all bases in cross-validation: those with the loop's model
    /// after the others, since these determine which trials each fold leaves out.
    ///
    /// # Errors
    /// As [`Batches::run`].
    pub fn cross_validate(&mut self) -> Result<Answer<()>, ScheduleError> {
        for above in [false, true] {
            let mut members = vec![];
            for entrant in self.entrants.iter_mut().filter(|entrant| entrant.above == above) {
                let out = folder(self.batches.request.out, &entrant.id);
                let request = self.batches.request;
                match settled(entrant.experiment.clone(), &entrant.source, &out, request, &mut self.campaigns)? {
                    Answer::Waiting(text) => return Ok(Answer::Waiting(text)),
                    Answer::Finished((experiment, _)) => entrant.experiment = experiment,
                }
                let left_out = self.batches.records.first().map(|records| entrant::left_out(records));
                members.extend(entrant.in_folds(self.upon.as_ref(), left_out.as_deref())?);
            }
            if members.is_empty() {
                continue;
            }
            if let Answer::Waiting(text) = self.batches.run(members, &mut self.campaigns)? {
                return Ok(Answer::Waiting(text));
            }
        }
        Ok(Answer::Finished(()))
    }

    /// Returns the predictions of each model on each fold, and the measured targets.
    ///
    /// # Errors
    /// A table is missing or was changed, or two are of other targets.
    pub fn singles(&self) -> Result<(Vec<Single>, Measured), ScheduleError> {
        let mut learned = vec![];
        for entrant in &self.entrants {
            learned.push((entrant, entrant.forecasts(&self.batches)?));
        }
        let Some((_, first)) = learned.first() else { return Err(entrant::no_folds()) };
        let targets: Vec<_> = first.folds.iter().map(|fold| fold.targets.clone()).collect();
        let mut singles = vec![];
        for above in [false, true] {
            let numbers = if above { self.upon.as_ref().map_or(0, |upon| upon.numbers) } else { 0 };
            let mut of = learned.iter().filter(|(entrant, _)| entrant.above == above).peekable();
            singles.extend(of.peek().map(|(_, result)| Single {
                name: if above { LOOP } else { NOMINAL }.into(),
                numbers,
                streams: true,
                predicted: result.folds.iter().map(|fold| fold.nominal.clone()).collect(),
                optimism: vec![1.0; result.folds.len()],
            }));
            for (entrant, result) in of {
                result
                    .folds
                    .iter()
                    .zip(&targets)
                    .try_for_each(|(fold, targets)| forecast::same(targets, &fold.targets, &entrant.name))?;
                singles.push(Single {
                    name: entrant.name.clone(),
                    numbers: numbers + result.numbers,
                    streams: entrant.streams(),
                    predicted: result.folds.iter().map(|fold| fold.predicted.clone()).collect(),
                    optimism: result.optimism.clone(),
                });
            }
        }
        let (trials, values) = targets.into_iter().map(|targets| (targets.trial, targets.measured)).unzip();
        Ok((singles, Measured { outputs: self.first()?.outputs.len(), trials, values }))
    }

    /// Returns one run, from which the common settings are read.
    ///
    /// # Errors
    /// There is none.
    pub fn first(&self) -> Result<&RunRecord, ScheduleError> {
        self.batches.records.iter().flatten().next().ok_or_else(entrant::no_folds)
    }

    /// Returns the caveats, in sentences.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![];
        if self.upon.as_ref().is_some_and(|upon| upon.folds.is_empty()) {
            notes.push(
                "The loop's model was fitted on trials that the folds leave out, so the errors of what stands upon it are \
                 smaller here than on new trials; best.loop_folds names models that were not."
                    .into(),
            );
        }
        let folds = self.batches.records.first().map_or(0, |records| entrant::left_out(records).len());
        if folds < 2 {
            notes.push("One fold has no standard error: what errs least is chosen, and little is known of it.".into());
        }
        notes
    }
}
