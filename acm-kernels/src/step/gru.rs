//! A step of the gated recurrent unit: one sample, units in the lanes.

use pulp::Simd;

use super::Buffers;
use super::spread::{Spread, collect};
use crate::bodies::cell;
use crate::bodies::gru::Gru;

impl Gru {
    /// Writes (1, h') of the top layer to the features, and returns their number.
    #[inline(always)]
    pub(super) fn step<S: Simd>(&self, s: S, matrices: &[Spread], buffers: &mut Buffers, inputs: &[f32]) -> usize {
        let Buffers { state, features, y, update } = buffers;
        features[..inputs.len()].copy_from_slice(inputs);
        for (layer, h) in self.layers.iter().zip(state) {
            let one = layer.inputs;
            let width = one + 1 + self.units;
            features[one] = 1.0;
            collect(h, &mut features[one + 1..width]);
            let y = &mut y[..4 * h.len()];
            let (gates, rest) = y.split_at_mut(2 * h.len());
            let (c, a) = rest.split_at_mut(h.len());
            matrices[layer.forward.gates].times(s, &features[..width], gates);
            matrices[layer.forward.state].times(s, &features[one..width], c);
            matrices[layer.forward.input].times(s, &features[..=one], a);
            cell::gru::<S, false>(s, y, update, h);
            collect(h, &mut features[..self.units]);
        }
        // From the input of the next layer, (h', …), to (1, h').
        features.copy_within(..self.units, 1);
        features[0] = 1.0;
        1 + self.units
    }
}
