//! Strain orders on one trial: fitted to bins, evaluated on bins and on samples, in the plane of the bending.
//!
//! ```text
//! RMSE = √( Σ_t (e_{t,u}² + e_{t,v}²) / T )       u, v: the two outputs that vary most in the trial
//! ```

use acm_core::{ArmSpec, NominalModel, StrainModel, calibration::order_fits};
use acm_datasets::{Campaign, Trial};
use nalgebra::DMatrix;

use super::record::{Fitted, NominalStudy, OrderRow, OrderStudy};
use crate::{
    run::RunError,
    schedule::{descriptive::rms::Rms, error::ScheduleError},
};

/// Fitted orders and their predictions; tables have the columns of the tip.
pub struct Orders {
    /// Study for the record.
    pub study: OrderStudy,
    /// Actuators of each bin, [B×A].
    pub actuators: DMatrix<f64>,
    /// Measured means, [B×O].
    pub measured: DMatrix<f64>,
    /// Samples in each bin.
    pub samples: Vec<usize>,
    /// Measured samples, [T×O].
    pub raw: DMatrix<f64>,
    /// Predictions, one per order.
    pub predicted: Vec<Predicted>,
}

/// Predictions of one order, [B×O] and [T×O].
pub struct Predicted {
    /// Legendre order.
    pub order: usize,
    /// Predictions with the actuation map of the linear fit: at the bins, and at the samples.
    pub frozen: [DMatrix<f64>; 2],
    /// Predictions with a refitted actuation map.
    pub refitted: [DMatrix<f64>; 2],
}

/// Fits and scores every requested order.
///
/// # Errors
/// The trial is too short, or no arm.
pub fn study(
    trial: &Trial,
    campaign: &Campaign,
    arm: &ArmSpec,
    record: &NominalStudy,
) -> Result<Orders, ScheduleError> {
    let asked = &record.asked;
    let refused = |source| RunError::Calibration { trials: trial.name.clone(), source };
    let data = campaign.observations(&[trial]);
    let fits = order_fits(&data, arm, &asked.orders, asked.bins, record.swept).map_err(refused)?;
    let tip = |table: &DMatrix<f64>| table.columns_range(campaign.tip_columns()).into_owned();
    let (measured, raw) = (tip(&fits.binned.measured), tip(&trial.measured));
    let plane = plane(&raw);
    let at = |model: &StrainModel| {
        let model = NominalModel::Strain(model.clone());
        [&fits.binned.actuators, &trial.actuators].map(|actuators| tip(&model.predict(actuators)))
    };
    let judged = |[binned, samples]: &[DMatrix<f64>; 2], parameters: usize| Fitted {
        parameters,
        binned: planar(&(binned - &measured), plane),
        raw: planar(&(samples - &raw), plane),
    };
    let (mut rows, mut predicted) = (vec![], vec![]);
    for fit in &fits.fits {
        let (frozen, refitted) = (at(&fit.frozen), at(&fit.refitted));
        let (strain, map) = (fit.frozen.strain_range().len(), fit.frozen.actuation_range().len());
        rows.push(OrderRow {
            order: fit.order,
            frozen: judged(&frozen, strain),
            refitted: judged(&refitted, map + strain),
        });
        predicted.push(Predicted { order: fit.order, frozen, refitted });
    }
    let study = OrderStudy {
        trial: trial.name.clone(),
        samples: trial.samples(),
        bins: measured.nrows(),
        plane: plane.map(|o| record.outputs[o].clone()),
        rows,
    };
    Ok(Orders { study, actuators: fits.binned.actuators, measured, samples: fits.samples, raw, predicted })
}

/// Returns the two columns with the largest variance, in their order.
fn plane(measured: &DMatrix<f64>) -> [usize; 2] {
    let mut columns: Vec<usize> = (0..measured.ncols()).collect();
    columns.sort_by(|&a, &b| measured.column(b).variance().total_cmp(&measured.column(a).variance()));
    let (first, second) = (columns[0], columns[1]);
    [first.min(second), first.max(second)]
}

fn planar(error: &DMatrix<f64>, plane: [usize; 2]) -> f64 {
    Rms::of(&error.select_columns(&plane)).total
}
