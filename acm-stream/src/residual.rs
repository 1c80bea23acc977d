//! The network on its way: what it adds to the nominal model at each sample.
//!
//! Training and scoring show a network windows of W samples, each from a state of zero. Beside a robot there are two ways
//! to have a state:
//!
//! | [`StateRule`] | state at a sample                       | equal to                                  | steps |
//! | ------------- | --------------------------------------- | ----------------------------------------- | ----- |
//! | `Running`     | zero at the last start, then runs on    | the batch over everything since then      | 1     |
//! | `Window(W)`   | zero before the last W samples          | the scored prediction of the window there | W     |
//!
//! A start is the first sample, or the first after a gap. Both agree up to the W-th sample after one. A network without
//! memory answers alike under either. A state that runs on is older than any that the network was trained with: what that
//! costs or gains is a matter of measurement.

use acm_kernels::Stepper;
use serde::{Deserialize, Serialize};

/// How far back a network's state reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StateRule {
    /// To the last start: the first sample, or the first after a gap.
    Running,
    /// Over this many samples, as in training, and not beyond the last start.
    Window(usize),
}

/// See the head of this file.
#[derive(Debug)]
pub(crate) struct Residual {
    stepper: Stepper,
    /// Under a window, the last samples: channels [W][C] and elapsed times [W], the newest before place `next`.
    kept: Option<Kept>,
}

#[derive(Debug)]
struct Kept {
    inputs: Vec<f32>,
    elapsed: Vec<f32>,
    count: usize,
    next: usize,
}

impl Residual {
    pub fn new(stepper: Stepper, channels: usize, rule: StateRule) -> Self {
        let kept = match rule {
            StateRule::Running => None,
            StateRule::Window(length) => {
                Some(Kept { inputs: vec![0.0; length * channels], elapsed: vec![0.0; length], count: 0, next: 0 })
            }
        };
        Self { stepper, kept }
    }

    /// Forgets all samples.
    pub fn restart(&mut self) {
        self.stepper.reset();
        if let Some(kept) = &mut self.kept {
            (kept.count, kept.next) = (0, 0);
        }
    }

    /// Standardised channels [C] and elapsed time to standardised predictions [O].
    pub fn step(&mut self, inputs: &[f32], elapsed: f32, out: &mut [f32]) {
        let Some(kept) = &mut self.kept else { return self.stepper.step(inputs, elapsed, out) };
        kept.push(inputs, elapsed);
        self.stepper.reset();
        for (inputs, elapsed) in kept.samples(inputs.len()) {
            self.stepper.step(inputs, elapsed, out);
        }
    }
}

impl Kept {
    fn push(&mut self, inputs: &[f32], elapsed: f32) {
        let (length, width) = (self.elapsed.len(), inputs.len());
        self.inputs[self.next * width..(self.next + 1) * width].copy_from_slice(inputs);
        self.elapsed[self.next] = elapsed;
        self.next = (self.next + 1) % length;
        self.count = length.min(self.count + 1);
    }

    /// The oldest first.
    fn samples(&self, width: usize) -> impl Iterator<Item = (&[f32], f32)> {
        let length = self.elapsed.len();
        let first = self.next + length - self.count;
        (0..self.count).map(move |k| {
            let place = (first + k) % length;
            (&self.inputs[place * width..(place + 1) * width], self.elapsed[place])
        })
    }
}
