//! An experiment that is ready to be run: its data read, its runs planned, its nominal model calibrated.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use acm_core::Calibration;
use acm_datasets::{Campaign, Channel, DomainFilter};

use crate::{
    augmented,
    error::TrainError,
    experiment::{self, Experiment, Source},
    floors,
    folder::{Hold, RunFolder},
    job::Request,
    nominal::{calibrations, choose},
    plan::{Plan, plans},
    prepare::{channels, filtered, refuse_long_windows, refuse_strange_shuffles, stamp},
    range,
    record::{DataStamp, NominalRecord, NominalSource},
    run::Setting,
    summary,
};

/// An experiment with all that its runs need.
#[derive(Debug)]
pub struct Ready {
    /// The file that its values were written in.
    pub file: PathBuf,
    /// What is asked, every default filled in.
    pub experiment: Experiment,
    /// The data after the domain filter.
    pub campaign: Arc<Campaign>,
    /// The network's inputs.
    pub channels: Vec<Channel>,
    /// The runs.
    pub plans: Vec<Plan>,
    /// The calibrations.
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
    ) -> Result<Self, TrainError> {
        let calibrate = |experiment: &Experiment, campaign: &Campaign, plans: &[Plan], data| {
            calibrations(&choose(&experiment.nominal, source, campaign)?, campaign, plans, data)
        };
        Self::with(experiment, source, request, campaigns, calibrate)
    }

    /// The same with what was calibrated before, of the same data.
    ///
    /// # Errors
    /// As [`Ready::new`], or the data have changed.
    pub fn calibrated(
        experiment: Experiment,
        source: &Source,
        request: &Request,
        campaigns: &mut Campaigns,
        nominal: NominalRecord,
    ) -> Result<Self, TrainError> {
        let same = |_: &Experiment, campaign: &Campaign, _: &[Plan], data: DataStamp| {
            let (before, now) = (&nominal.data.hash, &data.hash);
            match before == now {
                true => Ok(nominal.clone()),
                false => Err(TrainError::Usage {
                    what: format!("the data {} have changed: hash {before}, now {now}", campaign.folder.display()),
                    help: "put the former data back, or begin anew with --out DIR".into(),
                }),
            }
        };
        Self::with(experiment, source, request, campaigns, same)
    }

    fn with(
        mut experiment: Experiment,
        source: &Source,
        request: &Request,
        campaigns: &mut Campaigns,
        calibrate: impl Fn(&Experiment, &Campaign, &[Plan], DataStamp) -> Result<NominalRecord, TrainError>,
    ) -> Result<Self, TrainError> {
        let campaign = campaigns.of(&mut experiment, source, request)?;
        let channels = channels(&mut experiment, source, &campaign)?;
        refuse_strange_shuffles(&experiment, source)?;
        let plans = plans(&experiment, source, &campaign)?;
        refuse_long_windows(&experiment, source, &campaign, &plans)?;
        for warning in range::warnings(&experiment, &campaign, &channels, &plans) {
            request.progress.note(&format!("warning: {warning}"));
        }
        let data = stamp(&campaign, floors::read(&campaign.folder)?);
        let nominal = calibrate(&experiment, &campaign, &plans, data)?;
        Ok(Self { file: source.path().into(), experiment, campaign, channels, plans, nominal })
    }

    /// Claims the run folder `out`, and writes there what is to be run.
    ///
    /// # Errors
    /// The folder is in use, belongs to something else, or cannot be written.
    pub fn claim(&self, out: &Path, hold: Hold) -> Result<RunFolder, TrainError> {
        let folder = RunFolder::hold(out, hold)?;
        folder.adopt(&self.experiment, &self.nominal)?;
        Ok(folder)
    }

    /// What all its runs share.
    pub fn setting(&self) -> Setting<'_> {
        let Self { experiment, campaign, channels, nominal, .. } = self;
        Setting { experiment, campaign, channels, nominal }
    }

    /// Data and calibrations, for people.
    pub fn description(&self) -> String {
        let data = &self.nominal.data;
        let synthetic = if data.synthetic { " (synthetic data)" } else { "" };
        let (scale, unit) = summary::shown_unit(&data.unit);
        let rms = |fitted: &Calibration| format!("{:.2} {unit}", scale * fitted.rms_total);
        let brought =
            if self.nominal.source == NominalSource::Augmented { "as it was saved" } else { "the data's own" };
        let mut lines = vec![format!("{}{synthetic}", data.title)];
        for pair in self.nominal.calibrations.values() {
            let (trials, own) = (pair.trials.join(" "), pair.nominal.as_ref().map_or(brought.to_string(), rms));
            lines.push(format!("calibrated on {trials}: nominal {own}, polynomial {}", rms(&pair.polynomial)));
        }
        lines.join("\n")
    }
}

/// Data sets that were read and filtered, so that the experiments of a study share them.
#[derive(Debug, Default)]
pub struct Campaigns(Vec<(PathBuf, DomainFilter, Arc<Campaign>)>);

impl Campaigns {
    /// The data of an experiment, its saved model and its domain filter applied.
    ///
    /// # Errors
    /// There are no such data, or they cannot be used.
    pub fn of(
        &mut self,
        experiment: &mut Experiment,
        source: &Source,
        request: &Request,
    ) -> Result<Arc<Campaign>, TrainError> {
        let (folder, filter) = (find(experiment, source)?, experiment.inputs.domain_filter);
        let shared = experiment.nominal.augmented.is_none();
        let alike = |known: &&(PathBuf, DomainFilter, _)| shared && (&known.0, known.1) == (&folder, filter);
        if let Some((_, _, campaign)) = self.0.iter().find(alike) {
            return Ok(campaign.clone());
        }
        let campaign = Campaign::read(&folder, request.data)?;
        for warning in &campaign.warnings {
            request.progress.note(&format!("warning: {warning}"));
        }
        let predicted = augmented::predicted(campaign, &mut experiment.nominal, source)?;
        let campaign = Arc::new(filtered(predicted, experiment)?);
        if shared {
            self.0.push((folder, filter, campaign.clone()));
        }
        Ok(campaign)
    }
}

fn find(experiment: &Experiment, source: &Source) -> Result<PathBuf, TrainError> {
    experiment::find_folder(&experiment.data, source.path()).ok_or_else(|| {
        let what = format!("`data` is {:?}, and there is no such folder", experiment.data);
        let help = "name a folder with a manifest.toml, as seen from the current directory or from the experiment file";
        Box::new(source.complaint(&["data".to_string()], what, help)).into()
    })
}
