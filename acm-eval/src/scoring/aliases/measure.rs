//! Measurement of all pairs of effects at all places.

use std::collections::BTreeMap;

use acm_core::effects::instance::Instance;
use acm_core::effects::{Carrier, find};
use rayon::prelude::*;

use super::explained::Planted;
use super::place::{PLACES, Place};
use super::planted::planted;
use super::table::{KEPT, Shares, Table};
use crate::error::EvalError;
use crate::scoring::share::quantile;
use acm_trace::series::Series;

/// Shares of one case: effect, effect that explains it, share; the largest over the carriers of the latter.
type Pairs = Vec<(&'static str, &'static str, f64)>;

/// Measures every place; `progress` receives its name first.
///
/// # Errors
/// A nominal model that cannot be calibrated.
pub fn measure(command: &str, mut progress: impl FnMut(&str)) -> Result<Table, EvalError> {
    let mut places = BTreeMap::new();
    for name in PLACES {
        progress(name);
        let pairs: Vec<Pairs> = Place::all(name)?.iter().map(of_case).collect();
        places.insert(name.to_string(), medians(pairs.into_iter().flatten()));
    }
    Ok(Table { command: command.into(), version: env!("CARGO_PKG_VERSION").into(), places })
}

/// Returns the shares of every effect that shows, by every other.
fn of_case(place: &Place) -> Pairs {
    let library = &place.prepared.library;
    let of = |instance: &Instance| -> Pairs {
        let Some(series) = planted(place, instance) else { return vec![] };
        explained(place, instance, &series)
    };
    let asked: Vec<&Instance> = library.iter().filter(|instance| is_asked(instance)).collect();
    asked.into_par_iter().flat_map_iter(of).collect()
}

/// Number of actuators that effects are planted on: of many that are alike, the first few represent all.
const ACTUATORS: usize = 2;

fn is_asked(instance: &Instance) -> bool {
    !matches!(instance.carrier(), Carrier::Actuator(a) if a >= ACTUATORS)
}

fn explained(place: &Place, instance: &Instance, series: &[Series]) -> Pairs {
    let problem = place.problem(series);
    let bare = Place::bare(&problem);
    let Some(planted) = Planted::new(problem, bare, change(place, series)) else { return vec![] };
    let (own, mut largest) = (name(instance), BTreeMap::<&'static str, f64>::new());
    let others = place.prepared.library.iter().filter(|other| is_comparable(instance, other));
    for other in others.filter(|other| name(other) != own) {
        let best = largest.entry(name(other)).or_default();
        *best = best.max(planted.explained_by(other));
    }
    largest.into_iter().map(|(by, share)| (own, by, share)).collect()
}

/// Returns the name of an effect of the library, as all of a scored campaign are.
fn name(instance: &Instance) -> &'static str {
    find(instance.effect().name()).map_or("", |effect| effect.name())
}

/// Returns whether two effects are compared: only those on the same signal, since a claim on another one is never
/// right. The rig carries any.
fn is_comparable(one: &Instance, other: &Instance) -> bool {
    let carriers = [one.carrier(), other.carrier()];
    carriers[0] == carriers[1] || carriers.contains(&Carrier::Rig)
}

/// Returns the sum of squares of the weighted change of the outputs, over the samples that count.
fn change(place: &Place, series: &[Series]) -> f64 {
    let weight = &place.prepared.weight;
    let still = super::planted::still(place);
    let of = |(series, still): (&Series, &Vec<f64>)| -> f64 {
        let counted = series.measured.iter().zip(still).enumerate();
        let counted = counted.filter(|(k, _)| series.counts[k / weight.len()]);
        counted.map(|(k, (a, b))| (weight[k % weight.len()] * (a - b)).powi(2)).sum()
    };
    series.iter().zip(&still).map(of).sum()
}

/// Returns the medians over signals and cases of shares that are large enough to be kept, to three digits.
fn medians(pairs: impl Iterator<Item = (&'static str, &'static str, f64)>) -> BTreeMap<String, Shares> {
    let mut all: BTreeMap<(&str, &str), Vec<f64>> = BTreeMap::new();
    pairs.for_each(|(of, by, share)| all.entry((of, by)).or_default().push(share));
    let mut kept: BTreeMap<String, Shares> = BTreeMap::new();
    for ((of, by), shares) in all {
        let share = (1e3 * quantile(&shares, 0.5).unwrap_or(0.0)).floor() / 1e3;
        if share >= KEPT {
            kept.entry(of.into()).or_default().insert(by.into(), share);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand; shares are rounded down, so that none becomes an alias by rounding.
    #[test]
    fn medians_over_cases_are_kept() {
        let pairs = [("a", "b", 0.9), ("a", "b", 0.9799), ("a", "b", 0.99), ("a", "c", 0.5), ("b", "a", 1.0)];
        let kept = medians(pairs.into_iter());
        assert_eq!(kept["a"], BTreeMap::from([("b".to_string(), 0.979)]));
        assert_eq!(kept["b"]["a"], 1.0);
    }
}
