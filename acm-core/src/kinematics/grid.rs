//! Integration grid: steps from base to tip that stop at every strain border and every marker.

use crate::kinematics::strain::StrainBasis;

/// Distance of the outer Gauss points from the middle one, as a fraction of the step: √15/10.
const GAUSS: f64 = 0.387_298_334_620_741_7;

/// √15/3, the weight of the slope.
const SLOPE: f64 = 1.290_994_448_735_805_6;

/// The weight of the curvature.
const CURVATURE: f64 = 10.0 / 3.0;

/// How strain varies along a step, for which [`crate::kinematics::magnus`] has formulas of different cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variation {
    /// One value along the step.
    Constant,
    /// A straight line.
    Linear,
    /// Any polynomial.
    Any,
}

/// One step: its length, and where its share of each basis function stands.
#[derive(Debug, Clone)]
pub struct Step {
    /// m.
    pub length: f64,
    /// First basis function that is active here.
    pub first: usize,
    /// Where in [`Grid::values`] the weights of the active functions start: in α₁, then in α₂, then in α₃.
    pub weights: usize,
}

/// Marker number `marker` sits where `after` steps have been taken.
#[derive(Debug, Clone)]
pub struct Stop {
    /// Steps from the base.
    pub after: usize,
    /// Index from 0.
    pub marker: usize,
}

/// Steps with their basis functions tabulated, and markers in the order in which they are passed.
#[derive(Debug, Clone)]
pub struct Grid {
    /// Steps from base to tip.
    pub steps: Vec<Step>,
    /// Stops from base to tip.
    pub stops: Vec<Stop>,
    /// α of [`crate::kinematics::magnus`] per unit of each basis function, m.
    pub values: Vec<f64>,
    /// How strain varies along a step.
    pub variation: Variation,
    /// Basis functions in all.
    pub functions: usize,
    /// Basis functions that are active in one step.
    pub active: usize,
    /// Least number of steps that was asked for.
    pub least_steps: usize,
}

impl Grid {
    /// At least `least_steps` steps over the whole arm; one step between borders where that is exact.
    pub fn new(length: f64, basis: StrainBasis, at: &[f64], least_steps: usize) -> Self {
        let mut grid = Self {
            steps: Vec::new(),
            stops: Vec::new(),
            values: Vec::new(),
            variation: variation(basis),
            functions: basis.functions(),
            active: basis.active(0.0).1.len(),
            least_steps,
        };
        let nodes = nodes(basis, at);
        grid.stop_at(0.0, at);
        for pair in nodes.windows(2) {
            let steps = steps_between(basis, pair[0], pair[1], least_steps);
            grid.divide(length, basis, pair[0], pair[1], steps);
            grid.stop_at(pair[1], at);
        }
        grid
    }

    fn stop_at(&mut self, place: f64, at: &[f64]) {
        let after = self.steps.len();
        let here = at.iter().enumerate().filter(|(_, s)| **s == place);
        self.stops.extend(here.map(|(marker, _)| Stop { after, marker }));
    }

    fn divide(&mut self, length: f64, basis: StrainBasis, from: f64, to: f64, steps: usize) {
        let width = (to - from) / steps as f64;
        for k in 0..steps {
            let middle = from + (k as f64 + 0.5) * width;
            let step = Step { length: length * width, first: basis.active(middle).0, weights: self.values.len() };
            let [early, there, late] = [-GAUSS, 0.0, GAUSS].map(|offset| basis.active(middle + offset * width).1);
            let h = step.length;
            self.values.extend(there.iter().map(|b| h * b));
            self.values.extend(early.iter().zip(&late).map(|(a, c)| SLOPE * h * (c - a)));
            let bent = early.iter().zip(&there).zip(&late);
            self.values.extend(bent.map(|((a, b), c)| CURVATURE * h * (c - 2.0 * b + a)));
            self.steps.push(step);
        }
    }
}

fn variation(basis: StrainBasis) -> Variation {
    match basis {
        StrainBasis::Legendre { order: 1 } => Variation::Linear,
        basis if basis.is_constant_between_borders() => Variation::Constant,
        _ => Variation::Any,
    }
}

/// Base, borders and markers in order, each once; nothing beyond the last marker is integrated.
fn nodes(basis: StrainBasis, at: &[f64]) -> Vec<f64> {
    let last = at.iter().copied().fold(0.0, f64::max);
    let mut nodes = vec![0.0];
    nodes.extend(basis.borders().into_iter().filter(|&u| u < last));
    nodes.extend(at.iter().copied().filter(|&u| u > 0.0));
    nodes.sort_by(f64::total_cmp);
    nodes.dedup();
    nodes
}

fn steps_between(basis: StrainBasis, from: f64, to: f64, least_steps: usize) -> usize {
    if basis.is_constant_between_borders() { 1 } else { ((to - from) * least_steps as f64).ceil().max(1.0) as usize }
}
