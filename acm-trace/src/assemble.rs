//! Conversion of a search state to the model that is saved; both predict the same.

use acm_core::InterSample;
use acm_core::actuation::Monomials;
use acm_core::augmented::AugmentedModel;
use acm_core::effects::instance::Instance;
use acm_core::nominal::NominalModel;
use acm_core::polynomial::Polynomial;
use acm_core::response::Response;
use acm_core::static_map::{Harmonic, Kink, StaticMap};
use nalgebra::DMatrix;

use crate::fit::form::angles::{Sums, sums};
use crate::fit::form::{BEYOND, Form};
use crate::fit::interval::with_linear;
use crate::fit::problem::Problem;
use crate::fit::projected::{Projected, project};
use crate::fit::state::State;

/// A state as a predictive model.
#[derive(Debug, Clone)]
pub struct Assembled {
    /// Nominal model with its static map.
    pub response: Response,
    /// Effects with their values, linear parameters included.
    pub effects: Vec<(Instance, Vec<f64>)>,
    /// Delay of the actuators' time stamps, s.
    pub clock: f64,
    /// Inter-sample behaviour of the actuators.
    pub inter_sample: InterSample,
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
            (None, _) => polynomial(problem, state.form, &fitted),
        };
        Some(Self {
            response,
            effects: state.effects.iter().map(|e| (e.instance.clone(), e.theta.clone())).collect(),
            clock: state.clock,
            inter_sample: problem.inter_sample(),
            stands_for: problem.base.filter(|base| base.strain.is_none()).map(|base| base.stands_for.clone()),
            rig: problem.rig.clone(),
        })
    }

    /// Assembles a baseline, for a search that found no effect.
    pub fn unchanged(problem: &Problem, baseline: &Response) -> Self {
        let stands_for = problem.base.filter(|base| base.strain.is_none()).map(|base| base.stands_for.clone());
        Self {
            response: baseline.clone(),
            effects: vec![],
            clock: 0.0,
            inter_sample: InterSample::Straight,
            stands_for,
            rig: problem.rig.clone(),
        }
    }

    /// Returns the model.
    pub fn model(&self) -> AugmentedModel {
        let (response, effects) = (self.response.clone(), self.effects.clone());
        let model = AugmentedModel::assembled(self.rig.clone(), response, self.stands_for.clone(), effects);
        let model = model.with_inter_sample(&self.inter_sample);
        if self.clock == 0.0 { model } else { model.with_clock_correction(self.clock) }
    }
}

/// Returns the correction as a static map.
fn map(problem: &Problem, form: Form, fitted: &Projected) -> Option<StaticMap> {
    let actuators = problem.rig.actuators.len();
    let basis = form.monomials(actuators)?;
    let powers: Vec<Vec<usize>> =
        std::iter::once(vec![0; actuators]).chain(basis.exponents().iter().cloned()).collect();
    let coefficients =
        DMatrix::from_fn(powers.len(), problem.outputs(), |j, o| fitted.beta[(j, o)] / problem.weight[o]);
    let (low, high) = problem.range.iter().map(|(middle, half)| (middle - half, middle + half)).unzip();
    let mut kinks = kinks(problem, form, powers.len(), fitted);
    // Beside a base nothing is extrapolated: at the end of the range the slopes add up to zero.
    for (actuator, (middle, half)) in problem.range.iter().enumerate() {
        let own = kinks.iter().filter(|kink| kink.actuator == actuator);
        let slopes = own.fold(vec![0.0; problem.outputs()], |sum, kink| {
            sum.iter().zip(&kink.slopes).map(|(sum, slope)| sum - slope).collect()
        });
        kinks.extend((!form.kinks.is_empty()).then(|| Kink { actuator, at: middle + half, slopes }));
    }
    let first = powers.len() + form.kinks.count() * actuators;
    let harmonics = harmonics(problem, form, first, fitted);
    Some(StaticMap::from_powers(low, high, &powers, &coefficients).with_kinks(kinks).with_harmonics(harmonics))
}

/// Returns the terms of angles of a form, whose coefficients begin at row `first`.
fn harmonics(problem: &Problem, form: Form, first: usize, fitted: &Projected) -> Vec<Harmonic> {
    let size = |j: usize| (0..problem.outputs()).map(|o| fitted.beta[(first + j, o)] / problem.weight[o]).collect();
    let sums = sums(problem.rig, form.sums).into_iter().enumerate();
    sums.map(|(h, multiples)| Harmonic { multiples, cosine: size(2 * h), sine: size(2 * h + 1) }).collect()
}

/// Returns the kinks of a form, whose coefficients begin at row `first`.
fn kinks(problem: &Problem, form: Form, first: usize, fitted: &Projected) -> Vec<Kink> {
    let places = (0..problem.range.len()).flat_map(|actuator| form.kinks.places().map(move |place| (actuator, place)));
    let kink = |(k, (actuator, place)): (usize, (usize, f64))| {
        let (middle, half) = problem.range[actuator];
        let slope = |o: usize| fitted.beta[(first + k, o)] / problem.weight[o] / half;
        Kink { actuator, at: middle + place * half, slopes: (0..problem.outputs()).map(slope).collect() }
    };
    places.enumerate().map(kink).collect()
}

/// Returns the linear part of a polynomial of the normalised inputs as a polynomial of the inputs themselves, with the higher powers and
/// the kinks as a static map.
fn polynomial(problem: &Problem, form: Form, fitted: &Projected) -> Response {
    let degree = form.degree.unwrap_or(0);
    let (actuators, width) = (problem.rig.actuators.len(), problem.outputs());
    let beta = |j: usize, o: usize| fitted.beta[(j, o)] / problem.weight[o];
    let mut coefficients = DMatrix::zeros(1 + actuators, width);
    if fitted.design.correction > 0 {
        (0..width).for_each(|o| coefficients[(0, o)] = beta(0, o));
    }
    for (a, (middle, half)) in problem.range.iter().enumerate().filter(|_| degree > 0) {
        for o in 0..width {
            coefficients[(1 + a, o)] = beta(1 + a, o) / half;
            coefficients[(0, o)] -= beta(1 + a, o) * middle / half;
        }
    }
    let blank = Polynomial::fit(&DMatrix::zeros(1, actuators), &DMatrix::zeros(1, width), 1).polynomial;
    let bent = (degree > 1 || !form.kinks.is_empty() || form.sums != Sums::None).then(|| {
        let monomials = form.monomials(actuators);
        let exponents = monomials.iter().flat_map(Monomials::exponents);
        let powers: Vec<Vec<usize>> = exponents.skip(actuators).cloned().collect();
        // The map's own inputs are 1 at its borders.
        let scale = |j: usize| BEYOND.powi(powers[j].iter().sum::<usize>() as i32);
        let bent = DMatrix::from_fn(powers.len(), width, |j, o| scale(j) * beta(1 + actuators + j, o));
        let border = |sign: f64| problem.range.iter().map(|(middle, half)| middle + sign * BEYOND * half).collect();
        let first = 1 + form.monomial_count(actuators);
        let kinks = kinks(problem, form, first, fitted);
        let harmonics = harmonics(problem, form, first + kinks.len(), fitted);
        StaticMap::from_powers(border(-1.0), border(1.0), &powers, &bent).with_kinks(kinks).with_harmonics(harmonics)
    });
    Response::new(NominalModel::Polynomial(blank.with_coefficients(coefficients)), bent, None)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use acm_core::effects::{Carrier, find};
    use acm_core::record::Record;
    use acm_core::rig::Signal;

    use super::*;
    use crate::fit::bench;
    use crate::fit::form::{Kinks, Powers};
    use crate::fit::problem::Base;
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

    /// Oracle: y = 1 + 2 q − q² + q³/4 on −1 … 1. Up to a quarter beyond, it is the polynomial; far out, only its linear part grows.
    #[test]
    fn a_polynomial_goes_on_straight() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let truth = |q: f64| 1.0 + 2.0 * q - q * q + 0.25 * q.powi(3);
        let q: Vec<f64> = bench::time().into_iter().map(|t| (1.3 * t).cos()).collect();
        let y = q.iter().map(|q| truth(*q)).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q], vec![], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let (middle, half) = problem.range[0];
        let state = State::bare(Form { degree: Some(3), ridge: 1e-9, ..Form::LINEAR });
        let model = Assembled::new(&problem, &state).unwrap().model();
        let at = |q: Vec<f64>| {
            let time = (0..q.len()).map(|k| k as f64).collect();
            model.predict(&Record::new(time, vec![q], vec![], vec![]), None)
        };
        let near = [-0.9, 0.3, 1.2].map(|z| middle + half * z);
        near.iter().enumerate().for_each(|(k, q)| assert!((at(near.to_vec())[(k, 0)] - truth(*q)).abs() < 1e-6, "{q}"));
        let far = at([10.0, 11.0, 12.0].map(|z| middle + half * z).to_vec());
        assert!(
            (far[(2, 0)] - 2.0 * far[(1, 0)] + far[(0, 0)]).abs() < 1e-6 && far[(2, 0)].abs() < 30.0 * half,
            "{far}"
        );
    }

    /// Oracle: y = T₄(a) b, where b is held at two values: the saved model equals the formula with and without a base.
    #[test]
    fn a_map_of_limited_powers_is_saved() {
        let rig = bench::rig(&["a", "b"], &[], &["y"]);
        let truth = |a: f64, b: f64| (8.0 * a.powi(4) - 8.0 * a * a + 1.0) * b;
        let a: Vec<f64> = bench::time().into_iter().map(|t| (1.3 * t).cos()).collect();
        let series = [-0.5, 1.0].map(|b| {
            let y = a.iter().map(|a| truth(*a, b)).collect();
            bench::series(Record::new(bench::time(), vec![a.clone(), vec![b; a.len()]], vec![], vec![]), y)
        });
        let zero = Polynomial::fit(&DMatrix::zeros(1, 2), &DMatrix::zeros(1, 1), 1).polynomial;
        let at = [vec![-0.7, 0.2, 0.9], vec![-0.5, 1.0, 1.0]];
        for base in [None, Some(Base { stands_for: &zero, strain: None })] {
            let problem = Problem::new(&rig, &series, &[1.0], base);
            let form = Form { degree: Some(5), powers: Powers::up_to(&[4, 1]), ridge: 1e-12, ..Form::LINEAR };
            let model = Assembled::new(&problem, &State::bare(form)).unwrap().model();
            let record = Record::new(vec![0.0, 1.0, 2.0], at.to_vec(), vec![], vec![]);
            let said = model.predict(&record, base.map(|_| DMatrix::zeros(3, 1)).as_ref());
            (0..3).for_each(|k| assert!((said[(k, 0)] - truth(at[0][k], at[1][k])).abs() < 1e-4, "{k}: {said}"));
        }
    }

    /// Oracle: y = |q| − 2 q on −1 … 1, by a line and a kink in the middle. Without a base the lines continue; with one the value at the
    /// end of the range is held.
    #[test]
    fn kinks_are_saved() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let truth = |q: f64| q.abs() - 2.0 * q;
        let q: Vec<f64> = bench::time().into_iter().map(|t| (1.3 * t).cos()).collect();
        let y = q.iter().map(|q| truth(*q)).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q.clone()], vec![], vec![]), y)];
        let zero = Polynomial::fit(&DMatrix::zeros(1, 1), &DMatrix::zeros(1, 1), 1).polynomial;
        let flat = Base { stands_for: &zero, strain: None };
        for (base, beyond) in [(None, -1.5), (Some(flat), -1.0)] {
            let problem = Problem::new(&rig, &series, &[1.0], base);
            let state = State::bare(Form { kinks: Kinks::spaced(16), ridge: 1e-9, ..Form::LINEAR });
            let model = Assembled::new(&problem, &state).unwrap().model();
            let at = [-0.7, 0.2, 0.9, 1.5].to_vec();
            let given = DMatrix::zeros(4, 1);
            let record = Record::new(vec![0.0, 1.0, 2.0, 3.0], vec![at.clone()], vec![], vec![]);
            let said = model.predict(&record, base.map(|_| &given));
            let (middle, half) = problem.range[0];
            assert!(middle.abs() < 0.01 && (half - 1.0).abs() < 0.01, "{middle} {half}");
            (0..3).for_each(|k| assert!((said[(k, 0)] - truth(at[k])).abs() < 0.02, "{k}: {said}"));
            assert!((said[(3, 0)] - beyond).abs() < 0.03, "{said}");
        }
    }

    /// Oracle: y = 2 cos(q₁ − q₂) + 3 sin q₁ + q₂, far beyond the recorded angles too.
    #[test]
    fn harmonics_are_saved() {
        let rig = bench::rig(&["a", "b"], &[], &["y"]);
        let truth = |a: f64, b: f64| 2.0 * (a - b).cos() + 3.0 * a.sin() + b;
        let course = |rate: f64| -> Vec<f64> { bench::time().into_iter().map(|t| (rate * t).cos()).collect() };
        let (a, b) = (course(1.3), course(2.9));
        let y = a.iter().zip(&b).map(|(a, b)| truth(*a, *b)).collect();
        let series = [bench::series(Record::new(bench::time(), vec![a, b], vec![], vec![]), y)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let state = State::bare(Form { sums: Sums::UpTo(2), ridge: 1e-12, ..Form::LINEAR });
        let model = Assembled::new(&problem, &state).unwrap().model();
        let at = [vec![-0.7, 0.2, 2.5], vec![0.4, -0.9, -1.5]];
        let said = model.predict(&Record::new(vec![0.0, 1.0, 2.0], at.to_vec(), vec![], vec![]), None);
        (0..3).for_each(|k| assert!((said[(k, 0)] - truth(at[0][k], at[1][k])).abs() < 1e-3, "{k}: {said}"));
    }
}
