//! Preparation of a campaign: targets on which networks and comparators are scored.
//!
//! campaign → domain filter (once) → for each part of a split: nominal prediction → residual → channels → [`Series`]

use std::{collections::BTreeMap, ops::Range};

use acm_datasets::{
    Campaign, Channel, DropReason, Entry, Manifest, Role, Series, Trial, default_channels, default_rates,
    domain_filter,
    levels::{self, Constant},
    series,
};
use nalgebra::DMatrix;

use super::Data;
use super::shuffle::shuffle;
use crate::config::{ConfigError, Elapsed, Experiment, Fault, Source};
use crate::run::error::RunError;
use crate::run::names;
use crate::run::nominal::predict;
use crate::run::plan::Plan;
use crate::run::record::{CalibrationPair, DataStamp, Floors, TrialStamp};

/// Series of some trials, and the predictions of the comparator.
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// Inputs, residual, nominal prediction and measurement of each trial.
    pub series: Vec<Series>,
    /// The comparator's prediction of each trial, [T×O].
    pub polynomial: Vec<DMatrix<f64>>,
}

impl Part {
    /// Adds a trial.
    pub fn push(
        &mut self,
        trial: &Trial,
        tip: Range<usize>,
        pair: &CalibrationPair,
        channels: &[Channel],
        experiment: &Experiment,
    ) {
        let (trial, _) = trial.with_unmeasured(); // windows hold the inputs of samples without an output
        let (nominal, polynomial) = predict(pair, &trial);
        let nominal = nominal.columns_range(tip.clone()).into_owned();
        let mut series = series(&trial, nominal, tip.clone(), channels, experiment.windows.gap());
        if experiment.network.corrects_actuators()
            && let Some(slopes) = pair.arm().and_then(|arm| arm.actuator_slopes(&trial.actuators))
        {
            let width = trial.actuators.ncols();
            series.slopes = slopes.columns_range(tip.start * width..tip.end * width).into_owned();
        }
        if experiment.memory.is_trial() {
            // A median step of the trial is not known at its start; a gap is what a start follows.
            series.segments.iter().for_each(|segment| series.elapsed[segment.start] = experiment.windows.gap());
        }
        if experiment.windows.elapsed == Elapsed::One {
            series.elapsed.fill(1.0);
        }
        self.series.push(series);
        self.polynomial.push(polynomial.columns_range(tip).into_owned());
    }

    /// Permutes the inputs that the experiment shuffles, once all trials are there.
    pub fn shuffle(&mut self, channels: &[Channel], experiment: &Experiment) {
        for name in &experiment.inputs.shuffled {
            if let Some(column) = channels.iter().position(|channel| channel.name == *name) {
                shuffle(&mut self.series, column, name);
            }
        }
    }
}

/// Keeps the samples that the experiment's domain filter accepts.
///
/// # Errors
/// The filter cannot be applied to these data.
pub fn filtered(campaign: Campaign, experiment: &Experiment) -> Result<Campaign, RunError> {
    let calibration: Vec<&Trial> = campaign.trials(Role::Calibration).collect();
    let all: Vec<&Trial> = campaign.trials.iter().collect();
    let trials = domain_filter(experiment.inputs.domain_filter, &calibration, &all)?;
    Ok(Campaign { trials, ..campaign })
}

/// Returns the channels that the experiment names, or all actuators and context signals, and where the state is carried their
/// rates ([`default_rates`]).
///
/// # Errors
/// A name that the data do not have.
pub fn channels(
    experiment: &mut Experiment,
    source: &Source,
    manifest: &Manifest,
    trials: &[Entry],
) -> Result<Vec<Channel>, RunError> {
    let names = experiment.inputs.channels.clone().unwrap_or_else(|| {
        let rates = if experiment.memory.is_trial() { default_rates(manifest, trials) } else { vec![] };
        [default_channels(manifest), rates].concat()
    });
    let parse = |name: &String| {
        Channel::parse(name, manifest, trials).map_err(|unknown| {
            let key = ["inputs".to_string(), "channels".to_string()];
            let help = "name actuators, context signals or conditions of the manifest, or their rate(…)";
            RunError::from(Box::new(source.complaint(&key, format!("`inputs.channels`: {unknown}"), help)))
        })
    };
    let channels = names.iter().map(parse).collect::<Result<_, _>>()?;
    experiment.inputs.channels = Some(names);
    Ok(channels)
}

/// Refuses to shuffle a channel that is no input.
///
/// # Errors
/// Names the first that is none.
pub fn refuse_unknown_shuffles(experiment: &Experiment, source: &Source) -> Result<(), ConfigError> {
    let channels = experiment.inputs.channels.as_deref().unwrap_or_default();
    let unknown = experiment.inputs.shuffled.iter().find(|name| !channels.contains(name));
    source.refuse_first(unknown.map(|name| {
        let help = format!("the inputs are {}; name some of them, or delete the key", channels.join(", "));
        Fault::new("inputs.shuffled", format!("names {name:?}, which is no input"), help)
    }))
}

/// Refuses windows that no trial of a part is long enough for.
///
/// # Errors
/// Names the part, its longest stretch without a gap, and the key.
pub fn refuse_long_windows(
    experiment: &Experiment,
    source: &Source,
    data: &Data,
    plans: &[Plan],
) -> Result<(), RunError> {
    let asked = &experiment.windows;
    if experiment.memory.is_trial() {
        return Ok(());
    }
    let entries: BTreeMap<&str, &Entry> = data.entries.iter().map(|entry| (entry.name.as_str(), entry)).collect();
    for plan in plans {
        for (part, names) in [("training", &plan.split.training), ("validation", &plan.split.validation)] {
            let trials = || names.iter().filter_map(|name| entries.get(name.as_str()));
            let samples = trials().map(|trial| trial.longest).max().unwrap_or(0);
            if samples < asked.reach {
                let what = format!(
                    "`windows.reach` is {}, and the longest stretch of the {part} trials ({}) has {samples} samples without a gap over {} \
                     s",
                    asked.reach,
                    names::some(names, ", "),
                    asked.gap()
                );
                let left_out = |trial: &&Entry| trial.dropped.get(&DropReason::OutsideDomain).copied();
                let outside: usize = trials().filter_map(left_out).sum();
                let what = match outside {
                    0 => what,
                    outside => format!("{what}; the domain filter left out {outside} samples of them"),
                };
                let help = "shorten windows.reach, allow a longer windows.max_gap, or widen inputs.domain_filter";
                let key = ["windows".to_string(), "reach".to_string()];
                return Err(Box::new(source.complaint(&key, what, help)).into());
            }
        }
    }
    Ok(())
}

/// Returns the origin of the numbers, for the records.
pub fn stamp(data: &Data, floors: Option<Floors>) -> DataStamp {
    let trial = |trial: &Entry| {
        let dropped: BTreeMap<String, usize> =
            trial.dropped.iter().map(|(reason, count)| (reason.to_string(), *count)).collect();
        (trial.name.clone(), TrialStamp { role: trial.role.name().into(), samples: trial.samples, dropped })
    };
    let manifest = &data.manifest;
    DataStamp {
        name: manifest.name.clone(),
        title: manifest.title.clone(),
        licence: manifest.licence.clone(),
        source: manifest.provenance().to_string(),
        synthetic: manifest.synthetic,
        hash: data.hash.clone(),
        unit: manifest.output_unit().into(),
        trials: data.entries.iter().map(trial).collect(),
        floors,
        constant: constant(data),
    }
}

/// Returns the signals that are constant within the development trials, each with the number of its values.
fn constant(data: &Data) -> BTreeMap<String, usize> {
    let trials: Vec<&Entry> = data.of_role(Role::Development).collect();
    let actuators = data.manifest.actuator.iter().map(|signal| signal.name().to_string());
    let signals = actuators.chain(levels::context(&data.manifest, &trials));
    let of = |name: String| Constant::of(&name, &data.manifest, &trials).map(|signal| (name, signal.values.len()));
    signals.filter_map(of).collect()
}
