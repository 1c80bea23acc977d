//! One, two and five threads give the same bits.

use acm_kernels::{Body, CfcMode, CfcShape, GruShape, Keep, Kernel, MlpShape, Shape};

use crate::cases::Case;

fn bodies() -> [Body; 3] {
    let activation = acm_kernels::Activation::LecunTanh;
    [
        Body::Cfc(CfcShape { units: 6, mode: CfcMode::Default, backbone_units: 10, backbone_layers: 1, activation }),
        Body::Gru(GruShape { units: 6, layers: 2 }),
        Body::Mlp(MlpShape { hidden: vec![9], activation }),
    ]
}

/// Predictions, gradient in two ways, loss.
fn results(case: &Case) -> (Vec<f32>, Vec<f32>, Vec<f32>, f64) {
    let kernel = Kernel::new(&case.shape).expect("sizes are positive");
    let (mut work, derivatives) = (kernel.workspace(), case.derivatives());
    let mut predictions = vec![0.0; derivatives.len()];
    let mut inferred = predictions.clone();
    let mut gradient = vec![0.0; kernel.parameters()];
    let mut trained = gradient.clone();
    kernel.forward(&case.parameters, &case.sequences(), &mut work, &mut predictions);
    kernel.backward(&case.parameters, &case.sequences(), &derivatives, &mut work, &mut gradient);
    kernel.infer(&case.parameters, &case.sequences(), &mut work, &mut inferred);
    assert_eq!(predictions, inferred);
    let loss = |first: usize, found: &[f32], to: &mut [f32]| {
        to.copy_from_slice(&derivatives[first..first + to.len()]);
        found.iter().map(|&p| f64::from(p)).sum()
    };
    let loss = kernel.train(&case.parameters, &case.sequences(), &loss, &mut work, &mut trained);
    (predictions, gradient, trained, loss)
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for body in bodies() {
        // 1 shard, several, and more than there are groups.
        for batch in [20, 200, 1500] {
            let shape = Shape { body: body.clone(), inputs: 3, outputs: 2 };
            let case = Case::new(shape, batch, 4, Keep::Every, true);
            let with = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
                pool.install(|| results(&case))
            };
            let one = with(1);
            for threads in [2, 3, 5] {
                assert!(with(threads) == one, "{threads} threads: {}", case.name());
            }
        }
    }
}
