//! Averages of models, by greedy forward selection.
//!
//! Begins with the model that errs least under the folds, and takes in the model with which the mean errs least, as long as
//! that is less than before. No model twice, and M at most. Caruana et al. (2004), ICML, without repetition.

use serde::{Deserialize, Serialize};

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

/// Models that may be averaged, and the error of an average of some of them.
pub struct Pool<'a, E: Fn(&[usize]) -> f64> {
    /// Names of all models.
    pub names: &'a [String],
    /// Indices of those that may be averaged.
    pub may: &'a [usize],
    /// Error of the average of the models with these indices.
    pub error: E,
}

/// Returns the indices of the models of each average of two to `most` that was kept, and the steps to them.
pub fn grow<E: Fn(&[usize]) -> f64>(pool: &Pool<E>, most: usize) -> (Vec<Vec<usize>>, Vec<Step>) {
    let least = |tried: &[(usize, f64)]| tried.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1));
    let alone: Vec<(usize, f64)> = pool.may.iter().map(|&place| (place, (pool.error)(&[place]))).collect();
    let (mut kept, mut steps) = (vec![], vec![]);
    let Some((first, mut before)) = least(&alone) else { return (kept, steps) };
    let mut taken = vec![first];
    while taken.len() < most {
        let others = pool.may.iter().copied().filter(|place| !taken.contains(place));
        let with = |place: usize| (pool.error)(&[&taken[..], &[place]].concat());
        let tried: Vec<(usize, f64)> = others.map(|place| (place, with(place))).collect();
        let found = least(&tried).filter(|(_, error)| *error < before);
        let name = |place: usize| pool.names[place].clone();
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

    /// Oracle: by hand. The truth is (0, 0). b is nearest, a is off to the other side, so that a and b have a mean of (0.25, 0); c
    /// is off where nothing makes up for it.
    #[test]
    fn what_makes_up_for_each_other_is_averaged() {
        let said: [[f64; 2]; 3] = [[-1.5, 0.0], [1.0, 0.0], [3.0, 3.0]];
        let error = |places: &[usize]| {
            let mean = |o: usize| places.iter().map(|&place| said[place][o]).sum::<f64>() / places.len() as f64;
            mean(0).hypot(mean(1))
        };
        let names = ["a", "b", "c"].map(String::from);
        let pool = Pool { names: &names, may: &[0, 1, 2], error };
        let (kept, steps) = grow(&pool, 4);
        assert_eq!(kept, [vec![1, 0]]);
        assert_eq!(steps[0].taken, ["b"]);
        assert_eq!(steps[0].tried, [("a".to_string(), 0.25), ("c".to_string(), 6.25_f64.sqrt())]);
        assert_eq!((steps[0].took.as_deref(), steps[1].took.as_deref(), steps.len()), (Some("a"), None, 2));
        assert!(grow(&pool, 1).0.is_empty());
        assert!(grow(&Pool { may: &[], ..pool }, 4).1.is_empty());
    }
}
