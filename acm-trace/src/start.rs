//! Where the search starts: around the calibration and its map, held within the 99 % ellipsoid of the calibration; and what gains
//! are measured against, the noise and the doubt about what is static.

use acm_core::response::Response;
use nalgebra::DVector;
use rayon::prelude::*;

use crate::evaluate::{self, Point, StateFrom, Tip};
use crate::fit::{Scored, fit};
use crate::ground;
use crate::moving::{recalibrated, remainder};
use crate::noise_floor::{noise_floor, noise_floor_of};
use crate::prepared::Prepared;
use crate::series::Series;
use crate::setup::Setup;

/// Nominal model, map and precision from the calibration trials, around the development trials.
pub(crate) fn initial_setup(prepared: &Prepared) -> Setup<'_> {
    let case = &prepared.case;
    let plain = Response::new(prepared.nominal.model.clone(), None, prepared.down());
    let trials = if prepared.calibration.is_empty() { &prepared.development } else { &prepared.calibration };
    let bare = ground::bare(case, trials, plain, &prepared.weight, 1.0);
    let zero = DVector::zeros(bare.calibrated());
    let nothing = Point { instances: &[], theta: &[], delta: &zero };
    // A map of the trials in which an effect is sought would swallow the effect.
    let map = if prepared.calibration.is_empty() { None } else { ground::static_map(&bare, nothing) };
    let mapped = ground::bare(case, trials, bare.response.with_map(map), &prepared.weight, 1.0);
    let around = ground::bare(case, &prepared.development, mapped.response.clone(), &prepared.weight, 1.0);
    if prepared.calibration.is_empty() {
        return around;
    }
    around.with_precision(ground::precision(&mapped, nothing))
}

/// Tightens the prior until the best calibration without effects lies within the 99 % ellipsoid.
pub(crate) fn within_ellipsoid(setup: Setup) -> Setup {
    let free = setup.calibrated();
    let limit = chi_square_99(free as f64);
    let mut tightened = setup.clone();
    for half_decades in 0..=16 {
        let factor = 10f64.powf(0.5 * f64::from(half_decades));
        tightened = setup.with_precision(&setup.precision * factor);
        let fitted = fit(&tightened, &[], &[], &setup.centre, Tip::Exact, 2);
        let away = &fitted.delta - &setup.centre;
        if away.dot(&(&setup.precision * &away)) <= limit {
            break;
        }
    }
    tightened
}

/// Wilson & Hilferty (1931), PNAS 17(12).
fn chi_square_99(freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom.max(1.0));
    freedom * (1.0 - spread + 2.326_347_9 * spread.sqrt()).powi(3)
}

/// Variance of the noise in one weighted output.
pub(crate) fn variance(floor: f64, setup: &Setup) -> f64 {
    (floor * floor / setup.outputs() as f64).max(f64::MIN_POSITIVE)
}

/// From what is left, or from what was measured at the full rate of the recording, whichever is smaller: both are bounds from
/// above.
pub(crate) fn floor(setup: &Setup, scored: &Scored, prepared: &Prepared) -> f64 {
    let left = noise_floor(&remainder(setup, scored, &prepared.case.rig, 0.0));
    let measured = prepared.case.development.iter().map(|trial| {
        let weighted =
            |(column, weight): (nalgebra::DVectorView<f64>, &f64)| column.iter().map(|y| y * weight).collect();
        let columns: Vec<Vec<f64>> = trial.measured.column_iter().zip(&prepared.weight).map(weighted).collect();
        noise_floor_of(&trial.record.time, &columns)
    });
    let (sum, count) = measured.fold((0.0, 0usize), |(sum, count), floor| (sum + floor * floor, count + 1));
    left.min((sum / count.max(1) as f64).sqrt())
}

/// What calibration and map miss in a calibration trial that they have not seen, over the noise: the median of the trials.
pub(crate) fn doubt(prepared: &Prepared, floor: f64) -> f64 {
    let trials = &prepared.calibration;
    if trials.len() < 3 {
        return 0.0;
    }
    let plain = Response::new(prepared.nominal.model.clone(), None, None);
    let missed = |c: usize| {
        let others: Vec<Series> = trials.iter().enumerate().filter(|(k, _)| *k != c).map(|(_, s)| s.clone()).collect();
        let again = recalibrated(prepared, &others, plain.clone(), 1.0);
        let bare = ground::bare(&prepared.case, &others, again.clone(), &prepared.weight, 1.0);
        let zero = DVector::zeros(bare.calibrated());
        let nothing = Point { instances: &[], theta: &[], delta: &zero };
        let map = ground::static_map(&bare, nothing);
        let alone = std::slice::from_ref(&trials[c]);
        let mapped = ground::bare(&prepared.case, alone, again.with_map(map), &prepared.weight, 1.0);
        let residual = evaluate::residual(&mapped, 0, nothing, Tip::Exact, StateFrom::Trial);
        let count = trials[c].counts.iter().filter(|counts| **counts).count();
        (residual.norm_squared() / count.max(1) as f64 - floor * floor).max(0.0).sqrt()
    };
    let mut all: Vec<f64> = (0..trials.len()).into_par_iter().map(missed).collect();
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}
