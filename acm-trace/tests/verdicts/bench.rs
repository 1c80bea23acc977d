//! Cases of every kind, from motions and a formula for what is measured.

use acm_core::arm::ArmSpec;
use acm_core::nominal::NominalSpec;
use acm_core::record::Record;
use acm_core::registration::RegistrationSpec;
use acm_core::rig::{Mounting, Rig, Signal};
use acm_core::strain::StrainBasis;
use acm_trace::case::{Case, Trial};
use acm_trace::close::{About, Closed, close};
use acm_trace::finding::{Data, Finding, FoundEffect, FoundParameter};
use acm_trace::holdout::Holdout;
use acm_trace::trace::Options;
use nalgebra::{DMatrix, Vector3};
use rand::RngExt;

use crate::motion::{Motion, normal, random};

pub const STEP: f64 = 0.1;

/// Noise of each coordinate of the tip, m.
pub const NOISE: f64 = 1e-3;

/// Noise of a force, N.
pub const FORCE_NOISE: f64 = 0.05;

const LENGTH: f64 = 0.62;

/// The tip of an arm of constant curvature that hangs from the origin, m:
///
/// ```text
/// φ = |k|,   tip = L (k_x (1 − cos φ)/φ², k_y (1 − cos φ)/φ², −sin φ/φ),   k straight in q
/// ```
pub fn tip(q: [f64; 2]) -> [f64; 3] {
    let k = [0.55 * q[0] + 0.06 * q[1], 0.75 * q[1] - 0.08 * q[0]];
    let phi = k[0].hypot(k[1]);
    let (side, along) =
        if phi > 1e-4 { ((1.0 - phi.cos()) / (phi * phi), phi.sin() / phi) } else { (0.5, 1.0 - phi * phi / 6.0) };
    [LENGTH * k[0] * side, LENGTH * k[1] * side, -LENGTH * along]
}

/// What is known of a rig before anything moves: names and units.
#[derive(Debug, Clone)]
pub struct Bench {
    pub actuators: usize,
    pub contexts: Vec<[&'static str; 2]>,
    pub outputs: Vec<[&'static str; 2]>,
    pub nominal: NominalSpec,
    /// Standard deviation of the noise in each output.
    pub noise: Vec<f64>,
}

/// A case and its held-out trials.
pub struct Recorded {
    pub case: Case,
    pub held_out: Vec<Trial>,
}

/// What moves in one trial.
#[derive(Debug)]
pub struct Drive {
    pub index: usize,
    pub time: Vec<f64>,
    pub motion: Vec<Motion>,
    pub contexts: Vec<Vec<f64>>,
    pub seed: u64,
}

impl Drive {
    /// Actuators as recorded, A columns.
    pub fn q(&self) -> Vec<Vec<f64>> {
        self.motion.iter().map(|motion| self.time.iter().map(|t| motion.at(*t)).collect()).collect()
    }

    /// Actuators after `effect`, A columns.
    pub fn after(&self, effect: impl Fn(&[f64], &Motion) -> Vec<f64>) -> Vec<Vec<f64>> {
        self.motion.iter().map(|motion| effect(&self.time, motion)).collect()
    }
}

/// Two actuators bend an arm; the tip is measured.
pub fn arm() -> Bench {
    let registration = RegistrationSpec::Fixed { rotation: [0.0; 3], translation: [0.0; 3] };
    let strain = StrainBasis::Legendre { order: 0 };
    Bench {
        actuators: 2,
        contexts: vec![],
        outputs: vec![["x", "m"], ["y", "m"], ["z", "m"]],
        nominal: NominalSpec::Strain(ArmSpec { degree: 1, strain, registration, ..ArmSpec::default() }),
        noise: vec![NOISE; 3],
    }
}

/// Columns of the tip for columns of two actuators.
pub fn tips(q: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..3).map(|o| q[0].iter().zip(&q[1]).map(|(a, b)| tip([*a, *b])[o]).collect()).collect()
}

/// One actuator presses with a force, N.
pub fn press(contexts: Vec<[&'static str; 2]>) -> Bench {
    Bench {
        actuators: 1,
        contexts,
        outputs: vec![["force", "N"]],
        nominal: NominalSpec::Polynomial { degree: 3 },
        noise: vec![FORCE_NOISE],
    }
}

/// What it presses with at rest, N.
pub fn force(q: f64) -> f64 {
    1.0 + 10.0 * q + 3.0 * q * q - 2.0 * q * q * q
}

impl Bench {
    /// Trial `index` under fresh motions; conditions are constant in it.
    pub fn drive(&self, index: usize, samples: usize, seed: u64, conditions: &[f64]) -> Drive {
        let seed = 1000 * seed + index as u64;
        let mut random = random(seed);
        Drive {
            index,
            time: (0..samples).map(|t| STEP * t as f64).collect(),
            motion: (0..self.actuators).map(|_| Motion::new(&mut random)).collect(),
            contexts: conditions.iter().map(|c| vec![*c; samples]).collect(),
            seed,
        }
    }

    /// A recorded trial: `outputs` (M columns) and noise.
    pub fn trial(&self, part: &str, drive: &Drive, outputs: &[Vec<f64>]) -> Trial {
        let mut random = random(drive.seed + 1_000_000);
        let samples = drive.time.len();
        let measured =
            DMatrix::from_fn(samples, self.outputs.len(), |t, o| outputs[o][t] + self.noise[o] * normal(&mut random));
        let record = Record::new(drive.time.clone(), drive.q(), drive.contexts.clone(), vec![]);
        Trial { name: format!("{part}{}", drive.index), record, lead: None, measured, predicted: None, offset: None }
    }

    /// Settled poses all over the range of the actuators, five seconds apart, as no effect with memory shows in them.
    pub fn poses(&self, index: usize, samples: usize, outputs: impl Fn(&[Vec<f64>]) -> Vec<Vec<f64>>) -> Trial {
        let mut random = random(77_000 + index as u64);
        let time: Vec<f64> = (0..samples).map(|t| 5.0 * t as f64).collect();
        let mut draw = || (0..samples).map(|_| random.random_range(-0.95..0.95)).collect::<Vec<f64>>();
        let q: Vec<Vec<f64>> = (0..self.actuators).map(|_| draw()).collect();
        let y = outputs(&q);
        let measured =
            DMatrix::from_fn(samples, self.outputs.len(), |t, o| y[o][t] + self.noise[o] * normal(&mut random));
        let record = Record::new(time, q, self.contexts.iter().map(|_| vec![0.5; samples]).collect(), vec![]);
        Trial { name: format!("poses{index}"), record, lead: None, measured, predicted: None, offset: None }
    }

    /// The parts of a campaign, together.
    pub fn case(&self, calibration: Vec<Trial>, development: Vec<Trial>, held_out: Vec<Trial>) -> Recorded {
        let all = || calibration.iter().chain(&development);
        let signal = |[name, unit]: [&str; 2], of: &dyn Fn(&Trial) -> Vec<f64>| {
            let values: Vec<f64> = all().flat_map(of).collect();
            let (low, high) =
                values.iter().fold((f64::INFINITY, -f64::INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
            Signal { name: name.into(), unit: unit.into(), low, high }
        };
        let names: Vec<String> = (1..=self.actuators).map(|a| format!("q{a}")).collect();
        let is_arm = matches!(self.nominal, NominalSpec::Strain(_));
        let longest = development.iter().map(|trial| trial.record.samples()).max().unwrap_or(0);
        let rig = Rig {
            actuators: (0..self.actuators)
                .map(|a| signal([names[a].as_str(), "rad"], &|trial| trial.record.actuators[a].clone()))
                .collect(),
            contexts: (0..self.contexts.len())
                .map(|e| signal(self.contexts[e], &|trial| trial.record.contexts[e].clone()))
                .collect(),
            outputs: (0..self.outputs.len())
                .map(|o| signal(self.outputs[o], &|trial| trial.measured.column(o).iter().copied().collect()))
                .collect(),
            throttle: None,
            altitude: None,
            payload: None,
            carried: false,
            arm: is_arm.then(|| Mounting { length: LENGTH, down: -Vector3::z() }),
            step: STEP,
            duration: STEP * longest as f64,
        };
        let at = if is_arm { vec![1.0] } else { vec![] };
        let (nominal, reported) = (self.nominal.clone(), 0..self.outputs.len());
        let case = Case { rig, nominal, at, reported, calibration, development };
        Recorded { case, held_out }
    }
}

/// An arm's campaign: three trials of settled poses calibrate it, six show what `measured` does, two are held out.
pub fn arm_case(seed: u64, measured: impl Fn(&Drive) -> Vec<Vec<f64>>) -> Recorded {
    let bench = arm();
    let trial = |part: &str, k: usize| {
        let drive = bench.drive(k, 250, seed, &[]);
        bench.trial(part, &drive, &measured(&drive))
    };
    let poses = (0..3).map(|k| bench.poses(k, 60, tips)).collect();
    bench.case(poses, (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect())
}

/// A press's campaign without calibration trials: six trials show what `measured` does, two are held out.
pub fn press_case(seed: u64, measured: impl Fn(&Drive) -> Vec<f64>) -> Recorded {
    let bench = press(vec![]);
    let trial = |part: &str, k: usize| {
        let drive = bench.drive(k, 250, seed, &[]);
        bench.trial(part, &drive, &[measured(&drive)])
    };
    bench.case(vec![], (0..6).map(|k| trial("d", k)).collect(), (6..8).map(|k| trial("u", k)).collect())
}

pub fn about() -> About {
    let data = Data {
        name: "bench".into(),
        title: "Planted".into(),
        hash: "00".into(),
        synthetic: true,
        calibration: vec![],
        development: vec![],
        held_out: vec![],
    };
    About { data, configuration: serde_json::Value::Null, version: "0".into(), cautions: vec![], clock_interval: 0.0 }
}

pub fn closed_with(case: Recorded, options: &Options) -> Closed {
    let closed = close(case.case, &Holdout::new(case.held_out), about(), options, |_| ()).unwrap();
    println!("{:.2} s: {}", closed.finding.seconds, told(&closed.finding));
    closed
}

pub fn found(case: Recorded) -> Finding {
    closed_with(case, &Options::default()).finding
}

/// For the message of a test that fails.
pub fn told(finding: &Finding) -> String {
    let steps: Vec<String> = finding.steps.iter().map(|step| format!("{} {:.3}", step.model, step.error)).collect();
    let (removed, left) = (finding.removed, finding.left.rms);
    let verdict = finding.verdict;
    format!(
        "{verdict:?} {} [{}], removed {removed:?}, left {left:.3}, {:?}",
        finding.sentence,
        steps.join("; "),
        finding.symbolic
    )
}

pub fn names(finding: &Finding) -> Vec<&str> {
    finding.effects.iter().map(|effect| effect.name.as_str()).collect()
}

pub fn effect<'f>(finding: &'f Finding, name: &str) -> &'f FoundEffect {
    let found = finding.effects.iter().find(|effect| effect.name == name);
    found.unwrap_or_else(|| panic!("no {name}: {}", told(finding)))
}

pub fn parameter<'f>(effect: &'f FoundEffect, name: &str) -> &'f FoundParameter {
    let found = effect.parameters.iter().find(|parameter| parameter.name == name);
    found.unwrap_or_else(|| panic!("no {name} in {:?}", effect.parameters))
}

pub fn covers(parameter: &FoundParameter, truth: f64) -> bool {
    (parameter.interval[0]..=parameter.interval[1]).contains(&truth)
}

/// Whether the error on held-out trials is what noise alone makes.
pub fn is_near(finding: &Finding, noise: f64) -> bool {
    (finding.errors.after.value / noise - 1.0).abs() < 0.1
}
