//! What the commands that look for effects are asked: which recordings, with which nominal model, and where the result goes.

use std::path::{Path, PathBuf};

use acm_core::calibration::CalibrationError;
use acm_datasets::Campaign;
use acm_eval::{
    error::EvalError,
    loop_config::LoopConfig,
    recordings::{Recordings, recordings},
};
use acm_trace::{close::About, finding::Data, trace::Options};
use acm_train::{
    config::{ConfigError, NominalKind, Source},
    run::nominal::choose,
};
use clap::Args;

/// What may be asked for.
#[derive(Args)]
pub struct Asked {
    /// Data set: a folder with manifest.toml
    #[arg(required_unless_present = "config", conflicts_with = "config")]
    folder: Option<PathBuf>,
    /// Configuration of close-loop, which names the data set
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Folder with the tables, where they do not lie beside the manifest
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Folder of the result [default: in runs/, named after the command and the folder or the configuration]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// File with effects of your own, tried beside those of the library (as effects.file of a configuration)
    #[arg(long, value_name = "FILE")]
    effects: Option<PathBuf>,
    /// Replace one value of the configuration, as a dotted key and a TOML value or a plain text; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// A question with its recordings.
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
    /// Reads configuration and recordings; the result goes into `runs/<prefix>-…` where no folder was named.
    pub fn read(&self, prefix: &str) -> Result<Question, EvalError> {
        let (config, source, folder) = self.question()?;
        let mut campaign = Campaign::read(&folder, self.data.as_deref()).map_err(EvalError::Table)?;
        config.leave_out(&mut campaign, &source)?;
        campaign.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
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

/// What the result repeats of the question; `cautions` weaken it, and `clock_interval` is that of the recordings.
pub fn about(
    config: &LoopConfig,
    campaign: &Campaign,
    cautions: Vec<String>,
    clock_interval: f64,
) -> Result<About, EvalError> {
    let manifest = &campaign.manifest;
    let data = Data {
        name: manifest.name.clone(),
        title: manifest.title.clone(),
        hash: campaign.hash.clone(),
        synthetic: manifest.synthetic,
        calibration: vec![],
        development: vec![],
        held_out: vec![],
    };
    let configuration = serde_json::to_value(config).map_err(|error| EvalError::Usage(error.to_string()))?;
    Ok(About { data, configuration, version: env!("CARGO_PKG_VERSION").into(), cautions, clock_interval })
}

/// The message for a nominal model that cannot be calibrated.
pub fn not_calibrated(campaign: &Campaign, error: &CalibrationError) -> EvalError {
    EvalError::Data(format!(
        "{}: the nominal model cannot be calibrated: {error}; choose another [nominal] model (strain, polynomial, \
         predicted), or give more calibration trials",
        campaign.manifest.name
    ))
}
