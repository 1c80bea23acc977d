//! Actions of a mechanism: move the actuators, push the arm, tilt it, shift the measurement.
//!
//! ```text
//! q → actuate → rod (tilt, push) → see → filter → + noise
//! ```

use super::course::Course;
use super::quiet::{Rig, Tip};
use super::truth::Parameter;
use crate::twin::mechanics::rod::Chain;
use nalgebra::{Rotation3, Vector3};

/// One instant of a trial.
#[derive(Clone, Copy)]
pub struct Now<'a> {
    /// Course of the trial.
    pub course: &'a Course,
    /// Constants of the arm.
    pub rig: &'a Rig,
    /// Time, s.
    pub time: f64,
}

impl Now<'_> {
    /// Returns the throttle now, or `ago` seconds before.
    pub fn throttle(&self, ago: f64) -> f64 {
        self.course.at(&self.course.throttle, self.time - ago)
    }

    /// Returns the altitude now, m.
    pub fn altitude(&self) -> f64 {
        self.course.at(&self.course.altitude, self.time)
    }

    /// Returns the reading of an actuator now, rad.
    pub fn actuator(&self, j: usize) -> f64 {
        self.course.at(&self.course.actuators[j], self.time)
    }

    /// Returns the horizontal acceleration of the vehicle now, m/s².
    pub fn acceleration(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.course.at(&self.course.acceleration[axis], self.time))
    }
}

/// Smallest and largest reading of each actuator in the trials that a model is fitted to, rad.
pub type Ranges = [[f64; 2]; 2];

/// An undeclared mechanism. Methods that it does not define change nothing.
pub trait Mechanism: Sync + Send {
    /// Moves the actuators: courses on the grid, in place.
    fn actuate(&self, _course: &Course, _actuators: &mut [Vec<f64>; 2]) {}

    /// Adds forces at the joint centres and (last) the tip of an arm of this shape, N.
    fn push(&self, _now: &Now, _arm: &Chain, _forces: &mut [Vector3<f64>]) {}

    /// Returns whether the forces depend on the shape.
    fn shaped(&self) -> bool {
        false
    }

    /// Returns the attitude of the vehicle.
    fn tilt(&self, _now: &Now) -> Rotation3<f64> {
        Rotation3::identity()
    }

    /// Changes the measured tip.
    fn see(&self, _now: &Now, _tip: &mut Tip) {}

    /// Filters the course of the measured tip on the grid, in place; only called where [`Mechanism::filters`].
    fn filter(&self, _tips: &mut [Vec<f64>; 3]) {}

    /// Returns whether it needs the whole course of the tip.
    fn filters(&self) -> bool {
        false
    }

    /// Returns the values that the effect library has a counterpart for, where the actuators cover these ranges.
    fn parameters(&self, _ranges: &Ranges) -> Vec<Parameter> {
        Vec::new()
    }

    /// Returns further effects of the library whose formula becomes this one for some of their values.
    fn contained_in(&self) -> &'static [&'static str] {
        &[]
    }

    /// Returns equation and numbers, for the reader of the truth.
    fn formula(&self) -> String;
}
