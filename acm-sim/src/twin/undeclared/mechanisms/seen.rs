//! Mechanisms of the mount, the marker and the instrument.
//!
//! | mechanism | equation |
//! | --- | --- |
//! | leaning vehicle | attitude turned by atan(k·a/g) about e_z × a, with the weight of the arm staying vertical |
//! | marker on a stalk | p + R·d + 0.15·ǀdǀ·(−e_z)·sin²(arm, vertical): the stalk sags where the arm lies flat |
//! | bumped camera | p_0 + Rot(w)·(p − p_0) + t, p_0 a place in the room |
//! | stretched lens | p·(1 + s·(1 + 0.15·(ǀpǀ²/L² − ½))) |
//! | tracker | mean of five frames at 100 Hz, then y_k = y_{k−1} + α·(x_k − y_{k−1}) |
//! | warming tracker | p + d·(1 − e^(−t/T))/(1 − e^(−50 s/T)) |

use crate::twin::undeclared::course::STEP;
use crate::twin::undeclared::mechanism::{Mechanism, Now, Ranges};
use crate::twin::undeclared::quiet::Tip;
use crate::twin::undeclared::truth::Parameter;
use nalgebra::{Rotation3, Unit, Vector3};

/// A vehicle that leans as it accelerates.
pub struct Leaning {
    /// Ratio of the tangent of the tilt to that of the balancing tilt, 1.
    pub share: f64,
}

impl Mechanism for Leaning {
    fn tilt(&self, now: &Now) -> Rotation3<f64> {
        let [x, y] = now.acceleration();
        let axis = Vector3::new(-y, x, 0.0);
        match Unit::try_new(axis, 1e-12) {
            Some(unit) => {
                let gravity = now.rig.settings.arm.gravity;
                Rotation3::from_axis_angle(&unit, (self.share * axis.norm() / gravity).atan())
            }
            None => Rotation3::identity(),
        }
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        // Weight, which stays vertical, takes some of the lean back.
        vec![Parameter::new("gain", self.share, "1", 0.3 * self.share)]
    }

    fn formula(&self) -> String {
        format!("leans by atan({:.4}·a/g)", self.share)
    }
}

/// A marker that is not where it was.
pub struct Stalk {
    /// Place on the tip, in the tip's frame, m.
    pub offset: Vector3<f64>,
}

impl Mechanism for Stalk {
    fn see(&self, _: &Now, tip: &mut Tip) {
        let along = tip.turn * Vector3::z();
        tip.place += tip.turn * self.offset;
        tip.place.z -= 0.15 * self.offset.norm() * (1.0 - along.z * along.z);
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        // Half a turn about x lies between the tip's frame and the world's where the arm hangs straight.
        let tolerance = 0.3 * self.offset.norm();
        let one =
            |(name, sign, axis): (&str, f64, usize)| Parameter::new(name, sign * self.offset[axis], "m", tolerance);
        [("dx", 1.0, 0), ("dy", -1.0, 1), ("dz", -1.0, 2)].map(one).into()
    }

    fn formula(&self) -> String {
        let [x, y, z] = [0, 1, 2].map(|axis| 1e3 * self.offset[axis]);
        format!("marker at ({x:.2}, {y:.2}, {z:.2}) mm of the tip's frame, on a stalk that sags")
    }
}

/// Cameras that were bumped.
pub struct Bumped {
    /// Rotation vector, rad.
    pub turn: Vector3<f64>,
    /// Translation, m.
    pub shift: Vector3<f64>,
}

/// Point about which the cameras turn, m.
const PIVOT: [f64; 3] = [0.1, -0.05, -0.3];

impl Mechanism for Bumped {
    fn see(&self, _: &Now, tip: &mut Tip) {
        let pivot = Vector3::from(PIVOT);
        tip.place = pivot + Rotation3::new(self.turn) * (tip.place - pivot) + self.shift;
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        let pivot = Vector3::from(PIVOT);
        let shift = pivot - Rotation3::new(self.turn) * pivot + self.shift;
        let mut all = Vec::new();
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            all.push(Parameter::new(format!("r{name}"), self.turn[axis], "rad", 3e-3));
            all.push(Parameter::new(format!("t{name}"), shift[axis], "m", 2e-3));
        }
        all
    }

    fn formula(&self) -> String {
        let degrees = self.turn * 180.0 / std::f64::consts::PI;
        let shift = 1e3 * self.shift;
        format!(
            "turned by ({:.3}, {:.3}, {:.3})° about a point of the room and moved by ({:.2}, {:.2}, {:.2}) mm",
            degrees.x, degrees.y, degrees.z, shift.x, shift.y, shift.z
        )
    }
}

/// A measure that is too long, more so far out.
pub struct Stretched {
    /// Relative error half an arm's length out, 1.
    pub scale: f64,
}

impl Mechanism for Stretched {
    fn see(&self, now: &Now, tip: &mut Tip) {
        let far = tip.place.norm_squared() / now.rig.settings.arm.length.powi(2);
        tip.place *= 1.0 + self.scale * (1.0 + 0.15 * (far - 0.5));
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        vec![Parameter::new("scale", self.scale, "1", 0.15 * self.scale.abs() + 0.003)]
    }

    fn formula(&self) -> String {
        format!("too long by {:.5} half an arm's length out", self.scale)
    }
}

/// A tracker that averages and smooths.
pub struct Tracker {
    /// Time of the smoother, s.
    pub time: f64,
}

impl Mechanism for Tracker {
    fn filter(&self, tips: &mut [Vec<f64>; 3]) {
        let share = STEP / (self.time + STEP);
        for course in tips {
            let frames = course.clone();
            let mut smooth = course[0];
            for n in 0..frames.len() {
                let near = &frames[n.saturating_sub(4)..=n];
                smooth += share * (near.iter().sum::<f64>() / near.len() as f64 - smooth);
                course[n] = smooth;
            }
        }
    }

    fn filters(&self) -> bool {
        true
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        // Two frames of averaging, and the smoother's own lag.
        let lag = self.time + 2.0 * STEP;
        vec![Parameter::new("tau", lag, "s", 0.15 * lag + 0.01)]
    }

    fn formula(&self) -> String {
        format!("mean of five frames at 100 Hz and an exponential smoother of {:.4} s", self.time)
    }
}

/// A tracker that warms up.
pub struct Drifting {
    /// Displacement in 50 s, m.
    pub way: Vector3<f64>,
    /// Time of warming, s.
    pub time: f64,
}

impl Mechanism for Drifting {
    fn see(&self, now: &Now, tip: &mut Tip) {
        tip.place += self.way * ((-now.time.max(0.0) / self.time).exp_m1() / (-50.0 / self.time).exp_m1());
    }

    fn parameters(&self, _: &Ranges) -> Vec<Parameter> {
        let one = |(axis, name): (usize, &str)| {
            Parameter::new(format!("rate_{name}"), self.way[axis] / 50.0, "m/s", 0.25 * self.way.norm() / 50.0)
        };
        ["x", "y", "z"].into_iter().enumerate().map(one).collect()
    }

    fn formula(&self) -> String {
        let way = 1e3 * self.way;
        format!("drifts by ({:.2}, {:.2}, {:.2}) mm in 50 s, in {:.1} s by 63 %", way.x, way.y, way.z, self.time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twin::undeclared::course::trial_of;
    use crate::twin::undeclared::quiet::Rig;

    fn seen(mechanism: &dyn Mechanism, place: Vector3<f64>, time: f64) -> Vector3<f64> {
        let (course, rig) = (trial_of(&|_| 0.0), Rig::new([0.0; 2]));
        let mut tip = Tip { place, turn: Rotation3::identity() };
        mechanism.see(&Now { course: &course, rig: &rig, time }, &mut tip);
        tip.place
    }

    /// Oracle: rotation vector and translation about the origin, as the truth states them, put the point where it is seen.
    #[test]
    fn bumped_camera_is_a_motion_about_the_origin_as_stated() {
        let bump = Bumped { turn: Vector3::new(0.02, -0.03, 0.01), shift: Vector3::new(0.002, 0.0, -0.001) };
        let stated = bump.parameters(&[[0.0; 2]; 2]);
        let of = |name: &str| stated.iter().find(|p| p.name == name).map_or(f64::NAN, |p| p.value);
        let place = Vector3::new(0.3, -0.1, -0.4);
        let turn = Rotation3::new(Vector3::new(of("rx"), of("ry"), of("rz")));
        let expected = turn * place + Vector3::new(of("tx"), of("ty"), of("tz"));
        assert!((seen(&bump, place, 0.0) - expected).norm() < 1e-12);
    }

    /// Oracle: hand arithmetic at half an arm's length squared, at the start and after 50 s, and for an arm that hangs.
    #[test]
    fn marker_lens_and_tracker_by_hand() {
        let place = Vector3::new(0.0, 0.62 * 0.5f64.sqrt(), 0.0);
        assert!((seen(&Stretched { scale: 0.05 }, place, 0.0) - 1.05 * place).norm() < 1e-12);
        let drift = Drifting { way: Vector3::new(0.01, 0.02, 0.0), time: 80.0 };
        assert_eq!(seen(&drift, place, 0.0), place);
        assert!((seen(&drift, place, 50.0) - place - drift.way).norm() < 1e-12);
        let stalk = Stalk { offset: Vector3::new(0.01, 0.0, 0.005) };
        assert!((seen(&stalk, place, 0.0) - place - stalk.offset).norm() < 1e-12);
    }

    /// Oracle: a vehicle that accelerates along x leans towards x: what hangs below it swings to −x.
    #[test]
    fn vehicle_leans_into_its_acceleration() {
        let mut course = trial_of(&|_| 0.0);
        course.acceleration = [vec![1.0; course.throttle.len()], vec![0.0; course.throttle.len()]];
        let rig = Rig::new([0.0; 2]);
        let turn = Leaning { share: 1.0 }.tilt(&Now { course: &course, rig: &rig, time: 3.0 });
        let below = turn * Vector3::new(0.0, 0.0, -1.0);
        assert!((below.x / below.z - 1.0 / 9.81).abs() < 1e-9 && below.x < 0.0, "{below}");
    }

    /// Oracle: a ramp is late by the stated lag.
    #[test]
    fn tracker_is_late_by_the_stated_lag() {
        let tracker = Tracker { time: 0.2 };
        let ramp: Vec<f64> = (0..6000).map(|n| 0.3 * STEP * f64::from(n)).collect();
        let mut tips = [ramp.clone(), ramp.clone(), ramp.clone()];
        tracker.filter(&mut tips);
        let lag = &tracker.parameters(&[[0.0; 2]; 2])[0];
        assert!(((ramp[5000] - tips[0][5000]) / 0.3 - lag.value).abs() < 1e-6);
    }
}
