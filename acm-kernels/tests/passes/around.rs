//! What lies around a pass: derivatives by inputs and first state, the state that a piece leaves, and networks without a
//! linear layer.
//!
//! Oracle of derivatives: central differences of the equations in double precision, as for those by parameters. Oracle
//! of pieces: the whole sequence in one.

use acm_kernels::{Activation, Body, Keep, Kernel, Sequences, Shape};

use crate::cases::{Case, cases, noise};
use crate::equations::{self, Batch};
use crate::values::error;

const TOLERANCE: f64 = 1e-5;
const STEP: f64 = 1e-5;

/// Central differences of Σ k_i p_i by the numbers that `part` picks.
fn differences(case: &Case, part: impl Fn(&mut Batch) -> &mut Vec<f64>) -> Vec<f64> {
    let parameters: Vec<_> = case.parameters.iter().map(|&p| f64::from(p)).collect();
    let mut batch = case.in_double();
    let mut loss = |i: usize, step: f64| {
        let before = part(&mut batch)[i];
        part(&mut batch)[i] = before + step;
        let all = equations::predictions(&case.shape, &parameters, &batch);
        part(&mut batch)[i] = before;
        all.iter().zip(case.derivatives()).map(|(p, k)| p * f64::from(k)).sum::<f64>()
    };
    let count = part(&mut case.in_double()).len();
    (0..count).map(|i| (loss(i, STEP) - loss(i, -STEP)) / (2.0 * STEP)).collect()
}

fn smooth(case: &Case) -> bool {
    !matches!(&case.shape.body, Body::Cfc(cfc) if cfc.activation == Activation::Relu)
        && !matches!(&case.shape.body, Body::Mlp(mlp) if mlp.activation == Activation::Relu)
}

/// Derivatives by inputs and first state.
fn around(case: &Case) -> [Vec<f32>; 2] {
    let kernel = Kernel::new(&case.shape).expect("sizes are positive");
    let (mut work, derivatives, sequences) = (kernel.workspace(), case.derivatives(), case.sequences());
    let mut predictions = vec![0.0; derivatives.len()];
    let mut gradient = vec![0.0; kernel.parameters()];
    kernel.forward(&case.parameters, &sequences, &mut work, &mut predictions);
    kernel.backward(&case.parameters, &sequences, &derivatives, &mut work, &mut gradient);
    let (mut inputs, mut state) = (vec![f32::NAN; case.inputs.len()], vec![f32::NAN; kernel.states(&sequences)]);
    kernel.derivatives(&case.parameters, &sequences, &derivatives, &mut work, &mut inputs, &mut state);
    [inputs, state]
}

#[test]
fn derivatives_by_inputs_and_first_state_are_those_of_finite_differences() {
    for case in cases().iter().filter(|case| smooth(case)) {
        let [inputs, state] = around(case);
        let scaled = |found: &[f32], expected: &[f64]| {
            let size = expected.iter().fold(1.0f64, |most, d| most.max(d.abs()));
            let found: Vec<_> = found.iter().map(|&d| (f64::from(d) / size) as f32).collect();
            error(&found, &expected.iter().map(|d| d / size).collect::<Vec<_>>())
        };
        let off = scaled(&inputs, &differences(case, |batch| &mut batch.inputs));
        assert!(off < TOLERANCE, "inputs: off by {off:.1e}: {}", case.name());
        if case.state.is_some() && !state.is_empty() {
            let off = scaled(&state, &differences(case, |batch| batch.state.as_mut().expect("it is given")));
            assert!(off < TOLERANCE, "state: off by {off:.1e}: {}", case.name());
        }
    }
}

/// Steps `from .. to` of each sequence.
fn piece(case: &Case, from: usize, to: usize) -> [Vec<f32>; 3] {
    let cut = |all: &[f32], width: usize| {
        let rows = all.chunks(case.steps * width).flat_map(|one| &one[from * width..to * width]);
        rows.copied().collect::<Vec<_>>()
    };
    let (inputs, elapsed) = (cut(&case.inputs, case.shape.inputs), cut(&case.elapsed, 1));
    [inputs, elapsed, cut(&case.derivatives(), case.shape.outputs)]
}

/// Two pieces, of which the second goes on from the state that the first leaves, predict what the whole predicts; and
/// the derivative by that state carries the gradient back.
#[test]
fn two_pieces_are_the_whole() {
    let of_interest = |case: &&Case| case.keep == Keep::Every && case.steps > 1;
    for case in cases().iter().filter(of_interest) {
        let kernel = Kernel::new(&case.shape).expect("sizes are positive");
        let (whole, batch, cut) = (case.sequences(), case.batch, case.steps / 2);
        let [inputs, elapsed, derivatives] = piece(case, 0, cut);
        let first = Sequences { inputs: &inputs, elapsed: &elapsed, steps: cut, ..whole };
        let mut works = [kernel.workspace(), kernel.workspace(), kernel.workspace()];
        let count = kernel.parameters();
        let mut predictions = [vec![0.0; kernel.predictions(&first)], vec![0.0; kernel.predictions(&whole)]];
        kernel.forward(&case.parameters, &first, &mut works[0], &mut predictions[0]);
        let mut state = vec![f32::NAN; kernel.states(&first)];
        kernel.last_state(&first, &works[0], &mut state);

        let [inputs, elapsed, later] = piece(case, cut, case.steps);
        let given = (!state.is_empty()).then_some(state.as_slice());
        let second = Sequences { inputs: &inputs, elapsed: &elapsed, state: given, steps: case.steps - cut, ..whole };
        let mut rest = vec![0.0; kernel.predictions(&second)];
        kernel.forward(&case.parameters, &second, &mut works[1], &mut rest);
        kernel.forward(&case.parameters, &whole, &mut works[2], &mut predictions[1]);
        let outputs = case.shape.outputs;
        for b in 0..batch {
            let of = |all: &[f32], steps: usize| all[b * steps * outputs..(b + 1) * steps * outputs].to_vec();
            let pieces = [of(&predictions[0], cut), of(&rest, case.steps - cut)].concat();
            assert_eq!(pieces, of(&predictions[1], case.steps), "{}", case.name());
        }

        let mut gradients = [vec![0.0; count], vec![0.0; count], vec![0.0; count]];
        let (mut by_inputs, mut by_state) = (vec![0.0; inputs.len()], vec![0.0; state.len()]);
        kernel.backward(&case.parameters, &second, &later, &mut works[1], &mut gradients[1]);
        kernel.derivatives(&case.parameters, &second, &later, &mut works[1], &mut by_inputs, &mut by_state);
        let last = Some(by_state.as_slice());
        kernel.backward_from(&case.parameters, &first, &derivatives, last, &mut works[0], &mut gradients[0]);
        kernel.backward(&case.parameters, &whole, &case.derivatives(), &mut works[2], &mut gradients[2]);
        let size = gradients[2].iter().fold(1.0f32, |most, g| most.max(g.abs()));
        for i in 0..count {
            let off = (gradients[0][i] + gradients[1][i] - gradients[2][i]).abs() / size;
            assert!(off < 1e-5, "gradient {i} off by {off:.1e}: {}", case.name());
        }
    }
}

/// Without a linear layer a network predicts what it does through one that is the identity, and has its gradient.
#[test]
fn features_are_predictions_through_the_identity() {
    let linear = |case: &Case| matches!(&case.shape.body, Body::Mlp(mlp) if mlp.hidden.is_empty());
    for case in cases().into_iter().filter(|case| !linear(case)) {
        let width = case.shape.features();
        let shape = Shape { outputs: width, ..case.shape.clone() };
        let mut through = Case::new(shape, case.batch, case.steps, case.keep, case.state.is_some());
        let own = through.parameters.len() - (width * width + width);
        for (i, value) in through.parameters[own..].iter_mut().enumerate() {
            *value = f32::from(u8::from(i < width * width && i % (width + 1) == 0));
        }
        let identity = Kernel::new(&through.shape).expect("sizes are positive");
        let plain = Kernel::without_head(&through.shape.body, through.shape.inputs).expect("sizes are positive");
        assert_eq!(plain.parameters(), own);
        let run = |kernel: &Kernel| {
            let (parameters, sequences) = (&through.parameters[..kernel.parameters()], through.sequences());
            let mut work = kernel.workspace();
            let mut predictions = vec![f32::NAN; kernel.predictions(&sequences)];
            let mut inferred = predictions.clone();
            let mut gradient = vec![f32::NAN; kernel.parameters()];
            let derivatives = noise(predictions.len(), 11.0);
            kernel.forward(parameters, &sequences, &mut work, &mut predictions);
            kernel.backward(parameters, &sequences, &derivatives, &mut work, &mut gradient);
            kernel.infer(parameters, &sequences, &mut work, &mut inferred);
            assert_eq!(predictions, inferred, "{}", case.name());
            let mut stepper = kernel.stepper(parameters);
            let mut stepped = vec![0.0; width];
            stepper.step(&through.inputs[..through.shape.inputs], through.elapsed[0], &mut stepped);
            gradient.truncate(own);
            (predictions, gradient, stepped)
        };
        assert_eq!(run(&plain), run(&identity), "{}", case.name());
    }
}
