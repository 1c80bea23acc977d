//! A prepared experiment: data read, runs planned, nominal model calibrated.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use acm_core::{Calibration, display};
use acm_datasets::{
    Campaign, Channel, DomainFilter,
    recordings::{self, Options, Recordings},
};

use super::{
    error::ScheduleError,
    plans::{folds, plans},
    request::Request,
};
use crate::config::{self, CORRECTS_NO_ARM, CORRECTS_NO_ARM_HELP, Experiment, Fault, OutputLayer, Source};
use crate::run::data::prepare::{channels, filtered, refuse_long_windows, refuse_unknown_shuffles, stamp};
use crate::run::data::{CALIBRATION_SAMPLES, Data, Trials, range};
use crate::run::evaluation::floors;
use crate::run::nominal::augmented::{Predicted, predicted};
use crate::run::nominal::{calibrations, choose};
use crate::run::plan::Plan;
use crate::run::record::{CalibrationPair, DataStamp, NominalRecord, NominalSource};
use crate::run::setting::Setting;
use crate::run::{RunError, names};
use crate::store::{Hold, RunFolder};

/// An experiment with all that its runs need.
#[derive(Debug)]
pub struct Ready {
    /// The file that its values were written in.
    pub file: PathBuf,
    /// Configuration, with every default filled in.
    pub experiment: Experiment,
    /// The data after the domain filter.
    pub data: Data,
    /// The network's inputs.
    pub channels: Vec<Channel>,
    /// Planned runs.
    pub plans: Vec<Plan>,
    /// Calibrations of the nominal model.
    pub nominal: NominalRecord,
}

impl Ready {
    /// Reads, plans and calibrates, and writes nothing; `campaigns` are those that were read before.
    ///
    /// # Errors
    /// The data or the experiment cannot be used.
    pub fn new(
        experiment: Experiment,
        source: &Source,
        request: &Request,
        campaigns: &mut Campaigns,
    ) -> Result<Self, ScheduleError> {
        let calibrate = |experiment: &Experiment, data: &Data, plans: &[Plan], stamp| {
            Ok(calibrations(&choose(&experiment.nominal, source, &data.manifest)?, data, plans, stamp)?)
        };
        Self::with(experiment, source, request, campaigns, calibrate)
    }

    /// Prepares an experiment with an earlier calibration on the same data.
    ///
    /// # Errors
    /// As [`Ready::new`], or the data have changed.
    pub fn calibrated(
        experiment: Experiment,
        source: &Source,
        request: &Request,
        campaigns: &mut Campaigns,
        nominal: NominalRecord,
    ) -> Result<Self, ScheduleError> {
        let same = |_: &Experiment, data: &Data, _: &[Plan], stamp: DataStamp| {
            let (before, now) = (&nominal.data.hash, &stamp.hash);
            match before == now {
                true => Ok(nominal.clone()),
                false => Err(RunError::Unusable {
                    what: format!("the data {} have changed: hash {before}, now {now}", data.folder.display()),
                    help: "put the former data back, or train again with another --out".into(),
                }
                .into()),
            }
        };
        Self::with(experiment, source, request, campaigns, same)
    }

    fn with(
        mut experiment: Experiment,
        source: &Source,
        request: &Request,
        campaigns: &mut Campaigns,
        calibrate: impl Fn(&Experiment, &Data, &[Plan], DataStamp) -> Result<NominalRecord, ScheduleError>,
    ) -> Result<Self, ScheduleError> {
        let trials = campaigns.trials(&mut experiment, source, request)?;
        let data = Data::new(trials, &mut experiment.windows)?;
        let channels = channels(&mut experiment, source, &data.manifest, &data.entries)?;
        refuse_unknown_shuffles(&experiment, source)?;
        let (folds, data) = folds(&experiment, source, data)?;
        let plans = plans(&experiment, source, &data, &folds)?;
        refuse_long_windows(&experiment, source, &data, &plans)?;
        for warning in range::warnings(&experiment, &data, &channels, &plans)? {
            request.progress.note(&format!("warning: {warning}"));
        }
        let stamp = stamp(&data, floors::read(&data.folder)?);
        let runs = plans.iter().map(|plan| plan.id.clone()).collect();
        let nominal = NominalRecord { runs, ..calibrate(&experiment, &data, &plans, stamp)? };
        start(&mut experiment, nominal.source);
        let arms = nominal.calibrations.values().all(|pair| pair.arm().is_some());
        let lacks = experiment.network.corrects_actuators() && !arms;
        source.refuse_first(lacks.then(|| Fault::new("network.corrects", CORRECTS_NO_ARM, CORRECTS_NO_ARM_HELP)))?;
        Ok(Self { file: source.path().into(), experiment, data, channels, plans, nominal })
    }

    /// Claims the run folder `out`, and writes there what is to be run.
    ///
    /// # Errors
    /// The folder is in use, belongs to something else, or cannot be written.
    pub fn claim(&self, out: &Path, hold: Hold) -> Result<RunFolder, ScheduleError> {
        let folder = RunFolder::hold(out, hold)?;
        folder.adopt_experiment(&self.experiment, &self.nominal)?;
        Ok(folder)
    }

    /// Returns the settings that all its runs share.
    pub fn setting(&self) -> Setting<'_> {
        let Self { experiment, data, channels, nominal, .. } = self;
        Setting { experiment, data, channels, nominal }
    }

    /// Describes data and calibrations, for people.
    pub fn description(&self) -> String {
        let data = &self.nominal.data;
        let synthetic = if data.synthetic { " (synthetic data)" } else { "" };
        let rms = |fitted: &Calibration| display::shown(fitted.rms_total, &data.unit);
        let brought =
            if self.nominal.source == NominalSource::Augmented { "as it was saved" } else { "the data's own" };
        let mut lines = vec![format!("{}{synthetic}", data.title)];
        for pair in self.nominal.calibrations.values() {
            let (trials, own) = (calibrated_on(pair), pair.nominal.as_ref().map_or(brought.to_string(), rms));
            lines.push(format!("calibrated on {trials}: nominal {own}, polynomial {}", rms(&pair.polynomial)));
        }
        lines.join("\n")
    }
}

/// Sets networks to start from the nominal model where there is one, unless configured otherwise.
fn start(experiment: &mut Experiment, source: NominalSource) {
    let start = if source == NominalSource::None { OutputLayer::Random } else { OutputLayer::Zero };
    if experiment.baseline.is_none() {
        experiment.training.output_layer.get_or_insert(start);
    }
}

/// Returns the trials of a calibration, and how many of their samples it took where it did not take all.
fn calibrated_on(pair: &CalibrationPair) -> String {
    let (trials, taken) = (&pair.trials, pair.polynomial.samples);
    let every = if taken == CALIBRATION_SAMPLES { format!(" ({taken} samples of them)") } else { String::new() };
    names::some(trials, " ") + &every
}

/// Data sets that were read and filtered, so that the experiments of a study share them.
#[derive(Debug)]
pub struct Campaigns {
    known: Vec<(PathBuf, DomainFilter, Trials)>,
    hold: usize,
}

impl Default for Campaigns {
    fn default() -> Self {
        Self::holding(recordings::HOLD)
    }
}

impl Campaigns {
    /// Returns a cache whose sets with more than `samples` stay on the disk.
    pub fn holding(samples: usize) -> Self {
        Self { known: vec![], hold: samples }
    }

    /// Returns all data of an experiment in memory, its saved model and its domain filter applied.
    ///
    /// # Errors
    /// There are no such data, or they cannot be used.
    pub fn of(
        &mut self,
        experiment: &mut Experiment,
        source: &Source,
        request: &Request,
    ) -> Result<Arc<Campaign>, ScheduleError> {
        self.hold = usize::MAX;
        match self.trials(experiment, source, request)? {
            Trials::Held(campaign) => Ok(campaign),
            Trials::Streamed(set, _) => Err(RunError::Unusable {
                what: format!("{} has too many samples for memory", set.manifest.name),
                help: "take fewer of its trials".into(),
            }
            .into()),
        }
    }

    /// Returns the data of an experiment, its saved model and its domain filter applied; in memory where they are few.
    ///
    /// A saved model predicts whole trials, and its predictions are held with them.
    ///
    /// # Errors
    /// There are no such data, or they cannot be used.
    pub fn trials(
        &mut self,
        experiment: &mut Experiment,
        source: &Source,
        request: &Request,
    ) -> Result<Trials, ScheduleError> {
        let (folder, filter) = (find(experiment, source)?, experiment.inputs.domain_filter);
        let shared = experiment.nominal.augmented.is_none();
        let alike = |known: &&(PathBuf, DomainFilter, _)| shared && (&known.0, known.1) == (&folder, filter);
        if let Some((_, _, trials)) = self.known.iter().find(alike) {
            return Ok(trials.clone());
        }
        let hold = if shared { self.hold } else { usize::MAX };
        let set = Recordings::open(&folder, request.data, &Options { hold, ..Options::default() })?;
        for warning in &set.warnings {
            request.progress.note(&format!("warning: {warning}"));
        }
        let trials = if set.is_held() {
            let Predicted { campaign, warnings } = predicted(set.into(), &mut experiment.nominal, source)?;
            warnings.iter().for_each(|warning| request.progress.note(&format!("warning: {warning}")));
            Trials::Held(Arc::new(filtered(campaign, experiment)?))
        } else {
            let (samples, trials) = (set.samples(), set.entries.len());
            request.progress.note(&format!("{samples} samples in {trials} trials, which stay on the disk"));
            Trials::streamed(set, filter)?
        };
        if shared {
            self.known.push((folder, filter, trials.clone()));
        }
        Ok(trials)
    }
}

fn find(experiment: &Experiment, source: &Source) -> Result<PathBuf, ScheduleError> {
    config::find_folder(&experiment.data, source.path()).ok_or_else(|| {
        let what = format!("`data` is {:?}, and there is no such folder", experiment.data);
        let help = "name a folder with a manifest.toml, as seen from the current directory or from the experiment file";
        Box::new(source.complaint(&["data".to_string()], what, help)).into()
    })
}
