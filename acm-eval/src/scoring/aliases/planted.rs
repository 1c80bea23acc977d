//! One effect of a given size in the outputs of the nominal model, without noise.
//!
//! ```text
//! r(s) ~ s^p between two sizes,   s = s₁·(wanted/r₁)^(1/p)
//! ```
//!
//! `r` is the root mean square of what the effect does to the weighted outputs; its sizes grow together along its middle initial
//! guess, its shapes stay. The outputs are the model's own, not those of the regression that explains them.

use acm_core::augmented::AugmentedModel;
use acm_core::effects::instance::Instance;
use acm_core::record::Record;
use nalgebra::DMatrix;

use super::place::Place;
use acm_trace::series::Series;

/// Requested size where outputs are lengths of an arm, m, and as a share of the spread of the outputs elsewhere.
const WANTED: (f64, f64) = (0.012, 0.15);

/// Share of the requested size below which an effect leaves no trace within its bounds.
const TRACE: f64 = 0.2;

/// Steps of the search for the size, and how near it comes.
const STEPS: (usize, f64) = (6, 0.15);

/// Returns the trials with the outputs of the model with the effect; none where its bounds do not let it show.
pub fn planted(place: &Place, instance: &Instance) -> Option<Vec<Series>> {
    let still = still(place);
    let wanted = wanted(place, &still);
    let guesses = instance.initial_guesses(&place.prepared.case.rig);
    let start = guesses.get(guesses.len() / 2)?;
    let at = |scale: f64| {
        let moved = outputs(place, Some((instance, scaled(instance, start, scale))));
        (rms(place, &moved, &still), moved)
    };
    let (mut scale, (mut reached, mut moved)) = (1.0, at(1.0));
    let mut power = 1.0;
    for _ in 0..STEPS.0 {
        if (reached / wanted - 1.0).abs() < STEPS.1 || reached <= 0.0 {
            break;
        }
        let next = scale * (wanted / reached).powf(1.0 / power).clamp(0.02, 50.0);
        let (there, outputs) = at(next);
        let bent = (there / reached).ln() / (next / scale).ln();
        power = if bent.is_finite() { bent.clamp(0.3, 3.0) } else { power };
        (scale, reached, moved) = (next, there, outputs);
    }
    (reached.is_finite() && reached > TRACE * wanted).then(|| measured(place, moved))
}

/// Returns θ with its sizes at `scale` times those of the start.
fn scaled(instance: &Instance, start: &[f64], scale: f64) -> Vec<f64> {
    let one = |(spec, value): (&acm_core::effects::ParameterSpec, &f64)| {
        if spec.may_vary { spec.inside(spec.neutral + scale * (value - spec.neutral)) } else { *value }
    };
    instance.parameters().iter().zip(start).map(one).collect()
}

/// Returns the outputs without an effect.
pub fn still(place: &Place) -> Vec<Vec<f64>> {
    outputs(place, None)
}

/// Returns the outputs [N×M] of each trial at the samples that are looked at.
fn outputs(place: &Place, effect: Option<(&Instance, Vec<f64>)>) -> Vec<Vec<f64>> {
    let prepared = &place.prepared;
    let effects = effect.into_iter().map(|(instance, theta)| (instance.clone(), theta)).collect();
    let rig = prepared.case.rig.clone();
    let model = AugmentedModel::assembled(rig, prepared.response.clone(), prepared.nominal.stands_for.clone(), effects);
    let all = |record: &Record, rows: &[usize]| -> Vec<f64> {
        let predicted: DMatrix<f64> = model.predict(record, None);
        rows.iter().flat_map(|&t| predicted.row(t).iter().copied().collect::<Vec<f64>>()).collect()
    };
    place.series.iter().map(|series| all(&series.record, &series.rows)).collect()
}

fn measured(place: &Place, outputs: Vec<Vec<f64>>) -> Vec<Series> {
    place.series.iter().zip(outputs).map(|(series, measured)| Series { measured, ..series.clone() }).collect()
}

/// Returns the root mean square distance of weighted outputs.
fn rms(place: &Place, one: &[Vec<f64>], other: &[Vec<f64>]) -> f64 {
    let weight = &place.prepared.weight;
    let pairs = || one.iter().flatten().zip(other.iter().flatten());
    let square = |(k, (a, b)): (usize, (&f64, &f64))| (weight[k % weight.len()] * (a - b)).powi(2);
    let rows = pairs().count() / weight.len().max(1);
    (pairs().enumerate().map(square).sum::<f64>() / rows.max(1) as f64).sqrt()
}

fn wanted(place: &Place, still: &[Vec<f64>]) -> f64 {
    if place.prepared.case.rig.arm.is_some() {
        return WANTED.0;
    }
    let width = place.prepared.weight.len();
    let rows = still.iter().map(Vec::len).sum::<usize>() as f64 / width as f64;
    let mean = |o: usize| still.iter().flat_map(|trial| trial.iter().skip(o).step_by(width)).sum::<f64>() / rows;
    let means: Vec<f64> = (0..width).map(mean).collect();
    let level: Vec<Vec<f64>> = still.iter().map(|trial| (0..trial.len()).map(|k| means[k % width]).collect()).collect();
    WANTED.1 * rms(place, still, &level)
}
