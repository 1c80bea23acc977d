//! Compared experiments: each base, and each base on top of the loop's model.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use super::{
    asked::{Asked, LOOP},
    forecast::{self, Forecast},
    optimism::ratio,
    record::AugmentedStamp,
};
use crate::config::{ConfigError, Elapsed, Experiment, Fault, Nominal, Source, find_file};
use crate::run::nominal::augmented;
use crate::run::record::{RunRecord, Stage};
use crate::schedule::error::ScheduleError;
use crate::schedule::study::batch::Batches;
use crate::schedule::study::list::{List, Member, slug};
use crate::schedule::study::record::folder;
use crate::store::hashed;

/// The model of a closed loop.
#[derive(Debug, Clone)]
pub struct Loop {
    /// Path of its file.
    pub file: PathBuf,
    /// SHA-256 of that, hex.
    pub sha256: String,
    /// Fitted values of its effects; at least one.
    pub numbers: usize,
    /// Files of the model fitted without the trials of each fold; empty where there are none.
    pub folds: Vec<PathBuf>,
}

impl Loop {
    /// Returns the one that a study names.
    ///
    /// # Errors
    /// A file is not there, or is no saved model.
    pub fn of(list: &List, source: &Source) -> Result<Option<Self>, ScheduleError> {
        let Asked { augmented, loop_folds, .. } = list.best.clone().unwrap_or_default();
        let Some(named) = augmented else { return Ok(None) };
        let found = |key: &[&str], named: &PathBuf| {
            find_file(named, source.path()).ok_or_else(|| {
                let key: Vec<String> = key.iter().map(ToString::to_string).collect();
                let what = format!("`{}` is {named:?}, and there is no such file", key.join("."));
                let help = "run `acm-eval close-loop` on these data first, which writes model.json, or delete the key: then \
                            no model of a loop is compared";
                ConfigError::from(Box::new(source.complaint(&key, what, help)))
            })
        };
        let file = found(&["best", "loop"], &named)?;
        let folds = loop_folds.iter().enumerate();
        let folds: Vec<PathBuf> = folds
            .map(|(fold, named)| found(&["best", "loop_folds", &fold.to_string()], named))
            .collect::<Result<_, _>>()?;
        let model = augmented::read(&file)?;
        let values: usize = model.effects().iter().map(|term| term.values.len()).sum();
        Ok(Some(Self { sha256: hashed::of_file(&file)?, numbers: values.max(1), file, folds }))
    }

    /// Returns the stamp of the model for the record.
    pub fn stamp(&self) -> AugmentedStamp {
        AugmentedStamp { file: self.file.clone(), sha256: self.sha256.clone(), folds: self.folds.clone() }
    }
}

/// One experiment that is compared.
#[derive(Debug)]
pub struct Entrant {
    /// Name in tables.
    pub name: String,
    /// Name of its base.
    pub base: String,
    /// Name of its run folder.
    pub id: String,
    /// Whether the loop's model is its nominal model.
    pub above: bool,
    /// Experiment of the entrant.
    pub experiment: Experiment,
    /// Source of its values.
    pub source: Source,
}

/// Predictions of an entrant on the folds.
#[derive(Debug)]
pub struct InFolds {
    /// Mean over seeds.
    pub folds: Vec<Forecast>,
    /// Optimism ρ of each fold, mean over seeds ([`ratio`]).
    pub optimism: Vec<f64>,
    /// Fitted numbers of all seeds together, mean over folds.
    pub numbers: usize,
}

/// Returns every base, then every base with the loop's model as its nominal model.
///
/// # Errors
/// An experiment file cannot be used, or asks another question than the first.
pub fn entrants(list: &List, source: &Source, upon: Option<&Loop>) -> Result<Vec<Entrant>, ScheduleError> {
    let mut entrants: Vec<Entrant> = vec![];
    for above in [false, true] {
        for (place, base) in list.base.iter().enumerate().filter(|_| !above || upon.is_some()) {
            let Member { mut experiment, source: edited, .. } = list.member(source, base, "", vec![])?;
            let first = entrants.first().map_or(&experiment, |first| &first.experiment);
            source.refuse_first(differs(place, &experiment, first).filter(|_| !above))?;
            let (mut name, mut id) = (base.name.clone(), slug(&base.name));
            if let (true, Some(upon)) = (above, upon) {
                experiment.nominal = upon_loop(&upon.file, &experiment.nominal);
                (name, id) = (format!("{name} + {LOOP}"), format!("{id}-{LOOP}"));
            }
            entrants.push(Entrant { name, base: base.name.clone(), id, above, experiment, source: edited });
        }
    }
    Ok(entrants)
}

fn upon_loop(file: &Path, nominal: &Nominal) -> Nominal {
    let comparator_degree = nominal.comparator_degree;
    Nominal { augmented: Some(file.into()), comparator_degree, ..Nominal::default() }
}

/// Returns the fault of an experiment that differs in targets, folds or nominal model.
fn differs(place: usize, own: &Experiment, first: &Experiment) -> Option<Fault> {
    let (windows, inputs) = (&own.windows, &own.inputs);
    let key = match () {
        () if own.nominal.augmented.is_some() => {
            let what = "names nominal.augmented, and what all models stand upon is named once";
            let help = "write loop = \"…/model.json\" in [best], and delete nominal.augmented";
            return Some(Fault::new(&format!("base.{place}.experiment"), what, help));
        }
        () if own.data != first.data => "data",
        () if own.protocol != first.protocol => "protocol",
        () if own.nominal != first.nominal => "nominal",
        () if windows.reach != first.windows.reach => "windows.reach",
        () if windows.evaluation_stride != first.windows.evaluation_stride => "windows.evaluation_stride",
        () if windows.gap().to_bits() != first.windows.gap().to_bits() => "windows.max_gap",
        () if inputs.domain_filter != first.inputs.domain_filter => "inputs.domain_filter",
        () if inputs.learn_from != first.inputs.learn_from => "inputs.learn_from",
        () => return None,
    };
    let what = format!("has another `{key}` than the first, so that their errors are not of the same targets");
    Some(Fault::new(&format!("base.{place}.experiment"), what, format!("write the same `{key}` for all in [set]")))
}

/// Returns the trials that each fold leaves out, by runs in cross-validation.
pub fn left_out(records: &[RunRecord]) -> Vec<Vec<String>> {
    let mut folds: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    for record in records {
        if let Stage::CrossValidation { fold } = record.stage {
            folds.entry(fold).or_insert_with(|| record.split.validation.clone());
        }
    }
    folds.into_values().collect()
}

impl Entrant {
    /// Returns its experiments in cross-validation: one; or one for each fold, where the loop's model is another in
    /// each.
    ///
    /// # Errors
    /// There are not as many models as folds.
    pub fn in_folds(
        &self,
        upon: Option<&Loop>,
        left_out: Option<&[Vec<String>]>,
    ) -> Result<Vec<Member>, ScheduleError> {
        let mut experiment = self.experiment.clone();
        (experiment.protocol.cross_validation, experiment.protocol.final_runs) = (true, false);
        experiment.protocol.validation_fold = None;
        if experiment.baseline.is_some() {
            // Nothing of it depends on a seed.
            experiment.protocol.seeds.truncate(1);
        }
        let models = upon.filter(|_| self.above).map_or(&[][..], |upon| upon.folds.as_slice());
        let Some(left_out) = left_out.filter(|_| !models.is_empty()) else {
            return Ok(vec![self.member(self.id.clone(), experiment)]);
        };
        refuse_other_count(models, left_out)?;
        let of_fold = |(fold, (model, trials)): (usize, (&PathBuf, &Vec<String>))| {
            let mut experiment = experiment.clone();
            experiment.nominal = upon_loop(model, &experiment.nominal);
            (experiment.protocol.leave_out, experiment.protocol.folds) = (None, Some(vec![trials.clone()]));
            self.member(format!("{}-fold{fold}", self.id), experiment)
        };
        Ok(models.iter().zip(left_out).enumerate().map(of_fold).collect())
    }

    /// Returns whether `acm-eval stream` can run it.
    pub fn streams(&self) -> bool {
        let Experiment { baseline, inputs, windows, .. } = &self.experiment;
        baseline.is_none() && inputs.shuffled.is_empty() && windows.elapsed == Elapsed::Measured
    }

    /// Returns its final runs.
    pub fn to_the_end(&self) -> Member {
        let mut experiment = self.experiment.clone();
        (experiment.protocol.cross_validation, experiment.protocol.final_runs) = (false, true);
        self.member(format!("final-{}", self.id), experiment)
    }

    fn member(&self, id: String, experiment: Experiment) -> Member {
        let (base, variant, source) = (self.base.clone(), self.name.clone(), self.source.clone());
        Member { id, base, variant, values: vec![], experiment, source }
    }

    /// Returns the predictions of each fold.
    ///
    /// # Errors
    /// A table is missing or was changed.
    pub fn forecasts(&self, batches: &Batches) -> Result<InFolds, ScheduleError> {
        let runs = self.runs(batches);
        let mut result = InFolds { folds: vec![], optimism: vec![], numbers: 0 };
        for (fold, (place, own)) in runs.iter().enumerate() {
            let Some(forecast) = forecast::mean(place, own, "validation")? else { return Err(no_folds()) };
            let ratios: f64 = own.iter().map(|record| ratio(record, &on_others(&runs, fold, record.seed))).sum();
            result.folds.push(forecast);
            result.optimism.push(ratios / own.len() as f64);
            result.numbers += own.iter().map(|record| record.parameters).sum::<usize>();
        }
        result.numbers /= runs.len().max(1);
        Ok(result)
    }

    /// Returns run folder and runs of each fold.
    fn runs<'b>(&self, batches: &'b Batches) -> Vec<(PathBuf, Vec<&'b RunRecord>)> {
        let mut runs: Vec<(PathBuf, Vec<&RunRecord>)> = vec![];
        let crossed = |record: &&RunRecord| record.stage != Stage::Final;
        let own = |member: &Member| member.base == self.base && member.variant == self.name;
        for (member, records) in batches.members.iter().zip(&batches.records).filter(|(member, _)| own(member)) {
            let mut folds: BTreeMap<Stage, Vec<&RunRecord>> = BTreeMap::new();
            records.iter().filter(crossed).for_each(|record| folds.entry(record.stage).or_default().push(record));
            let place = folder(batches.request.out, &member.id);
            runs.extend(folds.into_values().map(|of_fold| (place.clone(), of_fold)));
        }
        runs
    }
}

/// Returns the runs of a seed on all folds but one.
fn on_others<'r>(runs: &[(PathBuf, Vec<&'r RunRecord>)], fold: usize, seed: u64) -> Vec<&'r RunRecord> {
    let elsewhere = runs.iter().enumerate().filter(|(other, _)| *other != fold).flat_map(|(_, (_, run))| run);
    elsewhere.copied().filter(|other| other.seed == seed).collect()
}

fn refuse_other_count(models: &[PathBuf], left_out: &[Vec<String>]) -> Result<(), ScheduleError> {
    let blocks = left_out.iter().flatten().any(|trial| trial.contains(":block"));
    if models.len() == left_out.len() && !blocks {
        return Ok(());
    }
    let folds: Vec<String> = left_out.iter().map(|trials| trials.join(" ")).collect();
    Err(ScheduleError::Usage {
        what: format!("best.loop_folds names {} models, and the folds leave out {}", models.len(), folds.join(" | ")),
        help: "close the loop once without the trials of each fold, and name the models in this order; where blocks of time \
               are left out, delete the key"
            .into(),
    })
}

/// Returns the error for the case that nothing was run.
pub fn no_folds() -> ScheduleError {
    ScheduleError::Usage {
        what: "there are no runs in cross-validation to compare".into(),
        help: "give two development trials or more, and at least one [[base]]".into(),
    }
}
