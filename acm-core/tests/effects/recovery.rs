//! Planted values come back: the columns of an effect tell its parameters.

use acm_core::effects::ParameterSpec;
use nalgebra::{DMatrix, DVector};

use crate::rigs::{Case, Scene, all, cases};

/// Values near the guess that moves its columns most, so that the effect is heard.
fn planted(case: &Case) -> Vec<f64> {
    let moved = |start: &Vec<f64>| -> f64 {
        let pairs = case.act(start).into_iter().flatten().zip(case.columns().into_iter().flatten());
        pairs.map(|(a, b)| (a - b) * (a - b)).sum()
    };
    let loudest = case
        .starts
        .iter()
        .filter(|guess| is_told(case, guess))
        .max_by(|a, b| moved(a).total_cmp(&moved(b)))
        .expect("a guess");
    let shifted = |(j, (value, spec)): (usize, (&f64, &ParameterSpec))| {
        // A motion hardly tells a window that smooths none of it away.
        let by = if spec.name == "window" { 0.0 } else { [0.2, -0.15][j % 2] };
        spec.inside(value + by * spec.scale)
    };
    loudest.iter().zip(&case.specs).enumerate().map(shifted).collect()
}

/// Whether a record tells values near a guess: windows of none or of more than a few samples, a breaking away that is not over between
/// two of them, a brim that is reached, and no ringing that outlasts the guesses next to it: damping or dry friction end it.
fn is_told(case: &Case, guess: &[f64]) -> bool {
    let value = |name: &str| case.specs.iter().position(|spec| spec.name == name).map(|j| guess[j]);
    let largest = |name: &str| {
        let j = case.specs.iter().position(|spec| spec.name == name);
        j.map_or(0.0, |j| case.starts.iter().map(|guess| guess[j]).fold(0.0, f64::max))
    };
    let is_braked = value("friction").is_some_and(|friction| friction == largest("friction"));
    let reaches = |j: usize| {
        let mut open = guess.to_vec();
        open[j] = case.specs[j].neutral;
        case.act(&open) != case.act(guess)
    };
    let brim = case.specs.iter().position(|spec| spec.name == "brim");
    brim.is_none_or(reaches)
        && value("window").is_none_or(|window| window == 0.0 || window > 5.0 * case.scene.rig.step)
        && value("speed").is_none_or(|speed| speed == largest("speed"))
        && (value("hardness").is_none() || value("damping").is_none_or(|damping| damping > 0.5) || is_braked)
}

/// The guesses next to the truth, in units of each parameter's scale.
fn nearest<'a>(case: &'a Case, truth: &[f64]) -> Vec<&'a Vec<f64>> {
    let off = |guess: &Vec<f64>| -> f64 {
        let each = guess.iter().zip(truth).zip(&case.specs);
        each.map(|((guess, truth), spec)| ((guess - truth) / spec.scale).powi(2)).sum()
    };
    let mut guesses: Vec<&Vec<f64>> = case.starts.iter().collect();
    guesses.sort_by(|a, b| off(a).total_cmp(&off(b)));
    guesses.truncate(NEAREST);
    guesses
}

/// Differences to the target, each column over the size of the effect in it.
fn misfit(case: &Case, theta: &[f64], target: &[Vec<f64>], sizes: &[f64]) -> DVector<f64> {
    let columns = case.act(theta);
    let scaled =
        columns.iter().zip(target).zip(sizes).flat_map(|((a, b), size)| {
            a.iter().zip(b).map(move |(a, b)| if *size > 0.0 { (a - b) / size } else { 0.0 })
        });
    DVector::from_iterator(columns.len() * columns[0].len(), scaled)
}

/// Damped Gauss–Newton steps on central differences, in units of each parameter's scale.
fn fit(case: &Case, start: &[f64], target: &[Vec<f64>], sizes: &[f64]) -> (Vec<f64>, f64) {
    // A window that smooths nothing stays so: a motion without noise hardly tells a narrow one from none.
    let is_told = |j: &usize| case.specs[*j].is_free() && (case.specs[*j].name != "window" || start[*j] > 0.0);
    let free: Vec<usize> = (0..start.len()).filter(is_told).collect();
    let (mut theta, mut damping) = (start.to_vec(), 1e-3);
    let mut residual = misfit(case, &theta, target, sizes);
    for _ in 0..200 {
        let slope = |&j: &usize| {
            let spec = &case.specs[j];
            let side = |by: f64| {
                let mut theta = theta.clone();
                theta[j] = spec.inside(theta[j] + by * spec.scale);
                (misfit(case, &theta, target, sizes), theta[j])
            };
            let ((ahead, high), (behind, low)) = (side(1e-5), side(-1e-5));
            (ahead - behind) * (spec.scale / (high - low))
        };
        let slopes: Vec<DVector<f64>> = free.iter().map(slope).collect();
        let jacobian = DMatrix::from_columns(&slopes);
        let (normal, gradient) = (jacobian.tr_mul(&jacobian), jacobian.tr_mul(&residual));
        let mut better = false;
        for _ in 0..12 {
            let mut damped = normal.clone();
            (0..free.len()).for_each(|k| damped[(k, k)] += damping * normal[(k, k)] + 1e-14 * normal.trace());
            let Some(factor) = damped.cholesky() else { break };
            let step = factor.solve(&gradient);
            let mut next = theta.clone();
            free.iter().zip(step.iter()).for_each(|(&j, step)| {
                next[j] = case.specs[j].inside(theta[j] - step * case.specs[j].scale);
            });
            let after = misfit(case, &next, target, sizes);
            if after.norm() < residual.norm() {
                (theta, residual, better) = (next, after, true);
                damping = (damping * 0.1).max(1e-12);
                break;
            }
            damping *= 10.0;
        }
        if !better || residual.norm() < 1e-11 {
            break;
        }
    }
    (theta, residual.norm())
}

/// Guesses to fit from: the misfit of a play has kinks, where a fit from one of them stays.
const NEAREST: usize = 3;

/// Fewer samples than that do not tell the values of several parameters.
const ENOUGH: usize = 100;

/// Oracle: the planted values themselves.
#[test]
fn planted_values_are_recovered() {
    let mut failed = vec![];
    let scenes: Vec<Scene> = all().into_iter().filter(|scene| scene.record.samples() > ENOUGH).collect();
    for case in cases(&scenes) {
        let truth = planted(&case);
        let (target, before) = (case.act(&truth), case.columns());
        let size =
            |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        let sizes: Vec<f64> = target.iter().zip(&before).map(size).collect();
        let mut fits = vec![];
        for guess in nearest(&case, &truth) {
            let (found, left) = fit(&case, guess, &target, &sizes);
            let off = |j: usize| (found[j] - truth[j]).abs() / case.specs[j].scale;
            let worst = (0..truth.len()).map(off).fold(0.0, f64::max);
            let recovered = worst < 1e-3 && left < 1e-3;
            fits.push(format!("off by {worst:.1e}, {left:.1e} left: {found:?}"));
            if recovered {
                fits.clear();
                break;
            }
        }
        if !fits.is_empty() {
            failed.push(format!("{}: {truth:?}\n  {}", case.label(), fits.join("\n  ")));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}
