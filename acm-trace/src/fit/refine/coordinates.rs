//! Nonlinear parameters of a state as dimensionless coordinates.
//!
//! ```text
//! u = 1 + ln(θ/θ₀) for a parameter that has no sign, 1 + (θ − θ₀)/s for one that has
//! ```

use std::sync::Arc;

use acm_core::effects::ParameterSpec;

use crate::fit::problem::Problem;
use crate::fit::state::{Placed, State};

/// Finite-difference step in u; smaller for a resonance, and for an effect that is periodic in an actuator.
const STEP: (f64, f64) = (0.02, 0.002);

/// A nonlinear parameter that a fit moves.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Place {
    /// Parameter `1` of effect `0`.
    Effect(usize, usize),
    /// Clock correction.
    Clock,
}

/// Returns the nonlinear parameters of a state.
pub(crate) fn places(state: &State) -> Vec<Place> {
    let effects = state.effects.iter().enumerate();
    let mut all: Vec<Place> =
        effects.flat_map(|(i, placed)| placed.free().into_iter().map(move |j| Place::Effect(i, j))).collect();
    all.extend((state.clock != 0.0).then_some(Place::Clock));
    all
}

/// A dimensionless coordinate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coordinate {
    place: Place,
    start: f64,
    lower: f64,
    upper: f64,
    /// Scale s of a parameter that has a sign; none for a logarithmic one.
    scale: Option<f64>,
    /// Finite-difference step.
    step: f64,
}

impl Coordinate {
    pub fn new(problem: &Problem, state: &State, place: Place) -> Self {
        match place {
            Place::Clock => {
                let longest = problem.rig.duration / 3.0;
                let scale = Some(problem.rig.step.max(f64::MIN_POSITIVE));
                Self { place, start: state.clock, lower: 0.2 * problem.rig.step, upper: longest, scale, step: STEP.0 }
            }
            Place::Effect(i, j) => {
                let (spec, start) = (&state.effects[i].instance.parameters()[j], state.effects[i].theta[j]);
                let traits = state.effects[i].instance.effect().traits();
                let step = if traits.is_periodic || traits.is_resonance { STEP.1 } else { STEP.0 };
                let scale = (!is_positive(spec, start)).then_some(spec.scale);
                Self { place, start, lower: spec.lower, upper: spec.upper, scale, step }
            }
        }
    }

    /// Returns θ at u.
    pub fn value(&self, u: f64) -> f64 {
        let value = match self.scale {
            None => self.start * (u - 1.0).exp(),
            Some(scale) => self.start + scale * (u - 1.0),
        };
        value.max(self.lower).min(self.upper)
    }

    /// Returns the finite-difference step at u: backwards on the upper bound.
    pub fn step_from(&self, u: f64) -> f64 {
        if self.value(u + self.step) == self.value(u) { -self.step } else { self.step }
    }

    /// Returns u at both bounds.
    pub fn bounds(&self) -> [f64; 2] {
        [self.lower, self.upper].map(|bound| self.at(bound))
    }

    /// Returns u at θ.
    fn at(&self, value: f64) -> f64 {
        match self.scale {
            None => 1.0 + (value.max(f64::MIN_POSITIVE) / self.start).ln(),
            Some(scale) => 1.0 + (value - self.start) / scale,
        }
    }
}

fn is_positive(spec: &ParameterSpec, value: f64) -> bool {
    spec.lower >= 0.0 && value > 0.0
}

/// Returns a state with other values of some parameters.
pub(crate) fn put(state: &State, coordinates: &[Coordinate], u: &[f64]) -> State {
    let mut next = state.clone();
    for (coordinate, u) in coordinates.iter().zip(u) {
        match coordinate.place {
            Place::Clock => next.clock = coordinate.value(*u),
            Place::Effect(i, j) => {
                let mut placed: Placed = (*next.effects[i]).clone();
                placed.theta[j] = coordinate.value(*u);
                next.effects[i] = Arc::new(placed);
            }
        }
    }
    next
}
