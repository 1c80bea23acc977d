//! An estimator without a network: the nominal model, and a network of one unit with a factor of 0.

use std::ops::Range;

use acm_kernels::{Activation, Body, Kernel, MlpShape, Shape};

use crate::channel::{Channel, Source};
use crate::nominal::Nominal;
use crate::parts::{Parts, PartsError, Signals};
use crate::residual::StateRule;
use crate::scaler::Scaler;

impl Parts {
    /// Returns the parts of an estimator without a network: the nominal model alone. `step` is the usual time between
    /// two samples, s.
    ///
    /// # Errors
    /// There is no actuator, or no output.
    pub fn alone(signals: Signals, nominal: Nominal, tip: Range<usize>, step: f64) -> Result<Self, PartsError> {
        let plain = |n: usize| Scaler { mean: vec![0.0; n], spread: vec![1.0; n] };
        let body = Body::Mlp(MlpShape { hidden: vec![1], activation: Activation::Tanh });
        let network = Shape { body, inputs: 1, outputs: tip.len() };
        let parameters = Kernel::new(&network)?.parameters();
        let parts = Self {
            signals,
            nominal,
            channels: vec![Channel { source: Source::Actuator(0), rate: false }],
            ranges: None,
            inputs: plain(1),
            targets: plain(tip.len()),
            tip,
            network,
            weights: vec![0.0; parameters],
            members: vec![],
            factor: 0.0,
            straight: vec![],
            max_gap: f64::MAX,
            first_elapsed: step,
            state: StateRule::Running,
            actuators: vec![],
            interval: None,
            labels: None,
        };
        parts.kernel().map(|_| parts)
    }

    /// Returns whether a network takes part. [`Parts::alone`] has none: its factor is 0, and it knows no training range.
    pub fn has_network(&self) -> bool {
        self.factor != 0.0 || self.ranges.is_some()
    }
}
