//! Initial guesses of a fit: grids over what is not linear, scaled from the record.
//!
//! A linear parameter is set to its scale, since it is solved for. Where each actuator has its own parameter, all are
//! alike first; then, with two to six moving actuators, each acts alone on a coarser grid and the others are neutral.

use super::actuation::actuators;
use super::times::spread;
use super::{ParameterSpec, Rig};

/// Smallest and largest length to start from, as shares of a travel, and how many.
const LENGTHS: (f64, f64, usize) = (0.002, 0.8, 10);

/// The same for presliding lengths, which may be as short as a step of a fine encoder.
const PRESLIDING: (f64, f64, usize) = (2e-5, 0.8, 14);

/// Points of the grid on which one actuator acts alone.
const ALONE: usize = 4;

/// Most actuators that are tried alone.
const FEW: usize = 6;

/// Plays and transitions as shares of a travel.
pub fn lengths() -> Vec<f64> {
    spread(LENGTHS.0, LENGTHS.1, LENGTHS.2)
}

/// Presliding lengths as shares of a travel.
pub fn presliding() -> Vec<f64> {
    spread(PRESLIDING.0, PRESLIDING.1, PRESLIDING.2)
}

/// At most `count` of a grid, evenly, first and last among them.
pub fn thinned<T: Clone>(grid: &[T], count: usize) -> Vec<T> {
    match (grid.len(), count) {
        (length, _) if length <= count => grid.to_vec(),
        (length, 0 | 1) => grid.iter().skip(length / 2).take(count).cloned().collect(),
        (length, _) => (0..count).map(|k| grid[k * (length - 1) / (count - 1)].clone()).collect(),
    }
}

/// Sizes at `share` of their scales, linear ones at their scale, all others neutral.
pub fn guess(specs: &[ParameterSpec], share: f64) -> Vec<f64> {
    let of = |p: &ParameterSpec| match p.may_vary {
        true => p.inside(p.neutral + if p.linear { 1.0 } else { share } * p.scale),
        false => p.neutral,
    };
    specs.iter().map(of).collect()
}

/// The same with parameter `j` at `value`.
pub fn guess_with(specs: &[ParameterSpec], share: f64, j: usize, value: f64) -> Vec<f64> {
    let mut guess = guess(specs, share);
    guess[j] = specs[j].inside(value);
    guess
}

/// Which actuators act.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Who {
    /// Every actuator.
    All,
    /// One actuator, by index.
    One(usize),
}

impl Who {
    /// Whether actuator `j` acts.
    pub fn has(self, j: usize) -> bool {
        self == Who::All || self == Who::One(j)
    }
}

/// `make` for all actuators alike over the whole grid, then for each that moves alone over a coarser one.
pub fn alike_then_alone<T: Clone>(rig: &Rig, grid: &[T], make: impl Fn(Who, T) -> Vec<f64>) -> Vec<Vec<f64>> {
    let mut guesses: Vec<Vec<f64>> = grid.iter().map(|point| make(Who::All, point.clone())).collect();
    let moving: Vec<usize> = (0..rig.actuators.len()).filter(|&j| actuators::travel(&rig.actuators[j]) > 0.0).collect();
    if (2..=FEW).contains(&moving.len()) {
        let coarse = thinned(grid, ALONE);
        let alone = moving.into_iter().flat_map(|j| coarse.iter().map(move |point| (Who::One(j), point.clone())));
        guesses.extend(alone.map(|(who, point)| make(who, point)));
    }
    guesses
}

/// The first `sizes` parameters at `share` of their scales for the actuators that act, everything else at rest.
pub fn sizes_of(specs: &[ParameterSpec], sizes: usize, who: Who, share: f64) -> Vec<f64> {
    let of = |(j, p): (usize, &ParameterSpec)| match j < sizes && who.has(j) {
        true => p.inside(p.neutral + share * p.scale),
        false => p.neutral,
    };
    specs.iter().enumerate().map(of).collect()
}

/// [`alike_then_alone`] where the first parameters are one size for each actuator: `size(j, point)`, within its bounds, for those
/// that act. All others are neutral.
pub fn of_each<T: Clone>(
    rig: &Rig,
    specs: &[ParameterSpec],
    grid: &[T],
    size: impl Fn(usize, &T) -> f64,
) -> Vec<Vec<f64>> {
    alike_then_alone(rig, grid, |who, point| {
        let of = |(j, spec): (usize, &ParameterSpec)| match who.has(j) && j < rig.actuators.len() {
            true => spec.inside(size(j, &point)),
            false => spec.neutral,
        };
        specs.iter().enumerate().map(of).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_is_thinned_from_end_to_end() {
        assert_eq!(thinned(&[1, 2, 3, 4, 5, 6, 7], 3), [1, 4, 7]);
        assert_eq!(thinned(&[1, 2, 3], 4), [1, 2, 3]);
        assert_eq!(thinned(&[1, 2, 3], 1), [2]);
        let lengths = lengths();
        assert_eq!((lengths.len(), lengths[0], lengths[9]), (10, 0.002, 0.8));
    }
}
