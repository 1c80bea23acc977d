//! States over a block: their start, their reset where all sizes are silent, and updates.

use super::super::function::Function;
use super::super::phi::MOST;
use super::super::plan::{Form, Plan};
use super::super::program::{Class, run};
use super::{Block, Track};

impl Plan {
    /// States of every sample of a block.
    pub(super) fn step(&self, block: &Block, track: &mut Track, constant: bool) {
        match &self.form {
            Form::Static => (),
            Form::Update => self.update(block, track, constant),
            Form::Linear(linear) => match self.now.len() {
                1 => self.linear::<1>(linear, block, track, constant),
                2 => self.linear::<2>(linear, block, track, constant),
                3 => self.linear::<3>(linear, block, track, constant),
                4 => self.linear::<4>(linear, block, track, constant),
                5 => self.linear::<5>(linear, block, track, constant),
                _ => self.linear::<MOST>(linear, block, track, constant),
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

    /// Starts the states at sample `k`.
    pub(super) fn begin(&self, block: &Block, track: &mut Track, k: usize, lane: usize) {
        for (&start, &now) in self.start.iter().zip(&self.now) {
            track.buffer[block.at(now, k, lane)] = track.buffer[block.at(start, k, lane)];
        }
    }

    /// Whether this is a trial's first sample; if so, sets all states to their start.
    pub(super) fn begins(&self, block: &Block, track: &mut Track, k: usize) -> bool {
        let is = k == 0 && !track.begun;
        (0..if is { block.lanes } else { 0 }).for_each(|lane| self.begin(block, track, k, lane));
        is
    }

    /// Where all sizes are silent, a state is at its start.
    pub(super) fn rest(&self, block: &Block, track: &mut Track, k: usize, constant: bool) {
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

    /// One state that a chain of operations updates; it stays in a processor register.
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
