//! A data set that was read and checked: the manifest and its trials, in SI.

use std::ops::Range;
use std::path::{Path, PathBuf};

use acm_core::nominal::NominalSpec;
use acm_core::observations::Observations;
use nalgebra::DMatrix;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::channel::Channel;
use crate::error::{DataError, Problems};
use crate::layout::Layout;
use crate::locate::{self, DataFiles};
use crate::manifest::{self, Manifest, Role};
use crate::toml_file::TomlSource;
use crate::trial::Trial;
use crate::{consistency, cut, folds, natural, plausible, recording, split};

/// Degree of the polynomial that is the nominal model of a robot without an arm.
const POLYNOMIAL_DEGREE: usize = 3;

/// A checked data set.
#[derive(Debug, Clone, PartialEq)]
pub struct Campaign {
    /// What the data are.
    pub manifest: Manifest,
    /// All trials, also excluded ones, by name in natural order.
    pub trials: Vec<Trial>,
    /// SHA-256 of the manifest and the data files, hex.
    pub hash: String,
    /// What looks wrong and may be right.
    pub warnings: Vec<String>,
    /// Where the data files lie.
    pub folder: PathBuf,
}

/// What one file gave.
struct Part {
    trials: Vec<Trial>,
    problems: Vec<DataError>,
    digest: Vec<u8>,
}

impl Campaign {
    /// Reads the data set of `folder/manifest.toml`; the data files lie in `data_folder`, or where [`crate::locate`]
    /// finds them.
    ///
    /// The result is the same on any number of threads: files are read side by side and joined in sorted order.
    ///
    /// # Errors
    /// All problems of the manifest; or else all problems of the data.
    pub fn read(folder: &Path, data_folder: Option<&Path>) -> Result<Campaign, DataError> {
        Campaign::read_for(folder, data_folder, None)
    }

    /// As [`Campaign::read`]; development and held-out trials that have no `window` samples in a row without a gap
    /// over `max_gap` seconds are problems too.
    pub fn check(
        folder: &Path,
        data_folder: Option<&Path>,
        window: usize,
        max_gap: f64,
    ) -> Result<Campaign, DataError> {
        Campaign::read_for(folder, data_folder, Some((window, max_gap)))
    }

    fn read_for(
        folder: &Path,
        data_folder: Option<&Path>,
        window: Option<(usize, f64)>,
    ) -> Result<Campaign, DataError> {
        let (manifest, source) = manifest::read(folder)?;
        let unplanned = || DataError::Usage(format!("{}: the manifest was not validated", source.path.display()));
        let layout = Layout::new(&manifest).ok_or_else(unplanned)?;
        let mut problems = Vec::new();
        let found = locate::locate(&manifest, folder, data_folder, &mut problems)?;
        let parts: Vec<Part> = found.files.par_iter().map(|file| read_file(&found.folder, file, &layout)).collect();
        let hash = hash(&source, &found, &parts);
        let complete = parts.iter().all(|p| p.problems.is_empty());
        let mut whole = Vec::new();
        for part in parts {
            whole.extend(part.trials);
            problems.extend(part.problems);
        }
        let trials = organise(&manifest, &source, whole, complete, &mut problems);
        if let Some((length, max_gap)) = window {
            problems.extend(consistency::windows(&trials, length, max_gap));
        }
        let mut warnings = plausible::warnings(&manifest, &layout, &trials);
        warnings.extend(unmatched(&found));
        if window.is_some() && !problems.is_empty() {
            // A check tells everything at once; what is only suspicious comes after what is wrong.
            problems.extend(warnings.drain(..).map(DataError::Warning));
        }
        Problems(problems).into_result()?;
        Ok(Campaign { manifest, trials, hash, warnings, folder: found.folder })
    }

    /// The trials of a role.
    pub fn trials(&self, role: Role) -> impl Iterator<Item = &Trial> {
        self.trials.iter().filter(move |t| t.role == role)
    }

    /// A trial by name.
    pub fn trial(&self, name: &str) -> Option<&Trial> {
        self.trials.iter().find(|t| t.name == name)
    }

    /// The nominal model that the manifest describes: the strain model of its arm, or a polynomial. Where it has
    /// `[[predicted]]` columns, the user's own prediction stands in each trial's `predicted`.
    pub fn nominal_spec(&self) -> NominalSpec {
        match &self.manifest.arm {
            Some(arm) => NominalSpec::Strain(arm.spec()),
            None => NominalSpec::Polynomial { degree: POLYNOMIAL_DEGREE },
        }
    }

    /// The rows of the trials on top of each other: `[T×A]` and, for all markers, `[T×M]`.
    pub fn observations(&self, trials: &[&Trial]) -> Observations {
        let stack = |columns: usize, part: &dyn Fn(&Trial) -> DMatrix<f64>| {
            let rows = trials.iter().map(|t| t.samples()).sum();
            let mut all = DMatrix::zeros(rows, columns);
            let mut start = 0;
            for trial in trials {
                all.rows_mut(start, trial.samples()).copy_from(&part(trial));
                start += trial.samples();
            }
            all
        };
        Observations {
            actuators: stack(self.manifest.actuator.len(), &|t| t.actuators.clone()),
            measured: stack(self.manifest.measured.len(), &|t| t.measured.clone()),
            at: self.manifest.marker_places(),
        }
    }

    /// Validation trials of each fold; see [`crate::folds`].
    pub fn folds(&self) -> Vec<Vec<String>> {
        let names: Vec<&str> = self.trials(Role::Development).map(|t| t.name.as_str()).collect();
        folds::folds(&self.manifest, &names)
    }

    /// Which measured columns are reported: the tip's three, or all outputs.
    pub fn tip_columns(&self) -> Range<usize> {
        self.manifest.tip_columns()
    }

    /// The inputs of these names; all actuators and context signals where the list is empty.
    ///
    /// # Errors
    /// A name that is no input: the message lists the known ones.
    pub fn channels(&self, names: &[String]) -> Result<Vec<Channel>, DataError> {
        let all = crate::channel::default_channels(&self.manifest);
        let names = if names.is_empty() { &all } else { names };
        let parsed = names.iter().map(|n| Channel::parse(n, &self.manifest, &self.trials));
        parsed.collect::<Result<_, _>>().map_err(|e| DataError::Usage(e.to_string()))
    }

    /// Development and held-out trials that have no `length` samples in a row without a gap over `max_gap` seconds.
    pub fn shorter_than(&self, length: usize, max_gap: f64) -> Vec<DataError> {
        consistency::windows(&self.trials, length, max_gap)
    }
}

fn read_file(folder: &Path, file: &Path, layout: &Layout) -> Part {
    let path = folder.join(file);
    let mut part = Part { trials: Vec::new(), problems: Vec::new(), digest: Vec::new() };
    match recording::bytes(&path) {
        Ok(bytes) => {
            part.digest = Sha256::digest(&bytes).to_vec();
            let recording = recording::read(&path, bytes, &layout.wanted(), &mut part.problems);
            if let Some(recording) = recording {
                part.trials = split::trials(&recording, file, layout, &mut part.problems);
            }
        }
        Err(error) => part.problems.push(error),
    }
    part
}

/// Trials with their roles, cut and sorted; what the manifest and the files do not agree on is a problem.
fn organise(
    manifest: &Manifest,
    source: &TomlSource,
    whole: Vec<Trial>,
    complete: bool,
    problems: &mut Vec<DataError>,
) -> Vec<Trial> {
    consistency::unique(&whole, problems);
    let read: Vec<String> = whole.iter().map(|t| t.name.clone()).collect();
    let mut trials = cut::roles_and_parts(manifest, source, whole, problems);
    trials.sort_by(|a, b| natural::compare(&a.name, &b.name));
    if complete {
        // after a file that could not be read, every name in it would be unknown
        consistency::names(manifest, source, &read, &trials, problems);
        consistency::recorded(&trials, problems);
    }
    consistency::folds(manifest, source, &trials, problems);
    trials
}

/// SHA-256 over the manifest and each file's name and digest, in sorted order.
fn hash(source: &TomlSource, found: &DataFiles, parts: &[Part]) -> String {
    let mut hash = Sha256::new();
    hash.update(Sha256::digest(source.text.as_bytes()));
    for (file, part) in found.files.iter().zip(parts) {
        let name = file.to_string_lossy().replace('\\', "/");
        hash.update((name.len() as u64).to_le_bytes());
        hash.update(name.as_bytes());
        hash.update(&part.digest);
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

fn unmatched(found: &DataFiles) -> Option<String> {
    let names: Vec<String> = found.unmatched.iter().map(|f| f.display().to_string()).collect();
    let shown = names.iter().take(10).cloned().collect::<Vec<_>>().join(", ");
    let more = if names.len() > 10 { format!(" and {} more", names.len() - 10) } else { String::new() };
    let folder = found.folder.display();
    (!names.is_empty()).then(|| {
        format!("{folder}: no pattern matches {shown}{more}; add a pattern to `files` or to `ignore` in [table]")
    })
}
