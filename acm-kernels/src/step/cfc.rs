//! A step of the closed-form network: one sample, units in the lanes.

use pulp::Simd;

use super::Buffers;
use super::spread::{Spread, collect};
use crate::bodies::cell;
use crate::bodies::cfc::Cfc;
use crate::bodies::layer::activate;
use crate::plan::Place;
use crate::shape::CfcMode;
use crate::vectors::row::{ROWS, Row};

impl Cfc {
    /// Returns the matrix whose rows are N_1, N_2, N_a, N_b.
    pub(super) fn maps(&self) -> Place {
        self.maps.forward
    }

    /// Returns w_τ and A; empty but in mode pure.
    pub(super) fn constants<'a>(&self, parameters: &'a [f32]) -> [&'a [f32]; 2] {
        let values = |first: usize| &parameters[first..first + self.shape.units];
        self.pure.as_ref().map_or([&[], &[]], |pure| [values(pure.rate), values(pure.level)])
    }

    /// Writes (1, h') to the features, and returns their number.
    #[inline(always)]
    pub(super) fn step<S: Simd>(
        &self,
        s: S,
        matrices: &[Spread],
        constants: &[Vec<Row>; 2],
        buffers: &mut Buffers,
        inputs: &[f32],
        elapsed: f32,
    ) -> usize {
        let Buffers { state, features, y, .. } = buffers;
        let (h, units) = (&mut state[0], self.shape.units);
        features[..self.inputs].copy_from_slice(inputs);
        features[self.inputs] = 1.0;
        collect(h, &mut features[self.inputs + 1..][..units]);
        let mut width = self.inputs + 1 + units;
        for layer in &self.backbone {
            let matrix = &matrices[layer.forward];
            let y = &mut y[..matrix.outputs()];
            matrix.times(s, &features[..width], y);
            activate(s, self.shape.activation, y, &mut []);
            width = 1 + self.shape.backbone_units;
            features[0] = 1.0;
            collect(y, &mut features[1..width]);
        }
        matrices[self.maps.forward].times(s, &features[..width], y);
        let (y, elapsed) = (&mut y[..4 * h.len()], Row([elapsed; ROWS]));
        match self.shape.mode {
            CfcMode::Default => cell::gated::<S, false, true>(s, y, &elapsed, h),
            CfcMode::NoGate => cell::gated::<S, false, false>(s, y, &elapsed, h),
            CfcMode::Pure => {
                let [rate, level] = constants;
                let at = |row: usize, v: usize| (rate[row].vectors::<S>()[v], level[row].vectors::<S>()[v]);
                cell::pure::<S, false>(s, y, &elapsed, at, h);
            }
        }
        features[0] = 1.0;
        collect(h, &mut features[1..][..units]);
        1 + units
    }
}
