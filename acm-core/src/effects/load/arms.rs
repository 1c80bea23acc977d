//! Shared by effects on an arm: typical sizes of the loads that bend it.
//!
//! A force F at the tip moves it by F L³/3EI, and a load w along the arm by w L⁴/8EI. A typical load, acting
//! across a straight arm, moves the tip by a twentieth of the length. A load may be much larger where it acts nearly along
//! the arm, as a weight or a downwash does while the arm hangs.
//!
//! ```text
//! free_f = w_f,   held_f = −c w_f
//! ```
//!
//! | symbol | meaning                                                                             | unit         |
//! | `w_f`  | load over stiffness                                                                 | of its field |
//! | `c`    | share of the mean bending that tendons hold: 0 without, near 1 where they are stiff | 1            |
//!
//! The equation of the held part is in [`crate::fields::FieldModel`].

use crate::effects::{Carrier, ParameterSpec, Rig, guesses};
use crate::fields::{Field, Load};
use crate::rig::Signal;

/// Share of the length by which a typical load moves the tip.
const TYPICAL: f64 = 0.05;

/// Largest load in typical ones.
const LARGEST: f64 = 100.0;

/// The rig as a whole where it has an arm, else nothing.
pub fn any(rig: &Rig) -> Vec<Carrier> {
    if rig.arm.is_some() { vec![Carrier::Rig] } else { vec![] }
}

/// Force at the tip over stiffness, 1/m², either sign.
pub fn force(rig: &Rig, name: &str) -> ParameterSpec {
    let typical = 3.0 * TYPICAL / length(rig).powi(2);
    ParameterSpec::size(name, "1/m^2", typical).within(-LARGEST * typical, LARGEST * typical)
}

/// Load along the arm over stiffness, 1/m³, either sign.
pub fn spread(rig: &Rig, name: &str) -> ParameterSpec {
    let typical = 8.0 * TYPICAL / length(rig).powi(3);
    ParameterSpec::size(name, "1/m^3", typical).within(-LARGEST * typical, LARGEST * typical)
}

/// [`spread`] for one unit of the rotors' throttle.
pub fn spread_by_throttle(rig: &Rig, name: &str) -> ParameterSpec {
    let throttle = rig.throttle.and_then(|context| rig.contexts.get(context));
    let (largest, unit) = throttle.map_or((1.0, "1"), |signal| (signal.magnitude(), signal.unit.as_str()));
    let whole = spread(rig, name);
    let unit = if unit == "1" { whole.unit.clone() } else { format!("{}/({unit})", whole.unit) };
    let typical = if largest > 0.0 { whole.scale / largest } else { whole.scale };
    ParameterSpec::size(name, unit, typical).within(-LARGEST * typical, LARGEST * typical)
}

/// The same parameter without its negative values.
pub fn positive(spec: ParameterSpec) -> ParameterSpec {
    ParameterSpec { lower: 0.0, ..spec }
}

/// Share of the mean bending that tendons hold.
pub fn held() -> ParameterSpec {
    ParameterSpec::shape("held", "1", 0.0, 0.3).within(0.0, 1.0).up_to_limit()
}

/// Share of a jet that is lost over one arm length, linearly with depth.
pub fn decay() -> ParameterSpec {
    ParameterSpec::shape("decay", "1", 0.0, 0.3).within(0.0, 1.0)
}

/// Half a typical size with these shapes, by their places in the list.
pub fn guess(specs: &[ParameterSpec], shapes: &[(usize, f64)]) -> Vec<f64> {
    let mut guess = guesses::guess(specs, 0.5);
    shapes.iter().for_each(|&(j, value)| guess[j] = specs[j].inside(value));
    guess
}

/// Adds a load, sample by sample, on an arm whose tendons hold a share of the mean bending.
pub fn load(columns: &mut [Vec<f64>], load: Load, held: impl Fn(usize) -> f64, size: impl Fn(usize) -> f64) {
    add(columns, Field::Free(load), &size);
    add(columns, Field::Held(load), |t| -held(t) * size(t));
}

/// Adds the drag of a jet that loses a share on its way down.
pub fn jet(
    columns: &mut [Vec<f64>],
    decay: impl Fn(usize) -> f64,
    held: impl Fn(usize) -> f64,
    drag: impl Fn(usize) -> f64,
) {
    load(columns, Load::Wash, &held, |t| drag(t) * (1.0 - decay(t)));
    load(columns, Load::WashNear, &held, |t| drag(t) * decay(t));
}

/// Adds a signal, sample by sample, to the column of its field.
pub fn add(columns: &mut [Vec<f64>], field: Field, signal: impl Fn(usize) -> f64) {
    if let Some(column) = columns.get_mut(field.column()) {
        column.iter_mut().enumerate().for_each(|(t, sum)| *sum += signal(t));
    }
}

/// The context of this index where it moves and the rig has an arm, else nothing.
pub fn carried_by(rig: &Rig, context: Option<usize>) -> Vec<Carrier> {
    let moves = |&e: &usize| rig.contexts.get(e).is_some_and(Signal::varies);
    context.filter(moves).filter(|_| rig.arm.is_some()).map(Carrier::Context).into_iter().collect()
}

fn length(rig: &Rig) -> f64 {
    rig.arm.as_ref().map_or(1.0, |arm| arm.length)
}
