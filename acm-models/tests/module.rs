//! What a burn user does with a network: composes it in a module of her own, trains it with burn's optimizer, stores it
//! in burn's records, feeds it piece by piece and step by step; on flex and in burn's own operations.

use acm_models::burn;
use acm_models::burn::module::{Module, Param};
use acm_models::burn::nn::{Linear, LinearConfig};
use acm_models::burn::tensor::{Device, Gradients, Tensor, TensorData};
use acm_models::{Activation, Cfc, CfcConfig, CfcMode, Gru, GruConfig, Mlp, MlpConfig};
use burn_optim::{AdamConfig, GradientsParams};

const BATCH: usize = 5;
const STEPS: usize = 7;
const CHANNELS: usize = 3;
const UNITS: usize = 6;

/// A network of a user: an embedding before the recurrent part, a linear layer after it.
#[derive(Module, Debug)]
struct Sensor {
    embedding: Linear,
    cfc: Cfc,
    gru: Gru,
    mlp: Mlp,
    head: Linear,
}

impl Sensor {
    fn new(device: &Device) -> Self {
        device.seed(3);
        Self {
            embedding: LinearConfig::new(CHANNELS, 4).init(device),
            cfc: CfcConfig::new(4).with_units(UNITS).with_backbone(2, 9).init(device),
            gru: GruConfig::new(UNITS).with_units(UNITS).with_layers(2).init(device),
            mlp: MlpConfig::new(UNITS).with_hidden(&[8]).with_activation(Activation::Tanh).init(device),
            head: LinearConfig::new(8, 1).init(device),
        }
    }

    fn plain(self) -> Self {
        Self { cfc: self.cfc.plain(), gru: self.gru.plain(), mlp: self.mlp.plain(), ..self }
    }

    fn forward(&self, inputs: Tensor<3>, elapsed: Tensor<2>) -> Tensor<3> {
        let states = self.cfc.forward(self.embedding.forward(inputs), elapsed);
        self.head.forward(self.mlp.forward(self.gru.forward(states)))
    }

    fn loss(&self, device: &Device) -> Tensor<1> {
        let (inputs, elapsed) = sequences(device);
        let targets = inputs.clone().narrow(2, 0, 1) * elapsed.clone().unsqueeze_dim::<3>(2).mul_scalar(4.0);
        let residual = self.forward(inputs, elapsed) - targets;
        (residual.clone() * residual).mean()
    }
}

/// Reproducible numbers in (−1, 1) without a pattern: the fractional parts of multiples of √root.
fn noise<const D: usize>(shape: [usize; D], root: f64, device: &Device) -> Tensor<D> {
    let count: usize = shape.iter().product();
    let values: Vec<f32> = (1..=count).map(|i| (2.0 * (i as f64 * root.sqrt()).fract() - 1.0) as f32).collect();
    Tensor::from_data(TensorData::new(values, shape), device)
}

fn sequences(device: &Device) -> (Tensor<3>, Tensor<2>) {
    let elapsed = noise([BATCH, STEPS], 3.0, device).mul_scalar(0.1).add_scalar(0.2);
    (noise([BATCH, STEPS, CHANNELS], 2.0, device), elapsed)
}

fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("f32")
}

fn near(what: &str, found: &[f32], expected: &[f32]) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-5 * expected.abs().max(1.0), "{what}: {found} instead of {expected}");
    }
}

fn cfcs() -> Vec<CfcConfig> {
    let modes = [CfcMode::Default, CfcMode::NoGate, CfcMode::Pure];
    let config = |mode, layers| CfcConfig::new(CHANNELS).with_units(UNITS).with_mode(mode).with_backbone(layers, 9);
    modes.iter().flat_map(|&mode| [0, 1, 2].map(|layers| config(mode, layers))).collect()
}

#[test]
fn a_user_module_learns_with_burns_adam() {
    let device = Device::flex().autodiff();
    let mut sensor = Sensor::new(&device);
    let mut optimizer = AdamConfig::new().init();
    let start = numbers(sensor.loss(&device))[0];
    for _ in 0..150 {
        let gradients = GradientsParams::from_grads(sensor.loss(&device).backward(), &sensor);
        sensor = optimizer.step(0.01, sensor, gradients);
    }
    let end = numbers(sensor.loss(&device))[0];
    assert!(end < 0.1 * start, "from {start} to {end}");
}

/// Each parameter's gradient, by the fused operation and by burn's own, through all layers of that module. The
/// embedding learns through the derivative by the inputs of the cell.
#[test]
fn gradients_are_those_of_burns_operations() {
    let device = Device::flex().autodiff();
    let sensor = Sensor::new(&device);
    let plain = sensor.clone().plain();
    let gradients = |sensor: &Sensor| {
        let mut gradients = sensor.loss(&device).backward();
        let of = |param: &Param<Tensor<2>>, gradients: &mut Gradients| {
            numbers(param.grad_remove(gradients).expect("every weight has a gradient"))
        };
        let weights = [
            &sensor.embedding.weight,
            &sensor.cfc.backbone[0].weight,
            &sensor.cfc.ff1.weight,
            &sensor.gru.layers[0].weight_ih,
            &sensor.gru.layers[1].weight_hh,
            &sensor.mlp.layers[0].weight,
            &sensor.head.weight,
        ];
        weights.map(|weight| of(weight, &mut gradients))
    };
    for (found, expected) in gradients(&sensor).iter().zip(gradients(&plain)) {
        near("gradient", found, &expected);
        assert!(found.iter().any(|&g| g != 0.0));
    }
}

/// Oracle: the equations in burn's operations, which `golden.rs` holds against torch.
#[test]
fn every_cfc_is_its_reference() {
    let device = Device::flex().autodiff();
    for config in cfcs() {
        let cfc = config.init_seeded(1, &device);
        let run = |cfc: &Cfc| {
            let (inputs, elapsed) = sequences(&device);
            let (inputs, state) = (inputs.require_grad(), noise([BATCH, UNITS], 5.0, &device).require_grad());
            let states = cfc.forward_from(inputs.clone(), elapsed, state.clone());
            let gradients = (states.clone() * noise([BATCH, STEPS, UNITS], 7.0, &device)).sum().backward();
            let of = |gradient: Option<Tensor<2>>| numbers(gradient.expect("it is tracked"));
            let by_inputs = numbers(inputs.grad(&gradients).expect("it is tracked"));
            [numbers(states), by_inputs, of(state.grad(&gradients)), of(cfc.ff1.weight.grad(&gradients))]
        };
        for (found, expected) in run(&cfc).iter().zip(run(&cfc.clone().plain())) {
            near(&format!("{config:?}"), found, &expected);
        }
    }
}

/// A network that does not learn hands the gradient down to what lies below it.
#[test]
fn a_fixed_network_passes_the_gradient_on() {
    let device = Device::flex().autodiff();
    let (inputs, elapsed) = sequences(&device);
    let learning = CfcConfig::new(CHANNELS).with_units(UNITS).init_seeded(1, &device);
    let gradient = |cfc: &Cfc| {
        let inputs = inputs.clone().require_grad();
        let loss = (cfc.forward(inputs.clone(), elapsed.clone()) * noise([BATCH, STEPS, UNITS], 7.0, &device)).sum();
        numbers(inputs.grad(&loss.backward()).expect("it is tracked"))
    };
    let expected = gradient(&learning.clone().plain());
    near("frozen", &gradient(&learning.clone().freeze()), &expected);
    near("without autodiff", &gradient(&learning.valid()), &expected);
}

#[test]
fn a_module_prints_its_layers() {
    let said = format!("{}", Sensor::new(&Device::flex()));
    eprintln!("{said}");
    for word in ["Cfc", "ff1", "Gru", "Mlp", "head"] {
        assert!(said.contains(word), "{said}");
    }
}

/// Where a gradient by the elapsed times is asked for, the fused operation gives way to burn's own.
#[test]
fn elapsed_times_have_a_gradient() {
    let device = Device::flex().autodiff();
    let cfc = CfcConfig::new(CHANNELS).with_units(UNITS).init_seeded(1, &device);
    let (inputs, elapsed) = sequences(&device);
    let sum = |elapsed: Tensor<2>| cfc.forward(inputs.clone(), elapsed).sum();
    let tracked = elapsed.clone().require_grad();
    let gradient = tracked.grad(&sum(tracked.clone()).backward()).expect("it is tracked");
    let direction = noise([BATCH, STEPS], 11.0, &device);
    let slope = numbers((gradient * direction.clone().inner()).sum())[0];
    let at = |step: f32| numbers(sum(elapsed.clone() + direction.clone().mul_scalar(step)))[0];
    let differences = (at(1e-2) - at(-1e-2)) / 2e-2;
    assert!((slope - differences).abs() < 2e-3 * differences.abs().max(1.0), "{slope} instead of {differences}");
}

#[test]
fn two_pieces_are_one_sequence() {
    let device = Device::flex();
    let (inputs, elapsed) = sequences(&device);
    let cut =
        |from: usize, count: usize| (inputs.clone().narrow(1, from, count), elapsed.clone().narrow(1, from, count));
    let ((first, first_times), (second, second_times)) = (cut(0, 3), cut(3, STEPS - 3));
    for config in cfcs() {
        for cfc in [config.init_seeded(1, &device), config.init_seeded(1, &device).plain()] {
            let whole = cfc.forward(inputs.clone(), elapsed.clone());
            let start = cfc.initial_state(BATCH, &device);
            let before = cfc.forward_from(first.clone(), first_times.clone(), start);
            let state = before.clone().narrow(1, 2, 1).squeeze_dim(1);
            let after = cfc.forward_from(second.clone(), second_times.clone(), state);
            near("cfc", &numbers(Tensor::cat(vec![before, after], 1)), &numbers(whole));
        }
    }
    let config = GruConfig::new(CHANNELS).with_units(UNITS).with_layers(3);
    for gru in [config.init_seeded(1, &device), config.init_seeded(1, &device).plain()] {
        let (before, state) = gru.forward_from(first.clone(), gru.initial_state(BATCH, &device));
        let (after, _) = gru.forward_from(second.clone(), state);
        near("gru", &numbers(Tensor::cat(vec![before, after], 1)), &numbers(gru.forward(inputs.clone())));
    }
}

/// The gradient goes through the state from the second piece into the first.
#[test]
fn pieces_pass_the_gradient_on() {
    let device = Device::flex().autodiff();
    let gru = GruConfig::new(CHANNELS).with_units(UNITS).with_layers(2).init_seeded(1, &device);
    let (inputs, _) = sequences(&device);
    let gradient = |last: Tensor<2>| {
        let gradients = (last * noise([BATCH, UNITS], 7.0, &device)).sum().backward();
        numbers(gru.layers[0].weight_ih.grad(&gradients).expect("it is tracked"))
    };
    let end = |states: Tensor<3>| {
        let [_, steps, _] = states.dims();
        states.narrow(1, steps - 1, 1).squeeze_dim(1)
    };
    let (_, state) = gru.forward_from(inputs.clone().narrow(1, 0, 3), gru.initial_state(BATCH, &device));
    let (after, _) = gru.forward_from(inputs.clone().narrow(1, 3, STEPS - 3), state);
    near("gradient", &gradient(end(after)), &gradient(end(gru.forward(inputs))));
}

#[test]
fn steps_are_one_sequence() {
    let device = Device::flex();
    let (inputs, elapsed) = sequences(&device);
    let input = |t: usize| inputs.clone().narrow(1, t, 1).squeeze_dim::<2>(1);
    for config in cfcs() {
        let cfc = config.init_seeded(1, &device);
        let states = (0..STEPS).scan(cfc.initial_state(BATCH, &device), |state, t| {
            *state = cfc.step(input(t), elapsed.clone().narrow(1, t, 1), state.clone());
            Some(state.clone())
        });
        let states = Tensor::stack::<3>(states.collect(), 1);
        near("cfc", &numbers(states), &numbers(cfc.forward(inputs.clone(), elapsed.clone())));
    }
    let gru = GruConfig::new(CHANNELS).with_units(UNITS).with_layers(2).init_seeded(1, &device);
    let states = (0..STEPS).scan(gru.initial_state(BATCH, &device), |state, t| {
        *state = gru.step(input(t), state.clone());
        Some(state.clone().narrow(0, 1, 1).squeeze_dim::<2>(0))
    });
    near("gru", &numbers(Tensor::stack::<3>(states.collect(), 1)), &numbers(gru.forward(inputs.clone())));
    let mlp = MlpConfig::new(CHANNELS).init_seeded(1, &device);
    let steps = Tensor::stack::<3>((0..STEPS).map(|t| mlp.step(input(t))).collect(), 1);
    near("mlp", &numbers(steps), &numbers(mlp.forward(inputs.clone())));
}

#[test]
fn records_carry_a_module_over() {
    let device = Device::flex();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sensor");
    let (inputs, elapsed) = sequences(&device);
    let sensor = Sensor::new(&device);
    let expected = numbers(sensor.forward(inputs.clone(), elapsed.clone()));
    let file = file.with_extension("bpk");
    sensor.save_file(&file).expect("the record is written");
    device.seed(4);
    let other = Sensor { embedding: LinearConfig::new(CHANNELS, 4).init(&device), ..Sensor::new(&device) };
    let other =
        Sensor { cfc: CfcConfig::new(4).with_units(UNITS).with_backbone(2, 9).init_seeded(9, &device), ..other };
    assert_ne!(numbers(other.forward(inputs.clone(), elapsed.clone())), expected);
    let read = other.try_load_file(&file).expect("the record is read");
    assert_eq!(numbers(read.forward(inputs, elapsed)), expected);
}

/// A module that was loaded, validated or moved goes on learning.
#[test]
fn a_module_learns_after_validation() {
    let sensor = Sensor::new(&Device::flex().autodiff()).valid();
    assert!(!sensor.cfc.ff1.weight.val().is_autodiff());
    let sensor = sensor.train();
    let gradients = sensor.loss(&Device::flex().autodiff()).backward();
    assert!(sensor.cfc.ff1.weight.grad(&gradients).is_some() && sensor.embedding.weight.grad(&gradients).is_some());
}

#[test]
fn first_values_follow_from_the_seed_or_from_burns_generator() {
    let device = Device::flex();
    let config = CfcConfig::new(CHANNELS).with_units(UNITS);
    let weight = |cfc: Cfc| numbers(cfc.ff1.weight.val());
    assert_eq!(weight(config.init_seeded(1, &device)), weight(config.init_seeded(1, &device)));
    assert_ne!(weight(config.init_seeded(1, &device)), weight(config.init_seeded(2, &device)));
    assert_ne!(weight(config.init(&device)), weight(config.init(&device)));
}

/// Other devices than flex compute by burn's own operations.
#[cfg(any(feature = "ndarray", feature = "cuda", feature = "wgpu"))]
#[test]
fn the_device_that_is_named_has_flexs_answer() {
    let name = std::env::var("ACM_DEVICE").expect("ACM_DEVICE names the device, as in scripts/test-device");
    let other = acm_models::device(&name).unwrap_or_else(|error| panic!("{error}")).autodiff();
    let flex = Device::flex().autodiff();
    let sensor = Sensor::new(&flex);
    let gradients = |device: &Device| {
        let sensor = sensor.clone().fork(device);
        let mut gradients = sensor.loss(device).backward();
        let weights = [&sensor.embedding.weight, &sensor.cfc.ff1.weight, &sensor.gru.layers[0].weight_ih];
        weights.map(|weight| numbers(weight.grad_remove(&mut gradients).expect("every weight has a gradient")))
    };
    for (found, expected) in gradients(&other).iter().zip(gradients(&flex)) {
        near(&name, found, &expected);
    }
    for config in cfcs() {
        let states = |device: &Device| {
            let (inputs, elapsed) = sequences(device);
            numbers(config.init_seeded(1, device).forward(inputs, elapsed).inner())
        };
        near(&format!("{name}, {config:?}"), &states(&other), &states(&flex));
    }
}
