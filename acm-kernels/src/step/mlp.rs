//! A step of the perceptron: one sample, units in the lanes.

use pulp::Simd;

use super::Buffers;
use super::spread::{Spread, collect};
use crate::bodies::layer::activate;
use crate::bodies::mlp::Mlp;

impl Mlp {
    /// Writes (1, a_L) to the features, and returns their number.
    #[inline(always)]
    pub(super) fn step<S: Simd>(&self, s: S, matrices: &[Spread], buffers: &mut Buffers, inputs: &[f32]) -> usize {
        let Buffers { features, y, .. } = buffers;
        features[0] = 1.0;
        features[1..][..inputs.len()].copy_from_slice(inputs);
        let mut width = 1 + inputs.len();
        for (layer, &units) in self.layers.iter().zip(&self.shape.hidden) {
            let matrix = &matrices[layer.forward];
            let y = &mut y[..matrix.outputs()];
            matrix.times(s, &features[..width], y);
            activate(s, self.shape.activation, y, &mut []);
            width = 1 + units;
            collect(y, &mut features[1..width]);
        }
        width
    }
}
