//! Blocks of rows: units of the resampling, and the folds that are left out together.
//!
//! Three trials or more are left out whole, in at most eight folds. One or two records are cut into 24 regions of time,
//! left out in five interleaved folds. Chu & Marron (1991), Annals of Statistics 19(4).

use std::ops::Range;

/// Fewest trials that are left out whole.
const TRIALS: usize = 3;

/// Smallest number of blocks that trials are cut into, in all.
const BLOCKS: usize = 12;

/// Number of regions of one or two records.
const REGIONS: usize = 24;

/// Number of folds of trials, and of regions.
const FOLDS: (usize, usize) = (8, 5);

/// Blocks of rows, with their folds; see the head of this file.
#[derive(Debug, Clone)]
pub struct Blocks {
    /// Rows of each block, one after the other.
    pub rows: Vec<Range<usize>>,
    /// Trial of each block.
    pub trial: Vec<usize>,
    /// Fold of each block.
    pub fold: Vec<usize>,
    /// Number of folds.
    pub folds: usize,
    /// Whether folds are whole trials.
    pub by_trial: bool,
}

impl Blocks {
    /// Cuts trials with the given numbers of rows into blocks.
    pub fn new(rows: &[usize]) -> Self {
        let trials = rows.len();
        let by_trial = trials >= TRIALS;
        let each = if by_trial { BLOCKS } else { REGIONS }.div_ceil(trials.max(1)).max(1);
        let (mut blocks, mut trial, mut fold, mut first) = (vec![], vec![], vec![], 0);
        for (s, &count) in rows.iter().enumerate() {
            let parts = each.min(count.max(1));
            for k in 0..parts {
                blocks.push(first + k * count / parts..first + (k + 1) * count / parts);
                trial.push(s);
                fold.push(if by_trial { s % FOLDS.0 } else { (fold.len()) % FOLDS.1 });
            }
            first += count;
        }
        let folds = fold.iter().max().map_or(0, |last| last + 1);
        Self { rows: blocks, trial, fold, folds, by_trial }
    }

    /// Returns the rows of each block of a fold.
    pub fn rows_of(&self, fold: usize) -> Vec<Range<usize>> {
        (0..self.len()).filter(|&b| self.fold[b] == fold).map(|b| self.rows[b].clone()).collect()
    }

    /// Returns the number of blocks.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns whether there are no blocks.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Returns all rows as one block.
    pub fn whole(rows: usize) -> Self {
        Self { rows: vec![0..rows], trial: vec![0], fold: vec![0], folds: 1, by_trial: true }
    }

    /// Returns the blocks with a fold for each.
    #[must_use]
    pub fn each_alone(&self) -> Self {
        Self { fold: (0..self.len()).collect(), folds: self.len(), ..self.clone() }
    }

    /// Returns the blocks where every row becomes `width` rows: outputs are stacked.
    #[must_use]
    pub fn stacked(&self, width: usize) -> Self {
        let rows = self.rows.iter().map(|rows| rows.start * width..rows.end * width).collect();
        Self { rows, ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trials_are_left_out_whole_and_records_in_regions() {
        let trials = Blocks::new(&[100, 90, 110, 100]);
        assert_eq!((trials.len(), trials.folds, trials.by_trial), (12, 4, true));
        assert_eq!(trials.fold, [0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3]);
        assert_eq!(trials.trial, trials.fold);
        assert_eq!(trials.rows[3], 100..130);
        let record = Blocks::new(&[480]);
        assert_eq!((record.len(), record.folds, record.rows[1].clone()), (24, 5, 20..40));
        assert_eq!(record.stacked(3).rows[1], 60..120);
    }
}
