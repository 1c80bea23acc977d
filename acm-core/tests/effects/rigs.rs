//! Rigs of several kinds, and one record of each: irregular time stamps, and signals that wander over their whole range.

use acm_core::effects::{ALL, Carrier, Effect, ParameterSpec, Site, Values};
use acm_core::fields::Field;
use acm_core::record::Record;
use acm_core::rig::{Mounting, Rig, Signal};
use nalgebra::Vector3;

/// A rig, a record of it, and its outputs.
pub struct Scene {
    pub name: &'static str,
    pub rig: Rig,
    pub record: Record,
    pub outputs: Vec<Vec<f64>>,
}

pub fn signal(name: &str, unit: &str, low: f64, high: f64) -> Signal {
    Signal { name: name.into(), unit: unit.into(), low, high }
}

/// Two tendons below a hovering vehicle, two markers.
pub fn hovering() -> Scene {
    let markers = ["x1", "y1", "z1", "x2", "y2", "z2"];
    scene(
        "hovering arm",
        Rig {
            actuators: vec![signal("q1", "rad", -0.9, 1.1), signal("q2", "rad", -0.6, 0.5)],
            contexts: vec![
                signal("throttle", "1", 0.3, 0.6),
                signal("altitude", "m", 0.2, 2.5),
                signal("vehicle", "m/s", -0.8, 0.7),
                signal("payload", "kg", 0.0, 0.05),
            ],
            outputs: markers.map(|name| signal(name, "m", -0.5, 0.4)).to_vec(),
            throttle: Some(0),
            altitude: Some(1),
            payload: Some(3),
            carried: true,
            arm: Some(Mounting { length: 0.62, down: -Vector3::z() }),
            step: 0.1,
            duration: 60.0,
        },
    )
}

/// One chamber; the position of the piston is known; a force is measured.
pub fn cylinder() -> Scene {
    scene(
        "cylinder",
        Rig {
            actuators: vec![signal("p", "Pa", 0.0, 7e5)],
            contexts: vec![signal("position", "m", 0.0, 0.04)],
            outputs: vec![signal("force", "N", -20.0, 60.0)],
            step: 0.01,
            duration: 8.0,
            ..bare()
        },
    )
}

/// Six tendons of a trunk that stands on a table.
pub fn trunk() -> Scene {
    scene(
        "trunk",
        Rig {
            actuators: (1..=6).map(|k| signal(&format!("u{k}"), "m", -0.02 - 0.005 * f64::from(k), 0.04)).collect(),
            outputs: ["x", "y", "z"].map(|name| signal(name, "m", -0.2, 0.3)).to_vec(),
            arm: Some(Mounting { length: 0.32, down: Vector3::x() }),
            step: 0.02,
            duration: 20.0,
            ..bare()
        },
    )
}

/// Actuators of three units, one of which rests; no context.
pub fn mixed() -> Scene {
    scene(
        "mixed units",
        Rig {
            actuators: vec![
                signal("angle", "rad", 1.0, 3.0),
                signal("slide", "m", -0.1, 0.1),
                signal("supply", "Pa", 6e5, 6e5),
            ],
            outputs: vec![signal("reading", "1", -1.0, 1.0), signal("other", "1", 0.0, 0.2)],
            step: 0.05,
            duration: 30.0,
            ..bare()
        },
    )
}

/// Nothing is driven; a context is all that is known.
pub fn passive() -> Scene {
    let contexts = vec![signal("load", "N", -5.0, 5.0), signal("temperature", "K", 293.0, 293.0)];
    scene("passive", Rig { contexts, outputs: vec![signal("y", "m", -1.0, 1.0)], ..bare() })
}

/// A trial of a third of a second.
pub fn short() -> Scene {
    let actuators = vec![signal("q1", "m", 0.0, 1e-4), signal("q2", "m", -1e-4, 0.0)];
    let outputs = vec![signal("x", "m", 0.0, 1e-3)];
    scene("short trial", Rig { actuators, outputs, step: 0.05, duration: 0.3, ..bare() })
}

/// All of them.
pub fn all() -> Vec<Scene> {
    vec![hovering(), cylinder(), trunk(), mixed(), passive(), short()]
}

fn bare() -> Rig {
    Rig {
        actuators: vec![],
        contexts: vec![],
        outputs: vec![],
        throttle: None,
        altitude: None,
        payload: None,
        carried: false,
        arm: None,
        step: 0.1,
        duration: 30.0,
    }
}

fn scene(name: &'static str, rig: Rig) -> Scene {
    let samples = (rig.duration / rig.step).round() as usize;
    let jitter = |k: usize| 0.4 * (0.618 * k as f64).fract();
    let time: Vec<f64> = (0..samples).map(|k| 5.0 + rig.step * (k as f64 + jitter(k))).collect();
    let all = |signals: &[Signal], first: usize| -> Vec<Vec<f64>> {
        signals.iter().enumerate().map(|(k, signal)| wander(&time, signal, first + k)).collect()
    };
    let axes = vec![signal("a", "m/s^2", -1.5, 1.5); if rig.carried { 3 } else { 0 }];
    let (actuators, contexts, acceleration) = (all(&rig.actuators, 0), all(&rig.contexts, 7), all(&axes, 13));
    let outputs = all(&rig.outputs, 17);
    Scene { name, record: Record::new(time, actuators, contexts, acceleration), outputs, rig }
}

/// A few waves of different lengths, over the whole range.
fn wander(time: &[f64], signal: &Signal, seed: usize) -> Vec<f64> {
    let whole = time[time.len() - 1] - time[0];
    let wave = |t: f64, k: usize| {
        let periods = 2.0 + 2.3 * k as f64 + 0.37 * (seed % 5) as f64;
        ((t - time[0]) / whole * periods * std::f64::consts::TAU + (seed * (k + 3)) as f64).sin()
            / (1.0 + 0.4 * k as f64)
    };
    let raw: Vec<f64> = time.iter().map(|&t| (0..5).map(|k| wave(t, k)).sum()).collect();
    let (low, high) = raw.iter().fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
    raw.iter().map(|x| signal.low + signal.span() * (x - low) / (high - low)).collect()
}

/// One effect, carried in one way, on one scene.
pub struct Case<'a> {
    pub effect: &'static dyn Effect,
    pub carrier: Carrier,
    pub scene: &'a Scene,
    pub specs: Vec<ParameterSpec>,
    pub starts: Vec<Vec<f64>>,
}

/// Every effect in every way that it can act on these scenes.
pub fn cases(scenes: &[Scene]) -> Vec<Case<'_>> {
    let mut cases = vec![];
    for scene in scenes {
        for &effect in ALL {
            for carrier in effect.carriers(&scene.rig) {
                let (specs, starts) =
                    (effect.parameters(&scene.rig, carrier), effect.initial_guesses(&scene.rig, carrier));
                cases.push(Case { effect, carrier, scene, specs, starts });
            }
        }
    }
    cases
}

impl Case<'_> {
    pub fn label(&self) -> String {
        format!("{} by {:?} on the {}", self.effect.name(), self.carrier, self.scene.name)
    }

    /// The columns that reach the effect.
    pub fn columns(&self) -> Vec<Vec<f64>> {
        match self.effect.site() {
            Site::Actuation => self.scene.record.actuators.clone(),
            Site::Load | Site::Marker => vec![vec![0.0; self.scene.record.samples()]; Field::ALL.len()],
            Site::Frame | Site::Output => self.scene.outputs.clone(),
        }
    }

    /// What it makes of them.
    pub fn act(&self, theta: &[f64]) -> Vec<Vec<f64>> {
        self.act_on(theta, &self.scene.record, self.columns())
    }

    pub fn act_on(&self, theta: &[f64], record: &Record, mut columns: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        self.effect.act(self.carrier, Values::constant(&self.specs, theta), record, &mut columns);
        columns
    }

    pub fn neutral(&self) -> Vec<f64> {
        self.specs.iter().map(|spec| spec.neutral).collect()
    }
}
