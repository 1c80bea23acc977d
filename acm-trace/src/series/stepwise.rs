//! Actuators that move in steps, and may be held between samples.
//!
//! What rests between samples, and jumps from one to the next by a share of its range, is a command and not a motion: it is held
//! between samples, and does not go straight to the next. A motion that is quantised rests and jumps as well, by a small share.

use crate::case::{Case, Trial};

/// Smallest mean size of a jump, as a share of the range.
const JUMP: f64 = 0.02;

/// Returns the actuators that move in steps in any trial; none where predictions come with the data, which are recorded at samples.
pub fn stepwise(case: &Case) -> Vec<usize> {
    if case.is_predicted() {
        return vec![];
    }
    let moves = |a: usize| case.development.iter().chain(&case.calibration).any(|trial| moves_in_steps(trial, a, case));
    (0..case.rig.actuators.len()).filter(|&a| moves(a)).collect()
}

/// Returns whether at least half of the way of an actuator is jumps with rest before and behind them, of the size of [`JUMP`].
fn moves_in_steps(trial: &Trial, a: usize, case: &Case) -> bool {
    let moved: Vec<f64> = trial.record.actuators[a].windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let jumps: Vec<f64> =
        moved.windows(3).filter(|near| near[0] == 0.0 && near[1] > 0.0 && near[2] == 0.0).map(|near| near[1]).collect();
    let (jumped, way): (f64, f64) = (jumps.iter().sum(), moved.iter().sum());
    way > 0.0 && 2.0 * jumped >= way && jumped >= JUMP * case.rig.actuators[a].span() * jumps.len() as f64
}
