//! Models on the move: the reference shifted to a new place, a calibration set free, and what a fit leaves and an effect does.

use acm_core::effects::instance::Instance;
use acm_core::response::Response;
use acm_core::rig::Rig;
use nalgebra::{DMatrix, DVector};

use crate::evaluate::{self, Point, StateFrom, Tip};
use crate::fit::{Scored, fit, score};
use crate::ground;
use crate::prepared::Prepared;
use crate::remainder::{Remainder, TrialRemainder};
use crate::series::Series;
use crate::setup::Setup;

/// Fits effects and calibration with no prior, moving the reference along.
pub fn free_fit<'a>(setup: Setup<'a>, instances: &[Instance], theta: &[Vec<f64>]) -> (Setup<'a>, Scored) {
    let free = setup.calibrated();
    let loose = Setup { precision: DMatrix::zeros(free, free), centre: DVector::zeros(free), ..setup };
    let mut setup = relinearised(&loose, instances, theta, &DVector::zeros(free));
    let mut theta = theta.to_vec();
    for _ in 0..4 {
        let step = fit(&setup, instances, &theta, &DVector::zeros(free), Tip::Exact, 4);
        setup = relinearised(&setup, instances, &step.theta, &step.delta);
        theta = step.theta;
    }
    let last = fit(&setup, instances, &theta, &DVector::zeros(free), Tip::Exact, 2);
    let scored = score(&setup, last, Tip::Exact);
    (setup, scored)
}

/// The setup around another point; δ is then measured from there.
pub fn relinearised<'a>(
    setup: &Setup<'a>,
    instances: &[Instance],
    theta: &[Vec<f64>],
    delta: &DVector<f64>,
) -> Setup<'a> {
    let moved: Vec<f64> = setup.response.parameters().iter().zip(delta.iter()).map(|(p, d)| p + d).collect();
    let response = setup.response.with_parameters(&moved);
    let prior = (setup.precision.clone(), &setup.centre - delta);
    Setup::new(setup.rig, setup.series, response, instances, theta, setup.weight.clone(), setup.noise, prior)
}

/// The response after calibrating again on `series`, without effects.
pub fn recalibrated(prepared: &Prepared, series: &[Series], response: Response, noise: f64) -> Response {
    let setup = ground::bare(&prepared.case, series, response, &prepared.weight, noise);
    let (setup, scored) = free_fit(setup, &[], &[]);
    let moved = setup.response.parameters();
    let moved: Vec<f64> = moved.iter().zip(scored.fit.delta.iter()).map(|(p, d)| p + d).collect();
    setup.response.with_parameters(&moved)
}

/// What a fit leaves on blocks left out.
pub fn remainder<'r>(setup: &'r Setup, scored: &Scored, rig: &'r Rig, floor: f64) -> Remainder<'r> {
    let trials = setup.series.iter().zip(&setup.references).zip(&scored.residual).map(|((series, reference), r)| {
        TrialRemainder {
            name: &series.name,
            record: &series.thin,
            residual: r.iter().copied().collect(),
            counts: &series.counts,
            slopes: &reference.linear.by_actuator,
            block: &series.block,
        }
    });
    Remainder { rig, trials: trials.collect(), floor }
}

/// Root mean square of what effect `i` does to the outputs of the trials, weighted.
pub fn size(setup: &Setup, scored: &Scored, i: usize) -> f64 {
    let (mut instances, mut theta) = (scored.fit.instances.clone(), scored.fit.theta.clone());
    instances.remove(i);
    theta.remove(i);
    let without = Point { instances: &instances, theta: &theta, delta: &scored.fit.delta };
    let (mut squares, mut count) = (0.0, 0usize);
    for s in 0..setup.series.len() {
        let change = evaluate::residual(setup, s, scored.fit.point(), Tip::Exact, StateFrom::Trial)
            - evaluate::residual(setup, s, without, Tip::Exact, StateFrom::Trial);
        squares += change.norm_squared();
        count += setup.series[s].counts.iter().filter(|counts| **counts).count();
    }
    (squares / count.max(1) as f64).sqrt()
}
