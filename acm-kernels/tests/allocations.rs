//! Nothing is allocated once a workspace has seen a batch, nor in single steps.

use acm_kernels::{Activation, Body, CfcMode, CfcShape, GruShape, Keep, Kernel, MlpShape, Sequences, Shape};

fn allocations(work: impl FnOnce()) -> u64 {
    allocation_counter::measure(work).count_total
}

fn bodies() -> Vec<Body> {
    let activation = Activation::LecunTanh;
    let cfc = |mode| CfcShape { units: 9, mode, backbone_units: 12, backbone_layers: 2, activation };
    vec![
        Body::Cfc(cfc(CfcMode::Default)),
        Body::Cfc(cfc(CfcMode::Pure)),
        Body::Gru(GruShape { units: 9, layers: 2 }),
        Body::Mlp(MlpShape { hidden: vec![12, 7], activation }),
    ]
}

#[test]
fn steady_state_allocates_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread starts");
    for body in bodies() {
        let shape = Shape { body, inputs: 3, outputs: 2 };
        let kernel = Kernel::new(&shape).expect("sizes are positive");
        let (batch, steps) = (70, 11);
        let (inputs, elapsed) = (vec![0.3; batch * steps * 3], vec![0.1; batch * steps]);
        let parameters = vec![0.1; kernel.parameters()];
        let sequences = Sequences { inputs: &inputs, elapsed: &elapsed, state: None, batch, steps, keep: Keep::Every };
        let (mut work, mut stepper) = (kernel.workspace(), kernel.stepper(&parameters));
        let mut predictions = vec![0.0; kernel.predictions(&sequences)];
        let mut gradient = vec![0.0; kernel.parameters()];
        let mut all = || {
            kernel.forward(&parameters, &sequences, &mut work, &mut predictions);
            kernel.backward(&parameters, &sequences, &predictions, &mut work, &mut gradient);
            let loss = |_: usize, found: &[f32], to: &mut [f32]| {
                to.copy_from_slice(found);
                0.0
            };
            kernel.train(&parameters, &sequences, &loss, &mut work, &mut gradient);
            kernel.infer(&parameters, &sequences, &mut work, &mut predictions);
            stepper.step(&inputs[..3], 0.1, &mut predictions[..2]);
        };
        pool.install(|| {
            let first = allocations(&mut all);
            assert!(first > 0, "the counter counts");
            assert_eq!(allocations(&mut all), 0, "{shape:?}");
        });
    }
}
