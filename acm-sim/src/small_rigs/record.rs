//! Simulation of a small rig from kind and seed: inputs on a fine grid, plant, clocks, encoders, noise.

use super::bench::{Bench, Input, Ports, spread};
use super::draw::Draw;
use super::drive::Drive;
use super::kind::Kind;
use super::motion::Motion;
use super::plan::Plan;
use super::recorded::{Recorded, SimTrial, Truth};
use crate::role::Role;

/// Purpose number of the rig's random stream; trials follow.
const OF_THE_RIG: u64 = 0;
const OF_TRIALS: u64 = 16;
/// First purpose number of the random streams of outputs and noise redraws.
const OF_OUTPUTS: u64 = 1 << 20;
const REDRAWN: u64 = 1 << 21;
/// Number of knots of the truth in a sampling period.
const FINE: f64 = 8.0;
/// Ratio of the speed of actuators to that of contexts.
const SLOWER: f64 = 4.0;

/// Makes the rig of a kind and a seed, and records it. The same seed gives the same bits.
pub fn simulate(kind: Kind, seed: u64) -> Recorded {
    Made::new(kind, seed).record(0)
}

/// A rig that has moved, before anything is read off.
pub struct Made {
    kind: Kind,
    seed: u64,
    plan: Plan,
    ports: Ports,
    /// Stamps of each trial, s.
    stamps: Vec<Vec<f64>>,
    drives: Vec<Drive>,
    bench: Bench,
    clean: Vec<Vec<f64>>,
    noise: Noise,
}

impl Made {
    /// Returns the rig of a kind and a seed.
    pub fn new(kind: Kind, seed: u64) -> Self {
        let mut draw = Draw::new(kind.number(), seed, OF_THE_RIG);
        let plan = Plan::new(kind.subject(), &mut draw);
        let ports = kind.ports(&mut draw);
        let joint = kind.joint(&mut draw);
        let stream = |trial: usize, purpose| stream(kind, seed, trial, purpose);
        let clocks: Vec<_> =
            plan.trials.iter().enumerate().map(|(k, (_, duration))| plan.clock(*duration, &mut stream(k, 0))).collect();
        let drives: Vec<Drive> = (0..clocks.len())
            .map(|k| drive(&plan, &ports, joint, plan.trials[k].1, &clocks[k].0, &mut stream(k, 1)))
            .collect();
        let bench = kind.build(&ports, &plan, joint, &drives[0], &mut draw);
        let values = bench.plant.values();
        let clean: Vec<Vec<f64>> = drives.iter().map(|drive| bench.plant.respond(&values, drive)).collect();
        let noise = Noise::new(&plan, &clean);
        let stamps = clocks.into_iter().map(|(_, stamps)| stamps).collect();
        Self { kind, seed, plan, ports, stamps, drives, bench, clean, noise }
    }

    /// Returns the readings of the instruments: the recording, and for other numbers up to 1000 the same motion with
    /// noise of encoders and output drawn again.
    pub fn record(&self, redraw: u64) -> Recorded {
        let signals = |inputs: &[Input]| inputs.iter().map(|input| input.signal.clone()).collect();
        Recorded {
            name: format!("{}-{}", self.kind.name(), self.seed),
            title: self.ports.title.into(),
            actuators: signals(&self.ports.actuators),
            contexts: signals(&self.ports.contexts),
            outputs: vec![self.ports.output.clone()],
            trials: (0..self.clean.len()).map(|trial| self.trial(trial, REDRAWN * redraw)).collect(),
            truth: Truth {
                causes: self.bench.causes.clone(),
                noise: vec![self.noise.total()],
                plant: self.bench.plant.clone(),
            },
        }
    }

    fn trial(&self, k: usize, first: u64) -> SimTrial {
        let stream = |purpose| stream(self.kind, self.seed, k, first + purpose);
        let output = &mut Draw::new(self.kind.number(), self.seed, first + OF_OUTPUTS + k as u64);
        let (plan, drive) = (&self.plan, &self.drives[k]);
        SimTrial {
            name: (k + 1).to_string(),
            role: plan.trials[k].0,
            time: self.stamps[k].clone(),
            actuators: read(&self.ports.actuators, drive, &drive.actuators, plan, &mut stream(2)),
            contexts: read(&self.ports.contexts, drive, &drive.contexts, plan, &mut stream(3)),
            outputs: vec![self.noise.measured(&self.clean[k], output)],
        }
    }
}

/// Returns the stream of a trial for a purpose.
fn stream(kind: Kind, seed: u64, trial: usize, purpose: u64) -> Draw {
    Draw::new(kind.number(), seed, OF_TRIALS + 4 * trial as u64 + purpose)
}

/// Returns the inputs of one trial on the fine grid.
fn drive(plan: &Plan, ports: &Ports, joint: Option<usize>, duration: f64, taken: &[f64], draw: &mut Draw) -> Drive {
    let fine = plan.step / FINE;
    let time: Vec<f64> = (0..(duration / fine) as usize + 2 * FINE as usize).map(|k| fine * k as f64).collect();
    let mut course = |input: &Input, pace: f64| -> Vec<f64> {
        let motion = Motion::new(plan.style, input.low, input.high, pace, duration, draw);
        time.iter().map(|t| motion.at(*t)).collect()
    };
    let actuators = ports.actuators.iter().map(|input| course(input, plan.pace)).collect();
    let contexts = ports.contexts.iter().map(|input| course(input, SLOWER * plan.pace)).collect();
    let drive = Drive { time, actuators, contexts, asked: taken.to_vec(), motion: [const { vec![] }; 3] };
    match joint {
        Some(joint) => drive.with_motion(joint, 2.0 * fine),
        None => drive,
    }
}

/// Returns the inputs as the encoders read them.
fn read(inputs: &[Input], drive: &Drive, courses: &[Vec<f64>], plan: &Plan, draw: &mut Draw) -> Vec<Vec<f64>> {
    let one = |(input, course): (&Input, &Vec<f64>)| {
        let step = input.range() / 2f64.powi(plan.bits);
        let noisy = |value: f64| ((value / step + plan.encoder * draw.normal()).round()) * step;
        drive.ask(course).into_iter().map(noisy).collect()
    };
    inputs.iter().zip(courses).map(one).collect()
}

/// Noise of the output: white, then rounded.
struct Noise {
    white: f64,
    step: f64,
}

impl Noise {
    /// Returns noise in proportion to the variation of the clean output in development.
    fn new(plan: &Plan, clean: &[Vec<f64>]) -> Self {
        let seen = clean.iter().zip(&plan.trials).filter(|(_, (role, _))| *role == Role::Development);
        let white = plan.noise * spread(&seen.flat_map(|(output, _)| output.iter().copied()).collect::<Vec<f64>>());
        Self { white, step: plan.digit * white }
    }

    /// Returns the standard deviation of both.
    fn total(&self) -> f64 {
        self.white.hypot(self.step / 12f64.sqrt())
    }

    fn measured(&self, clean: &[f64], draw: &mut Draw) -> Vec<f64> {
        let step = self.step.max(f64::MIN_POSITIVE);
        clean.iter().map(|y| ((y + self.white * draw.normal()) / step).round() * step).collect()
    }
}
