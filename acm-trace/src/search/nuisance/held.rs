//! Actuators that are held at a few values: n values determine the powers up to n − 1.

use crate::fit::design::inputs;
use crate::fit::form::Powers;
use crate::fit::problem::Problem;
use crate::fit::state::{Part, State};

/// Gap between recorded values of an actuator that separates two clusters, as a share of its range.
const GAP: f64 = 0.25;

/// Values of each trial that clusters are looked for in.
const VALUES: usize = 500;

/// Returns the powers that the values of each actuator determine. An effect on the inputs may fill the gaps between recorded
/// values, as a lag does between steps.
pub fn interpolated(problem: &Problem, state: &State) -> Powers {
    Powers::up_to(&highest(problem, state))
}

/// Returns the highest power that the clusters of every actuator determine.
pub fn fewest(problem: &Problem, state: &State) -> usize {
    highest(problem, state).into_iter().min().unwrap_or(usize::MAX)
}

/// Returns the highest power of each actuator that its values determine.
fn highest(problem: &Problem, state: &State) -> Vec<usize> {
    let recorded = |s: usize| problem.series[s].record.actuators.clone();
    let highest = determined(problem, recorded);
    let is_limited = highest.iter().any(|power| *power < usize::MAX);
    let fills = is_limited && state.effects.iter().any(|placed| placed.part() == Part::Input);
    if fills { determined(problem, |s| inputs(problem, state, s)) } else { highest }
}

/// Returns the number of clusters of an actuator's values in a range.
pub(crate) fn clusters(mut values: Vec<f64>, range: f64) -> usize {
    values.sort_by(f64::total_cmp);
    1 + values.windows(2).filter(|pair| pair[1] - pair[0] > GAP * range).count()
}

/// Returns the same for given values of each trial: one less than their clusters, and no limit where there is a single cluster.
fn determined(problem: &Problem, values: impl Fn(usize) -> Vec<Vec<f64>>) -> Vec<usize> {
    let trials: Vec<Vec<Vec<f64>>> = (0..problem.series.len()).map(values).collect();
    let of = |a: usize| {
        let few = |q: &Vec<Vec<f64>>| {
            let stride = q[a].len().div_ceil(VALUES).max(1);
            q[a].iter().step_by(stride).copied().collect::<Vec<f64>>()
        };
        match clusters(trials.iter().flat_map(few).collect(), 2.0 * problem.range[a].1) {
            1 => usize::MAX,
            clusters => clusters - 1,
        }
    };
    (0..problem.range.len()).map(of).collect()
}
