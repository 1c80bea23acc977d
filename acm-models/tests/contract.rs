//! What every network on the list must do.

use acm_models::burn::tensor::{Device, Tensor, TensorData};
use acm_models::{Activation, CfcConfig, CfcMode, GruConfig, MlpConfig, Network, NetworkConfig};

const CHANNELS: usize = 3;
const OUTPUTS: usize = 2;
const LENGTH: usize = 6;

/// The list with default sizes, and the forms that the defaults leave out.
fn networks() -> Vec<NetworkConfig> {
    let mut all = NetworkConfig::all();
    all.extend(
        Activation::ALL
            .map(|activation| NetworkConfig::Mlp(MlpConfig::default().with_hidden(&[16]).with_activation(activation))),
    );
    all.push(NetworkConfig::Mlp(MlpConfig { hidden: vec![], ..MlpConfig::default() }));
    all.push(NetworkConfig::Gru(GruConfig { units: 8, layers: 3, ..GruConfig::default() }));
    for mode in [CfcMode::Default, CfcMode::NoGate, CfcMode::Pure] {
        for backbone_layers in [0, 2] {
            let cfc = CfcConfig { units: 16, mode, backbone_layers, ..CfcConfig::default() };
            all.push(NetworkConfig::Cfc(cfc));
        }
    }
    all
}

/// Reproducible numbers without a pattern: the fractional parts of multiples of √2, √3, ….
fn noise(count: usize, root: f64) -> Vec<f32> {
    (1..=count).map(|i| (2.0 * (i as f64 * root.sqrt()).fract() - 1.0) as f32).collect()
}

fn windows(batch: usize, device: &Device) -> (Tensor<3>, Tensor<2>) {
    let inputs = TensorData::new(noise(batch * LENGTH * CHANNELS, 2.0), [batch, LENGTH, CHANNELS]);
    let elapsed = noise(batch * LENGTH, 3.0).iter().map(|v| 0.1 + 0.05 * v).collect();
    let elapsed = TensorData::new(elapsed, [batch, LENGTH]);
    (Tensor::from_data(inputs, device), Tensor::from_data(elapsed, device))
}

fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("f32")
}

fn largest_difference(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Names within the module are those of torch within its own; files put the module's place before them.
#[test]
fn files_have_the_same_parameters_in_the_same_order() {
    for config in networks() {
        let network = Network::new(&config, CHANNELS, OUTPUTS, 1, &Device::flex());
        let named = config.shape(CHANNELS, OUTPUTS).parameters();
        assert_eq!(named.len(), network.parameters().len(), "{config:?}");
        for (own, named) in network.parameters().iter().zip(&named) {
            assert_eq!(own.shape, named.axes, "{own:?} {named:?}");
            let expected = match own.name.split('.').collect::<Vec<_>>()[..] {
                ["head", what] => format!("fc.{what}"),
                // torch.nn.Sequential numbers activations too.
                ["layers", l, what] => format!("layers.{}.{what}", 2 * l.parse::<usize>().expect("a number")),
                _ if config.kind() == "gru" => format!("rnn.{}", own.name),
                _ => format!("rnn_cell.{}", own.name),
            };
            assert_eq!(named.name, expected);
        }
    }
}

#[test]
fn shapes_and_the_last_step() {
    let device = Device::flex();
    for config in networks() {
        let network = Network::new(&config, CHANNELS, OUTPUTS, 1, &device);
        let (inputs, elapsed) = windows(4, &device);
        let every = network.forward(inputs.clone(), elapsed.clone());
        let last = network.forward_last(inputs, elapsed);
        assert_eq!(every.dims(), [4, LENGTH, OUTPUTS], "{config:?}");
        assert_eq!(last.dims(), [4, OUTPUTS], "{config:?}");
        let end = every.narrow(1, LENGTH - 1, 1);
        assert!(largest_difference(&numbers(end), &numbers(last)) < 1e-6, "{config:?}");
    }
}

#[test]
fn windows_of_a_batch_do_not_see_each_other() {
    let device = Device::flex();
    for config in networks() {
        let network = Network::new(&config, CHANNELS, OUTPUTS, 1, &device);
        let (inputs, elapsed) = windows(5, &device);
        let together = numbers(network.forward_last(inputs.clone(), elapsed.clone()));
        for b in 0..5 {
            let alone = network.forward_last(inputs.clone().narrow(0, b, 1), elapsed.clone().narrow(0, b, 1));
            let row = &together[b * OUTPUTS..(b + 1) * OUTPUTS];
            assert!(largest_difference(row, &numbers(alone)) < 1e-6, "{config:?} window {b}");
        }
    }
}

/// Changing the last step changes the prediction there and at no step before.
#[test]
fn the_future_does_not_reach_the_past() {
    let device = Device::flex();
    for config in networks() {
        let network = Network::new(&config, CHANNELS, OUTPUTS, 1, &device);
        let (inputs, elapsed) = windows(2, &device);
        let past = inputs.clone().narrow(1, 0, LENGTH - 1);
        let changed = inputs.clone().narrow(1, LENGTH - 1, 1).add_scalar(1.0);
        let changed = Tensor::cat(vec![past, changed], 1);
        let before = network.forward(inputs, elapsed.clone());
        let after = network.forward(changed, elapsed);
        let step = |all: &Tensor<3>, t| numbers(all.clone().narrow(1, t, 1));
        for t in 0..LENGTH - 1 {
            assert_eq!(step(&before, t), step(&after, t), "{config:?} step {t}");
        }
        let moved = largest_difference(&step(&before, LENGTH - 1), &step(&after, LENGTH - 1));
        assert!(moved > 1e-4, "{config:?} moved by {moved}");
    }
}

#[test]
fn elapsed_time_matters_to_continuous_networks_alone() {
    let device = Device::flex();
    for config in networks() {
        let network = Network::new(&config, CHANNELS, OUTPUTS, 1, &device);
        let (inputs, elapsed) = windows(2, &device);
        let slow = numbers(network.forward_last(inputs.clone(), elapsed.clone().mul_scalar(10.0)));
        let fast = numbers(network.forward_last(inputs, elapsed));
        let moved = largest_difference(&slow, &fast);
        match config {
            NetworkConfig::Cfc(_) => assert!(moved > 1e-3, "{config:?} moved by {moved}"),
            NetworkConfig::Mlp(_) | NetworkConfig::Gru(_) => assert_eq!(moved, 0.0, "{config:?}"),
        }
    }
}

/// Oracle: the definition of a derivative. One step of central differences along a direction.
#[test]
fn gradients_are_those_of_finite_differences() {
    let device = Device::flex().autodiff();
    for config in networks() {
        let mut network = Network::new(&config, CHANNELS, OUTPUTS, 1, &device);
        let loss = |network: &Network| {
            let (inputs, elapsed) = windows(4, &device);
            let every = network.forward(inputs, elapsed);
            (every.clone() * every).mean()
        };
        let gradient = network.gradient(&mut loss(&network).backward());
        let direction = noise(gradient.len(), 5.0);
        let slope: f64 = gradient.iter().zip(&direction).map(|(g, d)| f64::from(*g) * f64::from(*d)).sum();

        let start = network.values();
        let mut at = |step: f32| {
            let moved: Vec<f32> = start.iter().zip(&direction).map(|(v, d)| v + step * d).collect();
            network.set_values(&moved);
            f64::from(loss(&network).into_scalar::<f32>())
        };
        let step = 5e-4;
        let differences = (at(step) - at(-step)) / (2.0 * f64::from(step));
        let off = (slope - differences).abs() / differences.abs().max(1e-2);
        assert!(off < 1e-2, "{config:?}: slope {slope}, differences {differences}");
    }
}

/// Plain gradient descent with momentum learns eight windows by heart.
#[test]
fn eight_windows_are_learnt_by_heart() {
    let device = Device::flex().autodiff();
    for config in NetworkConfig::all() {
        let mut network = Network::new(&config, CHANNELS, OUTPUTS, 1, &device);
        let target = Tensor::<2>::from_data(TensorData::new(noise(8 * OUTPUTS, 7.0), [8, OUTPUTS]), &device);
        let mut speed = vec![0.0; network.parameter_count()];
        let mut losses = Vec::new();
        for _ in 0..2000 {
            let (inputs, elapsed) = windows(8, &device);
            let residual = network.forward_last(inputs, elapsed) - target.clone();
            let loss = (residual.clone() * residual).mean();
            let gradient = network.gradient(&mut loss.backward());
            let mut values = network.values();
            for ((value, speed), gradient) in values.iter_mut().zip(&mut speed).zip(gradient) {
                *speed = 0.9 * *speed - 0.05 * gradient;
                *value += *speed;
            }
            network.set_values(&values);
            losses.push(loss.into_scalar::<f32>());
        }
        let end = losses[losses.len() - 1];
        assert!(end < 0.01 * losses[0], "{}: from {} to {end}", config.kind(), losses[0]);
    }
}

#[test]
fn values_carry_a_network_over() {
    let device = Device::flex();
    for config in networks() {
        let first = Network::new(&config, CHANNELS, OUTPUTS, 1, &device);
        let mut second = Network::new(&config, CHANNELS, OUTPUTS, 2, &device);
        let predict = |network: &Network| {
            let (inputs, elapsed) = windows(4, &device);
            numbers(network.forward_last(inputs, elapsed))
        };
        assert_ne!(predict(&first), predict(&second), "{config:?}");
        second.set_values(&first.values());
        assert_eq!(predict(&first), predict(&second), "{config:?}");
        let tracked = first.on(&Device::flex().autodiff());
        assert!(largest_difference(&predict(&first), &predict(&tracked)) < 1e-6, "{config:?}");
    }
}

/// The same seed gives the same bits, whichever thread builds the network first.
#[test]
fn first_values_follow_from_the_seed_alone() {
    for config in networks() {
        let build = |seed| Network::new(&config, CHANNELS, OUTPUTS, seed, &Device::flex()).values();
        let alone = build(7);
        let threads: Vec<Vec<f32>> = std::thread::scope(|scope| {
            let started: Vec<_> = (0..8).map(|i| scope.spawn(move || (i, build(7 + i)))).collect();
            started.into_iter().map(|thread| thread.join().expect("no panic").1).collect()
        });
        assert_eq!(threads[0], alone, "{config:?}");
        for other in &threads[1..] {
            assert_ne!(other, &alone, "{config:?}");
        }
    }
}

#[test]
fn files_carry_a_configuration_over() {
    for config in networks() {
        config.validate().expect("the list can be built");
        let text = toml::to_string(&config).expect("TOML");
        assert!(text.contains(&format!("kind = \"{}\"", config.kind())), "{text}");
        assert_eq!(toml::from_str::<NetworkConfig>(&text).expect(&text), config);
        let text = serde_json::to_string(&config).expect("JSON");
        assert_eq!(serde_json::from_str::<NetworkConfig>(&text).expect(&text), config);
    }
    assert_eq!(NetworkConfig::all().len(), NetworkConfig::KINDS.len());
    for (config, kind) in NetworkConfig::all().iter().zip(NetworkConfig::KINDS) {
        assert_eq!(config.kind(), *kind);
        assert_eq!(&toml::from_str::<NetworkConfig>(&format!("kind = \"{kind}\"")).expect(kind), config);
    }
}

#[test]
fn what_cannot_be_built_is_refused_with_a_remedy() {
    let refused = |text: &str| toml::from_str::<NetworkConfig>(text).expect_err(text).to_string();
    assert!(refused("kind = \"lstm\"").contains("lstm"));
    assert!(refused("kind = \"gru\"\nunitz = 3").contains("unitz"));
    assert!(refused("kind = \"gru\"\nunits = -3").contains("-3"));
    assert!(refused("kind = \"cfc\"\nmode = \"fast\"").contains("fast"));
    assert!(refused("units = 3").contains("kind"));

    let said = |text: &str| {
        let config: NetworkConfig = toml::from_str(text).expect(text);
        config.validate().expect_err(text).to_string()
    };
    assert!(said("kind = \"gru\"\nunits = 0").contains("units = 0"));
    assert!(said("kind = \"gru\"\nlayers = 0").contains("layers = 0"));
    assert!(said("kind = \"cfc\"\nunits = 1000000000").contains("1000000000"));
    assert!(said("kind = \"cfc\"\nbackbone_layers = 65").contains("backbone_layers = 65"));
    assert!(said("kind = \"mlp\"\nhidden = [64, 0]").contains("hidden = 0"));
}
