//! Scoring of a network that was trained elsewhere.

use std::slice;

use super::engine::queue;
use super::error::ScheduleError;
use super::ready::{Campaigns, Ready};
use super::request::Request;
use crate::{
    config::{Experiment, Imported, Source, TrainingConfig},
    run::{
        import::{Arrival, Foreign},
        record::RunRecord,
    },
    store::Hold,
};

/// Scores the network of `foreign` in one final run of its first seed, on the data, channels, windows and parts of the
/// experiment. Nothing is trained.
///
/// # Errors
/// The file is not the experiment's network, the experiment chooses its inputs, or anything in [`ScheduleError`].
pub fn run(
    experiment: Experiment,
    source: &Source,
    request: &Request,
    foreign: &Foreign,
    imported: Imported,
) -> Result<RunRecord, ScheduleError> {
    let ready = Ready::new(scored(experiment, imported)?, source, request, &mut Campaigns::default())?;
    let setting = ready.setting();
    let arrive = |plan| Arrival::new(&setting, plan, foreign);
    let arrivals: Vec<Arrival> = ready.plans.iter().map(arrive).collect::<Result<_, _>>()?;
    let folder = ready.claim(request.out, Hold::Alone { resume: false })?;
    arrivals.iter().try_for_each(|arrival| arrival.write(&folder))?;
    request.progress.note(&ready.description());
    let records = queue::run(slice::from_ref(&ready), slice::from_ref(&folder), request)?;
    records.into_iter().flatten().next().ok_or_else(|| ScheduleError::Stopped {
        folder: request.out.into(),
        finished: 0,
        planned: 1,
    })
}

/// Returns the experiment with one final run, and with nothing to train.
fn scored(mut experiment: Experiment, imported: Imported) -> Result<Experiment, ScheduleError> {
    if experiment.inputs.select {
        return Err(ScheduleError::Usage {
            what: "the experiment chooses its inputs (inputs.select = true)".into(),
            help: "give the run folder of the experiment, whose inputs are chosen".into(),
        });
    }
    experiment.baseline = None;
    experiment.inputs.straight_path = false; // the network learned the whole residual
    experiment.training = TrainingConfig::of_imported(imported);
    experiment.protocol.cross_validation = false;
    experiment.protocol.final_runs = true;
    experiment.protocol.seeds.truncate(1);
    Ok(experiment)
}
