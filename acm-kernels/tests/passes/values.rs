//! Predictions against the equations in double precision, on every level of this processor.

use acm_kernels::{Kernel, Level};

use crate::cases::{Case, cases, wide_cases};
use crate::equations;

const TOLERANCE: f64 = 1e-5;

/// Greatest |found − expected| in proportion to 1 + |expected|.
pub fn error(found: &[f32], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let errors = found.iter().zip(expected).map(|(&f, &e)| (f64::from(f) - e).abs() / (1.0 + e.abs()));
    errors.fold(0.0, |most, error| if error > most || error.is_nan() { error } else { most })
}

pub fn expected(case: &Case) -> Vec<f64> {
    let parameters: Vec<_> = case.parameters.iter().map(|&p| f64::from(p)).collect();
    equations::predictions(&case.shape, &parameters, &case.in_double())
}

#[test]
fn forward_and_infer_follow_the_equations() {
    let mut worst = 0f64;
    for case in cases().into_iter().chain(wide_cases()) {
        let expected = expected(&case);
        for level in Level::available() {
            let kernel = Kernel::with_level(&case.shape, level).expect("sizes are positive");
            let mut work = kernel.workspace();
            let mut found = vec![f32::NAN; expected.len()];
            kernel.forward(&case.parameters, &case.sequences(), &mut work, &mut found);
            let forward = error(&found, &expected);
            assert!(forward < TOLERANCE, "forward, {level:?}: off by {forward:.1e}: {}", case.name());
            found.fill(f32::NAN);
            kernel.infer(&case.parameters, &case.sequences(), &mut work, &mut found);
            let infer = error(&found, &expected);
            assert!(infer < TOLERANCE, "infer, {level:?}: off by {infer:.1e}: {}", case.name());
            worst = worst.max(forward).max(infer);
        }
    }
    eprintln!("worst error {worst:.1e}");
}

/// A workspace that has seen other batches answers as a new one does.
#[test]
fn a_used_workspace_leaves_no_trace() {
    for pair in cases().chunks(5) {
        let kernel = Kernel::new(&pair[0].shape).expect("sizes are positive");
        let mut used = kernel.workspace();
        for case in pair.iter().rev().filter(|case| case.shape == pair[0].shape) {
            let run = |work: &mut _| {
                let mut found = vec![0.0; case.derivatives().len()];
                let mut gradient = vec![0.0; kernel.parameters()];
                kernel.forward(&case.parameters, &case.sequences(), work, &mut found);
                kernel.backward(&case.parameters, &case.sequences(), &case.derivatives(), work, &mut gradient);
                (found, gradient)
            };
            assert_eq!(run(&mut used), run(&mut kernel.workspace()), "{}", case.name());
        }
    }
}
