//! A plan on its way through a trial: columns side by side, a block of samples at a time.
//!
//! Register r holds sample k of column l at r·stride + k·L + l, where L columns are acted on alike. Constants are computed once,
//! what depends on no state for the whole block, and states sample by sample.

use std::ops::Range;

use super::function::Function;
use super::phi;
use super::plan::{Form, Plan};
use super::program::{Class, run};
use crate::effects::Values;
use crate::effects::memory::{Derivatives, State};

/// Samples of a block: few enough for the registers to stay near the processor.
const BLOCK: usize = 64;

/// What is kept from one piece of a trial to the next, and room to work in.
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

    /// Room to work in is none of the memory.
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
pub(super) struct Block {
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

    /// States of every sample of a block.
    fn step(&self, block: &Block, track: &mut Track, constant: bool) {
        match &self.form {
            Form::Static => (),
            Form::Update => self.update(block, track, constant),
            Form::Linear(linear) => match self.now.len() {
                1 => self.linear::<1>(linear, block, track, constant),
                2 => self.linear::<2>(linear, block, track, constant),
                3 => self.linear::<3>(linear, block, track, constant),
                4 => self.linear::<4>(linear, block, track, constant),
                5 => self.linear::<5>(linear, block, track, constant),
                _ => self.linear::<{ phi::MOST }>(linear, block, track, constant),
            },
            Form::RungeKutta { rates, steps } => self.runge_kutta(rates, *steps, block, track, constant),
        }
        self.keep(block, track);
    }

    /// Remembers the last sample.
    fn keep(&self, block: &Block, track: &mut Track) {
        let last = block.samples - 1;
        for (i, &now) in self.now.iter().enumerate() {
            let from = block.at(now, last, 0);
            let kept = &track.buffer[from..from + block.lanes];
            track.states[i * block.lanes..(i + 1) * block.lanes].copy_from_slice(kept);
        }
        for register in 0..self.base {
            let from = block.at(register, last, 0);
            let kept = &track.buffer[from..from + block.lanes];
            track.base[register * block.lanes..(register + 1) * block.lanes].copy_from_slice(kept);
        }
        track.begun = true;
    }

    /// A state before sample `k`.
    pub(super) fn past(&self, block: &Block, track: &Track, i: usize, k: usize, lane: usize) -> f64 {
        match k {
            0 => track.states[i * block.lanes + lane],
            _ => track.buffer[block.at(self.now[i], k - 1, lane)],
        }
    }

    /// What a state starts at, at sample `k`.
    pub(super) fn begin(&self, block: &Block, track: &mut Track, k: usize, lane: usize) {
        for (&start, &now) in self.start.iter().zip(&self.now) {
            track.buffer[block.at(now, k, lane)] = track.buffer[block.at(start, k, lane)];
        }
    }

    /// At the first sample of a trial all states are at their start: whether this is it.
    fn begins(&self, block: &Block, track: &mut Track, k: usize) -> bool {
        let is = k == 0 && !track.begun;
        (0..if is { block.lanes } else { 0 }).for_each(|lane| self.begin(block, track, k, lane));
        is
    }

    /// Where all sizes are silent, a state is at its start.
    fn rest(&self, block: &Block, track: &mut Track, k: usize, constant: bool) {
        for lane in 0..if constant { 0 } else { block.lanes } {
            if track.silent[k * block.lanes + lane] {
                self.begin(block, track, k, lane);
            }
        }
    }

    fn update(&self, block: &Block, track: &mut Track, constant: bool) {
        if let Some(chain) = self.chain.as_ref().filter(|_| constant) {
            return self.follow(chain, block, track);
        }
        let operations = self.program.of(Class::State);
        for k in 0..block.samples {
            if self.begins(block, track, k) {
                continue;
            }
            for (i, &before) in self.before.iter().enumerate() {
                for lane in 0..block.lanes {
                    track.buffer[block.at(before, k, lane)] = self.past(block, track, i, k, lane);
                }
            }
            let span = k * block.lanes..(k + 1) * block.lanes;
            run(operations, &mut track.buffer, block.stride, span);
            self.rest(block, track, k, constant);
        }
    }

    /// One state that each operation takes on from the one before: it stays in a register of the processor.
    fn follow(&self, chain: &[(Function, usize)], block: &Block, track: &mut Track) {
        let first = usize::from(self.begins(block, track, 0));
        for lane in 0..block.lanes {
            if first < block.samples {
                let state = self.past(block, track, 0, first, lane);
                let places = (first * block.lanes + lane..block.samples * block.lanes).step_by(block.lanes);
                followed(chain, state, &mut track.buffer, block.stride, self.now[0], places);
            }
        }
    }

    /// Classical fourth order, in equal steps, with inputs straight between samples.
    fn runge_kutta(&self, rates: &[usize], steps: usize, block: &Block, track: &mut Track, constant: bool) {
        let (lanes, states) = (block.lanes, self.now.len());
        let registers = self.program.registers();
        grow(&mut track.point, registers * lanes);
        // States, and the sum of their rates.
        grow(&mut track.stages, 2 * states * lanes);
        for k in 0..block.samples {
            if self.begins(block, track, k) {
                continue;
            }
            for register in 0..registers {
                if self.program.classes[register] == Class::Constant || register == self.elapsed {
                    let from = block.at(register, k, 0);
                    track.point[register * lanes..(register + 1) * lanes]
                        .copy_from_slice(&track.buffer[from..from + lanes]);
                }
            }
            let part = track.buffer[block.at(self.elapsed, k, 0)] / steps as f64;
            for i in 0..states {
                for lane in 0..lanes {
                    track.stages[i * lanes + lane] = self.past(block, track, i, k, lane);
                }
            }
            for m in 0..steps {
                let share = |within: f64| (m as f64 + within) / steps as f64;
                track.stages[states * lanes..].fill(0.0);
                let mut reach = 0.0;
                for (within, next, weight) in [(0.0, 0.5, 1.0), (0.5, 0.5, 2.0), (0.5, 1.0, 2.0), (1.0, 0.0, 1.0)] {
                    self.rates(rates, block, track, k, (share(within), reach * part));
                    for (i, &rate) in rates.iter().enumerate() {
                        for lane in 0..lanes {
                            track.stages[(states + i) * lanes + lane] += weight * track.point[rate * lanes + lane];
                        }
                    }
                    reach = next;
                }
                for at in 0..states * lanes {
                    track.stages[at] += part / 6.0 * track.stages[states * lanes + at];
                }
            }
            for (i, &now) in self.now.iter().enumerate() {
                for lane in 0..lanes {
                    track.buffer[block.at(now, k, lane)] = track.stages[i * lanes + lane];
                }
            }
            self.rest(block, track, k, constant);
        }
    }

    /// Rates at `share` of the way to sample `k`, where states have gone `reach` seconds at the rates of the stage before.
    fn rates(&self, rates: &[usize], block: &Block, track: &mut Track, k: usize, (share, reach): (f64, f64)) {
        let lanes = block.lanes;
        for (i, &before) in self.before.iter().enumerate() {
            for lane in 0..lanes {
                let gone = if reach == 0.0 { 0.0 } else { reach * track.point[rates[i] * lanes + lane] };
                track.point[before * lanes + lane] = track.stages[i * lanes + lane] + gone;
            }
        }
        for register in 0..self.base {
            for lane in 0..lanes {
                let now = track.buffer[block.at(register, k, lane)];
                let past = match k {
                    0 => track.base[register * lanes + lane],
                    _ => track.buffer[block.at(register, k - 1, lane)],
                };
                track.point[register * lanes + lane] = past + share * (now - past);
            }
        }
        run(self.program.of(Class::Sample), &mut track.point, lanes, 0..lanes);
        run(self.program.of(Class::State), &mut track.point, lanes, 0..lanes);
    }
}

/// Place of a parameter's value for one lane.
fn place((first, is_each): (usize, bool), lane: usize) -> usize {
    first + if is_each { lane } else { 0 }
}

/// The state of each place in turn, into the register `now`, which is behind all others of the chain.
fn followed(
    chain: &[(Function, usize)],
    mut state: f64,
    buffer: &mut [f64],
    stride: usize,
    now: usize,
    places: impl Iterator<Item = usize>,
) {
    let (others, own) = buffer.split_at_mut(now * stride);
    let of = |register: usize| &others[register * stride..(register + 1) * stride];
    let own = &mut own[..stride];
    match *chain {
        // A play.
        [(Function::Max, low), (Function::Min, high)] => {
            let (low, high) = (of(low), of(high));
            places.for_each(|k| {
                state = state.max(low[k]).min(high[k]);
                own[k] = state;
            });
        }
        _ => places.for_each(|k| {
            for &(function, other) in chain {
                let other = others[other * stride + k];
                state = match function {
                    Function::Add => state + other,
                    Function::Multiply => state * other,
                    Function::Min => state.min(other),
                    Function::Max => state.max(other),
                    Function::Subtract => state - other,
                    Function::Divide => state / other,
                    function => function.of([state, other, 0.0]),
                };
            }
            own[k] = state;
        }),
    }
}

pub(super) fn grow(room: &mut Vec<f64>, length: usize) {
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
