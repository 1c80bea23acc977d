//! Error floors on the held-out trials: oracle floor and memoryless floor.
//!
//! ```text
//! oracle²     = K/(K−1) · mean_i mean_k |p_ik − p̄_i|²        same recorded inputs, K redraws of the rest
//! memoryless² = mean_i |p_i − m(u_i)|²,   u = (q1, q2, q̇1, h, τ)
//! ```
//!
//! | symbol | meaning                                                            | unit |
//! | `p_ik` | tip at sample i in redraw k of everything unrecorded               | m    |
//! | `m`    | locally linear regression on many other campaigns, other excitation | m    |
//!
//! The nominal model is a function of q alone: subtracting it changes neither floor, so none is needed. The
//! factor K/(K−1) undoes that the mean of K redraws follows each of them. The regression is Cleveland's (1979)
//! local one with tricube weights; of several neighbourhood sizes the one with the smallest error counts, which
//! flatters the memoryless estimator. Its error is measured on the campaign itself, which it never saw.

use super::campaign::{SyntheticTrial, TwinError, run_all};
use super::random::Seeds;
use super::schedule::{HELD_OUT, held_altitude, plan};
use super::settings::TwinSettings;
use super::validate::BadSetting;
use nalgebra::{Matrix5, Matrix5x3, Vector3, Vector5};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// A floor per coordinate and in space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Floor {
    /// Root mean square of the error in space, mm.
    pub total_mm: f64,
    /// Root mean square per coordinate x, y, z, mm.
    pub component_mm: [f64; 3],
}

/// Both floors, and the settings of their estimation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Floors {
    /// Seed of the campaign.
    pub seed: u64,
    /// Trials that the floors are about.
    pub trials: Vec<String>,
    /// Error of a predictor with all recorded inputs and all physics, mm in space.
    pub oracle_mm: f64,
    /// Oracle floor per coordinate, mm.
    pub oracle_component_mm: [f64; 3],
    /// Error left to the best function of the instantaneous inputs, mm in space.
    pub memoryless_mm: f64,
    /// Memoryless floor per coordinate, mm.
    pub memoryless_component_mm: [f64; 3],
    /// Ratio memoryless/oracle, 1: the gain that memory allows.
    pub ratio: f64,
    /// Number of redraws behind the oracle floor.
    pub redraws: usize,
    /// Campaigns behind the memoryless floor.
    pub campaigns: usize,
    /// Number of neighbours of the regression that had the smallest error.
    pub neighbours: usize,
}

/// Effort of the estimation of the floors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FloorEffort {
    /// Number of redraws behind the oracle floor, at least 2.
    pub redraws: usize,
    /// Campaigns behind the memoryless floor.
    pub campaigns: usize,
}

impl Default for FloorEffort {
    /// Returns the effort by which both floors are known to about 2 %.
    fn default() -> Self {
        Self { redraws: 48, campaigns: 80 }
    }
}

/// Finds both floors of the campaign with this seed.
///
/// # Errors
/// A setting has no meaning, or a trial has no equilibrium at some step.
pub fn floors(settings: &TwinSettings, seed: u64, effort: FloorEffort) -> Result<Floors, TwinError> {
    settings.validate()?;
    let oracle = oracle_floor(settings, seed, &HELD_OUT, effort.redraws)?;
    let (memoryless, neighbours) =
        memoryless_error(settings, seed, &HELD_OUT.map(|trial| (trial, trial)), effort.campaigns)?;
    Ok(Floors {
        seed,
        trials: HELD_OUT.map(|number| number.to_string()).to_vec(),
        oracle_mm: oracle.total_mm,
        oracle_component_mm: oracle.component_mm,
        memoryless_mm: memoryless.total_mm,
        memoryless_component_mm: memoryless.component_mm,
        ratio: memoryless.total_mm / oracle.total_mm,
        redraws: effort.redraws,
        campaigns: effort.campaigns,
        neighbours,
    })
}

/// Returns the oracle floor of some trials from `redraws` ≥ 2 redraws of all that is unrecorded.
///
/// # Errors
/// Fewer than two redraws, or a trial has no equilibrium at some step.
pub fn oracle_floor(settings: &TwinSettings, seed: u64, trials: &[usize], redraws: usize) -> Result<Floor, TwinError> {
    if redraws < 2 {
        return Err(BadSetting { name: "redraws", value: redraws as f64, least: 2.0, most: f64::INFINITY }.into());
    }
    let runs = redraws_of(settings, seed, trials, redraws)?;
    let correction = redraws as f64 / (redraws as f64 - 1.0);
    let mut errors = Vec::new();
    for trial in 0..trials.len() {
        for sample in 0..runs[0][trial].tip.len() {
            let mean = runs.iter().map(|run| run[trial].tip[sample]).sum::<Vector3<f64>>() / redraws as f64;
            errors.extend(runs.iter().map(|run| (run[trial].tip[sample] - mean) * correction.sqrt()));
        }
    }
    Ok(root_mean_square(&errors))
}

/// Returns the trials with the same recordings and redrawn unrecorded inputs: [redraw][trial].
fn redraws_of(
    settings: &TwinSettings,
    seed: u64,
    trials: &[usize],
    redraws: usize,
) -> Result<Vec<Vec<SyntheticTrial>>, TwinError> {
    (0..redraws as u64)
        .map(|redraw| {
            // Seeds of redraws lie far from any that a campaign is likely to have.
            let seeds = Seeds { recorded: seed, unrecorded: ORACLE_SEEDS + redraw };
            let plans: Vec<_> = trials.iter().map(|number| plan(settings, *number, &seeds)).collect();
            run_all(settings, &plans, &seeds, &|_, _| {})
        })
        .collect()
}

const ORACLE_SEEDS: u64 = 1 << 40;
const MEMORYLESS_SEEDS: u64 = 1 << 41;

/// Returns the error of the best function of instantaneous inputs and the neighbourhood that reached it.
///
/// Each pair is a trial that is asked about and the trial of other campaigns that is learned from: the
/// same number for the floor, one of another altitude for what carries over from there.
///
/// # Errors
/// As [`oracle_floor`].
pub fn memoryless_error(
    settings: &TwinSettings,
    seed: u64,
    pairs: &[(usize, usize)],
    campaigns: usize,
) -> Result<(Floor, usize), TwinError> {
    let mut errors_by_size = vec![Vec::new(); NEIGHBOURS.len()];
    for &(asked, learned) in pairs {
        let own = plan(settings, asked, &Seeds::both(seed));
        let tested = run_all(settings, &[own], &Seeds::both(seed), &|_, _| {})?;
        let others = other_campaigns(settings, learned, campaigns)?;
        let known: Vec<Example> = others.iter().flat_map(|trial| examples(settings, trial)).collect();
        let asked: Vec<Example> = tested.iter().flat_map(|trial| examples(settings, trial)).collect();
        for (errors, neighbours) in errors_by_size.iter_mut().zip(NEIGHBOURS) {
            let found: Vec<_> =
                asked.par_iter().map(|one| one.tip - estimate(&known, &one.input, neighbours)).collect();
            errors.extend(found);
        }
    }
    let floors = errors_by_size.iter().map(|errors| root_mean_square(errors)).zip(NEIGHBOURS);
    let best = floors.min_by(|a, b| a.0.total_mm.total_cmp(&b.0.total_mm));
    Ok(best.unwrap_or((root_mean_square(&[]), 0)))
}

/// Sizes of neighbourhood that are tried.
const NEIGHBOURS: [usize; 4] = [250, 1000, 4000, 12_000];

/// Returns the trial of this number in other campaigns, with other seeds for everything.
fn other_campaigns(settings: &TwinSettings, number: usize, campaigns: usize) -> Result<Vec<SyntheticTrial>, TwinError> {
    (0..campaigns as u64)
        .into_par_iter()
        .map(|campaign| {
            let seeds = Seeds::both(MEMORYLESS_SEEDS + campaign);
            super::campaign::run_trial(settings, &plan(settings, number, &seeds), &seeds)
        })
        .collect()
}

/// Instantaneous inputs and the tip. The scales of q2, altitude and throttle are wide: within a trial they hardly vary.
struct Example {
    input: [f64; 5],
    tip: Vector3<f64>,
}

/// Returns the samples of a trial, without the first one, which has no rate.
fn examples(settings: &TwinSettings, trial: &SyntheticTrial) -> Vec<Example> {
    let held = held_altitude(settings, trial.number);
    (1..trial.time.len())
        .map(|k| {
            let rate = (trial.q1[k] - trial.q1[k - 1]) / (trial.time[k] - trial.time[k - 1]);
            let input = [
                trial.q1[k] / 0.1,
                trial.q2[k] / 0.5,
                // Direction of motion matters most near rest: resolve 0.02 rad/s there, decades elsewhere.
                (rate / 0.02).asinh(),
                (trial.altitude[k] - held) / 0.2,
                trial.throttle[k] / 0.1,
            ];
            Example { input, tip: trial.tip[k] }
        })
        .collect()
}

/// Returns the locally linear regression at one input.
fn estimate(known: &[Example], input: &[f64; 5], neighbours: usize) -> Vector3<f64> {
    let mut near: Vec<(f64, usize)> =
        known.iter().enumerate().map(|(k, one)| (distance(&one.input, input), k)).collect();
    let count = neighbours.min(near.len());
    near.select_nth_unstable_by(count - 1, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    near.truncate(count);
    near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let width = near[count - 1].0.sqrt().max(1e-9);
    // A thousandth of one neighbour keeps a direction without spread (a held input) from being singular.
    let mut left = Matrix5::identity() * 1e-3;
    let mut right = Matrix5x3::zeros();
    for (square, k) in near {
        let weight = (1.0 - (square.sqrt() / width).powi(3)).powi(3);
        let one = &known[k];
        // q2 is held, so it gets no slope; its neighbourhood is the trial.
        let row = Vector5::new(
            1.0,
            one.input[0] - input[0],
            one.input[2] - input[2],
            one.input[3] - input[3],
            one.input[4] - input[4],
        );
        left += weight * row * row.transpose();
        right += weight * row * one.tip.transpose();
    }
    let solved = left.cholesky().map(|factor| factor.solve(&right));
    solved.map_or(known[0].tip, |slopes| slopes.row(0).transpose())
}

fn distance(a: &[f64; 5], b: &[f64; 5]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

fn root_mean_square(errors: &[Vector3<f64>]) -> Floor {
    let count = errors.len().max(1) as f64;
    let squares = errors.iter().map(|error| error.component_mul(error)).sum::<Vector3<f64>>() / count;
    let component_mm = [0, 1, 2].map(|axis| 1e3 * squares[axis].sqrt());
    Floor { total_mm: 1e3 * squares.sum().sqrt(), component_mm }
}
