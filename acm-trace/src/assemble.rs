//! Conversion of a search state to the model that is saved; both predict the same.

use acm_core::actuation::monomials;
use acm_core::augmented::AugmentedModel;
use acm_core::effects::instance::Instance;
use acm_core::nominal::NominalModel;
use acm_core::polynomial::Polynomial;
use acm_core::response::Response;
use acm_core::static_map::StaticMap;
use nalgebra::DMatrix;

use crate::fit::form::Form;
use crate::fit::interval::with_linear;
use crate::fit::problem::Problem;
use crate::fit::projected::{Projected, project};
use crate::fit::state::State;

/// A state as it predicts.
#[derive(Debug, Clone)]
pub struct Assembled {
    /// Nominal model with its static map.
    pub response: Response,
    /// Effects with their values, linear parameters included.
    pub effects: Vec<(Instance, Vec<f64>)>,
    /// Delay of the actuators' time stamps, s.
    pub clock: f64,
    /// Polynomial that approximates the given prediction.
    stands_for: Option<Polynomial>,
    rig: acm_core::rig::Rig,
}

impl Assembled {
    /// Solves for all linear parameters on the trials of `problem`; none where the equations are singular.
    pub fn new(problem: &Problem, state: &State) -> Option<Self> {
        let fitted = project(problem, state)?;
        let state = with_linear(problem, state, &fitted.beta, &fitted.design);
        let strain = problem.base.and_then(|base| base.strain);
        let response = match (problem.base, strain) {
            (_, Some(strain)) => strain.with_map(map(problem, state.form, &fitted)),
            (Some(base), None) => {
                let model = NominalModel::Polynomial(base.stands_for.clone());
                Response::new(model, map(problem, state.form, &fitted), None)
            }
            (None, _) => polynomial(problem, state.form.degree.unwrap_or(0), &fitted),
        };
        Some(Self {
            response,
            effects: state.effects.iter().map(|e| (e.instance.clone(), e.theta.clone())).collect(),
            clock: state.clock,
            stands_for: problem.base.filter(|base| base.strain.is_none()).map(|base| base.stands_for.clone()),
            rig: problem.rig.clone(),
        })
    }

    /// Assembles a baseline, for a search that found no effect.
    pub fn unchanged(problem: &Problem, baseline: &Response) -> Self {
        let stands_for = problem.base.filter(|base| base.strain.is_none()).map(|base| base.stands_for.clone());
        Self { response: baseline.clone(), effects: vec![], clock: 0.0, stands_for, rig: problem.rig.clone() }
    }

    /// Returns a model like any other.
    pub fn model(&self) -> AugmentedModel {
        let (response, effects) = (self.response.clone(), self.effects.clone());
        let model = AugmentedModel::assembled(self.rig.clone(), response, self.stands_for.clone(), effects);
        if self.clock == 0.0 { model } else { model.with_clock_correction(self.clock) }
    }
}

/// Returns the correction as a static map.
fn map(problem: &Problem, form: Form, fitted: &Projected) -> Option<StaticMap> {
    let actuators = problem.rig.actuators.len();
    let basis = monomials(actuators, form.degree?);
    let powers: Vec<Vec<usize>> =
        std::iter::once(vec![0; actuators]).chain(basis.exponents().iter().cloned()).collect();
    let coefficients =
        DMatrix::from_fn(powers.len(), problem.outputs(), |j, o| fitted.beta[(j, o)] / problem.weight[o]);
    let (low, high) = problem.range.iter().map(|(middle, half)| (middle - half, middle + half)).unzip();
    Some(StaticMap::from_powers(low, high, &powers, &coefficients))
}

/// Returns a polynomial of the normalised inputs as one of the inputs themselves.
fn polynomial(problem: &Problem, degree: usize, fitted: &Projected) -> Response {
    let actuators = problem.rig.actuators.len();
    let width = problem.outputs();
    let all = monomials(actuators, degree.max(1));
    let mut coefficients = DMatrix::zeros(1 + all.len(), width);
    let mut add = |exponents: &[usize], factor: f64, row: usize| {
        let at = all.exponents().iter().position(|own| own == exponents).map_or(0, |j| j + 1);
        (0..width).for_each(|o| coefficients[(at, o)] += factor * fitted.beta[(row, o)] / problem.weight[o]);
    };
    if fitted.design.correction > 0 {
        add(&vec![0; actuators], 1.0, 0);
        for (j, exponents) in monomials(actuators, degree).exponents().iter().enumerate() {
            expanded(exponents, &problem.range).iter().for_each(|(powers, factor)| add(powers, *factor, 1 + j));
        }
    }
    let blank = Polynomial::fit(&DMatrix::zeros(1, actuators), &DMatrix::zeros(1, width), degree.max(1)).polynomial;
    Response::new(NominalModel::Polynomial(blank.with_coefficients(coefficients)), None, None)
}

/// Expands Π_a ((q_a − m_a)/h_a)^{e_a} as a sum of monomials of q: exponents and factors.
fn expanded(exponents: &[usize], range: &[(f64, f64)]) -> Vec<(Vec<usize>, f64)> {
    let mut terms = vec![(vec![], 1.0)];
    for (&e, &(middle, half)) in exponents.iter().zip(range) {
        let mut next = Vec::new();
        for (powers, factor) in &terms {
            let mut binomial = 1.0;
            for k in 0..=e {
                let mut powers: Vec<usize> = powers.clone();
                powers.push(k);
                next.push((powers, factor * binomial * (-middle).powi((e - k) as i32) / half.powi(e as i32)));
                binomial *= (e - k) as f64 / (k + 1) as f64;
            }
        }
        terms = next;
    }
    terms
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use acm_core::effects::{Carrier, find};
    use acm_core::record::Record;
    use acm_core::rig::Signal;

    use super::*;
    use crate::fit::bench;
    use crate::fit::state::Placed;

    /// Oracle: y = 2 q + 1e-7 c sin t, with c about 1e5 Pa: the model that is saved predicts what the fit does. An effect
    /// whose size depends on c has columns in the unit of c, far from any bound of the size itself.
    #[test]
    fn the_saved_model_predicts_what_the_fit_does_where_a_size_depends_on_a_large_signal() {
        let mut rig = bench::rig(&["q"], &["p"], &["y"]);
        rig.contexts[0] = Signal { name: "p".into(), unit: "Pa".into(), low: 5e4, high: 1.5e5 };
        let of = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { bench::time().into_iter().map(f).collect() };
        let q = of(&|t| (1.3 * t).cos());
        let p = of(&|t| 1e5 + 5e4 * (0.31 * t).sin());
        let y: Vec<f64> = q.iter().zip(&p).zip(bench::time()).map(|((q, p), t)| 2.0 * q + 1e-7 * p * t.sin()).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![p], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        for name in ["coulomb_friction", "viscous_friction", "output_hysteresis"] {
            let plain = Instance::new(find(name).unwrap(), Carrier::Actuator(0), &rig);
            let instance = plain.with_context(Carrier::Context(0), &rig).unwrap();
            let theta = instance.initial_guesses(&rig).swap_remove(0);
            let state = State {
                effects: vec![Arc::new(Placed { instance, theta, in_calibration: true })],
                ..State::bare(Form::LINEAR)
            };
            let fitted = project(&problem, &state).unwrap();
            let model = Assembled::new(&problem, &state).unwrap().model();
            let predicted = model.predict(&series[0].record, None);
            for (k, y) in series[0].measured.iter().enumerate() {
                let (saved, fit) = (predicted[(k, 0)], y - fitted.residual[(k, 0)]);
                assert!((saved - fit).abs() < 1e-8, "{name} at {k}: {saved} {fit}");
            }
        }
    }

    /// Oracle: the product evaluated at a point.
    #[test]
    fn normalised_monomials_expand() {
        let range = [(0.3, 0.5), (-2.0, 4.0)];
        let q: [f64; 2] = [0.71, 1.3];
        for exponents in [[1, 0], [2, 1], [0, 3], [2, 2]] {
            let direct: f64 = (0..2).map(|a| ((q[a] - range[a].0) / range[a].1).powi(exponents[a] as i32)).product();
            let sum: f64 = expanded(&exponents, &range)
                .iter()
                .map(|(powers, factor)| factor * q[0].powi(powers[0] as i32) * q[1].powi(powers[1] as i32))
                .sum();
            assert!((direct - sum).abs() < 1e-12, "{exponents:?}");
        }
    }
}
