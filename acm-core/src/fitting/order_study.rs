//! Order study: number of Legendre orders that the curvature of an arm needs.
//!
//! The record of one actuator sweep is averaged in bins of the actuator that sweeps, and the model is fitted
//! to the bins with the strain orders asked for, under two protocols:
//!
//! - frozen: Φ and registration from the linear fit, θ_s alone refitted for each order;
//! - refitted: Φ and θ_s together, registration from the linear fit.
//!
//! The error is the root mean square distance in the plane of x and z, m.

use nalgebra::DMatrix;

use crate::arm::ArmSpec;
use crate::fitting::calibration::fit_some;
use crate::fitting::levenberg_marquardt::Options;
use crate::fitting::multi_start::{multi_start, scattered_starts};
use crate::fitting::observations::{CalibrationError, Observations};
use crate::fitting::strain_fit::StrainFit;
use crate::fitting::strain_start;
use crate::kinematics::strain::StrainBasis;
use crate::tip_model::StrainModel;

/// Samples that a bin needs.
const LEAST_IN_BIN: usize = 3;

/// Starts of each refitted fit.
const STARTS: usize = 6;

/// One order and its two errors.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct OrderRow {
    /// Highest Legendre order.
    pub order: usize,
    /// x–z error with the actuation map of the linear fit, m.
    pub frozen_rmse: f64,
    /// x–z error with the actuation map refitted, m.
    pub refitted_rmse: f64,
}

/// The models of one order.
#[derive(Debug, Clone)]
pub struct OrderFit {
    /// Highest Legendre order.
    pub order: usize,
    /// Model with the actuation map of the linear fit.
    pub frozen: StrainModel,
    /// Model with a refitted actuation map.
    pub refitted: StrainModel,
}

/// The bins, and what was fitted to them.
#[derive(Debug, Clone)]
pub struct OrderFits {
    /// Means of actuators and markers, one row per bin with enough samples.
    pub binned: Observations,
    /// Samples in each of these bins.
    pub samples: Vec<usize>,
    /// One entry per order asked for.
    pub fits: Vec<OrderFit>,
}

/// Both protocols for each of `orders`, on `data` averaged in `bins` bins of the first actuator.
///
/// # Errors
/// As [`order_fits`].
pub fn order_study(
    data: &Observations,
    arm: &ArmSpec,
    orders: &[usize],
    bins: usize,
) -> Result<Vec<OrderRow>, CalibrationError> {
    let OrderFits { binned, fits, .. } = order_fits(data, arm, orders, bins, 0)?;
    let row = |fit: &OrderFit| OrderRow {
        order: fit.order,
        frozen_rmse: planar_rmse(&fit.frozen, &binned),
        refitted_rmse: planar_rmse(&fit.refitted, &binned),
    };
    Ok(fits.iter().map(row).collect())
}

/// The models behind [`order_study`], on `data` averaged in `bins` bins of the actuator `swept`.
///
/// # Errors
/// The data or the arm are refused, or too few bins have enough samples.
///
/// # Panics
/// If there is no actuator `swept`.
pub fn order_fits(
    data: &Observations,
    arm: &ArmSpec,
    orders: &[usize],
    bins: usize,
    swept: usize,
) -> Result<OrderFits, CalibrationError> {
    data.validate()?;
    data.validate_markers()?;
    let (binned, samples) = binned(data, bins, swept)?;
    let linear = fitted(&arm_of_order(arm, 1), &binned, None)?;
    let fit = |&order: &usize| {
        let arm = arm_of_order(arm, order);
        let (frozen, refitted) = (frozen(&arm, &linear, &binned)?, fitted(&arm, &binned, Some(&linear))?);
        Ok(OrderFit { order, frozen, refitted })
    };
    let fits = orders.iter().map(fit).collect::<Result<_, CalibrationError>>()?;
    Ok(OrderFits { binned, samples, fits })
}

fn arm_of_order(arm: &ArmSpec, order: usize) -> ArmSpec {
    ArmSpec { strain: StrainBasis::Legendre { order }, ..arm.clone() }
}

/// Means of actuators and markers in bins of equal width, and the samples in each.
fn binned(data: &Observations, bins: usize, swept: usize) -> Result<(Observations, Vec<usize>), CalibrationError> {
    let swept = data.actuators.column(swept);
    let (low, width) = (swept.min(), (swept.max() - swept.min()) / bins as f64);
    let mut members = vec![Vec::new(); bins];
    for (sample, q) in swept.iter().enumerate() {
        let bin = ((q - low) / width) as usize;
        if let Some(bin) = members.get_mut(bin.min(bins.saturating_sub(1))) {
            bin.push(sample);
        }
    }
    members.retain(|bin| bin.len() >= LEAST_IN_BIN);
    let needed = 8;
    if members.len() < needed {
        let bins = members.len();
        return Err(CalibrationError::Bins { bins, needed });
    }
    let means = |table: &DMatrix<f64>| {
        let rows: Vec<_> = members.iter().map(|bin| table.select_rows(bin).row_mean()).collect();
        DMatrix::from_rows(&rows)
    };
    let samples = members.iter().map(Vec::len).collect();
    let binned =
        Observations { actuators: means(&data.actuators), measured: means(&data.measured), at: data.at.clone() };
    Ok((binned, samples))
}

/// Φ and θ_s fitted from several starts; registration too where `known` does not give it.
fn fitted(arm: &ArmSpec, data: &Observations, known: Option<&StrainModel>) -> Result<StrainModel, CalibrationError> {
    let model = StrainModel::new(arm, data.actuators.ncols(), &data.at)?;
    let mut model = strain_start::start(model, data);
    let registration = model.registration_range();
    let mut free: Vec<usize> = (0..registration.start).collect();
    match known {
        Some(known) => model = with_registration(model, known),
        None => {
            let flags = arm.registration.identified();
            free.extend(registration.clone().filter(|j| flags[j - registration.start]));
        }
    }
    let problem = StrainFit::new(&model, free.clone(), data);
    let strain = model.strain_range();
    let spread: Vec<f64> = free.iter().map(|j| if strain.contains(j) { 1.5 } else { 0.0 }).collect();
    let count = if strain.is_empty() { 1 } else { STARTS };
    let starts = scattered_starts(&problem.start(), &spread, count, 1);
    let best = multi_start(&problem, &starts, &problem.bounds(), &Options::default());
    let theta = best.map(|fit| problem.all(&fit.theta));
    Ok(match theta {
        Some(theta) => model.with_parameters(&theta),
        None => model,
    })
}

/// θ_s fitted with everything else from the linear fit.
fn frozen(arm: &ArmSpec, linear: &StrainModel, data: &Observations) -> Result<StrainModel, CalibrationError> {
    let model = StrainModel::new(arm, data.actuators.ncols(), &data.at)?;
    let mut theta = model.parameters().to_vec();
    theta[model.actuation_range()].copy_from_slice(&linear.parameters()[linear.actuation_range()]);
    let strain = model.strain_range();
    for i in 0..2 {
        // The linear fit's a_i is the first coefficient of direction i; higher ones start at zero.
        if let Some(a) = theta[strain.clone()].get_mut(i * strain.len() / 2) {
            *a = linear.parameters()[linear.strain_range().start + i];
        }
    }
    let model = with_registration(model.with_parameters(&theta), linear);
    let free = strain.collect();
    Ok(fit_some(model, free, data, &Options::default()).0)
}

fn with_registration(model: StrainModel, known: &StrainModel) -> StrainModel {
    let mut theta = model.parameters().to_vec();
    theta[model.registration_range()].copy_from_slice(&known.parameters()[known.registration_range()]);
    model.with_parameters(&theta)
}

/// Root mean square distance in x and z over all markers and bins, m.
fn planar_rmse(model: &StrainModel, data: &Observations) -> f64 {
    let nominal = crate::nominal::NominalModel::Strain(model.clone());
    let error = nominal.predict(&data.actuators) - &data.measured;
    let planar = error.column_iter().enumerate().filter(|(o, _)| o % 3 != 1);
    let squares: f64 = planar.map(|(_, column)| column.norm_squared()).sum();
    (squares / (data.samples() * data.at.len()) as f64).sqrt()
}
