//! Separability: effects that the given trials cannot distinguish, whatever the residual.
//!
//! ```text
//! imitated(a, b) = 1 − min_{θ_b, δ} ‖d_a − d_b(θ_b) − J δ‖² / ‖d_a‖²
//! ```
//!
//! | symbol | meaning                                                                     | shape | unit   |
//! | `d_a`  | change of the outputs by effect a, of one size for all effects              | NM    | weighted |
//! | `d_b`  | change by effect b                                                          | NM    | weighted |
//! | `J δ`  | change by recalibration, within the 99 % ellipsoid of the calibration       | NM    | weighted |
//!
//! The least squares are those of [`acm_core::levenberg_marquardt`], with δ projected out. Recorded outputs enter only through the
//! precision of the calibration; else the excitation alone decides. Not symmetric, since a richer effect imitates a poorer one. Two
//! effects are in one group where each imitates nine tenths of what recalibration leaves of the other.

mod anchor;
mod displacement;
mod groups;
mod imitation;
mod planted;
mod precision;
mod projected;
mod recalibration;
mod result;
mod start;
mod trials;

use acm_core::calibration::CalibrationError;
use acm_core::effects::instance::Instance;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::case::Case;
use crate::close::About;
use crate::finding::Data;
use crate::prepared::{self, Prepared};
use crate::series::Series;
use crate::trace::Options;
use imitation::Imitator;
use planted::Planted;
use precision::precision;
use recalibration::Recalibration;
pub use result::{Group, Separability};
use trials::Trials;

/// Size that every effect is given where outputs are lengths, m.
const SIZE: f64 = 0.01;

/// Size of every effect where outputs are no lengths, as a share of the spread of the outputs.
const SHARE: f64 = 0.1;

/// Most rows of the matrix.
const ROWS: usize = 40;

/// Longest time between samples where there are samples enough, s: a filter of the outputs is seen at this rate.
const STEP: f64 = 0.1;

/// Largest number of compared values: samples times outputs.
const NUMBERS: usize = 30_000;

/// Returns the share of each effect that the others could imitate, in the development trials of a case.
///
/// # Errors
/// A nominal model that cannot be calibrated.
pub fn separability(case: Case, about: About, options: &Options) -> Result<Separability, CalibrationError> {
    let options = thinned(&case, options);
    let prepared = prepared::prepare(case, &options)?;
    let calibration = Trials::new(&prepared, &prepared.calibration);
    let mut trials = Trials::new(&prepared, &prepared.development);
    if !calibration.all.is_empty() {
        trials.noise = calibration.noise;
    }
    let size = if prepared.is_length() { SIZE } else { SHARE * spread(&prepared) };
    let reported = prepared.case.reported.clone();
    let all = prepared.library.par_iter().map(|instance| Planted::new(&trials, instance, size, &reported)).collect();
    let (seen, unseen) = chosen(all);
    let matrix = Matrix::new(&trials, &precision(&calibration), &seen);
    let labels =
        |planted: &[Planted]| planted.iter().map(|one| label(&one.instance, &prepared)).collect::<Vec<String>>();
    let effects = labels(&seen);
    let groups = groups::groups(&effects, &matrix.imitated, &matrix.by_recalibration, &labels(&unseen));
    Ok(Separability {
        format: 2,
        size,
        unit: prepared.unit(),
        effects,
        imitated: matrix.imitated,
        by_recalibration: matrix.by_recalibration,
        groups,
        data: named(about.data, &prepared),
        version: about.version,
    })
}

/// Returns options with as many samples as the question needs.
fn thinned(case: &Case, options: &Options) -> Options {
    let total: usize = case.development.iter().map(|trial| trial.measured_rows().len()).sum();
    let numbers = total * case.rig.outputs.len().max(2);
    let fast = if case.rig.step > 0.0 { (STEP / case.rig.step * (1.0 + 1e-6)) as usize } else { 1 };
    let stride = fast.max(numbers.div_ceil(NUMBERS)).max(1);
    let samples = numbers.div_ceil(3 * stride).max(1);
    Options { samples, ..options.clone() }
}

/// Returns the root of the summed variances of the reported outputs, weighted.
fn spread(prepared: &Prepared) -> f64 {
    let width = prepared.weight.len();
    let of = |o: usize| {
        let column = |series: &Series| series.measured.iter().skip(o).step_by(width).copied().collect::<Vec<f64>>();
        let values: Vec<f64> = prepared.development.iter().flat_map(column).collect();
        let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
        let variance = values.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / values.len().max(1) as f64;
        variance * prepared.weight[o].powi(2)
    };
    prepared.case.reported.clone().map(of).sum::<f64>().sqrt()
}

/// Returns the effects that leave a trace, each in its strongest way first, and then others while there is room; and
/// those that leave none in any way.
fn chosen(all: Vec<Planted>) -> (Vec<Planted>, Vec<Planted>) {
    fn name(planted: &Planted) -> &str {
        planted.instance.effect().name()
    }
    let strength: Vec<f64> = all.iter().map(|planted| planted.strength).collect();
    let is_strongest = |k: usize| {
        let same = (0..all.len()).filter(|&other| name(&all[other]) == name(&all[k]));
        same.reduce(|best, other| if strength[other] > strength[best] { other } else { best }) == Some(k)
    };
    let mut order: Vec<usize> = (0..all.len()).collect();
    let strongest: Vec<bool> = order.iter().map(|&k| is_strongest(k)).collect();
    order.sort_by(|&a, &b| strongest[b].cmp(&strongest[a]).then(strength[b].total_cmp(&strength[a])));
    let kept: Vec<usize> = order.iter().copied().filter(|&k| all[k].is_seen()).take(ROWS).collect();
    let (mut seen, mut unseen) = (Vec::new(), Vec::new());
    for (k, planted) in all.into_iter().enumerate() {
        if kept.contains(&k) {
            seen.push(planted);
        } else if strongest[k] && !planted.is_seen() {
            unseen.push(planted);
        }
    }
    (seen, unseen)
}

struct Matrix {
    imitated: Vec<Vec<f64>>,
    by_recalibration: Vec<f64>,
}

impl Matrix {
    fn new(trials: &Trials, precision: &DMatrix<f64>, planted: &[Planted]) -> Self {
        let displacements: Vec<DVector<f64>> = planted.iter().map(|planted| planted.displacement.clone()).collect();
        let recalibrations: Vec<Recalibration> =
            displacements.par_iter().map(|displacement| Recalibration::new(trials, precision, displacement)).collect();
        let all = DMatrix::from_fn(trials.rows(), planted.len(), |row, a| displacements[a][row]);
        let imitators: Vec<Imitator> =
            planted.par_iter().map(|imitator| Imitator::new(trials, imitator, &all)).collect();
        let share = |a: usize, imitator: &Imitator| imitator.imitates(trials, a, &displacements[a], &recalibrations[a]);
        let row = |a: usize| imitators.par_iter().map(|imitator| share(a, imitator)).collect();
        let rows: Vec<Vec<f64>> = (0..planted.len()).into_par_iter().map(row).collect();
        Self { imitated: rows, by_recalibration: recalibrations.iter().map(|by| by.share).collect() }
    }
}

/// Returns the name, with the carrier where the effect has several here.
fn label(instance: &Instance, prepared: &Prepared) -> String {
    let name = instance.effect().name();
    let ways = prepared.library.iter().filter(|other| other.effect().name() == name).count();
    if ways > 1 { instance.label(&prepared.case.rig) } else { name.into() }
}

/// Returns the data with the names of their trials.
fn named(data: Data, prepared: &Prepared) -> Data {
    let names = |trials: &[crate::case::Trial]| trials.iter().map(|trial| trial.name.clone()).collect();
    Data {
        calibration: names(&prepared.case.calibration),
        development: names(&prepared.case.development),
        held_out: vec![],
        ..data
    }
}
