//! Single steps against the batch.

use acm_kernels::{Keep, Kernel, Level};

use crate::cases::{Case, bodies, wide_bodies};
use crate::values::{error, expected};

#[test]
fn steps_follow_the_equations() {
    let mut worst = 0f64;
    for body in bodies().into_iter().chain(wide_bodies()) {
        let shape = acm_kernels::Shape { body, inputs: 3, outputs: 2 };
        let mut case = Case::new(shape.clone(), 1, 9, Keep::Every, true);
        if shape.layers_with_state() == 0 {
            case = Case::new(shape, 1, 9, Keep::Every, false);
        }
        // Wide networks with large weights are chaotic: they enlarge any rounding.
        case.parameters.iter_mut().for_each(|p| *p *= 0.4);
        let expected = expected(&case);
        for level in Level::available() {
            let kernel = Kernel::with_level(&case.shape, level).expect("sizes are positive");
            let mut stepper = kernel.stepper(&case.parameters);
            let sequences = case.sequences();
            for attempt in 0..2 {
                stepper.reset();
                if let Some(state) = sequences.state {
                    stepper.set_state(state);
                }
                let mut found = vec![0.0; expected.len()];
                let steps = sequences.inputs.chunks(3).zip(sequences.elapsed).zip(found.chunks_mut(2));
                for ((inputs, &elapsed), found) in steps {
                    stepper.step(inputs, elapsed, found);
                }
                let off = error(&found, &expected);
                assert!(off < 1e-5, "{level:?}, attempt {attempt}: off by {off:.1e}: {}", case.name());
                worst = worst.max(off);
            }
        }
    }
    eprintln!("worst error {worst:.1e}");
}

/// A state that is read and given to another stepper goes on as the first would.
#[test]
fn a_state_can_be_handed_over() {
    for body in bodies().into_iter().chain(wide_bodies()) {
        let case = Case::new(acm_kernels::Shape { body, inputs: 3, outputs: 2 }, 1, 2, Keep::Every, false);
        let kernel = Kernel::new(&case.shape).expect("sizes are positive");
        let (mut first, mut second) = (kernel.stepper(&case.parameters), kernel.stepper(&case.parameters));
        let sequences = case.sequences();
        let (mut left, mut right) = ([0.0; 2], [0.0; 2]);
        first.step(&sequences.inputs[..3], sequences.elapsed[0], &mut left);
        let mut state = vec![0.0; case.shape.layers_with_state() * case.shape.features()];
        first.state(&mut state);
        second.set_state(&state);
        first.step(&sequences.inputs[3..], sequences.elapsed[1], &mut left);
        second.step(&sequences.inputs[3..], sequences.elapsed[1], &mut right);
        assert_eq!(left, right, "{}", case.name());
    }
}
