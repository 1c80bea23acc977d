//! Which trials validate in each fold of a cross-validation.
//!
//! The manifest's `[folds]` where it has one. Otherwise the development trials, in their natural order: up to
//! [`LEAVE_ONE_OUT`] of them validate one at a time; of more, trial `i` validates in fold `i mod 5`.

use crate::manifest::Manifest;

/// Up to so many development trials, each is a fold of its own; beyond, there are so many folds.
pub const LEAVE_ONE_OUT: usize = 5;

/// Validation trials of each fold; `development` in natural order.
pub fn folds(manifest: &Manifest, development: &[&str]) -> Vec<Vec<String>> {
    if !manifest.folds.validation.is_empty() {
        return manifest.folds.validation.clone();
    }
    let count = development.len().min(LEAVE_ONE_OUT);
    let mut folds = vec![Vec::new(); count];
    for (i, name) in development.iter().enumerate() {
        folds[i % count].push(name.to_string());
    }
    folds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifest::FoldTable;

    #[test]
    fn a_few_trials_are_left_out_one_by_one_and_more_are_dealt_out() {
        let manifest = Manifest::default();
        assert_eq!(folds(&manifest, &["1", "2", "3"]), [["1"], ["2"], ["3"]]);
        let names = ["1", "2", "3", "4", "5", "6", "7"];
        assert_eq!(folds(&manifest, &names), [vec!["1", "6"], vec!["2", "7"], vec!["3"], vec!["4"], vec!["5"]]);
        assert!(folds(&manifest, &[]).is_empty());
    }

    #[test]
    fn the_manifest_goes_first() {
        let validation = vec![vec!["b".to_string()]];
        let manifest = Manifest { folds: FoldTable { validation: validation.clone() }, ..Manifest::default() };
        assert_eq!(folds(&manifest, &["a", "b"]), validation);
    }
}
