//! Planned and open runs: the list from which every engine takes its runs. A run is open while its record is not in the
//! folder; no other state matters.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::ready::Ready;
use crate::{
    config::{Experiment, Question},
    run::record::RunRecord,
    store::{RunFolder, StoreError},
};

/// Runs that are planned in a folder.
#[derive(Debug, Clone)]
pub struct Planned {
    /// Configurations, in the order of the plans.
    pub asked: Vec<Asked>,
    /// All runs, those with a record too.
    pub runs: Vec<Run>,
}

/// Configuration of some runs, with every default filled in.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Asked {
    /// The run folder, as seen from the folder of the whole; empty where it is that.
    pub folder: PathBuf,
    /// The file that the values were written in: paths among them are looked for from there.
    pub file: PathBuf,
    /// Values of the configuration.
    pub what: What,
}

/// Values of a configuration.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum What {
    /// Run of an experiment.
    Experiment(Box<Experiment>),
    /// Run of a question about sequences.
    Question(Box<Question>),
}

/// One run, by names that stay the same from call to call.
#[derive(Debug, Clone)]
pub struct Run {
    /// Run folder as seen from the folder of the whole, and the name of the plan: `runs/cfc-small/fold0-seed1`.
    pub id: String,
    /// Index in [`Planned::asked`].
    pub asked: usize,
    /// The plan's name.
    pub plan: String,
    /// Whether it follows the other runs of its configuration.
    pub follows: bool,
    /// Path of its record.
    pub record: PathBuf,
    /// Path of its checkpoint.
    pub checkpoint: PathBuf,
}

impl Planned {
    /// Adds the plans of one run folder below `root`.
    pub(crate) fn add(
        &mut self,
        root: &Path,
        folder: &RunFolder,
        file: &Path,
        what: What,
        plans: impl Iterator<Item = (String, bool)>,
    ) {
        let below = folder.root().strip_prefix(root).unwrap_or(folder.root()).to_path_buf();
        let asked = self.asked.len();
        self.runs.extend(plans.map(|(plan, follows)| Run {
            follows,
            id: below.join(&plan).to_string_lossy().into_owned(),
            asked,
            record: folder.record(&plan),
            checkpoint: folder.checkpoint(&plan),
            plan,
        }));
        self.asked.push(Asked { folder: below, file: file.into(), what });
    }

    /// Returns an empty plan.
    pub(crate) fn none() -> Self {
        Self { asked: vec![], runs: vec![] }
    }

    /// Number of runs without a record.
    pub fn unfinished(&self) -> usize {
        self.runs.iter().filter(|run| !run.record.exists()).count()
    }

    /// Runs without a record, and without those that still wait for others.
    pub fn open(&self) -> Vec<&Run> {
        let missing: Vec<&Run> = self.runs.iter().filter(|run| !run.record.exists()).collect();
        let waits = |run: &Run| run.follows && missing.iter().any(|other| other.asked == run.asked && !other.follows);
        missing.iter().copied().filter(|run| !waits(run)).collect()
    }
}

/// Returns the runs of some experiments, each in its folder below `root`.
pub fn planned(experiments: &[Ready], folders: &[RunFolder], root: &Path) -> Planned {
    let mut planned = Planned::none();
    for (ready, folder) in experiments.iter().zip(folders) {
        let what = What::Experiment(Box::new(ready.experiment.clone()));
        planned.add(
            root,
            folder,
            &ready.file,
            what,
            ready.plans.iter().map(|plan| (plan.id.clone(), plan.follows_folds())),
        );
    }
    planned
}

/// Returns the records of some experiments that are there, in the order of the plans.
///
/// # Errors
/// A file is no record.
pub fn records(experiments: &[Ready], folders: &[RunFolder]) -> Result<Vec<Vec<Option<RunRecord>>>, StoreError> {
    let finished = |(ready, folder): (&Ready, &RunFolder)| {
        ready.plans.iter().map(|plan| folder.finished(&plan.id)).collect::<Result<_, _>>()
    };
    experiments.iter().zip(folders).map(finished).collect()
}
