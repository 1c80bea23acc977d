//! Choice of inputs: backward elimination over groups, a signal with its rates, and the one-standard-error rule.
//!
//! ```text
//! S₀ = all inputs         S_{k+1} = S_k without the group whose absence errs least         until one group is left
//! d_f = e_f(S) − e_f(best)        S is as good as the best:  mean(d) ≤ sd(d)/√K
//! ```
//!
//! | symbol | meaning                                                    |
//! | ------ | ---------------------------------------------------------- |
//! | e_f    | error on fold f, mean over seeds, in the unit of the output |
//! | K      | number of folds                                            |
//! | best   | the set with the smallest mean error of all that were tried |
//!
//! Of the sets as good as the best the one with the fewest inputs is chosen, of several the one that errs least. It ends before where no
//! set of a step is as good as the best so far. The differences are of pairs that share trials: how much harder one fold
//! is than another falls out of them. Breiman et al. (1984), §3.4.3, for trees.

use super::fold_errors::FoldErrors;

/// A set of inputs that was tried, in the order of the experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// Names of the inputs.
    pub inputs: Vec<String>,
    /// Error of each fold.
    pub errors: FoldErrors,
}

impl Tried {
    /// Returns the mean error; see [`FoldErrors::mean`].
    pub fn mean(&self) -> f64 {
        self.errors.mean()
    }

    /// Returns the excess error; see [`FoldErrors::more_than`].
    pub fn more_than(&self, other: &Self) -> (f64, Option<f64>) {
        self.errors.more_than(&other.errors)
    }

    /// Returns whether the errors are equal; see [`FoldErrors::as_good_as`].
    pub fn as_good_as(&self, other: &Self) -> bool {
        self.errors.as_good_as(&other.errors)
    }
}

/// Returns the signal that an input is of: `q1` of `rate(q1)`.
fn signal(input: &str) -> &str {
    input.strip_prefix("rate(").and_then(|inner| inner.strip_suffix(')')).unwrap_or(input).trim()
}

/// Returns the signals in the order in which they come first.
pub fn groups(inputs: &[String]) -> Vec<&str> {
    let mut groups = vec![];
    for signal in inputs.iter().map(|input| signal(input)) {
        if !groups.contains(&signal) {
            groups.push(signal);
        }
    }
    groups
}

/// Returns the inputs without a group.
fn without(inputs: &[String], group: &str) -> Vec<String> {
    inputs.iter().filter(|input| signal(input) != group).cloned().collect()
}

/// Returns the sets of the next step; none at the end. `tried` is all inputs, then the sets of each step before.
pub fn next(tried: &[Tried]) -> Vec<Vec<String>> {
    let Some(all) = tried.first() else { return vec![] };
    let (mut kept, mut done) = (all, 1);
    loop {
        let groups = groups(&kept.inputs);
        if groups.len() == 1 {
            return vec![];
        }
        let step = &tried[done..(done + groups.len()).min(tried.len())];
        if step.len() < groups.len() {
            return groups[step.len()..].iter().map(|group| without(&kept.inputs, group)).collect();
        }
        done += step.len();
        let best = least(&tried[..done]);
        kept = least(step);
        if !step.iter().any(|set| set.as_good_as(best)) {
            return vec![];
        }
    }
}

/// Returns the index of the chosen set; `tried` is not empty.
pub fn chosen(tried: &[Tried]) -> usize {
    let best = least(tried);
    let good = (0..tried.len()).filter(|&place| tried[place].as_good_as(best));
    let size = |place: &usize| tried[*place].inputs.len();
    let least = good.min_by(|a, b| size(a).cmp(&size(b)).then(tried[*a].mean().total_cmp(&tried[*b].mean())));
    least.unwrap_or(0)
}

fn least(tried: &[Tried]) -> &Tried {
    let first = &tried[0];
    tried.iter().fold(first, |best, set| if set.mean() < best.mean() { set } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tried(inputs: &[&str], errors: &[f64]) -> Tried {
        Tried { inputs: inputs.iter().map(ToString::to_string).collect(), errors: FoldErrors(errors.to_vec()) }
    }

    /// Returns the errors of each set from what each group is worth, on three folds that differ in difficulty.
    fn eliminate(inputs: &[&str], worth: impl Fn(&[String], usize) -> f64) -> Vec<Tried> {
        let errors = |inputs: &[String]| FoldErrors((0..3).map(|fold| worth(inputs, fold)).collect());
        let set = |inputs: Vec<String>| Tried { errors: errors(&inputs), inputs };
        let mut tried = vec![set(inputs.iter().map(ToString::to_string).collect())];
        loop {
            let next = next(&tried);
            if next.is_empty() {
                return tried;
            }
            tried.extend(next.into_iter().map(&set));
        }
    }

    #[test]
    fn a_signal_goes_with_its_rates() {
        let inputs = ["q1", "altitude", "rate(q1)", "rate(q2)"].map(String::from);
        assert_eq!(groups(&inputs), ["q1", "altitude", "q2"]);
        assert_eq!(without(&inputs, "q1"), ["altitude", "rate(q2)"]);
    }

    /// Planted: the name of the trial harms by 4, the useful input is worth 5 and another 3, the idle one nothing; folds have
    /// errors from 10 to 30.
    #[test]
    fn what_harms_and_what_is_idle_goes_and_what_is_useful_stays() {
        let worth = |inputs: &[String], fold: usize| {
            let has = |name: &str| f64::from(u8::from(inputs.iter().any(|input| input == name)));
            let wobble = 0.1 * ((inputs.len() + fold) % 2) as f64;
            10.0 * (fold + 1) as f64 + 4.0 * has("name") - 5.0 * has("q") - 3.0 * has("wind") + wobble
        };
        let tried = eliminate(&["q", "rate(q)", "name", "idle", "wind"], worth);
        assert_eq!(tried[chosen(&tried)].inputs, ["q", "rate(q)", "wind"]);
        assert_eq!(tried.len(), 1 + 4 + 3 + 2, "no set of two groups or fewer is as good, and it ends there");
    }

    /// Oracle: by hand. d = 0, 1, 2 has mean 1 and sd 1: one standard error is 1/√3 = 0.58; d = 0, 0, 1.5 has mean 0.5 and
    /// sd 0.87, one standard error of 0.5.
    #[test]
    fn the_smallest_set_within_one_standard_error_of_the_best_is_chosen() {
        let best = tried(&["a", "b", "c"], &[1.0, 1.0, 1.0]);
        let worse = tried(&["a"], &[1.0, 2.0, 3.0]);
        let equal = tried(&["a", "b"], &[1.0, 1.0, 2.5]);
        assert_eq!(worse.more_than(&best).0, 1.0);
        assert!((worse.more_than(&best).1.unwrap() - 3f64.sqrt().recip()).abs() < 1e-15);
        assert!(equal.as_good_as(&best) && !worse.as_good_as(&best) && best.as_good_as(&best));
        assert_eq!(chosen(&[best.clone(), equal, worse.clone()]), 1);
        assert_eq!(chosen(&[best, worse]), 0);
    }

    #[test]
    fn one_group_is_left_at_least_and_one_fold_has_no_standard_error() {
        assert!(next(&[tried(&["q", "rate(q)"], &[1.0, 2.0])]).is_empty());
        assert!(next(&[]).is_empty());
        let one = [tried(&["a", "b"], &[1.0]), tried(&["b"], &[1.0]), tried(&["a"], &[1.1])];
        assert_eq!(chosen(&one), 1);
    }
}
