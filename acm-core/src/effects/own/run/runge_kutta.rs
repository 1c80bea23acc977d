//! A nonlinear rate over a block: the classical Runge–Kutta method, with inputs linear between samples.

use super::super::plan::Plan;
use super::super::program::{Class, run};
use super::{Block, Track, grow};

impl Plan {
    /// Classical fourth order, in equal steps.
    pub(super) fn runge_kutta(&self, rates: &[usize], steps: usize, block: &Block, track: &mut Track, constant: bool) {
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

    /// Rates at `share` of the way to sample `k`, with states advanced by `reach` seconds at the rates of the last stage.
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
