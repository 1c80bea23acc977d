//! The network with its state: the residual that it adds at each sample.
//!
//! In training and scoring a network processes windows of W samples, each from a state of zero. In a stream there are two
//! rules for the state:
//!
//! | [`StateRule`] | state at a sample                       | equal to                                  | steps |
//! | ------------- | --------------------------------------- | ----------------------------------------- | ----- |
//! | `Running`     | zero at the last start, then runs on    | the batch over everything since then      | 1     |
//! | `Window(W)`   | zero before the last W samples          | the scored prediction of the window there | W     |
//!
//! A start is the first sample, or the first after a gap. Both rules agree up to the W-th sample after a start. A network
//! without memory gives the same answers under both. A running state is older than any in training; whether that helps has
//! to be measured.

use acm_kernels::{Kernel, Stepper};
use serde::{Deserialize, Serialize};

/// Rule for a network's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StateRule {
    /// The state runs on from the last start: the first sample, or the first after a gap.
    Running,
    /// The state is computed from the last W samples, as in training, and not beyond the last start.
    Window(usize),
}

/// Network with its state; see the head of this file.
#[derive(Debug)]
pub(crate) struct Residual {
    stepper: Stepper,
    memory: Memory,
}

/// State that a step changes, with its value before the last step.
#[derive(Debug)]
enum Memory {
    /// The state of the network before the last step, `[layers,H]`.
    State(Vec<f32>),
    /// The samples of a window.
    Window(Kept),
}

/// The last samples of a window: channels `[W][C]` and elapsed times `[W]`, the newest before place `next`.
#[derive(Debug)]
struct Kept {
    inputs: Vec<f32>,
    elapsed: Vec<f32>,
    count: usize,
    next: usize,
    before: Before,
}

/// State before the newest sample, for undoing a step.
#[derive(Debug, Default)]
struct Before {
    inputs: Vec<f32>,
    elapsed: f32,
    count: usize,
    next: usize,
}

impl Residual {
    pub fn new(kernel: &Kernel, weights: &[f32], rule: StateRule) -> Self {
        let shape = kernel.shape();
        let memory = match rule {
            StateRule::Running => Memory::State(vec![0.0; shape.layers_with_state() * shape.features()]),
            StateRule::Window(length) => Memory::Window(Kept::new(length, shape.inputs)),
        };
        Self { stepper: kernel.stepper(weights), memory }
    }

    /// Resets the state and the window.
    pub fn restart(&mut self) {
        self.stepper.reset();
        if let Memory::Window(kept) = &mut self.memory {
            kept.clear();
        }
    }

    /// Computes standardised predictions [O] from standardised channels [C] and the elapsed time. Where a stretch
    /// `begins`, all samples before are forgotten.
    pub fn step(&mut self, begins: bool, inputs: &[f32], elapsed: f32, out: &mut [f32]) {
        let stepper = &mut self.stepper;
        match &mut self.memory {
            Memory::State(before) => {
                if !before.is_empty() {
                    stepper.state(before);
                }
                if begins {
                    stepper.reset();
                }
                stepper.step(inputs, elapsed, out);
            }
            Memory::Window(kept) => {
                kept.push(begins, inputs, elapsed);
                stepper.reset();
                for (inputs, elapsed) in kept.samples(inputs.len()) {
                    stepper.step(inputs, elapsed, out);
                }
            }
        }
    }

    /// Undoes the last step.
    pub fn undo(&mut self) {
        match &mut self.memory {
            Memory::State(before) if before.is_empty() => (),
            Memory::State(before) => self.stepper.set_state(before),
            Memory::Window(kept) => kept.undo(),
        }
    }
}

impl Kept {
    fn new(length: usize, width: usize) -> Self {
        let before = Before { inputs: vec![0.0; width], ..Before::default() };
        Self { inputs: vec![0.0; length * width], elapsed: vec![0.0; length], count: 0, next: 0, before }
    }

    fn clear(&mut self) {
        (self.count, self.next) = (0, 0);
    }

    fn push(&mut self, begins: bool, inputs: &[f32], elapsed: f32) {
        (self.before.count, self.before.next) = (self.count, self.next);
        if begins {
            self.clear();
        }
        let (length, width) = (self.elapsed.len(), inputs.len());
        let place = &mut self.inputs[self.next * width..(self.next + 1) * width];
        self.before.inputs.copy_from_slice(place);
        self.before.elapsed = self.elapsed[self.next];
        place.copy_from_slice(inputs);
        self.elapsed[self.next] = elapsed;
        self.next = (self.next + 1) % length;
        self.count = length.min(self.count + 1);
    }

    fn undo(&mut self) {
        let (length, width) = (self.elapsed.len(), self.before.inputs.len());
        let place = (self.next + length - 1) % length;
        self.inputs[place * width..(place + 1) * width].copy_from_slice(&self.before.inputs);
        self.elapsed[place] = self.before.elapsed;
        (self.count, self.next) = (self.before.count, self.before.next);
    }

    /// Returns the samples, the oldest first.
    fn samples(&self, width: usize) -> impl Iterator<Item = (&[f32], f32)> {
        let length = self.elapsed.len();
        let first = self.next + length - self.count;
        (0..self.count).map(move |k| {
            let place = (first + k) % length;
            (&self.inputs[place * width..(place + 1) * width], self.elapsed[place])
        })
    }
}
