//! A linear rate over a block: exact steps of states that are forced by inputs.

use super::super::phi::{Square, Step, System};
use super::super::plan::{Linear, Plan};
use super::{Block, Track, grow};

impl Plan {
    /// States of every sample of a block.
    pub(super) fn linear<const N: usize>(&self, linear: &Linear, block: &Block, track: &mut Track, constant: bool) {
        forcing::<N>(linear, block, track);
        let group = if linear.is_shared { block.lanes } else { 1 };
        for from in (0..block.lanes).step_by(group) {
            let mut system = System::new(matrix::<N>(linear, block, track, 0, from));
            let mut first = 0;
            if !track.begun {
                (from..from + group).for_each(|lane| self.begin(block, track, 0, lane));
                first = 1;
            }
            let (mut over, mut step) = (f64::NAN, system.step(0.0));
            for k in first..block.samples {
                if !constant {
                    let a = matrix(linear, block, track, k, from);
                    if !system.is(&a) {
                        (system, over) = (System::new(a), f64::NAN);
                    }
                }
                let h = track.buffer[block.at(self.elapsed, k, from)];
                if over != h {
                    (over, step) = (h, system.step(h));
                }
                for lane in from..from + group {
                    self.advance(&step, block, track, (k, lane));
                    if !constant && track.silent[k * block.lanes + lane] {
                        self.begin(block, track, k, lane);
                    }
                }
            }
        }
    }

    #[inline]
    fn advance<const N: usize>(&self, step: &Step<N>, block: &Block, track: &mut Track, (k, lane): (usize, usize)) {
        let forcing = &track.forcing[2 * N * (k * block.lanes + lane)..][..2 * N];
        let (mut before, mut now, mut z) = ([0.0; N], [0.0; N], [0.0; N]);
        before.copy_from_slice(&forcing[..N]);
        now.copy_from_slice(&forcing[N..]);
        z.iter_mut().enumerate().for_each(|(i, z)| *z = self.past(block, track, i, k, lane));
        for (i, state) in step.advance(z, before, now).into_iter().enumerate() {
            track.buffer[block.at(self.now[i], k, lane)] = state;
        }
    }
}

/// Writes the forcing f = B u + c before and at each sample, both with the coefficients of the sample.
fn forcing<const N: usize>(linear: &Linear, block: &Block, track: &mut Track) {
    let (lanes, count) = (block.lanes, block.samples * block.lanes);
    grow(&mut track.forcing, 2 * N * count);
    let rows = &mut track.forcing[..2 * N * count];
    rows.fill(0.0);
    let of = |register: usize| &track.buffer[block.at(register, 0, 0)..][..count];
    for (i, c) in linear.c.iter().enumerate() {
        let Some(c) = c else { continue };
        for (row, c) in rows.chunks_exact_mut(2 * N).zip(of(*c)) {
            (row[i], row[N + i]) = (*c, *c);
        }
    }
    for &(i, input, coefficient) in &linear.b {
        let (now, b) = (of(input), of(coefficient));
        let first = &track.base[input * lanes..(input + 1) * lanes];
        let before = first.iter().chain(now);
        for (((row, b), now), before) in rows.chunks_exact_mut(2 * N).zip(b).zip(now).zip(before) {
            row[i] += b * before;
            row[N + i] += b * now;
        }
    }
}

/// A at sample `k`.
fn matrix<const N: usize>(linear: &Linear, block: &Block, track: &Track, k: usize, lane: usize) -> Square<N> {
    let at = |register: Option<usize>| register.map_or(0.0, |r| track.buffer[block.at(r, k, lane)]);
    std::array::from_fn(|i| std::array::from_fn(|j| at(linear.a[i * N + j])))
}
