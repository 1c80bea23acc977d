//! Actuators that move in steps, and may be held between samples.
//!
//! A signal that rests between samples, and jumps from one to the next by a share of its range, is a command and not a motion: it is held
//! between samples, not interpolated. A quantised motion rests and jumps as well, by a small share.

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

/// Returns whether at least half of an actuator's path is jumps between rests, of mean size [`JUMP`] or more.
fn moves_in_steps(trial: &Trial, a: usize, case: &Case) -> bool {
    let moved: Vec<f64> = trial.record.actuators[a].windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let jumps: Vec<f64> =
        moved.windows(3).filter(|near| near[0] == 0.0 && near[1] > 0.0 && near[2] == 0.0).map(|near| near[1]).collect();
    let (jumped, way): (f64, f64) = (jumps.iter().sum(), moved.iter().sum());
    way > 0.0 && 2.0 * jumped >= way && jumped >= JUMP * case.rig.actuators[a].span() * jumps.len() as f64
}

#[cfg(test)]
mod tests {
    use acm_core::nominal::NominalSpec;
    use acm_core::record::Record;
    use nalgebra::DMatrix;

    use super::*;
    use crate::fit::bench;

    /// Oracle: by eye. A command of three levels moves in steps; an encoder that rounds a sine to hundredths, a sine, a ramp of four
    /// samples between rests, and what rests throughout do not.
    #[test]
    fn commands_move_in_steps_and_encoders_do_not() {
        let rig = bench::rig(&["command", "encoder", "sine", "ramp", "rest"], &[], &["y"]);
        let time = bench::time();
        let sine = |t: &f64| (0.2 * t).sin();
        let signals: [&dyn Fn(usize) -> f64; 5] = [
            &|k| [-1.0, 0.3, 1.0][k / 40 % 3],
            &|k| (100.0 * sine(&time[k])).round() / 100.0,
            &|k| sine(&time[k]),
            &|k| (k % 100).min(4) as f64 * if k / 100 % 2 == 0 { 0.25 } else { -0.25 },
            &|_| 0.5,
        ];
        let actuators = signals.map(|signal| (0..time.len()).map(signal).collect()).to_vec();
        let record = Record::new(time.clone(), actuators, vec![], vec![]);
        let measured = DMatrix::zeros(time.len(), 1);
        let trial = Trial { name: String::new(), record, lead: None, measured, predicted: None, offset: None };
        let case = Case {
            rig,
            nominal: NominalSpec::Polynomial { degree: 1 },
            at: vec![],
            reported: 0..1,
            calibration: vec![],
            development: vec![trial],
        };
        assert_eq!(stepwise(&case), [0]);
        let mut predicted = case;
        predicted.development[0].predicted = Some(DMatrix::zeros(time.len(), 1));
        assert_eq!(stepwise(&predicted), Vec::<usize>::new());
    }
}
