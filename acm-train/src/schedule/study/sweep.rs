//! Settings of a sweep.
//!
//! ```toml
//! [sweep]
//! sampler = "grid"                           # "random", "sobol", "bayes", "halving"
//! count   = 24                               # settings for each base; a grid tries all
//! seed    = 1
//! batch   = 4                                # "bayes": settings that are proposed at a time
//! eta     = 3                                # "halving": one setting in so many goes on, for so many times the epochs
//! [sweep.space]
//! "windows.length"         = [10, 25, 50]    # one of these
//! "training.learning_rate" = { low = 3e-4, high = 1e-2, log = true }
//! ```
//!
//! Every sampler deals out points of the unit cube, one coordinate per key in the order of their names ([`Axis`]).
//!
//! | sampler  | points                                                                                       |
//! | -------- | -------------------------------------------------------------------------------------------- |
//! | `grid`   | every combination; a range is asked for in `steps` points                                    |
//! | `random` | uniform, ChaCha8                                                                             |
//! | `sobol`  | Owen-scrambled Sobol sequence (crate sobol_burley)                                           |
//! | `bayes`  | tree-structured Parzen estimators, Bergstra et al. (2011), one per key (crate tpe)            |
//! | `halving`| those of `sobol` for a few epochs, the best of them for more ([`halving`])                    |
//!
//! What is proposed next depends on the seed and on the errors of all batches before, so a sweep that was interrupted goes
//! on with the same settings, on any number of jobs.

mod axis;
mod halving;

use std::collections::BTreeMap;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Deserialize;
use tpe::TpeOptimizer;

pub use axis::{Axis, Range, Setting};

use crate::config::Fault;

/// Draws of the Parzen estimators before one that was not tried yet is given up on.
const TRIES: usize = 200;

/// Settings of one base, beyond which a sweep is a mistake.
const MOST_SETTINGS: usize = 10_000;

/// `[sweep]`: the space of settings and its sampler.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Sampler of the settings.
    pub sampler: Sampler,
    /// Settings for each base; a grid has its own number.
    #[serde(default = "default_count")]
    pub count: usize,
    /// Seed of the sampler.
    #[serde(default)]
    pub seed: u64,
    /// Settings that are proposed at a time, before their errors are looked at.
    #[serde(default = "default_batch")]
    pub batch: usize,
    /// Ratio of the settings in a round of a halving to those of the next.
    #[serde(default = "default_eta")]
    pub eta: usize,
    /// Values by dotted key of the experiment.
    pub space: BTreeMap<String, Axis>,
}

/// Samplers of settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sampler {
    /// Grid of all combinations.
    Grid,
    /// Uniform random settings.
    Random,
    /// Settings of low discrepancy.
    Sobol,
    /// Settings near those with small errors, by Bayesian optimisation.
    Bayes,
    /// Settings of low discrepancy, and then the best of them for more epochs.
    Halving,
}

fn default_count() -> usize {
    24
}

fn default_batch() -> usize {
    4
}

fn default_eta() -> usize {
    3
}

/// A point of the unit cube.
type Point = Vec<f64>;

impl Sweep {
    /// Returns the faults of the sweep.
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = vec![];
        for (key, value) in [("sweep.count", self.count), ("sweep.batch", self.batch)] {
            faults.extend(Fault::count(key, value, 1, MOST_SETTINGS, "24"));
        }
        faults.extend(Fault::count("sweep.eta", self.eta, 2, MOST_SETTINGS, "3"));
        if self.space.is_empty() {
            faults.push(Fault::new("sweep.space", "is empty", "name keys of the experiment, each with values to try"));
        }
        faults.extend(self.space.iter().filter_map(|(key, axis)| axis.fault(key)));
        let grid = self.space.values().fold(1usize, |points, axis| points.saturating_mul(axis.points()));
        if self.sampler == Sampler::Halving && self.space.contains_key(halving::EPOCHS) {
            let help = format!("leave it out: the last round trains for the {} of the experiment", halving::EPOCHS);
            let key = ["sweep", "space", halving::EPOCHS].map(String::from).to_vec();
            faults.push(Fault::at(key, "is what the rounds of a halving set", help));
        }
        if self.sampler == Sampler::Grid && grid > MOST_SETTINGS {
            let help = format!("try fewer values, {MOST_SETTINGS} settings at most, or another sampler with a count");
            faults.push(Fault::new("sweep.space", format!("has {grid} combinations"), help));
        }
        faults
    }

    /// Returns the settings of the next batch, if one is due after `tried` settings. `errors` are those of the settings
    /// so far, in order; the experiment trains for `epochs`.
    pub fn next(&self, tried: &[Setting], errors: &[f64], epochs: usize) -> Vec<Setting> {
        let first = tried.len();
        let whole = |points: Vec<Point>| distinct(points.iter().map(|point| self.setting(point)).collect());
        let once = |points: Vec<Point>| if first == 0 { whole(points) } else { vec![] };
        match self.sampler {
            Sampler::Grid => once(self.grid()),
            Sampler::Random => once(self.random()),
            Sampler::Sobol => once(self.sobol()),
            Sampler::Bayes if first < self.count => self.bayes(tried, errors),
            Sampler::Bayes => vec![],
            Sampler::Halving => halving::next(&whole(self.sobol()), self.eta, epochs, tried, errors),
        }
    }

    fn setting(&self, point: &Point) -> Setting {
        self.space.iter().zip(point).map(|((key, axis), &u)| (key.clone(), axis.value(u))).collect()
    }

    fn grid(&self) -> Vec<Point> {
        self.space.values().fold(vec![vec![]], |points: Vec<Point>, axis| {
            let with = |point: &Point, u: f64| point.iter().copied().chain([u]).collect();
            points.iter().flat_map(|point| axis.grid().into_iter().map(move |u| with(point, u))).collect()
        })
    }

    fn random(&self) -> Vec<Point> {
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        (0..self.count).map(|_| self.space.iter().map(|_| generator.random::<f64>()).collect()).collect()
    }

    /// Returns the points of the Sobol sequence. Its scrambling takes a seed of 32 bits.
    fn sobol(&self) -> Vec<Point> {
        let seed = (self.seed ^ (self.seed >> 32)) as u32;
        let point =
            |index| (0..self.space.len() as u32).map(|d| f64::from(sobol_burley::sample(index, d, seed))).collect();
        (0..self.count as u32).map(point).collect()
    }

    /// Returns one batch: every proposal of it uses the same errors.
    fn bayes(&self, tried: &[Setting], errors: &[f64]) -> Vec<Setting> {
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        generator.set_stream(tried.len() as u64 + 1);
        let mut estimators: Vec<TpeOptimizer> = self.space.values().map(Axis::estimator).collect();
        for (setting, &error) in tried.iter().zip(errors) {
            for ((axis, (_, value)), estimator) in self.space.values().zip(setting).zip(&mut estimators) {
                // Outside its range, or no number: nothing to learn from.
                let _ = estimator.tell(axis.place(value), error);
            }
        }
        let wanted = self.batch.min(self.count - tried.len());
        let mut batch: Vec<Setting> = vec![];
        for _ in 0..TRIES {
            let ask = |estimator: &mut TpeOptimizer| estimator.ask(&mut generator).unwrap_or(0.5);
            let places: Vec<f64> = estimators.iter_mut().map(ask).collect();
            let setting: Setting =
                self.space.iter().zip(&places).map(|((key, axis), &place)| (key.clone(), axis.at(place))).collect();
            if !tried.contains(&setting) && !batch.contains(&setting) {
                batch.push(setting);
            }
            if batch.len() == wanted {
                break;
            }
        }
        batch
    }
}

fn distinct(settings: Vec<Setting>) -> Vec<Setting> {
    let mut kept: Vec<Setting> = vec![];
    settings.into_iter().for_each(|setting| {
        if !kept.contains(&setting) {
            kept.push(setting);
        }
    });
    kept
}

#[cfg(test)]
mod tests {
    use toml::Value;

    use super::*;

    fn sweep(text: &str) -> Sweep {
        toml::from_str(text).unwrap()
    }

    fn numbers(settings: &[Setting], axis: usize) -> Vec<f64> {
        let number = |value: &Value| value.as_float().or(value.as_integer().map(|n| n as f64)).unwrap();
        settings.iter().map(|setting| number(&setting[axis].1)).collect()
    }

    /// Oracle: by hand.
    #[test]
    fn a_grid_is_every_combination() {
        let grid = sweep(
            "sampler = \"grid\"\n[space]\n\"a.units\" = [16, 32]\nrate = { low = 1e-4, high = 1e-1, log = true }",
        );
        let settings = grid.next(&[], &[], 60);
        assert_eq!(numbers(&settings, 0), [16.0, 16.0, 16.0, 16.0, 32.0, 32.0, 32.0, 32.0]);
        assert_eq!(numbers(&settings, 1)[..4], [1e-4, 1e-3, 1e-2, 1e-1]);
        assert_eq!(settings[0][0].0, "a.units");
        assert!(grid.next(&settings, &[0.0; 8], 60).is_empty());
    }

    /// Oracle: of 64 Sobol points, every eighth of an axis holds 8; of random ones it would be a coincidence of 1 : 10⁴.
    #[test]
    fn sobol_points_are_even() {
        let sobol = sweep(
            "sampler = \"sobol\"\ncount = 64\nseed = 3\n[space]\na = { low = 0.0, high = 1.0 }\nb = { low = 0, high = 8 }",
        );
        for (axis, width) in [(0, 0.125), (1, 1.0)] {
            let mut counts = [0; 8];
            numbers(&sobol.next(&[], &[], 60), axis)
                .iter()
                .for_each(|value| counts[((value / width) as usize).min(7)] += 1);
            assert!(counts.iter().all(|count| (7..=9).contains(count)), "{counts:?}");
        }
    }

    #[test]
    fn ranges_hold_and_whole_numbers_are_whole() {
        let random = sweep(
            "sampler = \"random\"\ncount = 200\n[space]\na = { low = 3, high = 5, whole = true }\nb = [\"x\", \"y\"]",
        );
        let settings = random.next(&[], &[], 60);
        assert_eq!(settings.len(), 6, "3 whole numbers and 2 words have 6 combinations");
        assert!(settings.iter().all(|setting| matches!(setting[0].1, Value::Integer(3..=5))));
    }

    /// Oracle: the smallest error is at 0.3 and "b", and there the last settings should be.
    #[test]
    fn the_parzen_estimator_goes_where_errors_are_small_and_repeats_nothing() {
        let bayes = sweep(
            "sampler = \"bayes\"\ncount = 60\nseed = 5\n[space]\nkind = [\"a\", \"b\", \"c\"]\nx = { low = 0.0, high = 1.0 }",
        );
        let error = |setting: &Setting| {
            let kind = if setting[0].1.as_str() == Some("b") { 0.0 } else { 1.0 };
            (setting[1].1.as_float().unwrap() - 0.3).powi(2) + kind
        };
        let (mut tried, mut errors): (Vec<Setting>, Vec<f64>) = (vec![], vec![]);
        loop {
            let batch = bayes.next(&tried, &errors, 60);
            assert_eq!(batch, bayes.next(&tried, &errors, 60), "the same errors give the same batch");
            if batch.is_empty() {
                break;
            }
            errors.extend(batch.iter().map(error));
            tried.extend(batch);
        }
        assert_eq!(tried.len(), 60);
        let late = &errors[30..];
        assert!(late.iter().filter(|error| **error < 0.05).count() > 18, "{late:?}");
    }

    #[test]
    fn what_cannot_be_tried_is_refused() {
        let fault = |space: &str| {
            let sweep = sweep(&format!("sampler = \"grid\"\n[space]\n{space}"));
            sweep.faults().first().map(|fault| fault.what.clone())
        };
        assert_eq!(fault("a = [1]"), None);
        for (space, words) in [
            ("", "empty"),
            ("a = []", "no values"),
            ("a = { low = 2, high = 1 }", "low` is 2, and high is 1"),
            ("a = { low = 0.2, high = 0.8, whole = true }", "no whole number"),
            ("a = { low = 0, high = 1e300 }", "high` is 1e300"),
            ("a = { low = 0, high = 1, steps = 200 }\nb = { low = 0, high = 1, steps = 200 }", "40000 combinations"),
            ("a = { low = 0, high = 1, log = true }", "log"),
            ("a = { low = 0, high = 1, steps = 1 }", "steps` is 1"),
        ] {
            assert!(fault(space).is_some_and(|what| what.contains(words)), "{space}");
        }
    }
}
