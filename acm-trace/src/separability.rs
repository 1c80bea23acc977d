//! What these trials cannot tell apart, whatever their residual: asked before any claim is made from them.
//!
//! ```text
//! imitated(a, b) = 1 − min_{θ_b, δ} ‖d_a − d_b(θ_b) − J δ‖² / ‖d_a‖²
//! ```
//!
//! | symbol | meaning                                                                     | shape | unit   |
//! | `d_a`  | what effect a, of one size for all effects, does to the outputs             | NM    | weighted |
//! | `d_b`  | what effect b does                                                          | NM    | weighted |
//! | `J δ`  | what recalibration does, within the 99 % ellipsoid of the calibration       | NM    | weighted |
//!
//! Nothing of the recorded outputs enters but how well they calibrate the model: the excitation alone decides. Not
//! symmetric, since a richer effect imitates a poorer one. Two effects stand in one group where each imitates nine
//! tenths of what recalibration leaves of the other.

mod descent;
mod equations;
mod evaluate;
mod ground;
mod groups;
mod imitation;
mod joint;
mod normal;
mod planted;
mod recalibration;
mod setup;

use acm_core::calibration::CalibrationError;
use acm_core::effects::instance::Instance;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::case::Case;
use crate::close::About;
use crate::finding::{Data, Separability};
use crate::prepared::{self, Prepared};
use crate::series::Series;
use crate::trace::Options;
use evaluate::Point;
use imitation::Imitator;
use planted::Planted;
use recalibration::Recalibration;
use setup::Setup;

/// Size that every effect is given where outputs are lengths, m.
const SIZE: f64 = 0.01;

/// The same where they are not, as a share of the spread of the outputs.
const SHARE: f64 = 0.1;

/// Rows of the matrix at most.
const ROWS: usize = 40;

/// Longest time between samples where there are samples enough, s: a filter of the outputs is seen at this rate.
const STEP: f64 = 0.1;

/// Numbers that are compared: samples times outputs.
const NUMBERS: usize = 30_000;

/// How much of each effect the others could imitate, in the development trials of a case.
///
/// # Errors
/// A nominal model that cannot be calibrated.
pub fn separability(case: Case, about: About, options: &Options) -> Result<Separability, CalibrationError> {
    let options = thinned(&case, options);
    let prepared = prepared::prepare(case, &options)?;
    let calibrated = calibrated_setup(&prepared);
    let precision = precision(&prepared, &calibrated);
    let series = planted::silent(&calibrated);
    let setup = Setup { series: &series, precision, ..calibrated.clone() };
    let size = if prepared.is_length() { SIZE } else { SHARE * spread(&prepared) };
    let reported = prepared.case.reported.clone();
    let all = prepared.library.par_iter().map(|instance| Planted::new(&setup, instance, size, &reported)).collect();
    let (seen, unseen) = chosen(all);
    let matrix = Matrix::new(&setup, &seen);
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

/// As many samples as the question needs.
fn thinned(case: &Case, options: &Options) -> Options {
    let total: usize = case.development.iter().map(|trial| trial.record.samples()).sum();
    let numbers = total * case.rig.outputs.len().max(2);
    let fast = if case.rig.step > 0.0 { (STEP / case.rig.step * (1.0 + 1e-6)) as usize } else { 1 };
    let stride = fast.max(numbers.div_ceil(NUMBERS)).max(1);
    let samples = numbers.div_ceil(3 * stride).max(1);
    Options { samples, ..options.clone() }
}

/// The calibrated model with its map around the development trials.
fn calibrated_setup(prepared: &Prepared) -> Setup<'_> {
    let case = &prepared.case;
    let plain = prepared.response.clone();
    if prepared.calibration.is_empty() {
        return ground::bare(case, &prepared.development, plain, &prepared.weight, 1.0);
    }
    let bare = ground::bare(case, &prepared.calibration, plain, &prepared.weight, 1.0);
    let zero = DVector::zeros(bare.calibrated());
    let nothing = Point { instances: &[], theta: &[], delta: &zero };
    let response = bare.response.with_map(ground::static_map(&bare, nothing));
    ground::bare(case, &prepared.development, response, &prepared.weight, 1.0)
}

/// Λ of the calibration trials; zero where there are none of their own.
fn precision(prepared: &Prepared, setup: &Setup) -> DMatrix<f64> {
    let free = setup.calibrated();
    if prepared.calibration.is_empty() {
        return DMatrix::zeros(free, free);
    }
    let response = setup.response.clone();
    let calibration = ground::bare(&prepared.case, &prepared.calibration, response, &prepared.weight, 1.0);
    let delta = DVector::zeros(free);
    ground::precision(&calibration, Point { instances: &[], theta: &[], delta: &delta })
}

/// Root of the summed variances of the reported outputs, weighted.
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

/// Effects that leave a trace, each in its strongest way first, and then others while there is room; and those that
/// leave none in any way.
fn chosen(all: Vec<Planted>) -> (Vec<Planted>, Vec<Planted>) {
    let name = |planted: &Planted| planted.instance.effect().name();
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
    fn new(setup: &Setup, planted: &[Planted]) -> Self {
        let recalibrations: Vec<Recalibration> =
            planted.par_iter().map(|planted| Recalibration::new(setup, &planted.displacement)).collect();
        let displacements: Vec<&[DVector<f64>]> = planted.iter().map(|p| p.displacement.as_slice()).collect();
        let imitators: Vec<Imitator> =
            planted.par_iter().map(|imitator| Imitator::new(setup, imitator, &displacements)).collect();
        let rows: Vec<Vec<f64>> = (0..planted.len())
            .into_par_iter()
            .map(|a| {
                let (original, by) = (&planted[a], &recalibrations[a]);
                let series = original.series(setup);
                let around = Setup { series: &series, precision: by.precision.clone(), ..setup.clone() };
                imitators.par_iter().map(|imitator| imitator.imitates(&around, a, by)).collect()
            })
            .collect();
        Self { imitated: rows, by_recalibration: recalibrations.iter().map(|by| by.share).collect() }
    }
}

/// Name, with the carrier where the effect has several here.
fn label(instance: &Instance, prepared: &Prepared) -> String {
    let name = instance.effect().name();
    let ways = prepared.library.iter().filter(|other| other.effect().name() == name).count();
    if ways > 1 { instance.label(&prepared.case.rig) } else { name.into() }
}

/// The data with the names of their trials.
fn named(data: Data, prepared: &Prepared) -> Data {
    let names = |trials: &[crate::case::Trial]| trials.iter().map(|trial| trial.name.clone()).collect();
    Data {
        calibration: names(&prepared.case.calibration),
        development: names(&prepared.case.development),
        held_out: vec![],
        ..data
    }
}

/// An effect alone.
fn alone<'p>(instance: &'p Instance, theta: &'p [Vec<f64>], delta: &'p DVector<f64>) -> Point<'p> {
    Point { instances: std::slice::from_ref(instance), theta, delta }
}
