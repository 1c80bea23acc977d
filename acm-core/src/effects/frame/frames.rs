//! Shared by frame effects: which rigs have a measurement frame, and how rigid motions act on columns x, y, z.

use nalgebra::Vector3;

use crate::effects::{Carrier, Rig};
use crate::rig::Signal;

/// The rig as a whole where its outputs are places in space: an arm, or x, y, z in metres of whole markers.
pub fn any(rig: &Rig) -> Vec<Carrier> {
    let places = !rig.outputs.is_empty() && rig.outputs.len() % 3 == 0 && rig.outputs.iter().all(|y| y.unit == "m");
    if rig.arm.is_some() || places { vec![Carrier::Rig] } else { vec![] }
}

/// The direction of gravity where it is known, else against z.
pub fn down(rig: &Rig) -> Vector3<f64> {
    rig.arm.as_ref().map_or(-Vector3::z(), |arm| arm.down)
}

/// Largest coordinate of any marker, m.
pub fn reach(rig: &Rig) -> f64 {
    let reach = rig.outputs.iter().map(Signal::magnitude).fold(0.0, f64::max);
    if reach > 0.0 { reach } else { 1.0 }
}

/// Applies `motion` to every marker at every sample.
pub fn each(columns: &mut [Vec<f64>], motion: impl Fn(usize, Vector3<f64>) -> Vector3<f64>) {
    for marker in columns.chunks_exact_mut(3) {
        let [x, y, z] = marker else { continue };
        for (t, ((x, y), z)) in x.iter_mut().zip(y).zip(z).enumerate() {
            let moved = motion(t, Vector3::new(*x, *y, *z));
            (*x, *y, *z) = (moved.x, moved.y, moved.z);
        }
    }
}
