//! What effects on an arm share: typical sizes of the loads that bend it.
//!
//! A force F at the tip moves it by F L³/3EI, and a load w along the arm by w L⁴/8EI. A typical load, acting
//! across a straight arm, moves the tip by a twentieth of the length. A load may be much larger where it acts nearly along
//! the arm, as a weight or a downwash does while the arm hangs.

use super::{Carrier, ParameterSpec, Rig};
use crate::fields::Field;
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

/// Adds a load, sample by sample, to the column of its field.
pub fn add(columns: &mut [Vec<f64>], field: Field, load: impl Fn(usize) -> f64) {
    if let Some(column) = columns.get_mut(field.column()) {
        column.iter_mut().enumerate().for_each(|(t, sum)| *sum += load(t));
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
