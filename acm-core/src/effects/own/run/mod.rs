//! A plan evaluated over a trial: columns side by side, a block of samples at a time.
//!
//! Register r holds sample k of column l at r·stride + k·L + l, where L columns are acted on alike. Constants are computed once,
//! what depends on no state for the whole block, and states sample by sample.

mod linear;
mod runge_kutta;
mod states;

use std::ops::Range;

use super::plan::{Form, Plan};
use super::program::{Class, run};
use crate::effects::Values;
use crate::effects::memory::{Derivatives, State};

/// Samples of a block: few enough for the registers to stay near the processor.
const BLOCK: usize = 64;

/// State between two pieces of a trial, and work buffers.
#[derive(Debug, Default)]
pub struct Track {
    pub(super) begun: bool,
    /// Of the sample before.
    time: f64,
    /// Of the sample before: states, and base registers, each for all columns.
    pub(super) states: Vec<f64>,
    pub(super) base: Vec<f64>,
    /// Of each input that is a derivative.
    pub derivatives: Vec<Derivatives>,
    pub derived: Vec<Vec<f64>>,
    pub(super) buffer: Vec<f64>,
    /// Registers at one moment between two samples, and stages of a Runge–Kutta step.
    point: Vec<f64>,
    stages: Vec<f64>,
    /// Of a linear rate: the forcing before and at each sample, of each column.
    pub(super) forcing: Vec<f64>,
    /// Of every sample and column of a block; empty where none is.
    pub(super) silent: Vec<bool>,
}

impl Clone for Track {
    fn clone(&self) -> Self {
        let mut own = Self::default();
        own.clone_from(self);
        own
    }

    /// Work buffers are no memory.
    fn clone_from(&mut self, other: &Self) {
        (self.begun, self.time) = (other.begun, other.time);
        self.states.clone_from(&other.states);
        self.base.clone_from(&other.base);
        self.derivatives.clone_from(&other.derivatives);
        self.derived.resize_with(other.derived.len(), Vec::new);
    }
}

impl State for Track {
    fn restart(&mut self) {
        self.begun = false;
        self.derivatives.iter_mut().for_each(State::restart);
    }
}

/// What a piece of a trial brings.
pub struct Piece<'a> {
    /// Time stamps, s.
    pub time: &'a [f64],
    /// Of the first sample of the trial, s.
    pub start: f64,
    /// One signal for each input; none where it is derived.
    pub inputs: &'a [Option<&'a [f64]>],
    /// Values of the parameters.
    pub values: Values<'a>,
    /// Place of each parameter among the values: the first, and whether each column has its own.
    pub slots: &'a [(usize, bool)],
    /// Parameters that are sizes, with the value at which they do nothing.
    pub silent: &'a [(usize, f64)],
    /// Which columns stand side by side: for each name of the plan, one for each lane.
    pub lanes: &'a [Vec<usize>],
}

/// A block of samples in the registers.
struct Block {
    first: usize,
    pub samples: usize,
    pub lanes: usize,
    stride: usize,
}

impl Block {
    fn all(&self) -> Range<usize> {
        0..self.samples * self.lanes
    }

    pub fn at(&self, register: usize, sample: usize, lane: usize) -> usize {
        register * self.stride + sample * self.lanes + lane
    }
}

impl Plan {
    /// Acts on the next samples of a trial, in place.
    pub fn proceed(&self, piece: &Piece, track: &mut Track, columns: &mut [Vec<f64>]) {
        let (samples, lanes) = (piece.time.len(), piece.lanes[0].len());
        let is_silent = |lane: usize, t: usize| {
            piece.silent.iter().all(|&(p, value)| piece.values.at(place(piece.slots[p], lane), t) == value)
        };
        let constant = piece.values.are_constant();
        if samples == 0 || lanes == 0 || (constant && (0..lanes).all(|lane| is_silent(lane, 0))) {
            return;
        }
        let any_silent = constant && (0..lanes).any(|lane| is_silent(lane, 0));
        let stride = samples.min(BLOCK) * lanes;
        let registers = self.program.registers();
        grow(&mut track.buffer, registers * stride);
        track.states.resize(self.now.len() * lanes, 0.0);
        track.base.resize(self.base * lanes, 0.0);
        for &(register, value) in &self.program.numbers {
            track.buffer[register * stride..(register + 1) * stride].fill(value);
        }
        if constant {
            self.parameters(piece, &Block { first: 0, samples: 1, lanes, stride }, &mut track.buffer);
            run(self.program.of(Class::Constant), &mut track.buffer, stride, 0..lanes);
            self.spread(&mut track.buffer, stride, lanes);
        }
        for first in (0..samples).step_by(BLOCK) {
            let block = Block { first, samples: BLOCK.min(samples - first), lanes, stride };
            self.load(piece, &block, track, columns);
            if !constant {
                self.parameters(piece, &block, &mut track.buffer);
                run(self.program.of(Class::Constant), &mut track.buffer, stride, block.all());
            }
            track.silent.clear();
            if !constant || any_silent {
                let at = |k: usize| (k % lanes, if constant { 0 } else { first + k / lanes });
                track.silent.extend(block.all().map(at).map(|(lane, t)| is_silent(lane, t)));
            }
            run(self.program.of(Class::Sample), &mut track.buffer, stride, block.all());
            self.step(&block, track, constant);
            run(self.program.of(Class::After), &mut track.buffer, stride, block.all());
            self.store(piece, &block, track, columns);
        }
    }

    /// Decay of the slowest pole of a linear rate, per second; negative where it grows, none of other forms.
    pub fn slowest(&self, values: &Values, slots: &[(usize, bool)]) -> Option<f64> {
        let Form::Linear(linear) = &self.form else { return None };
        let mut buffer = vec![0.0; self.program.registers()];
        self.program.numbers.iter().for_each(|&(register, value)| buffer[register] = value);
        slots.iter().enumerate().for_each(|(p, slot)| buffer[self.parameters + p] = values.at(place(*slot, 0), 0));
        run(self.program.of(Class::Constant), &mut buffer, 1, 0..1);
        let states = self.now.len();
        let at = |i: usize, j: usize| linear.a[i * states + j].map_or(0.0, |register| buffer[register]);
        let a = nalgebra::DMatrix::from_fn(states, states, at);
        let is_finite = a.iter().all(|a| a.is_finite());
        let decay = |pole: &nalgebra::Complex<f64>| -pole.re;
        is_finite.then(|| a.complex_eigenvalues().iter().map(decay).fold(f64::INFINITY, f64::min))
    }

    /// Writes the parameters of every sample of a block.
    fn parameters(&self, piece: &Piece, block: &Block, buffer: &mut [f64]) {
        for (p, slot) in piece.slots.iter().enumerate() {
            for k in 0..block.samples {
                for lane in 0..block.lanes {
                    buffer[block.at(self.parameters + p, k, lane)] =
                        piece.values.at(place(*slot, lane), block.first + k);
                }
            }
        }
    }

    /// Repeats what the first sample has in every constant register.
    fn spread(&self, buffer: &mut [f64], stride: usize, lanes: usize) {
        let constant = |register: &usize| self.program.classes[*register] == Class::Constant;
        for register in (0..self.program.registers()).filter(constant) {
            let row = &mut buffer[register * stride..(register + 1) * stride];
            if lanes == 1 {
                row.fill(row[0]);
            } else {
                (lanes..stride).for_each(|k| row[k] = row[k - lanes]);
            }
        }
    }

    /// Writes columns, inputs and times.
    fn load(&self, piece: &Piece, block: &Block, track: &mut Track, columns: &[Vec<f64>]) {
        let Block { first, samples, lanes, .. } = *block;
        for (register, own) in piece.lanes.iter().enumerate() {
            for (lane, &column) in own.iter().enumerate() {
                let values = &columns[column][first..first + samples];
                let row = &mut track.buffer[block.at(register, 0, lane)..];
                row.iter_mut().step_by(lanes).zip(values).for_each(|(to, x)| *to = *x);
            }
        }
        let mut register = piece.lanes.len();
        for (input, signal) in piece.inputs.iter().enumerate() {
            let signal = signal.unwrap_or(&track.derived[input]);
            repeat(
                &mut track.buffer[block.at(register, 0, 0)..],
                lanes,
                signal[first..first + samples].iter().copied(),
            );
            register += 1;
        }
        let time = &piece.time[first..first + samples];
        if self.uses_time {
            let since = time.iter().map(|t| t - piece.start);
            repeat(&mut track.buffer[block.at(register, 0, 0)..], lanes, since);
        }
        let mut before = if track.begun { track.time } else { time[0] };
        let elapsed = time.iter().map(|t| t - std::mem::replace(&mut before, *t));
        repeat(&mut track.buffer[self.elapsed * block.stride..], lanes, elapsed);
        track.time = before;
    }

    /// Writes the columns back; where all sizes are silent a column stays as it is.
    fn store(&self, piece: &Piece, block: &Block, track: &Track, columns: &mut [Vec<f64>]) {
        for (own, &result) in piece.lanes.iter().zip(&self.results) {
            for (lane, &column) in own.iter().enumerate() {
                let values = &mut columns[column][block.first..block.first + block.samples];
                let row = &track.buffer[block.at(result, 0, lane)..];
                if track.silent.is_empty() && block.lanes == 1 {
                    values.copy_from_slice(&row[..block.samples]);
                    continue;
                }
                let row = row.iter().step_by(block.lanes);
                if track.silent.is_empty() {
                    values.iter_mut().zip(row).for_each(|(x, y)| *x = *y);
                    continue;
                }
                let silent = track.silent[lane..].iter().step_by(block.lanes);
                values.iter_mut().zip(row).zip(silent).filter(|(_, silent)| !**silent).for_each(|((x, y), _)| *x = *y);
            }
        }
    }
}

/// Place of a parameter's value for one lane.
fn place((first, is_each): (usize, bool), lane: usize) -> usize {
    first + if is_each { lane } else { 0 }
}

fn grow(room: &mut Vec<f64>, length: usize) {
    if room.len() < length {
        room.resize(length, 0.0);
    }
}

/// Each value `lanes` times.
fn repeat(row: &mut [f64], lanes: usize, values: impl Iterator<Item = f64>) {
    match lanes {
        1 => row.iter_mut().zip(values).for_each(|(x, value)| *x = value),
        _ => row.chunks_exact_mut(lanes).zip(values).for_each(|(row, value)| row.fill(value)),
    }
}
