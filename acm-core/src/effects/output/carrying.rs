//! Shared by effects with a carrier signal: the signal, its derivatives and range, and one size for each output.

use crate::effects::memory::{Derivative, Derivatives, State};
use crate::effects::{Carrier, Memory, ParameterSpec, Record, Rig, Values, guesses, times};
use crate::rig::Signal;

/// The rig as a whole where any output moves, else nothing.
pub fn any(rig: &Rig) -> Vec<Carrier> {
    if rig.outputs.iter().any(Signal::varies) { vec![Carrier::Rig] } else { vec![] }
}

/// Every actuator and every context signal that moves, where any output does.
pub fn moving(rig: &Rig) -> Vec<Carrier> {
    let moving = rig.actuators.iter().enumerate().filter(|(_, q)| q.varies() && !any(rig).is_empty());
    moving.map(|(j, _)| Carrier::Actuator(j)).chain(moving_contexts(rig)).collect()
}

/// Those of [`moving`] where there is no arm; an arm has its own effects.
pub fn moving_of_no_arm(rig: &Rig) -> Vec<Carrier> {
    if rig.arm.is_none() { moving(rig) } else { vec![] }
}

/// Those of [`moving`] that are positions or angles, or have no unit, for forces that oppose or follow a motion; all where none is,
/// since any signal may then stand for the unrecorded motion.
pub fn motions(rig: &Rig) -> Vec<Carrier> {
    let all = moving(rig);
    let is_motion = |carrier: &Carrier| MOTIONS.contains(&range(rig, *carrier).0.as_str());
    let motions: Vec<Carrier> = all.iter().copied().filter(is_motion).collect();
    if motions.is_empty() { all } else { motions }
}

/// Units of positions and angles, SI.
const MOTIONS: [&str; 3] = ["m", "rad", "1"];

/// Every context signal that moves, where any output does.
pub fn moving_contexts(rig: &Rig) -> Vec<Carrier> {
    let moving = rig.contexts.iter().enumerate().filter(|(_, c)| c.varies() && !any(rig).is_empty());
    moving.map(|(e, _)| Carrier::Context(e)).collect()
}

/// The carrier in a record.
pub fn signal(record: &Record, carrier: Carrier) -> Option<&[f64]> {
    match carrier {
        Carrier::Rig => None,
        Carrier::Actuator(j) => record.actuators.get(j).map(Vec::as_slice),
        Carrier::Context(e) => record.contexts.get(e).map(Vec::as_slice),
    }
}

/// `of` applied to the derivatives of the carrier's signal: local polynomials with a half window of `window`, s.
pub fn derivative<'m>(
    record: &Record,
    carrier: Carrier,
    window: f64,
    memory: &'m mut Memory,
    of: impl Fn(&Derivative) -> f64,
) -> Option<&'m [f64]> {
    following(record, carrier, window, memory, |(): &mut (), _, derivative| of(derivative))
}

/// `step` applied, with its own state, to each sample of the carrier's signal: to its index, and to the local polynomial with a half
/// window of `window`, s.
pub fn following<'m, S: State>(
    record: &Record,
    carrier: Carrier,
    window: f64,
    memory: &'m mut Memory,
    mut step: impl FnMut(&mut S, usize, &Derivative) -> f64,
) -> Option<&'m [f64]> {
    let signal = signal(record, carrier)?;
    let is_whole = memory.is_whole();
    let (states, column) = memory.states_and_column::<Follower<S>>(1);
    let Follower { derivatives, state } = states.first_mut()?;
    column.clear();
    let found = record.derivatives(signal, window, (!is_whole).then_some(derivatives));
    column.extend(found.iter().enumerate().map(|(t, found)| step(state, t, found)));
    Some(column)
}

/// A state that follows the polynomials through a signal.
#[derive(Debug, Default)]
struct Follower<S> {
    derivatives: Derivatives,
    state: S,
}

impl<S: State> Clone for Follower<S> {
    fn clone(&self) -> Self {
        Self { derivatives: self.derivatives.clone(), state: self.state.clone() }
    }

    fn clone_from(&mut self, other: &Self) {
        self.derivatives.clone_from(&other.derivatives);
        self.state.clone_from(&other.state);
    }
}

impl<S: State> State for Follower<S> {
    fn restart(&mut self) {
        self.derivatives.restart();
        self.state.restart();
    }
}

/// Sizes at their scales, with each window of a derivative and each of these shares of a typical speed: the last two parameters.
pub fn by_window_and_speed(rig: &Rig, carrier: Carrier, specs: &[ParameterSpec], shares: &[f64]) -> Vec<Vec<f64>> {
    let (typical, last) = (typical_speed(rig, carrier), specs.len() - 1);
    let at = |window: f64, share: f64| {
        let mut guess = guesses::guess_with(specs, 1.0, last, window);
        guess[last - 1] = share * typical;
        guess
    };
    times::windows(rig).iter().flat_map(|window| shares.iter().map(|share| at(*window, *share))).collect()
}

/// A typical speed of the carrier: its range in a [`typical_time`].
pub fn typical_speed(rig: &Rig, carrier: Carrier) -> f64 {
    range(rig, carrier).1 / typical_time(rig)
}

/// Unit of the carrier, and the width of its range.
pub fn range(rig: &Rig, carrier: Carrier) -> (String, f64) {
    recorded(rig, carrier).map_or(("1".into(), 1.0), |signal| (signal.unit.clone(), extent(signal)))
}

/// Middle of its range.
pub fn middle(rig: &Rig, carrier: Carrier) -> f64 {
    recorded(rig, carrier).map_or(0.0, |signal| 0.5 * (signal.low + signal.high))
}

fn recorded(rig: &Rig, carrier: Carrier) -> Option<&Signal> {
    match carrier {
        Carrier::Rig => None,
        Carrier::Actuator(j) => rig.actuators.get(j),
        Carrier::Context(e) => rig.contexts.get(e),
    }
}

/// Width of the range; the magnitude of a signal that rests, and 1 where it rests at 0.
pub fn extent(signal: &Signal) -> f64 {
    let sizes = [if signal.varies() { signal.span() } else { 0.0 }, signal.magnitude()];
    sizes.into_iter().find(|size| *size > 0.0).unwrap_or(1.0)
}

/// One size for each output, in its unit per `unit`. A typical size spans a twentieth of the output's range while its factor
/// spans `width`; the largest is `largest` times as big. An output that does not move gets a size between 0 and 0, which no
/// fit can change.
pub fn sizes(rig: &Rig, name: &str, unit: &str, width: f64, largest: f64) -> Vec<ParameterSpec> {
    let of = |y: &Signal| {
        let typical = 0.05 * extent(y) / width;
        let bound = if y.varies() { largest * typical } else { 0.0 };
        let spec = ParameterSpec::size(format!("{name}_{}", y.name), per(&y.unit, unit), typical);
        ParameterSpec { linear: true, ..spec.within(-bound, bound) }
    };
    rig.outputs.iter().map(of).collect()
}

/// A unit over another.
pub fn per(unit: &str, other: &str) -> String {
    match other.strip_prefix("1/") {
        _ if other == "1" => unit.into(),
        _ if other == unit => "1".into(),
        Some(inverse) => format!("{unit}*{inverse}"),
        None if other.contains(['/', '*', '·']) => format!("{unit}/({other})"),
        None => format!("{unit}/{other}"),
    }
}

/// A time between one step and a whole trial, s: it scales rates of change where only ranges are known.
pub fn typical_time(rig: &Rig) -> f64 {
    let time = (rig.step * rig.duration).sqrt();
    if time.is_finite() && time > 0.0 { time } else { 1.0 }
}

/// Adds to every column its size, `size(m, t)`, times the same signal.
pub fn add(columns: &mut [Vec<f64>], size: impl Fn(usize, usize) -> f64, signal: &[f64]) {
    for (m, y) in columns.iter_mut().enumerate() {
        y.iter_mut().zip(signal).enumerate().for_each(|(t, (y, s))| *y += size(m, t) * s);
    }
}

/// Adds to every column its size times the carrier's signal minus `centre`, the value that follows one size for each column.
pub fn add_about_centre(
    carrier: Carrier,
    values: Values,
    record: &Record,
    memory: &mut Memory,
    columns: &mut [Vec<f64>],
) {
    let Some(signal) = signal(record, carrier) else { return };
    let centre = values.at(columns.len(), 0);
    add(columns, |m, t| values.at(m, t), memory.column(signal.iter().map(|c| c - centre)));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a cylinder, whose rod rubs and whose pressure does not; of a motor's voltage alone, that stands for its speed.
    #[test]
    fn what_moves_has_friction_and_inertia() {
        let signal = |name: &str, unit: &str| Signal { name: name.into(), unit: unit.into(), low: 0.0, high: 1.0 };
        let rig = |actuators: Vec<Signal>, contexts: Vec<Signal>| Rig {
            actuators,
            contexts,
            outputs: vec![signal("F", "N")],
            throttle: None,
            altitude: None,
            payload: None,
            carried: false,
            arm: None,
            step: 0.01,
            duration: 10.0,
        };
        let cylinder = rig(vec![signal("p", "Pa")], vec![signal("x", "m"), signal("T", "K")]);
        assert_eq!(motions(&cylinder), [Carrier::Context(0)]);
        assert_eq!(moving(&cylinder).len(), 3);
        assert_eq!(motions(&rig(vec![signal("voltage", "V")], vec![])), [Carrier::Actuator(0)]);
        assert_eq!(motions(&rig(vec![signal("q", "rad"), signal("d", "1")], vec![])).len(), 2);
    }

    #[test]
    fn units_divide() {
        let quotients = [("N", "m/s"), ("N", "1"), ("N", "s^2"), ("m", "m"), ("m", "1/s")];
        let expected = ["N/(m/s)", "N", "N/s^2", "1", "m*s"];
        assert_eq!(quotients.map(|(unit, other)| per(unit, other)), expected);
    }
}
