//! Candidates, and the choice: the simplest within one standard error of the best, or 1 % of its error.
//!
//! ```text
//! e_f(A)² = Σ_t |p_t − (1/M) Σ_{m ∈ A} p̂_{m,t}|² / T + Σ_{m ∈ A} (ρ_{m,f} − 1) s_{m,f} / M²
//! s_{m,f} = Σ_t |p_t − p̂_{m,t}|² / T
//! ```
//!
//! | symbol     | meaning                                                                   | unit |
//! | ---------- | ------------------------------------------------------------------------- | ---- |
//! | A          | a candidate: one model, or M whose predictions are averaged               | –    |
//! | f          | fold, of T targets                                                        | –    |
//! | p, p̂_m     | measured outputs, and as model m predicts them                            | SI   |
//! | ρ_{m,f}    | what its epoch gained by being chosen on the fold ([`super::optimism`])   | –    |
//!
//! The second sum is what a choice of epochs flatters. Of one model it is (ρ − 1) s. The chosen epoch and factor are those of the
//! least error, so another choice moves the prediction across that error and not along it: what that adds to the squared error of
//! an average is its own square, by the weight squared.
//!
//! Simple is what has few fitted numbers beyond the nominal model: none of itself, the values of the effects of the loop's
//! model, coefficients, leaves, weights; of an average, the sum.

use serde::{Deserialize, Serialize};

use crate::schedule::study::fold_errors::FoldErrors;

/// Predictions of one model on every fold.
#[derive(Debug, Clone)]
pub struct Single {
    /// Name in tables.
    pub name: String,
    /// Fitted numbers beyond the nominal model.
    pub numbers: usize,
    /// Whether it can run on a robot: outside baselines cannot.
    pub streams: bool,
    /// Predicted outputs of each fold, target by target [T·O].
    pub predicted: Vec<Vec<f64>>,
    /// Optimism ρ of each fold.
    pub optimism: Vec<f64>,
}

/// Measured outputs of each fold, target by target.
#[derive(Debug, Clone)]
pub struct Measured {
    /// Number of outputs O.
    pub outputs: usize,
    /// Trial of each target of each fold.
    pub trials: Vec<Vec<String>>,
    /// Measured values [T·O] of each fold.
    pub values: Vec<Vec<f64>>,
}

/// One model, or several that are averaged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Names of its models, in the order in which they were taken.
    pub members: Vec<String>,
    /// Fitted numbers beyond the nominal model.
    pub numbers: usize,
    /// Whether all its models can run on a robot.
    pub streams: bool,
    /// Error of each fold, SI.
    pub errors: FoldErrors,
    /// Mean error over folds, SI.
    pub mean: f64,
    /// Excess error over the best candidate: mean over folds, SI.
    pub more: f64,
    /// Standard error of that; none of a single fold.
    pub standard_error: Option<f64>,
    /// Whether it may be chosen and its error equals that of the best that may: within one standard error, or
    /// [`NEGLIGIBLE`].
    pub as_good: bool,
    /// Whether it is the one to be used.
    pub chosen: bool,
}

impl Candidate {
    /// Returns the candidate from singles by their indices; [`choose`] fills in the comparison with others.
    pub fn of(places: &[usize], singles: &[Single], measured: &Measured) -> Self {
        Self {
            streams: places.iter().all(|&place| singles[place].streams),
            ..Self::new(
                places.iter().map(|&place| singles[place].name.clone()).collect(),
                places.iter().map(|&place| singles[place].numbers).sum(),
                errors(places, singles, measured),
            )
        }
    }

    /// Returns a candidate that cannot run on a robot, from its errors; [`choose`] fills in the comparison with others.
    pub fn new(members: Vec<String>, numbers: usize, errors: FoldErrors) -> Self {
        Self {
            members,
            numbers,
            streams: false,
            mean: errors.mean(),
            errors,
            more: 0.0,
            standard_error: None,
            as_good: false,
            chosen: false,
        }
    }

    /// Returns whether it was chosen, or is as good, in words.
    pub fn mark(&self) -> &'static str {
        match (self.chosen, self.as_good) {
            (true, _) => "chosen",
            (false, true) => "as good",
            (false, false) => "",
        }
    }

    /// Returns the name in tables.
    pub fn name(&self) -> String {
        match self.members.as_slice() {
            [one] => one.clone(),
            all => format!("mean of {}", all.join(", ")),
        }
    }
}

/// Returns the mean prediction of some singles on a fold [T·O].
pub fn mean(places: &[usize], singles: &[Single], fold: usize) -> Vec<f64> {
    let all = |i: usize| places.iter().map(|&place| singles[place].predicted[fold][i]).sum::<f64>();
    (0..singles[places[0]].predicted[fold].len()).map(|i| all(i) / places.len() as f64).collect()
}

/// Returns the error of each fold of the mean of some singles.
pub fn errors(places: &[usize], singles: &[Single], measured: &Measured) -> FoldErrors {
    let of_fold = |(f, truth): (usize, &Vec<f64>)| {
        let count = places.len() as f64;
        let mean = mean(places, singles, f);
        let square = |of: &dyn Fn(usize) -> f64| {
            let squares = truth.iter().enumerate().map(|(i, p)| (p - of(i)) * (p - of(i)));
            squares.sum::<f64>() / (truth.len() / measured.outputs) as f64
        };
        let flattered = |place: usize| {
            let single = &singles[place];
            (single.optimism[f] - 1.0) * square(&|i| single.predicted[f][i])
        };
        let flattery: f64 = places.iter().map(|&place| flattered(place)).sum();
        (square(&|i| mean[i]) + flattery / (count * count)).sqrt()
    };
    FoldErrors(measured.values.iter().enumerate().map(of_fold).collect())
}

/// Returns the candidate that was chosen.
pub fn chosen(candidates: &[Candidate]) -> &Candidate {
    candidates.iter().find(|candidate| candidate.chosen).unwrap_or(&candidates[0])
}

/// Returns the candidate that errs least, of those that might be chosen.
pub fn least(candidates: &[Candidate]) -> &Candidate {
    let good = candidates.iter().filter(|candidate| candidate.as_good);
    good.fold(chosen(candidates), |best, one| if one.mean < best.mean { one } else { best })
}

/// Share of the best error below which a difference justifies no fitted number. A few folds may agree on a gain by
/// chance, and a network may cost 1 % where there is nothing to learn.
const NEGLIGIBLE: f64 = 0.01;

/// Compares all candidates with the best, and returns the index of the one to be used: of those within one standard
/// error of it, or [`NEGLIGIBLE`], the one with the fewest fitted numbers, of several the one with the smallest error.
/// For a `robot`, both are among those that can run there.
pub fn choose(candidates: &mut [Candidate], robot: bool) -> usize {
    let may = |candidate: &Candidate| candidate.streams || !robot;
    let least = candidates.iter().filter(|one| may(one)).min_by(|a, b| a.mean.total_cmp(&b.mean));
    let Some((best, error)) = least.map(|best| (best.errors.clone(), best.mean)) else { return 0 };
    for candidate in candidates.iter_mut() {
        (candidate.more, candidate.standard_error) = candidate.errors.more_than(&best);
        let negligible = candidate.mean <= (1.0 + NEGLIGIBLE) * error;
        candidate.as_good = may(candidate) && (negligible || candidate.errors.as_good_as(&best));
    }
    let good = candidates.iter().enumerate().filter(|(_, candidate)| candidate.as_good);
    let simplest = good.min_by(|(_, a), (_, b)| a.numbers.cmp(&b.numbers).then(a.mean.total_cmp(&b.mean)));
    let place = simplest.map_or(0, |(place, _)| place);
    candidates[place].chosen = true;
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns predictions with one target of one output a fold.
    fn single(name: &str, numbers: usize, predicted: &[f64]) -> Single {
        let predicted: Vec<Vec<f64>> = predicted.iter().map(|value| vec![*value]).collect();
        Single { name: name.into(), numbers, streams: name != "c", optimism: vec![1.0; predicted.len()], predicted }
    }

    fn zero(folds: usize) -> Measured {
        Measured { outputs: 1, trials: vec![], values: vec![vec![0.0]; folds] }
    }

    /// Oracle: by hand. Two targets of two outputs: squared distances of the mean are 1 + 0 and 0 + 4, over two targets 2.5; the
    /// second alone has 4/2, of which its choice of epochs hides twice as much, a quarter of it in the mean.
    #[test]
    fn an_error_of_an_average_by_hand() {
        let measured = Measured { outputs: 2, trials: vec![], values: vec![vec![1.0, 0.0, 0.0, 3.0]] };
        let one = |predicted: [f64; 4], optimism: f64| Single {
            name: String::new(),
            numbers: 3,
            streams: true,
            predicted: vec![predicted.to_vec()],
            optimism: vec![optimism],
        };
        let singles = [one([2.0, 1.0, -1.0, 0.0], 1.0), one([2.0, -1.0, 1.0, 2.0], 3.0)];
        let both = Candidate::of(&[0, 1], &singles, &measured);
        assert_eq!((both.errors.0[0], both.numbers), (3.5_f64.sqrt(), 6));
        assert_eq!(Candidate::of(&[1], &singles, &measured).errors.0[0], 6.0_f64.sqrt());
    }

    /// Oracle: by hand, as of [`FoldErrors`]: differences 0, 0, 1.5 have mean 0.5 and standard error 0.5; 1, 2, 3 have mean 2 and
    /// standard error 0.58.
    #[test]
    fn the_simplest_within_one_standard_error_is_chosen() {
        let singles = [
            single("simple and bad", 0, &[2.0, 3.0, 4.0]),
            single("simple", 5, &[1.0, 1.0, 2.5]),
            single("best", 9, &[1.0, 1.0, 1.0]),
        ];
        let mut all: Vec<Candidate> = (0..3).map(|place| Candidate::of(&[place], &singles, &zero(3))).collect();
        assert_eq!(choose(&mut all, false), 1);
        assert_eq!(
            all.iter().map(|one| (one.as_good, one.chosen)).collect::<Vec<_>>(),
            [(false, false), (true, true), (true, false)]
        );
        assert_eq!((all[0].more, all[2].more), (2.0, 0.0));
    }

    /// What has no form on a robot is not chosen for one, and nothing is measured by it.
    #[test]
    fn for_a_robot_only_what_has_a_form_there_is_chosen() {
        let singles = [single("a", 2, &[3.0, 3.1]), single("b", 5, &[2.0, 2.3]), single("c", 1, &[1.0, 1.0])];
        let all = || (0..3).map(|place| Candidate::of(&[place], &singles, &zero(2))).collect::<Vec<_>>();
        let (mut any, mut robot) = (all(), all());
        assert_eq!((choose(&mut any, false), choose(&mut robot, true)), (2, 1));
        assert_eq!((robot[1].more, robot[2].as_good), (0.0, false));
    }

    /// One fold has no standard error: the best is chosen, of equals the simplest.
    #[test]
    fn one_fold_chooses_the_best() {
        let singles = [single("a", 7, &[1.0]), single("b", 2, &[1.0]), single("c", 0, &[1.1])];
        let mut all: Vec<Candidate> = (0..3).map(|place| Candidate::of(&[place], &singles, &zero(1))).collect();
        assert_eq!(choose(&mut all, false), 1);
        assert_eq!(choose(&mut [], false), 0);
    }
}
