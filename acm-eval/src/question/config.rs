//! Configuration of the loop: one TOML file, every field with a default.
//!
//! ```toml
//! question = "What does the nominal model of the trunk lack?"
//! data     = "datasets/asl-trunk"
//! [nominal]                # as in an experiment of acm-train
//! degree = 2
//! [effects]                # or effects = "my_effects.toml"
//! without = ["creep"]
//! file    = "my_effects.toml"   # and, within the configuration, [[effects.define]]
//! [search]
//! max_effects = 3
//! [networks]
//! experiment = "experiments/trunk.toml"
//! ```
//!
//! A file names only what differs from the defaults; unknown keys, wrong types, `nan` and unknown effects are refused
//! with file, line and column, and so are edits of the command line (`--set search.max_effects=2`).

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use acm_core::effects;
use acm_core::effects::own::{Own, check, definition::Definition, read};
use acm_datasets::{Campaign, Role, Trial};
use acm_trace::search::criteria::Criteria;
use acm_trace::trace::Options;
use acm_train::config::{ConfigError, Fault, Nominal, Source, decode, find_file, find_folder, nominal_faults};
use serde::{Deserialize, Deserializer, Serialize, de};

/// One question to one data set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LoopConfig {
    /// Question in one sentence.
    pub question: String,
    /// Folder with `manifest.toml`: as seen from the current directory, else from this file's folder or one above it.
    pub data: PathBuf,
    /// The model that lacks something.
    pub nominal: Nominal,
    /// Effects that are tried.
    pub effects: Effects,
    /// Settings of the search.
    pub search: Search,
    /// Networks that are trained on the residual.
    pub networks: Networks,
    /// Effects that `effects.file` and `effects.define` define.
    #[serde(skip)]
    pub own: Vec<Definition>,
}

/// `[effects]`: the effects that are tried. The name of a file alone stands for a table with `file`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Effects {
    /// Stable names; `None` for all effects.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub only: Option<Vec<String>>,
    /// Effects that are not tried, although `only` allows them.
    pub without: Vec<String>,
    /// Effects of one's own, tried beside those of the library; found as `data` is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// The same, each as an `[[effect]]` of such a file.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub define: Vec<Definition>,
}

/// The table of [`Effects`].
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct EffectsTable {
    only: Option<Vec<String>>,
    without: Vec<String>,
    file: Option<PathBuf>,
    define: Vec<Definition>,
}

struct FileOrTable;

impl<'de> de::Visitor<'de> for FileOrTable {
    type Value = Effects;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "struct Effects")
    }

    fn visit_str<E: de::Error>(self, file: &str) -> Result<Effects, E> {
        Ok(Effects { file: Some(file.into()), ..Effects::default() })
    }

    fn visit_map<A: de::MapAccess<'de>>(self, map: A) -> Result<Effects, A::Error> {
        let EffectsTable { only, without, file, define } =
            EffectsTable::deserialize(de::value::MapAccessDeserializer::new(map))?;
        Ok(Effects { only, without, file, define })
    }
}

impl<'de> Deserialize<'de> for Effects {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(FileOrTable)
    }
}

/// `[search]`: the limits of the search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Search {
    /// Effects at most; `most` in files of earlier versions.
    #[serde(alias = "most")]
    pub max_effects: usize,
    /// Samples that the search looks at.
    pub samples: usize,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Development trials that are excluded, both from the search and at its end: those of a fold on which the model is
    /// scored later.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub leave_out: Vec<String>,
}

/// `[networks]`: the comparison of nominal, nominal + effect, nominal + network, nominal + effect + network in one
/// table.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Networks {
    /// An experiment file of acm-train, found as `data` is; without it no network is trained.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub experiment: Option<PathBuf>,
}

/// Default question.
const QUESTION: &str = "Which physical effect does the nominal model lack?";

/// Smallest number of samples. Fewer cannot determine more than the parameters of a few effects.
const LEAST_SAMPLES: usize = 200;

/// Largest number of samples; more are in no campaign.
const MOST_SAMPLES: usize = 1_000_000_000;

/// Largest number of effects. No data could distinguish more of them at once.
const MOST_EFFECTS: usize = 12;

impl Default for LoopConfig {
    fn default() -> Self {
        Self {
            question: QUESTION.into(),
            data: "datasets/acm-twin".into(),
            nominal: Nominal::default(),
            effects: Effects::default(),
            search: Search::default(),
            networks: Networks::default(),
            own: vec![],
        }
    }
}

impl Default for Search {
    fn default() -> Self {
        Self { max_effects: 6, samples: 3000, seed: 1, leave_out: vec![] }
    }
}

impl LoopConfig {
    /// Reads a file, applies edits (`key=value`) in order, and checks every value.
    ///
    /// # Errors
    /// Anything that is unreadable, unknown, of a wrong type or out of bounds, with its place and a remedy.
    pub fn read(file: &Path, edits: &[String]) -> Result<(Self, Source), ConfigError> {
        Self::read_with(file, edits, None)
    }

    /// Reads the configuration with another file of effects in the place of `effects.file`.
    ///
    /// # Errors
    /// As [`LoopConfig::read`].
    pub fn read_with(file: &Path, edits: &[String], effects: Option<&Path>) -> Result<(Self, Source), ConfigError> {
        Self::of(Source::read(file, edits)?, effects)
    }

    /// Returns the defaults for the data set in `folder`, with `edits` on top.
    ///
    /// # Errors
    /// As [`LoopConfig::read`].
    pub fn for_folder(folder: &Path, edits: &[String]) -> Result<(Self, Source), ConfigError> {
        Self::for_folder_with(folder, edits, None)
    }

    /// Returns the default configuration of a folder with a file of effects.
    ///
    /// # Errors
    /// As [`LoopConfig::read`].
    pub fn for_folder_with(
        folder: &Path,
        edits: &[String],
        effects: Option<&Path>,
    ) -> Result<(Self, Source), ConfigError> {
        let source = Source::without_file(edits)?;
        if source.tree.contains_key("data") {
            let help = "leave it out, or name a file with --config instead of a folder";
            let what = "`data` is given twice: as a folder, and as a value";
            return Err(Box::new(source.complaint(&["data".to_string()], what, help)).into());
        }
        let (config, source) = Self::of(source, effects)?;
        Ok((Self { data: folder.into(), ..config }, source))
    }

    fn of(source: Source, effects: Option<&Path>) -> Result<(Self, Source), ConfigError> {
        let mut config: Self = decode(&source, "acm-eval close-loop --help")?;
        config.effects.file = effects.map(Path::to_path_buf).or(config.effects.file);
        config.own = config.own_effects(&source)?;
        source.refuse_first(config.faults(written_as(&source)))?;
        Ok((config, source))
    }

    /// Returns the folder that `data` means.
    ///
    /// # Errors
    /// There is none.
    pub fn data_folder(&self, source: &Source) -> Result<PathBuf, ConfigError> {
        find_folder(&self.data, source.path()).ok_or_else(|| {
            let what = format!("`data` is {:?}, and there is no such folder", self.data);
            let help = "name a folder with a manifest.toml, as seen from the current directory or from this file";
            Box::new(source.complaint(&["data".to_string()], what, help)).into()
        })
    }

    /// Returns the experiment file of the networks, where one is named.
    ///
    /// # Errors
    /// It is not there.
    pub fn experiment_file(&self, source: &Source) -> Result<Option<PathBuf>, ConfigError> {
        let Some(named) = &self.networks.experiment else { return Ok(None) };
        let found = find_file(named, source.path()).ok_or_else(|| {
            let what = format!("`networks.experiment` is {named:?}, and there is no such file");
            let help = "name an experiment file of acm-train, or leave the key out: then no network is trained";
            ConfigError::from(Box::new(source.complaint(&["networks".into(), "experiment".into()], what, help)))
        });
        found.map(Some)
    }

    /// Returns the effects of the file and of the configuration itself; each name once.
    fn own_effects(&self, source: &Source) -> Result<Vec<Definition>, ConfigError> {
        let refused =
            |what: String, help: &str| -> ConfigError { Box::new(source.complaint(&defined_key(), what, help)).into() };
        let mut own = self.effects_of_file(source)?;
        let defined = check(self.effects.define.clone(), DEFINED);
        let defined = defined.map_err(|error| refused(error.fault(), &error.help))?;
        if let Some(twice) = defined.iter().find(|one| own.iter().any(|other| other.name == one.name)) {
            let what = format!("`effects.define` and `effects.file` both define {:?}", twice.name);
            return Err(refused(what, "give each effect a name of its own"));
        }
        own.extend(defined);
        Ok(own)
    }

    /// What the file of effects defines; nothing where none is named.
    fn effects_of_file(&self, source: &Source) -> Result<Vec<Definition>, ConfigError> {
        let Some(named) = &self.effects.file else { return Ok(vec![]) };
        let refused = |what: String, help: String| -> ConfigError {
            Box::new(source.complaint(&effects_key(source), what, help)).into()
        };
        let help = "name a file of effects, as the chapter \"Effects of one's own\" of the book describes";
        let file = find_file(named, source.path())
            .ok_or_else(|| refused(format!("`effects.file` is {named:?}, and there is no such file"), help.into()))?;
        let size = std::fs::metadata(&file).map_or(0, |known| known.len());
        let text = match size {
            0..=LARGEST => std::fs::read_to_string(&file).map_err(|error| error.to_string()),
            _ => Err(format!("it has {size} bytes, and {LARGEST} at most are read")),
        };
        let text = text.map_err(|error| refused(format!("{}: {error}", file.display()), help.into()))?;
        read(&text, &named.display().to_string()).map_err(|error| refused(error.fault(), error.help))
    }

    /// Returns the effects of one's own on a rig.
    ///
    /// # Errors
    /// One that cannot be carried out there.
    pub fn own_on(&self, rig: &effects::Rig, source: &Source) -> Result<Vec<Arc<Own>>, ConfigError> {
        // What is left out need not fit the rig.
        let asked = self.own.iter().filter(|own| self.tries(&own.name));
        let on = |definition: &Definition| {
            Own::new(definition, rig).map_err(|error| -> ConfigError {
                let key = if definition.file == DEFINED { defined_key() } else { effects_key(source) };
                Box::new(source.complaint(&key, error.fault(), error.help)).into()
            })
        };
        asked.map(on).collect()
    }

    /// Returns the names of all effects that may be tried.
    fn known(&self) -> Vec<&str> {
        let library = effects::ALL.iter().map(|effect| effect.name());
        library.chain(self.own.iter().map(|own| own.name.as_str())).collect()
    }

    /// Returns whether an effect is tried.
    pub fn tries(&self, effect: &str) -> bool {
        let named = |list: &[String]| list.iter().any(|name| name == effect);
        self.effects.only.as_deref().is_none_or(named) && !named(&self.effects.without)
    }

    /// Removes the trials of `search.leave_out` from a campaign.
    ///
    /// # Errors
    /// One of them is no development trial.
    pub fn leave_out(&self, campaign: &mut Campaign, source: &Source) -> Result<(), ConfigError> {
        let developed = |trial: &Trial, name: &String| trial.role == Role::Development && trial.name == *name;
        for (place, name) in self.search.leave_out.iter().enumerate() {
            let Some(trial) = campaign.trials.iter_mut().find(|trial| developed(trial, name)) else {
                let key = ["search".to_string(), "leave_out".into(), place.to_string()];
                let what = format!("`{}` is {name:?}, which is no development trial", key.join("."));
                return Err(Box::new(source.complaint(&key, what, "name trials of that role, each once")).into());
            };
            trial.role = Role::Excluded;
        }
        Ok(())
    }

    /// Returns the options of the search; effects of one's own are bound to a rig separately ([`LoopConfig::own_on`]).
    pub fn options(&self) -> Options {
        let Search { max_effects, samples, seed, .. } = self.search;
        let Effects { only, without, .. } = self.effects.clone();
        let criteria = Criteria { max_effects, ..Criteria::default() };
        Options { criteria, samples, seed, only, without, own: vec![] }
    }

    /// Returns every fault that can be found without the data; `most` is the key of `max_effects` as it was written.
    fn faults(&self, most: &str) -> Vec<Fault> {
        let mut faults = nominal_faults(&self.nominal);
        if self.data.as_os_str().is_empty() {
            faults.push(Fault::new("data", "is empty", "name a folder with a manifest.toml"));
        }
        if self.nominal.augmented.is_some() {
            let help = "give acm-train that model; here, let its predictions be [[predicted]] columns of the data";
            faults.push(Fault::new("nominal.augmented", "is a model that has its effects already", help));
        }
        let only = self.effects.only.as_deref();
        for (key, names) in
            [("effects.only", only.unwrap_or_default()), ("effects.without", self.effects.without.as_slice())]
        {
            faults
                .extend(names.iter().enumerate().filter_map(|(index, name)| unknown(key, index, name, &self.known())));
        }
        if faults.is_empty() && !self.known().iter().any(|name| self.tries(name)) {
            let key = if only.is_some_and(<[String]>::is_empty) { "effects.only" } else { "effects" };
            let help =
                "take an effect out of `without`, or add one to `only`; without the key `only` all effects are tried";
            faults.push(Fault::new(key, "leaves no effect to try", help));
        }
        let Search { max_effects, samples, .. } = self.search;
        if !(1..=MOST_EFFECTS).contains(&max_effects) {
            let help = format!("write the number of effects that may be found at once, 1 to {MOST_EFFECTS}");
            faults.push(Fault::new(most, format!("is {max_effects}"), help));
        }
        if !(LEAST_SAMPLES..=MOST_SAMPLES).contains(&samples) {
            let help = format!("write {LEAST_SAMPLES} or more, {MOST_SAMPLES} at most; 3000 is the default");
            faults.push(Fault::new("search.samples", format!("is {samples}"), help));
        }
        faults
    }
}

/// Returns the key of `max_effects`, or its alias where that was written, so that a fault is reported with its place.
fn written_as(source: &Source) -> &'static str {
    let search = source.tree.get("search");
    let is_alias = search.is_some_and(|search| search.get("most").is_some());
    if is_alias { "search.most" } else { "search.max_effects" }
}

/// Returns the key that names the file of effects: `effects = "…"`, or `effects.file`.
fn effects_key(source: &Source) -> Vec<String> {
    let is_table = source.tree.get("effects").is_some_and(|value| value.as_table().is_some());
    let mut key = vec!["effects".to_string()];
    key.extend(is_table.then(|| "file".to_string()));
    key
}

/// Name of the definitions within a configuration.
const DEFINED: &str = "effects.define";

fn defined_key() -> Vec<String> {
    DEFINED.split('.').map(str::to_string).collect()
}

/// Bytes of a file of effects at most.
const LARGEST: u64 = 1 << 20;

fn unknown(key: &str, index: usize, name: &str, known: &[&str]) -> Option<Fault> {
    let fault = || Fault::new(&format!("{key}.{index}"), format!("is {name:?}, which is no effect"), help(known));
    (!known.contains(&name)).then(fault)
}

fn help(known: &[&str]) -> String {
    format!("known effects: {}", known.join(" "))
}
