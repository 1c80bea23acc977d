//! A trial with the predictions of the nominal model.

use acm_datasets::Trial;
use nalgebra::DMatrix;

/// One trial with the predictions of the nominal model, [T×O].
pub struct Described<'a> {
    pub(super) trial: &'a Trial,
    pub(super) measured: DMatrix<f64>,
    pub(super) nominal: DMatrix<f64>,
    pub(super) residual: DMatrix<f64>,
}
