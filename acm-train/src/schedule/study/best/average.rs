//! Averages of models, by greedy forward selection.
//!
//! Begins with the model that errs least under the folds, and takes in the model with which the mean errs least, as long as
//! that is less than before. No model twice, and M at most. Caruana et al. (2004), ICML, without repetition.

use serde::{Deserialize, Serialize};

use super::candidate::{Measured, Single, errors};

/// A step: what was taken before, and what each further model would have made of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Names of the models taken before.
    pub taken: Vec<String>,
    /// Candidates for the next model, with the mean error over folds of the average with it, SI.
    pub tried: Vec<(String, f64)>,
    /// The one that was taken; none at the end.
    pub took: Option<String>,
}

/// Returns the indices of the models of each average of two or more that was kept, and the steps to them; for a
/// `robot`, of those that can run there.
pub fn grow(singles: &[Single], measured: &Measured, most: usize, robot: bool) -> (Vec<Vec<usize>>, Vec<Step>) {
    let error = |places: &[usize]| errors(places, singles, measured).mean();
    let least = |tried: &[(usize, f64)]| tried.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
    let may: Vec<usize> = (0..singles.len()).filter(|&place| singles[place].streams || !robot).collect();
    let alone: Vec<(usize, f64)> = may.iter().map(|&place| (place, error(&[place]))).collect();
    let (mut kept, mut steps) = (vec![], vec![]);
    let Some((first, mut before)) = least(&alone) else { return (kept, steps) };
    let mut taken = vec![first];
    while taken.len() < most {
        let others = may.iter().copied().filter(|place| !taken.contains(place));
        let tried: Vec<(usize, f64)> = others.map(|place| (place, error(&[&taken[..], &[place]].concat()))).collect();
        let found = least(&tried).filter(|(_, error)| *error < before);
        let name = |place: usize| singles[place].name.clone();
        steps.push(Step {
            taken: taken.iter().map(|&place| name(place)).collect(),
            tried: tried.iter().map(|&(place, error)| (name(place), error)).collect(),
            took: found.map(|(place, _)| name(place)),
        });
        let Some((place, error)) = found else { break };
        taken.push(place);
        before = error;
        kept.push(taken.clone());
    }
    (kept, steps)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn single(name: &str, predicted: [f64; 2]) -> Single {
        Single {
            name: name.into(),
            numbers: 1,
            streams: true,
            predicted: vec![predicted.to_vec()],
            optimism: vec![1.0],
        }
    }

    /// Oracle: by hand. The truth is (0, 0). b is nearest, a is off to the other side, so that a and b have a mean of (0.25, 0); c
    /// is off where nothing makes up for it.
    #[test]
    fn what_makes_up_for_each_other_is_averaged() {
        let singles = [single("a", [-1.5, 0.0]), single("b", [1.0, 0.0]), single("c", [3.0, 3.0])];
        let measured = Measured { outputs: 2, values: vec![vec![0.0, 0.0]] };
        let (kept, steps) = grow(&singles, &measured, 4, false);
        assert_eq!(kept, [vec![1, 0]]);
        assert_eq!(steps[0].taken, ["b"]);
        assert_eq!(steps[0].tried, [("a".to_string(), 0.25), ("c".to_string(), 6.25_f64.sqrt())]);
        assert_eq!((steps[0].took.as_deref(), steps[1].took.as_deref(), steps.len()), (Some("a"), None, 2));
        assert!(grow(&singles, &measured, 1, false).0.is_empty() && grow(&[], &measured, 4, false).1.is_empty());
    }
}
