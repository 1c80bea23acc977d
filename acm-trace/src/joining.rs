//! Whether effects act in the calibration trials too, and then calibration, map and effects fitted to all trials together.

use acm_core::response::Response;
use nalgebra::{DMatrix, DVector};

use crate::evaluate::Point;
use crate::fit::Scored;
use crate::ground;
use crate::moving::free_fit;
use crate::prepared::Prepared;
use crate::rules::compare;
use crate::series::Series;
use crate::setup::Setup;

/// Calibration and development trials together.
pub(crate) struct Joined<'a> {
    pub setup: Setup<'a>,
    pub last: Scored,
    pub bare_setup: Setup<'a>,
    pub bare: Scored,
}

/// Share of what is left over the noise in the calibration trials that the effects have to explain.
const JOIN_SHARE: f64 = 0.3;

/// Times the mean square of the development trials alone that all trials together may have.
const JOIN_LOSS: f64 = 1.5;

pub(crate) fn joined<'a>(
    prepared: &'a Prepared,
    series: &'a [Series],
    setup: &Setup<'a>,
    last: &Scored,
    floor: f64,
) -> Option<Joined<'a>> {
    let noise = setup.noise;
    let bare_on = |series: &'a [Series], response: Response| {
        ground::bare(&prepared.case, series, response, &prepared.weight, noise)
    };
    // The calibration trials with the effects as found, calibrated again.
    let plain = Response::new(prepared.nominal.model.clone(), None, prepared.down());
    let before = free_fit(bare_on(&prepared.calibration, plain.clone()), &[], &[]);
    let instances = &last.fit.instances;
    let frozen = free_fit(bare_on(&prepared.calibration, plain.clone()), instances, &last.fit.theta);
    let (noise_square, last_square) = (floor * floor, last.mean_square());
    let (was, is) = (before.1.mean_square(), frozen.1.mean_square());
    let comparison = compare(&before.1.left_out, &frozen.1.left_out);
    if was - is < JOIN_SHARE * (was - noise_square).max(0.2 * noise_square) || comparison.significance() < 2.0 {
        return None;
    }
    // Together: calibration and effects at once, then the map of what is left in the calibration trials, then both again.
    let (together, scored) = free_fit(bare_on(series, plain.clone()), instances, &last.fit.theta);
    let at_rest = on_calibration(prepared, &together, &scored, noise);
    let map =
        ground::static_map(&at_rest, Point { delta: &DVector::zeros(at_rest.calibrated()), ..scored.fit.point() });
    let (setup, last) =
        free_fit(Setup { response: together.response.with_map(map), ..together }, instances, &scored.fit.theta);
    // Together they must be explained about as well as the development trials were alone.
    if scored_on(&setup, &last) > JOIN_LOSS * last_square.max(noise_square) {
        return None;
    }
    let (bare_setup, bare) = free_fit(bare_on(series, setup.response.clone()), &[], &[]);
    Some(Joined { setup, last, bare_setup, bare })
}

/// Mean square left out in the trials that the first search saw: development trials come last.
fn scored_on(setup: &Setup, scored: &Scored) -> f64 {
    let (mut squares, mut count) = (0.0, 0usize);
    for (series, residual) in setup.series.iter().zip(&scored.residual) {
        squares += residual.norm_squared();
        count += series.counts.iter().filter(|counts| **counts).count();
    }
    squares / count.max(1) as f64
}

fn on_calibration<'a>(prepared: &'a Prepared, together: &Setup<'a>, scored: &Scored, noise: f64) -> Setup<'a> {
    let free = together.calibrated();
    let prior = (DMatrix::zeros(free, free), DVector::zeros(free));
    let (instances, theta) = (&scored.fit.instances, &scored.fit.theta);
    Setup::new(
        &prepared.case.rig,
        &prepared.calibration,
        together.response.clone(),
        instances,
        theta,
        prepared.weight.clone(),
        noise,
        prior,
    )
}
