//! The fused kernels against plain tensor operations: predictions and gradients, over kinds, sizes and forms.

use acm_models::burn::tensor::{Device, Tensor, TensorData};
use acm_models::{
    Activation, CfcConfig, CfcMode, Engine, GruConfig, Keep, MlpConfig, Network, NetworkConfig, Sequences,
};

const CHANNELS: usize = 3;
const OUTPUTS: usize = 2;
const TOLERANCE: f32 = 1e-5;

/// One window, one step; as many windows as units; and odd sizes around the width of a vector.
const SIZES: [(usize, usize); 5] = [(1, 1), (1, 9), (8, 5), (17, 3), (33, 2)];

fn networks() -> Vec<NetworkConfig> {
    let mut all: Vec<NetworkConfig> = Activation::ALL
        .into_iter()
        .map(|activation| NetworkConfig::Mlp(MlpConfig::default().with_hidden(&[7, 16]).with_activation(activation)))
        .collect();
    all.push(NetworkConfig::Mlp(MlpConfig { hidden: vec![], ..MlpConfig::default() }));
    all.extend([1, 3].map(|layers| NetworkConfig::Gru(GruConfig { units: 8, layers, ..GruConfig::default() })));
    for mode in [CfcMode::Default, CfcMode::NoGate, CfcMode::Pure] {
        for (backbone_layers, activation) in [(0, Activation::LecunTanh), (1, Activation::Relu), (2, Activation::Gelu)]
        {
            let cfc = CfcConfig::default().with_units(8).with_mode(mode).with_backbone(backbone_layers, 11);
            all.push(NetworkConfig::Cfc(cfc.with_activation(activation)));
        }
    }
    all
}

/// Reproducible numbers without a pattern: the fractional parts of multiples of √2, √3, ….
fn noise(count: usize, root: f64) -> Vec<f32> {
    (1..=count).map(|i| (2.0 * (i as f64 * root.sqrt()).fract() - 1.0) as f32).collect()
}

struct Windows {
    inputs: Vec<f32>,
    elapsed: Vec<f32>,
    batch: usize,
    steps: usize,
}

impl Windows {
    fn new(batch: usize, steps: usize) -> Self {
        let elapsed = noise(batch * steps, 3.0).iter().map(|v| 0.1 + 0.05 * v).collect();
        Self { inputs: noise(batch * steps * CHANNELS, 2.0), elapsed, batch, steps }
    }

    fn tensors(&self) -> (Tensor<3>, Tensor<2>) {
        let device = Device::flex();
        let inputs = TensorData::new(self.inputs.clone(), [self.batch, self.steps, CHANNELS]);
        let elapsed = TensorData::new(self.elapsed.clone(), [self.batch, self.steps]);
        (Tensor::from_data(inputs, &device), Tensor::from_data(elapsed, &device))
    }

    fn slices(&self, keep: Keep) -> Sequences<'_> {
        let Self { inputs, elapsed, batch, steps } = self;
        Sequences { inputs, elapsed, state: None, batch: *batch, steps: *steps, keep }
    }
}

fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("f32")
}

fn near(what: &str, fused: &[f32], plain: &[f32]) {
    assert_eq!(fused.len(), plain.len(), "{what}");
    for (k, (fused, plain)) in fused.iter().zip(plain).enumerate() {
        let off = (fused - plain).abs() / plain.abs().max(1.0);
        assert!(off < TOLERANCE, "{what}: {fused} and {plain} at {k}");
    }
}

fn every(network: &Network, windows: &Windows, keep: Keep) -> Tensor<2> {
    let (inputs, elapsed) = windows.tensors();
    match keep {
        Keep::Last => network.forward_last(inputs, elapsed),
        Keep::Every => network.forward(inputs, elapsed).reshape([windows.batch * windows.steps, OUTPUTS]),
    }
}

/// Predictions on the tape, and the gradient of Σ c · prediction.
fn on_the_tape(network: &Network, windows: &Windows, keep: Keep) -> (Vec<f32>, Vec<f32>) {
    let predicted = every(network, windows, keep);
    let weights = TensorData::new(noise(numbers(predicted.clone().inner()).len(), 5.0), predicted.dims());
    let weights = Tensor::<2>::from_data(weights, &network.device());
    let gradient = network.gradient(&mut (predicted.clone() * weights).sum().backward());
    (numbers(predicted.inner()), gradient)
}

#[test]
fn predictions_and_gradients_on_the_tape() {
    for config in networks() {
        for (batch, steps) in SIZES {
            for keep in [Keep::Last, Keep::Every] {
                let windows = Windows::new(batch, steps);
                let fused = Network::new(&config, CHANNELS, OUTPUTS, 3, &Device::flex().autodiff());
                let plain = fused.plain();
                assert!(fused.kernel().is_some() && plain.kernel().is_none());
                let what = format!("{config:?}, {batch} windows of {steps}, {keep:?}");
                let (predicted, gradient) = on_the_tape(&fused, &windows, keep);
                let (expected, slopes) = on_the_tape(&plain, &windows, keep);
                near(&what, &predicted, &expected);
                near(&format!("{what}: gradient"), &gradient, &slopes);
            }
        }
    }
}

#[test]
fn a_given_state() {
    for config in networks() {
        let device = Device::flex();
        let fused = Network::new(&config, CHANNELS, OUTPUTS, 3, &device);
        let windows = Windows::new(17, 4);
        let widths: Vec<usize> = fused.initial_state(17).iter().map(|state| state.dims()[1]).collect();
        let run = |network: &Network| {
            let state = |(k, &width): (usize, &usize)| {
                Tensor::from_data(TensorData::new(noise(17 * width, 7.0 + k as f64), [17, width]), &device)
            };
            let (inputs, elapsed) = windows.tensors();
            numbers(network.forward_from(inputs, elapsed, widths.iter().enumerate().map(state).collect()))
        };
        near(&format!("{config:?}"), &run(&fused), &run(&fused.plain()));
    }
}

/// Loss, gradient and predictions from slices, by kernels and by tensors.
#[test]
fn both_engines() {
    for config in networks() {
        for keep in [Keep::Last, Keep::Every] {
            let windows = Windows::new(33, 4);
            let network = Network::new(&config, CHANNELS, OUTPUTS, 3, &Device::flex());
            let run = |network: &Network| {
                let mut engine = Engine::new(network);
                let (mut predicted, mut gradient) = (Vec::new(), vec![0.0; network.parameter_count()]);
                let loss = |_: usize, predicted: &[f32], derivatives: &mut [f32]| {
                    derivatives.iter_mut().zip(predicted).for_each(|(d, p)| *d = 2.0 * p);
                    predicted.iter().map(|p| f64::from(p * p)).sum::<f64>()
                };
                let loss = engine.gradient(&network.values(), &windows.slices(keep), &loss, &mut gradient);
                engine.predict(&network.values(), &windows.slices(keep), &mut predicted);
                (loss as f32, predicted, gradient)
            };
            let (fused, plain) = (run(&network), run(&network.plain()));
            near(&format!("{config:?}: loss"), &[fused.0], &[plain.0]);
            near(&format!("{config:?}: predictions"), &fused.1, &plain.1);
            let largest = plain.2.iter().fold(1.0f32, |largest, g| largest.max(g.abs()));
            let scaled = |gradient: &[f32]| gradient.iter().map(|g| g / largest).collect::<Vec<f32>>();
            near(&format!("{config:?}: gradient"), &scaled(&fused.2), &scaled(&plain.2));
        }
    }
}
