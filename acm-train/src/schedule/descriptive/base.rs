//! The experiment of a study: its data, domain filter and nominal model.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use acm_datasets::{Campaign, Role};

use crate::config::{self, Experiment, Source};
use crate::run::RunError;
use crate::run::data::prepare::stamp;
use crate::run::data::{Data, Trials};
use crate::run::evaluation::floors;
use crate::run::nominal::{calibrations, choose};
use crate::run::plan::Plan;
use crate::run::record::{CalibrationPair, DataStamp, FoldStamp, NominalSource, Split, Stage};
use crate::schedule::error::ScheduleError;
use crate::schedule::ready::Campaigns;
use crate::schedule::request::Request;

/// A base experiment with its data.
#[derive(Debug)]
pub struct Base {
    /// Experiment of the file, every default filled in.
    pub experiment: Experiment,
    /// Source of its values.
    pub source: Source,
    /// The data that the domain filter keeps.
    pub campaign: Arc<Campaign>,
    /// Origin of the numbers.
    pub data: DataStamp,
}

impl Base {
    /// Reads the experiment file `base`, whose place the study file gives, and its data.
    ///
    /// # Errors
    /// There is no such file, it is no experiment, or its data cannot be used.
    pub fn read(base: &Path, study: &Source, request: &Request) -> Result<Self, ScheduleError> {
        let file = beside(study.path(), base);
        if !file.is_file() {
            let what = format!("`base` is {base:?}, and there is no file {}", file.display());
            let help = "name an experiment file, as seen from the study file: base = \"cfc.toml\"";
            return Err(Box::new(study.complaint(&["base".into()], what, help)).into());
        }
        let (mut experiment, source) = config::read(&file, &[])?;
        let campaign = Campaigns::default().of(&mut experiment, &source, request)?;
        let listed = Data::new(Trials::Held(campaign.clone()), &mut experiment.windows)?;
        let data = stamp(&listed, floors::read(&campaign.folder)?);
        Ok(Self { experiment, source, campaign, data })
    }

    /// Returns the names of the trials of a role.
    pub fn names(&self, role: Role) -> Vec<String> {
        self.campaign.trials(role).map(|trial| trial.name.clone()).collect()
    }

    /// Returns the nominal model and its comparator as the experiment has them: calibrated on the calibration trials,
    /// or for want of such on all trials that it learns from.
    ///
    /// # Errors
    /// The experiment asks for a model that the data cannot have, or a fit is impossible.
    pub fn calibrated(&self) -> Result<(CalibrationPair, NominalSource), ScheduleError> {
        let choice = choose(&self.experiment.nominal, &self.source, &self.campaign.manifest)?;
        let learners = self.experiment.inputs.learn_from.iter().flat_map(|role| self.names(*role)).collect();
        let data = Data::new(Trials::Held(self.campaign.clone()), &mut self.experiment.windows.clone())?;
        let split = Split { training: learners, validation: vec![], held_out: vec![] };
        let folds = FoldStamp { made: "none".into(), count: 0, fold: 0, value_of: None };
        let all = Plan { id: "all".into(), stage: Stage::Final, seed: 0, folds, split };
        let mut record = calibrations(&choice, &data, &[all], self.data.clone())?;
        let source = record.source;
        let pair = record.calibrations.pop_first().map(|(_, pair)| pair);
        let missing = || RunError::Unusable {
            what: format!("{} has no trials to calibrate on", self.data.name),
            help: "give trials the role calibration or development in the manifest".into(),
        };
        Ok((pair.ok_or_else(missing)?, source))
    }
}

/// Returns `path` as seen from the folder of `file`.
fn beside(file: &Path, path: &Path) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).join(path)
}
