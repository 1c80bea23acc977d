//! Signals that are constant within trials: an altitude, a payload, a pressure.
//!
//! ```text
//! w² = mean over trials of var(x within a trial)        b² = var over trials of mean(x)
//! constant within trials:  w < b / 10                   one value:  means that differ by 3 w at most from the next
//! ```
//!
//! | symbol | meaning                    | unit            |
//! | ------ | -------------------------- | --------------- |
//! | w      | spread within trials       | of the signal   |
//! | b      | spread of the trials' means | of the signal   |

mod level;

use crate::entry::Entry;
use crate::manifest::Manifest;

pub use level::Level;

/// Spread within trials at most, as a part of that between them.
pub const WITHIN: f64 = 0.1;

/// Trials whose means differ by so many spreads within trials have one value.
const ALIKE: f64 = 3.0;

/// Rounding, as a part of the largest value.
const ROUNDING: f64 = 1e-9;

/// A signal that is constant within trials.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// Its name.
    pub name: String,
    /// Its values, SI, increasing.
    pub values: Vec<f64>,
    /// The place among the values of each trial.
    pub of_trial: Vec<usize>,
    /// Means that differ by no more have one value.
    reach: f64,
}

impl Constant {
    /// The signal called `name` (an actuator, a context signal or a condition), if it is constant within `trials` and not the
    /// same in all.
    pub fn of(name: &str, manifest: &Manifest, trials: &[&Entry]) -> Option<Self> {
        let levels: Vec<Level> = trials.iter().map(|trial| level(name, manifest, trial)).collect::<Option<_>>()?;
        let count = levels.len() as f64;
        let mean = levels.iter().map(|level| level.mean).sum::<f64>() / count;
        let between = (levels.iter().map(|level| (level.mean - mean).powi(2)).sum::<f64>() / count).sqrt();
        let within = (levels.iter().map(|level| level.variance).sum::<f64>() / count).sqrt();
        let largest = levels.iter().map(|level| level.mean.abs()).fold(0.0, f64::max);
        let reach = ALIKE * within + ROUNDING * largest;
        (between > reach && within < WITHIN * between).then(|| Self::grouped(name, &levels, reach))
    }

    fn grouped(name: &str, levels: &[Level], reach: f64) -> Self {
        let mut order: Vec<usize> = (0..levels.len()).collect();
        order.sort_by(|&a, &b| levels[a].mean.total_cmp(&levels[b].mean));
        let (mut groups, mut of_trial, mut last): (Vec<Vec<f64>>, _, _) =
            (vec![], vec![0; levels.len()], f64::NEG_INFINITY);
        for trial in order {
            let mean = levels[trial].mean;
            if mean - last > reach {
                groups.push(vec![]);
            }
            groups.last_mut().into_iter().for_each(|group| group.push(mean));
            (of_trial[trial], last) = (groups.len() - 1, mean);
        }
        let values = groups.iter().map(|group| group.iter().sum::<f64>() / group.len() as f64).collect();
        Self { name: name.into(), values, of_trial, reach }
    }

    /// Whether a trial has one of the values; true where it does not have the signal.
    pub fn knows(&self, manifest: &Manifest, trial: &Entry) -> bool {
        let near = |level: Level| self.values.iter().any(|value| (value - level.mean).abs() <= self.reach);
        level(&self.name, manifest, trial).is_none_or(near)
    }
}

/// Names of all that may be constant within trials and is no command: context signals, then the conditions of all trials.
pub fn context(manifest: &Manifest, trials: &[&Entry]) -> Vec<String> {
    let conditions = trials.first().into_iter().flat_map(|trial| trial.conditions.keys());
    let shared = conditions.filter(|name| trials.iter().all(|trial| trial.conditions.contains_key(*name)));
    manifest.context.iter().map(|signal| signal.name().to_string()).chain(shared.cloned()).collect()
}

fn level(name: &str, manifest: &Manifest, trial: &Entry) -> Option<Level> {
    let mut signals = manifest.actuator.iter().chain(&manifest.context);
    match signals.position(|signal| signal.name() == name || signal.column == name) {
        Some(place) => trial.levels.get(place).copied(),
        None => trial.conditions.get(name).map(|&mean| Level { mean, variance: 0.0 }),
    }
}
