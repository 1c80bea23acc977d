//! A list of experiments: some experiment files, each with every set of edits.
//!
//! ```toml
//! question = "Which inputs carry the estimate?"
//! study    = "ablation"
//!
//! [[base]]                                   # as many as wanted; rows are called by these names
//! name       = "cfc"
//! experiment = "cfc.toml"                    # seen from this file
//!
//! [set]                                      # edits of all of them, as --set would make them
//! protocol.cross_validation = true
//!
//! [[variant]]                                # the first is what the others are compared with
//! name = "all inputs"
//! [[variant]]
//! name = "without altitude"
//! only = ["cfc"]                             # left out: every base
//! set.inputs.channels = ["q1", "q2", "throttle"]
//! ```
//!
//! A sweep has `[sweep]` in the place of variants ([`super::sweep`]), a search for the best model may have `[best]`
//! ([`super::best`]).

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

use serde::Deserialize;
use sha2::{Digest, Sha256};
use toml::{Table, Value};

use super::{
    best::asked::{self, Asked},
    sweep::{Sampler, Sweep},
};
use crate::config::{self, ConfigError, Edits, Experiment, Fault, Kind, Source, decode};

/// Contents of a file with a list of experiments.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct List {
    #[serde(rename = "study")]
    _study: String,
    /// Question in one sentence.
    pub question: String,
    /// The experiments that edits are applied to.
    #[serde(default)]
    pub base: Vec<Base>,
    /// Edits of all experiments.
    #[serde(default)]
    pub set: Table,
    /// Variants: one experiment for each of these and each base.
    #[serde(default)]
    pub variant: Vec<Variant>,
    /// Values to be tried, in the place of variants.
    pub sweep: Option<Sweep>,
    /// Settings of a search for the best model, beside the bases.
    pub best: Option<Asked>,
}

/// An experiment file with a name.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Base {
    /// Name in tables.
    pub name: String,
    /// Path of the file, relative to the study's.
    pub experiment: PathBuf,
    /// Edits of this base.
    #[serde(default)]
    pub set: Table,
}

/// A set of edits with a name.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variant {
    /// Name in tables.
    pub name: String,
    /// Names of the bases that it applies to; left out: all.
    pub only: Option<Vec<String>>,
    /// Edits of the variant.
    #[serde(default)]
    pub set: Table,
}

/// One experiment of the list.
#[derive(Debug)]
pub struct Member {
    /// Name of its run folder: a function of base and edits alone, so that it is found again.
    pub id: String,
    /// Name of its base.
    pub base: String,
    /// Name of its edits.
    pub variant: String,
    /// Values that the variant or the sweep sets, by dotted key.
    pub values: Vec<(String, Value)>,
    /// The experiment, checked.
    pub experiment: Experiment,
    /// Source of its values.
    pub source: Source,
}

/// Reads a list.
///
/// # Errors
/// Unknown keys, wrong types, no base, names that are not unique; with place and remedy.
pub fn read(source: &Source, kind: Kind) -> Result<List, ConfigError> {
    let list: List = decode(source, "acm-train --help")?;
    source.refuse_first(faults(&list, kind))?;
    Ok(list)
}

fn faults(list: &List, kind: Kind) -> Vec<Fault> {
    let mut faults = vec![];
    if list.base.is_empty() {
        faults.push(Fault::new(
            "base",
            "is missing, so there is nothing to edit",
            "write [[base]] with name and experiment",
        ));
    }
    let bases: Vec<&String> = list.base.iter().map(|base| &base.name).collect();
    let variants: Vec<&String> = list.variant.iter().map(|variant| &variant.name).collect();
    for (key, names) in [("base", &bases), ("variant", &variants)] {
        let mut seen = BTreeSet::new();
        if let Some(twice) = names.iter().position(|name| slug(name).is_empty() || !seen.insert(slug(name))) {
            let what = format!("is {:?}, which is empty or alike another", names[twice]);
            faults.push(Fault::new(&format!("{key}.{twice}.name"), what, "give each a name with letters of its own"));
        }
    }
    for (v, variant) in list.variant.iter().enumerate() {
        if variant.only.as_ref().is_some_and(Vec::is_empty) {
            let help = "name bases, or leave the key out for all of them";
            faults.push(Fault::new(&format!("variant.{v}.only"), "is empty, so the variant is of no base", help));
        }
        let unknown = variant.only.iter().flatten().find(|name| !bases.contains(name));
        faults.extend(unknown.map(|name| {
            let what = format!("names {name:?}, which is no base");
            let known: Vec<&str> = bases.iter().map(|base| base.as_str()).collect();
            Fault::new(&format!("variant.{v}.only"), what, format!("the bases are {}", known.join(", ")))
        }));
    }
    if kind == Kind::Best {
        faults.extend(asked::faults(list.best.as_ref(), &bases, list.variant.is_empty(), list.sweep.is_none()));
        return faults;
    }
    if list.best.is_some() {
        faults.push(Fault::new("best", "belongs to study = \"best\"", "write that, or delete the table"));
    }
    if kind == Kind::Inputs && !list.variant.is_empty() {
        let help = "delete it: sets of inputs are tried as the elimination goes; [set] edits all of them";
        faults.push(Fault::new("variant", "is not a key of study = \"inputs\"", help));
        return faults;
    }
    match (kind == Kind::Sweep, &list.sweep, list.variant.is_empty() && kind != Kind::Inputs) {
        (true, None, _) => faults.push(Fault::new("sweep", "is missing", "write [sweep] and [sweep.space]")),
        (true, Some(sweep), true) => faults.extend(sweep.faults()),
        (true, Some(_), false) => {
            faults.push(Fault::new("variant", "is set together with [sweep]", "delete one of the two"));
        }
        (false, Some(_), _) => {
            faults.push(Fault::new("sweep", "belongs to a sweep", "write study = \"sweep\", or delete the table"));
        }
        (false, None, true) => faults.push(Fault::new("variant", "is missing", "write at least one [[variant]]")),
        (false, None, false) => {}
    }
    faults
}

impl List {
    /// Returns the experiments of the variants, base by base.
    ///
    /// # Errors
    /// An experiment file or an edit of it cannot be used.
    pub fn members(&self, source: &Source) -> Result<Vec<Member>, ConfigError> {
        let mut members = vec![];
        for base in &self.base {
            for (name, values) in self.variants_of(base) {
                members.push(self.member(source, base, name, values)?);
            }
        }
        Ok(members)
    }

    /// Returns the names of the variants of a base, and what they set.
    pub fn variants_of<'l>(&'l self, base: &'l Base) -> impl Iterator<Item = (&'l str, Vec<(String, Value)>)> {
        let made_of = move |variant: &&Variant| variant.only.as_ref().is_none_or(|only| only.contains(&base.name));
        self.variant.iter().filter(made_of).map(|variant| (variant.name.as_str(), leaves(&variant.set)))
    }

    /// Returns one experiment: `base` with the common edits, and with `values`.
    ///
    /// # Errors
    /// As [`List::members`].
    pub fn member(
        &self,
        source: &Source,
        base: &Base,
        variant: &str,
        values: Vec<(String, Value)>,
    ) -> Result<Member, ConfigError> {
        let mut edited = self.source_of(source, base, variant, &values)?;
        let experiment = config::of_source(&mut edited)?;
        let id = format!("{}-{}", slug(&base.name), slug(variant));
        Ok(Member { id, base: base.name.clone(), variant: variant.into(), values, experiment, source: edited })
    }

    /// Returns the file of `base` with the common edits, and with `values`.
    ///
    /// # Errors
    /// The file cannot be read, or an edit of it cannot be made.
    pub fn source_of(
        &self,
        source: &Source,
        base: &Base,
        variant: &str,
        values: &[(String, Value)],
    ) -> Result<Source, ConfigError> {
        let (table, whole) = match self.variant.iter().position(|known| known.name == variant) {
            Some(v) if self.sweep.is_none() => (vec!["variant".into(), v.to_string(), "set".into()], false),
            _ => (vec!["sweep".into(), "space".into()], true),
        };
        let edits = [
            (Edits { study: source, table: vec!["set".into()], whole: false }, leaves(&self.set)),
            (Edits { study: source, table, whole }, values.to_vec()),
        ];
        self.edited(source, base, variant, &edits)
    }

    /// Returns the epochs of `base`, with the common edits.
    ///
    /// # Errors
    /// As [`List::members`]; a halving of a baseline, which has none.
    pub fn epochs(&self, source: &Source, base: &Base) -> Result<usize, ConfigError> {
        let experiment = self.member(source, base, "", vec![])?.experiment;
        let halving = self.sweep.as_ref().is_some_and(|sweep| sweep.sampler == Sampler::Halving);
        if experiment.baseline.is_some() && halving {
            let what =
                format!("`sampler` is \"halving\", and {:?} is a {} without epochs", base.name, experiment.kind());
            let place = ["sweep".to_string(), "sampler".to_string()];
            return Err(Box::new(source.complaint(&place, what, "take sampler = \"sobol\" or \"bayes\" for it")).into());
        }
        Ok(experiment.training.epochs)
    }

    /// Returns the experiment of `base` without the edits of the list.
    ///
    /// # Errors
    /// As [`List::members`].
    pub fn original(&self, source: &Source, base: &Base) -> Result<Experiment, ConfigError> {
        config::of_source(&mut self.untouched(source, base)?)
    }

    /// Returns the file of `base` without the edits of the list.
    ///
    /// # Errors
    /// As [`List::source_of`].
    pub fn untouched(&self, source: &Source, base: &Base) -> Result<Source, ConfigError> {
        self.edited(source, base, "", &[])
    }

    /// Returns the file of `base` with its own edits and then others.
    fn edited(
        &self,
        source: &Source,
        base: &Base,
        variant: &str,
        edits: &[(Edits, Vec<(String, Value)>)],
    ) -> Result<Source, ConfigError> {
        let index = self.base.iter().position(|known| known.name == base.name).unwrap_or(0).to_string();
        let key = |name: &str| vec!["base".to_string(), index.clone(), name.to_string()];
        let file = source.path().parent().unwrap_or(Path::new("")).join(&base.experiment);
        if !file.is_file() {
            let what = format!("`experiment` is {:?}, and there is no file {}", base.experiment, file.display());
            let help = "name an experiment file, as seen from this file: experiment = \"cfc.toml\"";
            return Err(Box::new(source.complaint(&key("experiment"), what, help)).into());
        }
        let mut edited = Source::read(&file, &[])?;
        edited.asked_by(format!(" (in variant {variant:?} of base {:?} of {})", base.name, source.path().display()));
        let own = (Edits { study: source, table: key("set"), whole: false }, leaves(&base.set));
        for (place, values) in std::iter::once(&own).chain(edits) {
            values.iter().try_for_each(|(key, value)| edited.edit_from(place, key, value))?;
        }
        Ok(edited)
    }
}

/// Returns dotted key and value of everything in a table.
fn leaves(table: &Table) -> Vec<(String, Value)> {
    let below = |(name, value): (&String, &Value)| -> Vec<(String, Value)> {
        let name = if name.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c)) {
            name.clone()
        } else {
            Value::String(name.clone()).to_string()
        };
        match value {
            Value::Table(inner) => leaves(inner).into_iter().map(|(key, v)| (format!("{name}.{key}"), v)).collect(),
            leaf => vec![(name, leaf.clone())],
        }
    };
    table.iter().flat_map(below).collect()
}

/// Returns letters, digits and dots of a name, in lower case, with hyphens for the rest: fit for a folder.
pub fn slug(name: &str) -> String {
    let kept = |c: char| if c.is_alphanumeric() || c == '.' { c.to_lowercase().next().unwrap_or(c) } else { '-' };
    let text: String = name.chars().map(kept).collect();
    text.split('-').filter(|word| !word.is_empty()).collect::<Vec<_>>().join("-")
}

/// Longest name of a folder in bytes; longer ones are cut.
const LONGEST: usize = 120;

/// Returns the name of the run folder of a variant of a base: file systems refuse names of more than 255 bytes.
pub fn folder(base: &str, variant: &str) -> String {
    let whole = format!("{}-{}", slug(base), slug(variant));
    if whole.len() <= LONGEST {
        return whole;
    }
    let start: String = whole.chars().take(LONGEST / 4).collect();
    format!("{start}-{}", &acm_hashed::hexadecimal(&Sha256::digest(&whole))[..16])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_many_inputs_are_short_and_differ() {
        assert_eq!(folder("CfC", "q1 rate(q1)"), "cfc-q1-rate-q1");
        let many: Vec<String> = (0..60).map(|n| format!("rate(channel{n})")).collect();
        let (all, fewer) = (folder("CfC", &many.join(" ")), folder("CfC", &many[..59].join(" ")));
        assert!(all != fewer && all.len() < 100 && fewer.len() < 100, "{all} {fewer}");
    }

    #[test]
    fn tables_become_edits() {
        let table: Table = "a.b = 1\na.c.d = [1, 2]\ne = \"x\"\n\"f g\" = 0.5".parse().unwrap();
        let texts: Vec<String> = leaves(&table).iter().map(|(key, value)| format!("{key}={value}")).collect();
        assert_eq!(texts, ["a.b=1", "a.c.d=[1, 2]", "e=\"x\"", "\"f g\"=0.5"]);
    }

    #[test]
    fn names_become_folders() {
        assert_eq!(slug("without rate(q1)"), "without-rate-q1");
        assert_eq!(slug("Δt = 1"), "δt-1");
        assert_eq!(slug("length=25 learning_rate=0.001"), "length-25-learning-rate-0.001");
        assert_eq!(slug("../.."), "..-..");
    }
}
