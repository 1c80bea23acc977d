//! Shape of the nominal arm at several configurations of each slice, for the figure of the residual at the tip.
//!
//! The swept actuator stands at the mean of a bin, the others at the mean of the slice. Along the arm nothing but the
//! tip is measured, so the residual is known there alone.

use acm_core::{NominalModel, StrainModel};

use super::record::{Backbone, ResidualStudy, Slice};
use crate::run::record::CalibrationPair;

/// Points along an arm.
const POINTS: usize = 21;

/// Returns the backbones of every slice; none, with a note, where the nominal model has no arm.
pub fn backbones(pair: &CalibrationPair, record: &ResidualStudy, notes: &mut Vec<String>) -> Vec<Backbone> {
    let Some(NominalModel::Strain(arm)) = pair.nominal.as_ref().map(|nominal| &nominal.model) else {
        notes.push("The nominal model is no strain model, so no arm is drawn.".into());
        return vec![];
    };
    let of = |(place, slice): (usize, &Slice)| -> Vec<Backbone> {
        let chosen = spread(slice.bins.len(), record.asked.backbones);
        chosen.into_iter().map(|bin| one(arm, place, bin, slice, record.swept)).collect()
    };
    record.slices.iter().enumerate().flat_map(of).collect()
}

fn one(arm: &StrainModel, slice: usize, bin: usize, of: &Slice, swept: usize) -> Backbone {
    let mut q = of.actuators.clone();
    q[swept] = of.bins[bin].q;
    let length = arm.arm().length;
    let at = |k: usize| arm.pose(&q, length * k as f64 / (POINTS - 1) as f64).position.into();
    Backbone { slice, bin, points: (0..POINTS).map(at).collect() }
}

/// Returns `wanted` of `count` indices, the first and the last among them, evenly spread.
fn spread(count: usize, wanted: usize) -> Vec<usize> {
    match (count, wanted) {
        (0, _) | (_, 0) => vec![],
        (_, 1) => vec![count / 2],
        _ => {
            let step = (count - 1) as f64 / (wanted - 1) as f64;
            let mut places: Vec<usize> = (0..wanted).map(|k| (step * k as f64).round() as usize).collect();
            places.dedup();
            places
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn places_are_spread_from_end_to_end() {
        assert_eq!(spread(9, 5), [0, 2, 4, 6, 8]);
        assert_eq!(spread(3, 5), [0, 1, 2]);
        assert_eq!(spread(1, 5), [0]);
        assert_eq!((spread(0, 5), spread(7, 1)), (vec![], vec![3]));
    }
}
