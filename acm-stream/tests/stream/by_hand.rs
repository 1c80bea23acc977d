//! Oracle: hand arithmetic with a network that hands on one channel, and a nominal model that is given.

use acm_kernels::{Activation, Body, MlpShape, Shape};
use acm_stream::{Channel, ChannelRange, Estimator, Nominal, Parts, PartsError, Scaler, Signals, Source, StateRule};

fn hands_on(channel: Channel) -> Estimator {
    scaled(channel, 1.0).expect("parts that fit")
}

fn scaled(channel: Channel, factor: f64) -> Result<Estimator, PartsError> {
    several(channel, vec![], factor)
}

fn several(channel: Channel, members: Vec<Vec<f32>>, factor: f64) -> Result<Estimator, PartsError> {
    let parts = Parts {
        signals: Signals { actuators: vec!["q".into()], contexts: vec!["c".into()] },
        nominal: Nominal::Given(2),
        tip: 0..1,
        channels: vec![channel],
        ranges: Some(vec![ChannelRange { low: -4.0, high: 5.0 }]),
        inputs: Scaler { mean: vec![1.0], spread: vec![2.0] },
        targets: Scaler { mean: vec![10.0], spread: vec![4.0] },
        network: Shape {
            body: Body::Mlp(MlpShape { hidden: vec![], activation: Activation::Tanh }),
            inputs: 1,
            outputs: 1,
        },
        weights: vec![1.0, 0.0],
        members,
        factor,
        straight: vec![],
        max_gap: 0.5,
        first_elapsed: 0.1,
        state: StateRule::Running,
        actuators: vec![],
        interval: None,
        labels: None,
    };
    Estimator::new(parts)
}

/// 100 + f (4 (7 − 1)/2 + 10), and the nominal model where f = 0.
#[test]
fn the_factor_scales_what_the_network_adds() {
    let channel = || Channel { source: Source::Context(0), rate: false };
    for (factor, tip) in [(1.0, 122.0), (0.25, 105.5), (0.0, 100.0)] {
        let mut estimator = scaled(channel(), factor).expect("parts that fit");
        assert_eq!(estimator.step(&[3.0, 7.0, 100.0, 200.0], 0.0).expect("a sample"), [tip]);
    }
    for factor in [-0.1, 1.5, f64::NAN] {
        assert!(matches!(scaled(channel(), factor), Err(PartsError::Value { what: "the factor", .. })));
    }
}

/// 100 + ¼ (4 (7 − 1)/2 + 10) + ½ (7 − 1)/2 + ⅛: the factor does not act on the straight path.
#[test]
fn a_straight_path_runs_beside_the_network() {
    let network = scaled(Channel { source: Source::Context(0), rate: false }, 0.25).expect("parts that fit");
    let with = |straight: &[Vec<f64>]| Estimator::new(Parts { straight: straight.to_vec(), ..network.parts().clone() });
    let mut estimator = with(&[vec![0.5], vec![0.125]]).expect("parts that fit");
    assert_eq!(estimator.step(&[3.0, 7.0, 100.0, 200.0], 0.0).expect("a sample"), [107.125]);
    for wrong in [vec![vec![0.5]], vec![vec![0.5], vec![]], vec![vec![0.5], vec![f64::NAN]]] {
        assert!(with(&wrong).is_err(), "{wrong:?}");
    }
}

#[test]
fn channels_are_scaled_and_predictions_restored() {
    for (source, value) in [(Source::Actuator(0), 3.0), (Source::Context(0), 7.0)] {
        let mut estimator = hands_on(Channel { source, rate: false });
        // 100 + 4 (value − 1)/2 + 10
        let found = estimator.step(&[3.0, 7.0, 100.0, 200.0], 0.0).expect("a sample").to_vec();
        assert_eq!(found, [110.0 + 2.0 * (value - 1.0)]);
        assert_eq!(estimator.nominal(), [100.0]);
    }
}

/// Networks that hand on one, three and five times the channel: 100 + f (4 · 3 (7 − 1)/2 + 10).
#[test]
fn an_ensemble_says_the_mean() {
    let channel = || Channel { source: Source::Context(0), rate: false };
    let members = vec![vec![3.0, 0.0], vec![5.0, 0.0]];
    for (factor, tip) in [(1.0, 146.0), (0.5, 123.0)] {
        let mut estimator = several(channel(), members.clone(), factor).expect("parts that fit");
        assert_eq!(estimator.step(&[3.0, 7.0, 100.0, 200.0], 0.0).expect("a sample"), [tip]);
    }
    assert!(several(channel(), vec![vec![3.0]], 1.0).is_err());
}

/// Steps of 0.5 s (no gap yet, rounding included), 0.25 s, and 0.6 s (a gap).
#[test]
fn rates_begin_anew_after_a_gap() {
    let mut estimator = hands_on(Channel { source: Source::Actuator(0), rate: true });
    let mut rate = |q: f64, elapsed: f64| {
        let found = estimator.step(&[q, 0.0, 0.0, 0.0], elapsed).expect("a sample")[0];
        ((found - 10.0) / 2.0 + 1.0, estimator.history())
    };
    assert_eq!(rate(5.0, 9.0), (0.0, 1));
    assert_eq!(rate(6.0, 0.5 * (1.0 + 1e-10)).1, 2);
    assert_eq!(rate(5.0, 0.25), (-4.0, 3));
    assert_eq!(rate(9.0, 0.6), (0.0, 1));
    assert_eq!(rate(10.0, 0.5), (2.0, 2));
}

/// Training saw −4 to 5. A rate leaves its range though its signal does not, and starts again after a gap.
#[test]
fn a_sample_is_in_range_where_all_its_channels_are() {
    let channel = |rate| Channel { source: Source::Actuator(0), rate };
    let mut signal = hands_on(channel(false));
    assert_eq!(signal.in_range(), None, "nothing was asked yet");
    for (q, expected) in [(-4.0, true), (5.0, true), (5.1, false), (0.0, true), (1000.0, false)] {
        let inputs = [q, 1e6, 0.0, 0.0];
        signal.step(&inputs, 0.1).expect("a sample");
        assert_eq!(signal.in_range(), Some(expected), "{q}");
        signal.step_unseen(&inputs, 0.1).expect("a sample");
        assert_eq!(signal.in_range(), Some(expected), "{q}, not seen");
    }
    signal.restart();
    assert_eq!(signal.in_range(), None);
    let mut rate = hands_on(channel(true));
    for (q, elapsed, expected) in [(0.0, 0.1, true), (0.4, 0.1, true), (1.0, 0.1, false), (90.0, 9.0, true)] {
        rate.step(&[q, 0.0, 0.0, 0.0], elapsed).expect("a sample");
        assert_eq!(rate.in_range(), Some(expected), "{q}");
    }
}
