//! Degree, kinks and ridge of the nominal form, by blocks left out: the simplest that predicts about as well as the best.

pub(crate) mod held;

use rayon::prelude::*;

use super::criteria::Criteria;
use super::scan::{Losses, cross_validate, sum};
use crate::fit::design::design;
use crate::fit::form::angles::{Sums, angles, sums};
use crate::fit::form::{Form, Kinks, Powers, fits_sums, most_kinks};
use crate::fit::gram::Grams;
use crate::fit::problem::Problem;
use crate::fit::state::{Part, State};
use held::{fewest, interpolated};

/// Ridge parameters that are tried.
const RIDGES: [f64; 3] = [1e-6, 1e-4, 1e-2];

/// Highest degree where one actuator is alone, or alone moves freely, and no base is given; and highest degree elsewhere.
const DEGREES: (usize, usize) = (4, 8);

/// Returns the polynomial of the highest degree that is tried on a state.
pub fn largest_polynomial(problem: &Problem, state: &State) -> Form {
    let powers = interpolated(problem, state);
    polynomial(highest_degree(problem, powers), powers)
}

/// Returns the highest degree that is tried with these powers.
fn highest_degree(problem: &Problem, powers: Powers) -> usize {
    let actuators = problem.rig.actuators.len();
    let free = powers.highest(actuators, DEGREES.1).into_iter().filter(|power| *power == DEGREES.1).count();
    let alone = actuators == 1 || free == 1;
    let most = if alone && problem.base.is_none() { DEGREES.0 } else { DEGREES.1 };
    let degrees = 1..=largest(powers, actuators, most);
    degrees.take_while(|&degree| polynomial(degree, powers).fits(actuators)).last().unwrap_or(0)
}

/// Returns the highest power of any actuator in a polynomial of a degree.
fn largest(powers: Powers, actuators: usize, degree: usize) -> usize {
    powers.highest(actuators, degree).into_iter().max().unwrap_or(0)
}

fn polynomial(degree: usize, powers: Powers) -> Form {
    Form { degree: Some(degree), powers, ..Form::LINEAR }
}

/// Returns the forms with terms of angles beside a straight line: of consecutive joints, and of every number of joints that a sum may
/// have; none beside a base, whose correction is small, or where angles rest at one or two values.
fn turning(problem: &Problem, state: &State) -> impl Iterator<Item = Form> {
    let (rig, actuators) = (problem.rig, problem.rig.actuators.len());
    let most = if problem.base.is_none() && fewest(problem, state) > 1 { angles(rig) } else { 0 };
    let fit = move |which: &Sums| fits_sums(actuators, sums(rig, *which).len());
    let chains = [Sums::Chain, Sums::Planar].into_iter().filter(move |_| most >= CHAIN);
    chains.chain((1..=most).map(Sums::UpTo)).filter(fit).map(|sums| Form { sums, ..Form::LINEAR })
}

/// Highest degree, and most columns, of the static map that a static effect has to predict better than.
const RIVAL: (usize, usize) = (10, 70);

/// Returns the smallest sum of squares of a correction of any degree, left out: a static effect may be such a
/// correction in disguise.
pub fn most_flexible(problem: &Problem, state: &State) -> f64 {
    let (actuators, powers) = (problem.rig.actuators.len(), interpolated(problem, state));
    let degrees = highest_degree(problem, powers) + 1..=largest(powers, actuators, RIVAL.0);
    let fits = |degree: &usize| polynomial(*degree, powers).monomial_count(actuators) <= RIVAL.1;
    let of = |degree: usize| {
        let form = Form { degree: Some(degree), powers, ridge: RIDGES[0], ..state.form };
        of_ridges(problem, &State { form, ..state.clone() })
    };
    let tried = degrees.take_while(fits).flat_map(of);
    tried.map(|(_, losses)| sum(&losses)).fold(f64::INFINITY, f64::min)
}

/// Distances between kinks that are evenly spaced: 3, 7 and 15 of them.
const SPACED: [u32; 3] = [32, 16, 8];

/// Largest number of kinks that are placed one after the other, and the distance between places at first.
const PLACED: (usize, u32) = (12, 2);

/// Rounds in which kinks move to places beside theirs.
const MOVES: usize = 4;

/// Returns the state with the best form with kinks beside a straight line: for maps that polynomials fit poorly, such as a sensor of the
/// absolute value. Kinks are evenly spaced, or placed one by one where each predicts best; those before then move.
pub fn bent(problem: &Problem, state: &State, criteria: &Criteria) -> Option<(State, Losses)> {
    let actuators = problem.rig.actuators.len();
    let most = most_kinks(actuators).min(fewest(problem, state) - 1);
    let with = |kinks: Kinks| State { form: Form { kinks, ..Form::LINEAR }, ..state.clone() };
    let mut forms: Vec<Kinks> = SPACED.into_iter().map(Kinks::spaced).filter(|kinks| kinks.count() <= most).collect();
    let best = |all: Vec<Kinks>| -> Option<(f64, Kinks)> {
        let tried = all.into_par_iter().filter_map(|kinks| Some((sum(&cross_validate(problem, &with(kinks))?), kinks)));
        tried.collect::<Vec<_>>().into_iter().min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let mut placed = (f64::INFINITY, Kinks::NONE);
    while placed.1.count() < PLACED.0.min(most) {
        let few = placed.0 / (1.0 + criteria.degree_share);
        let Some(next) = best(placed.1.larger(PLACED.1).collect()).filter(|next| next.0 < few) else { break };
        placed = next;
        for _ in 0..MOVES {
            let Some(next) = best(placed.1.moved().collect()).filter(|next| next.0 < placed.0) else { break };
            placed = next;
        }
        forms.push(placed.1);
    }
    let tried: Vec<(State, Losses)> =
        forms.into_par_iter().flat_map_iter(|kinks| of_ridges(problem, &with(kinks))).collect();
    simplest(problem, tried, criteria)
}

/// Returns the state with the best form, and with each effect in the calibration trials or not.
pub fn choose(problem: &Problem, state: &State, criteria: &Criteria) -> (State, Losses) {
    let mut best = with_form(problem, state, criteria);
    if problem.has_calibration() {
        for i in 0..state.effects.len() {
            let other = best.0.rescoped(i);
            let losses = cross_validate(problem, &other);
            let better = |losses: &Losses| sum(losses) * (1.0 + criteria.degree_share) < sum(&best.1);
            if let Some(losses) = losses.filter(better) {
                best = (other, losses);
            }
        }
    }
    best
}

/// Returns the state with the best form.
fn with_form(problem: &Problem, state: &State, criteria: &Criteria) -> (State, Losses) {
    let options = options(problem, state);
    let tried: Vec<(State, Losses)> =
        options.into_par_iter().flat_map_iter(|option| of_ridges(problem, &option)).collect();
    let none = || (state.clone(), vec![f64::INFINITY; problem.blocks.len()]);
    simplest(problem, tried, criteria).unwrap_or_else(none)
}

/// Returns the state with the fewest columns that predicts about as well as the best.
fn simplest(problem: &Problem, tried: Vec<(State, Losses)>, criteria: &Criteria) -> Option<(State, Losses)> {
    let best = tried.iter().map(|(_, losses)| sum(losses)).min_by(f64::total_cmp)?;
    let size = |state: &State| (columns(problem, state.form), -state.form.ridge);
    let close = tried.into_iter().filter(|(_, losses)| sum(losses) <= best * (1.0 + criteria.degree_share));
    close.min_by(|a, b| {
        let (a, b) = (size(&a.0), size(&b.0));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    })
}

/// Returns the state with each ridge, and its losses: all share the products of a design.
fn of_ridges(problem: &Problem, state: &State) -> Vec<(State, Losses)> {
    let regression = design(problem, state);
    let grams = Grams::new(&regression, &problem.blocks);
    let of = |ridge: f64| {
        let cv = grams.cross_validate(&problem.blocks, ridge)?;
        let form = Form { ridge, ..state.form };
        Some((State { form, ..state.clone() }, cv.loss))
    };
    RIDGES.into_iter().filter_map(of).collect()
}

/// Fewest angles that form a chain of joints, whose nominal form may have terms of angles from the start. The weight of a single joint is
/// a named effect.
const CHAIN: usize = 2;

/// Returns the number of columns of a form.
fn columns(problem: &Problem, form: Form) -> usize {
    let actuators = problem.rig.actuators.len();
    let further = actuators * form.kinks.count() + 2 * sums(problem.rig, form.sums).len();
    form.degree.map_or(0, |_| 1 + form.monomial_count(actuators) + further)
}

/// Returns a state for every degree, and for its own kinks where it has some.
fn options(problem: &Problem, state: &State) -> Vec<State> {
    let has_input = state.clock != 0.0 || state.effects.iter().any(|placed| placed.part() == Part::Input);
    let lowest = usize::from(has_input && problem.base.is_none());
    let powers = interpolated(problem, state);
    let degrees = lowest..=highest_degree(problem, powers).max(lowest);
    let mut forms: Vec<Form> = degrees.map(|degree| polynomial(degree, powers)).collect();
    if problem.base.is_some() {
        forms.push(Form::GIVEN);
    }
    if !state.form.kinks.is_empty() {
        forms.push(Form { kinks: state.form.kinks, ..Form::LINEAR });
    }
    if angles(problem.rig) >= CHAIN || state.form.sums != Sums::None {
        forms.extend(turning(problem, state));
    }
    forms.into_iter().map(|form| State { form, ..state.clone() }).collect()
}

#[cfg(test)]
mod tests {
    use acm_core::record::Record;

    use super::*;
    use crate::fit::bench;
    use crate::series::Series;

    /// Oracle: two recorded values determine a straight line; a lag passes through all between them.
    #[test]
    fn a_lag_fills_the_gaps_between_steps() {
        let rig = bench::rig(&["q"], &[], &["y"]);
        let q: Vec<f64> = bench::time().iter().map(|t| (1.7 * t).sin().signum()).collect();
        let series = [bench::series(Record::new(bench::time(), vec![q.clone()], vec![], vec![]), q)];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let bare = State::bare(Form::LINEAR);
        let lagging = bare.with(bench::placed("actuator_lag", acm_core::effects::Carrier::Rig, &rig, &[0.5]));
        assert_eq!(
            [&bare, &lagging].map(|state| highest_degree(&problem, interpolated(&problem, state))),
            [1, DEGREES.0]
        );
        let [bare, lagging] = [bare, lagging].map(|state| bent(&problem, &state, &Criteria::default()));
        assert!(bare.is_none() && lagging.is_some());
    }

    /// Oracle: T₄(a) has the fourth power of an actuator that moves; the three values at which b is held determine two powers of b.
    #[test]
    fn an_actuator_that_is_held_limits_its_own_powers_alone() {
        let rig = bench::rig(&["a", "b"], &[], &["y"]);
        let a: Vec<f64> = bench::time().iter().map(|t| (1.7 * t).cos()).collect();
        let power = 3.0 * a.len() as f64;
        let of = |held: f64| {
            let y = bench::time().iter().map(|t| (4.0 * 1.7 * t).cos() + held).collect();
            let record = Record::new(bench::time(), vec![a.clone(), vec![held; a.len()]], vec![], vec![]);
            Series { block: (0..a.len()).map(|k| k / 200).collect(), ..bench::series(record, y) }
        };
        let series = [-1.0, 0.1, 1.0, -1.0, 0.1, 1.0].map(of);
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let largest = largest_polynomial(&problem, &State::bare(Form::LINEAR));
        let exponents = largest.monomials(2).unwrap().exponents().to_vec();
        assert_eq!([0, 1].map(|q| exponents.iter().map(|e| e[q]).max().unwrap()), [DEGREES.0, 2]);
        let (chosen, losses) = choose(&problem, &State::bare(Form::LINEAR), &Criteria::default());
        assert!(chosen.form.degree == Some(4) && sum(&losses) < 1e-6 * power, "{:?} {}", chosen.form, sum(&losses));
    }

    /// Oracle: Chebyshev's T₉ is a polynomial of degree 9: one of degree 10 takes it up, and the forms that corrections may have
    /// do not; T₁₁ is beyond both.
    #[test]
    fn the_most_flexible_map_has_degrees_that_a_correction_has_not() {
        let left = |degree: f64| {
            let rig = bench::rig(&["q"], &[], &["y"]);
            let angle = |t: &f64| 1.7 * t;
            let q: Vec<f64> = bench::time().iter().map(|t| angle(t).cos()).collect();
            let y: Vec<f64> = bench::time().iter().map(|t| (degree * angle(t)).cos()).collect();
            let power = y.iter().map(|y| y * y).sum::<f64>();
            let series = [bench::series(Record::new(bench::time(), vec![q], vec![], vec![]), y)];
            let problem = Problem::new(&rig, &series, &[1.0], None);
            let bare = State::bare(Form::LINEAR);
            let (_, corrected) = choose(&problem, &bare, &Criteria::default());
            [sum(&corrected) / power, most_flexible(&problem, &bare) / power]
        };
        let [corrected, flexible] = left(9.0);
        assert!(corrected > 0.5 && flexible < 0.1, "{corrected} {flexible}");
        assert!(left(11.0)[1] > 0.5);
    }

    /// Oracle: the height of three links in a plane is linear in the sines of q₁, q₁ + q₂ and q₁ + q₂ + q₃; a torque that turns with
    /// q₁ − q₂ is not among sums of consecutive joints.
    #[test]
    fn links_in_a_plane_have_terms_of_joints_that_follow_one_another() {
        let rig = bench::rig(&["a", "b", "c"], &[], &["y"]);
        let course = |rate: f64| -> Vec<f64> { bench::time().iter().map(|t| 1.4 * (rate * t).sin()).collect() };
        let q = [0.7, 1.9, 3.1].map(course);
        let chosen = |of: &dyn Fn([f64; 3]) -> f64| {
            let y: Vec<f64> = (0..q[0].len()).map(|k| of([q[0][k], q[1][k], q[2][k]])).collect();
            let mut series = bench::series(Record::new(bench::time(), q.to_vec(), vec![], vec![]), y);
            series.block = (0..series.rows.len()).map(|k| k / 200).collect();
            let series = [series];
            let problem = Problem::new(&rig, &series, &[1.0], None);
            choose(&problem, &State::bare(Form::LINEAR), &Criteria::default()).0.form.sums
        };
        assert_eq!(chosen(&|[a, b, c]| 3.0 * a.sin() + 2.0 * (a + b).sin() + (a + b + c).sin()), Sums::Chain);
        assert_eq!(chosen(&|[a, b, c]| 3.0 * a.sin() + 2.0 * (b + c).sin() + (a + b + c).sin()), Sums::Planar);
        assert_eq!(chosen(&|[a, b, _]| 3.0 * a.sin() + 2.0 * (a - b).sin()), Sums::UpTo(2));
    }

    /// Oracle: the truth is a plane, and a cubic of six actuators has 83 coefficients of noise. With a lag in the model, too.
    #[test]
    fn a_plane_over_six_actuators_stays_a_plane() {
        let names = ["a", "b", "c", "d", "e", "f"];
        let rig = bench::rig(&names, &[], &["y"]);
        let mut noise = bench::noise(0.2);
        let course = |k: usize| -> Vec<f64> {
            bench::time().iter().map(|t| ((0.4 + 0.31 * k as f64) * t + k as f64).sin()).collect()
        };
        let q: Vec<Vec<f64>> = (0..names.len()).map(course).collect();
        let y = (0..q[0].len()).map(|t| q.iter().zip(1..).map(|(q, w)| q[t] / f64::from(w)).sum::<f64>() + noise());
        let y: Vec<f64> = y.collect();
        let mut series = bench::series(Record::new(bench::time(), q, vec![], vec![]), y);
        series.block = (0..series.rows.len()).map(|k| k / 200).collect();
        let series = [series];
        let problem = Problem::new(&rig, &series, &[1.0], None);
        let bare = State::bare(Form::LINEAR);
        let lagging = bare.with(bench::placed("actuator_lag", acm_core::effects::Carrier::Rig, &rig, &[0.02]));
        for state in [bare, lagging] {
            let form = choose(&problem, &state, &Criteria::default()).0.form;
            assert_eq!(form.degree, Some(1), "{form:?}");
        }
    }
}
