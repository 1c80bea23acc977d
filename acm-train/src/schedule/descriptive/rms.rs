//! Root mean squares of errors, by component and in total.
//!
//! ```text
//! RMS_o = √( Σ_t e_{t,o}² / T )          RMS = √( Σ_t ‖e_t‖² / T ) = √( Σ_o RMS_o² )
//! ```
//!
//! | symbol | meaning                          | shape | unit            |
//! | `e`    | error or residual of each sample | T × O | SI (m for a tip) |

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

/// Root mean squares over some samples.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rms {
    /// Number of samples.
    pub samples: usize,
    /// RMS of each output.
    pub components: Vec<f64>,
    /// RMS of the distance.
    pub total: f64,
}

impl Rms {
    /// Returns the RMS over the rows of `error` [T×O]; zeros where there are none.
    pub fn of(error: &DMatrix<f64>) -> Self {
        let samples = error.nrows();
        let n = samples.max(1) as f64;
        let squares: Vec<f64> = error.column_iter().map(|column| column.norm_squared() / n).collect();
        let components = squares.iter().map(|square| square.sqrt()).collect();
        Self { samples, components, total: squares.iter().sum::<f64>().sqrt() }
    }

    /// Returns the RMS over several tables together.
    pub fn of_all<'a>(errors: impl IntoIterator<Item = &'a DMatrix<f64>>) -> Self {
        Self::of(&stacked(errors))
    }
}

/// Stacks tables of equal width on top of each other.
pub fn stacked<'a>(tables: impl IntoIterator<Item = &'a DMatrix<f64>>) -> DMatrix<f64> {
    let tables: Vec<&DMatrix<f64>> = tables.into_iter().collect();
    let columns = tables.first().map_or(0, |table| table.ncols());
    let mut all = DMatrix::zeros(tables.iter().map(|table| table.nrows()).sum(), columns);
    let mut start = 0;
    for table in tables {
        all.rows_mut(start, table.nrows()).copy_from(table);
        start += table.nrows();
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: hand arithmetic; (3, 4) and (0, 0) have mean squares 9/2 and 16/2.
    #[test]
    fn two_samples_by_hand() {
        let rms = Rms::of(&DMatrix::from_row_slice(2, 2, &[3.0, -4.0, 0.0, 0.0]));
        assert_eq!((rms.samples, rms.components[0]), (2, 4.5_f64.sqrt()));
        assert!((rms.components[1] - 8.0_f64.sqrt()).abs() < 1e-15 && (rms.total - 12.5_f64.sqrt()).abs() < 1e-15);
    }

    /// Trials of different length weigh by their samples.
    #[test]
    fn pooling_is_over_samples_and_not_over_tables() {
        let (one, three) = (DMatrix::from_element(1, 1, 2.0), DMatrix::from_element(3, 1, 0.0));
        assert_eq!(Rms::of_all([&one, &three]).total, 1.0);
        assert_eq!(Rms::of(&DMatrix::zeros(0, 3)).total, 0.0);
    }
}
