//! Question to recordings: the data, the nominal model, and the folder of the result; and the answers.
//!
//! [`config`] reads what is asked, with criteria of the search by name ([`criteria`]); [`recordings`](mod@recordings) sorts the
//! trials by role.

pub mod config;
pub mod criteria;
pub mod recordings;

use std::path::{Path, PathBuf};

use acm_core::{augmented::AugmentedModel, calibration::CalibrationError};
use acm_datasets::Campaign;
use acm_trace::{
    close::{About, Closed, close},
    finding::{Data, Separability, Step},
    separability::separability,
    trace::Options,
};
use acm_train::config::{ConfigError, NominalKind, Source};
use acm_train::run::nominal::augmented::origin;
use acm_train::run::nominal::choose;
use clap::Args;

use crate::error::EvalError;
use crate::question::config::LoopConfig;
use crate::question::recordings::{Recordings, recordings};

/// What may be asked for.
#[derive(Debug, Default, Args)]
pub struct Asked {
    /// Data set: a folder with manifest.toml
    #[arg(required_unless_present = "config", conflicts_with = "config")]
    pub folder: Option<PathBuf>,
    /// Configuration of close-loop, which names the data set
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Folder with the tables, where they do not lie beside the manifest
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Folder of the result [default: in runs/, named after the command and the folder or the configuration]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// File with effects of your own, tried beside those of the library (as effects.file of a configuration)
    #[arg(long, value_name = "FILE")]
    pub effects: Option<PathBuf>,
    /// Replace one value of the configuration, as a dotted key and a TOML value or a plain text; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// A question with its recordings.
#[derive(Debug)]
pub struct Question {
    /// As resolved.
    pub config: LoopConfig,
    /// How to search, with the effects of one's own.
    pub options: Options,
    /// Where its values were written.
    pub source: Source,
    /// The recordings as they were read.
    pub campaign: Campaign,
    /// The same as arrays, sorted by role.
    pub recordings: Recordings,
    /// Folder of the result.
    pub out: PathBuf,
}

impl Asked {
    /// Reads configuration and recordings; the result goes into `runs/<prefix>-…` where no folder was named. `warn` is told what
    /// looks wrong in the recordings and may be right.
    ///
    /// # Errors
    /// A configuration or recordings that cannot be used.
    pub fn read(&self, prefix: &str, mut warn: impl FnMut(&str)) -> Result<Question, EvalError> {
        let (config, source, folder) = self.question()?;
        let mut campaign = Campaign::read(&folder, self.data.as_deref()).map_err(EvalError::Table)?;
        config.leave_out(&mut campaign, &source)?;
        campaign.warnings.iter().for_each(|warning| warn(warning));
        let choice = choose(&config.nominal, &source, &campaign.manifest)?;
        let own = choice.spec().is_none();
        let nominal = choice.spec().cloned().unwrap_or_else(|| campaign.nominal_spec());
        let recordings = recordings(&campaign, nominal, own)?;
        let options = Options { own: config.own_on(&recordings.case.rig, &source)?, ..config.options() };
        Ok(Question { out: self.out(prefix, &folder), config, options, source, campaign, recordings })
    }

    fn question(&self) -> Result<(LoopConfig, Source, PathBuf), EvalError> {
        let (config, source) = match (&self.config, &self.folder) {
            (Some(file), _) => LoopConfig::read_with(file, &self.set, self.effects.as_deref())?,
            (None, folder) => {
                let folder = folder.as_deref().unwrap_or(Path::new("."));
                LoopConfig::for_folder_with(folder, &self.set, self.effects.as_deref())?
            }
        };
        let folder = match &self.folder {
            Some(folder) => folder.clone(),
            None => config.data_folder(&source)?,
        };
        if config.nominal.model == Some(NominalKind::None) {
            let what = "`nominal.model` is \"none\", and a model that predicts nothing lacks everything";
            let help = "write strain, polynomial or predicted, or leave the key out for what the manifest describes";
            let key = ["nominal".to_string(), "model".to_string()];
            return Err(ConfigError::from(Box::new(source.complaint(&key, what, help))).into());
        }
        Ok((config, source, folder))
    }

    fn out(&self, prefix: &str, folder: &Path) -> PathBuf {
        let name = || {
            let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.into());
            let name = self.config.as_ref().map_or(folder.file_name(), |file| file.file_stem());
            name.map_or("data".into(), |name| name.to_string_lossy().into_owned())
        };
        self.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("{prefix}-{}", name())))
    }
}

impl Question {
    /// Finds what the nominal model lacks, and adds it; `tried` is told every step.
    ///
    /// # Errors
    /// A nominal model that cannot be calibrated.
    pub fn close(self, tried: impl FnMut(&Step)) -> Result<Closed, EvalError> {
        let about = self.about()?;
        let Recordings { case, holdout, .. } = self.recordings;
        let closed = close(case, &holdout, about, &self.options, tried);
        let mut closed = closed.map_err(|error| not_calibrated(&self.campaign, &error))?;
        closed.model = noted(closed.model, &self.campaign);
        Ok(closed)
    }

    /// Says which effects these trials could tell apart.
    ///
    /// # Errors
    /// As [`Question::close`].
    pub fn separability(self) -> Result<Separability, EvalError> {
        let about = self.about()?;
        let found = separability(self.recordings.case, about, &self.options);
        found.map_err(|error| not_calibrated(&self.campaign, &error))
    }

    /// Returns the facts of the question that the result repeats.
    fn about(&self) -> Result<About, EvalError> {
        let manifest = &self.campaign.manifest;
        let data = Data {
            name: manifest.name.clone(),
            title: manifest.title.clone(),
            hash: self.campaign.hash.clone(),
            synthetic: manifest.synthetic,
            calibration: vec![],
            development: vec![],
            held_out: vec![],
        };
        let configuration = serde_json::to_value(&self.config).map_err(|error| EvalError::Usage(error.to_string()))?;
        let Recordings { cautions, clock_interval, .. } = &self.recordings;
        let (cautions, clock_interval) = (cautions.clone(), *clock_interval);
        Ok(About { data, configuration, version: env!("CARGO_PKG_VERSION").into(), cautions, clock_interval })
    }
}

/// Returns the model with the properties that distinguish its robot from others.
fn noted(model: AugmentedModel, campaign: &Campaign) -> AugmentedModel {
    let origin = origin(&model, campaign);
    model.with_origin(origin)
}

/// Returns the message for a nominal model that cannot be calibrated.
fn not_calibrated(campaign: &Campaign, error: &CalibrationError) -> EvalError {
    EvalError::Data(format!(
        "{}: the nominal model cannot be calibrated: {error}; choose another [nominal] model (strain, polynomial, \
         predicted), or give more calibration trials",
        campaign.manifest.name
    ))
}
