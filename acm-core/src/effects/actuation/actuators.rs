//! Shared by effects of the actuation: one size for each actuator.
//!
//! An actuator that does not move gets a size between 0 and 0, which no fit can change.

use std::ops::Range;

use crate::effects::{Carrier, ParameterSpec, Rig, Values};
use crate::rig::Signal;

/// Width of the range, 0 for an actuator that does not move.
pub fn travel(q: &Signal) -> f64 {
    if q.varies() { q.span() } else { 0.0 }
}

/// The rig as a whole where any actuator moves, else nothing.
pub fn moving(rig: &Rig) -> Vec<Carrier> {
    if rig.actuators.iter().any(Signal::varies) { vec![Carrier::Rig] } else { vec![] }
}

/// Most moving actuators that may act alone.
const FEW: usize = 3;

/// The rig as a whole where any actuator moves; with few of them and no arm, each of them too.
pub fn together_or_alone(rig: &Rig) -> Vec<Carrier> {
    let alone: Vec<Carrier> =
        rig.actuators.iter().enumerate().filter(|(_, q)| q.varies()).map(|(j, _)| Carrier::Actuator(j)).collect();
    let few = (2..=FEW).contains(&alone.len()) && rig.arm.is_none();
    moving(rig).into_iter().chain(alone.into_iter().filter(|_| few)).collect()
}

/// Indices of the columns that an effect with this carrier acts on.
pub fn acting(carrier: Carrier, columns: usize) -> Range<usize> {
    match carrier {
        Carrier::Actuator(j) if j < columns => j..j + 1,
        _ => 0..columns,
    }
}

/// Whether a moving actuator comes to its zero, or nearly so.
pub fn crosses_zero(q: &Signal) -> bool {
    let near = 0.05 * q.span();
    q.varies() && q.low <= near && q.high >= -near
}

/// One size for each actuator in its own unit; scale, smallest and largest as shares of its travel.
pub fn sizes<'a>(
    rig: &'a Rig,
    name: &'a str,
    [scale, lower, upper]: [f64; 3],
) -> impl Iterator<Item = ParameterSpec> + 'a {
    rig.actuators.iter().map(move |q| {
        let travel = travel(q);
        ParameterSpec::size(format!("{name}_{}", q.name), &q.unit, scale * travel)
            .within(lower * travel, upper * travel)
    })
}

/// One size without unit for each actuator; scale, smallest and largest as they are.
pub fn shares<'a>(
    rig: &'a Rig,
    name: &'a str,
    [scale, lower, upper]: [f64; 3],
) -> impl Iterator<Item = ParameterSpec> + 'a {
    rig.actuators.iter().map(move |q| {
        let moves = if q.varies() { 1.0 } else { 0.0 };
        ParameterSpec::size(format!("{name}_{}", q.name), "1", scale).within(moves * lower, moves * upper)
    })
}

/// Ends of each actuator's range as known values: all upper ends, then all lower ends.
pub fn ends(rig: &Rig) -> impl Iterator<Item = ParameterSpec> + '_ {
    let known = |name: &str, q: &Signal, value: f64| ParameterSpec::known(format!("{name}_{}", q.name), &q.unit, value);
    let high = rig.actuators.iter().map(move |q| known("high", q, q.high));
    high.chain(rig.actuators.iter().map(move |q| known("low", q, q.low)))
}

/// Passes each actuator that has a range through its own state. `step` takes the sample's index and x, the actuator in half ranges
/// from the middle, and returns its replacement. [`ends`] follow the first `own` parameters.
pub fn pass_in_range<'c, S>(
    values: Values,
    own: usize,
    columns: &'c mut [Vec<f64>],
    states: &'c mut [S],
    mut step: impl FnMut(&mut S, usize, f64) -> f64,
) {
    let count = columns.len();
    let with_range = |(j, (q, state)): (usize, (&'c mut Vec<f64>, &'c mut S))| {
        let (middle, half) = middle_and_half(values, own, count, j);
        is_range(middle, half).then_some((middle, half, q, state))
    };
    let mut passing: Vec<_> = columns.iter_mut().zip(states).enumerate().filter_map(with_range).collect();
    // Sample by sample: steps of one column depend on each other, those of several columns overlap.
    for t in 0..passing.first().map_or(0, |(_, _, q, _)| q.len()) {
        for (middle, half, q, state) in &mut passing {
            if let Some(q) = q.get_mut(t) {
                let x = (*q - *middle) / *half;
                *q += *half * (step(state, t, x) - x);
            }
        }
    }
}

/// Middle of actuator `j`'s range and half its width, where [`ends`] follow the first `own` parameters.
pub fn middle_and_half(values: Values, own: usize, count: usize, j: usize) -> (f64, f64) {
    let (high, low) = (values.at(own + j, 0), values.at(own + count + j, 0));
    (0.5 * (high + low), 0.5 * (high - low))
}

/// Whether a range of that half width around `middle` is one: an actuator at rest has none.
pub fn is_range(middle: f64, half: f64) -> bool {
    2.0 * half > 1e-9 * (middle.abs() + half)
}
