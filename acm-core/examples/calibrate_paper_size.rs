//! How long does the paper's calibration take? 10,538 samples, 20 parameters, planted values with 5 mm of noise.
//!
//! `cargo run -p acm-core --example calibrate_paper_size`

use std::time::Instant;

use acm_core::registration::RegistrationSpec;
use acm_core::{ArmSpec, NominalModel, NominalSpec, Observations, StrainModel, calibrate};
use nalgebra::DMatrix;

const SAMPLES: usize = 10_538;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arm = ArmSpec {
        registration: RegistrationSpec::Fixed { rotation: [0.0; 3], translation: [0.0; 3] },
        ..ArmSpec::default()
    };
    let truth = StrainModel::new(&arm, 2, &[1.0])?;
    let mut theta = truth.parameters().to_vec();
    theta[1] = 0.9;
    theta[9] = 1.2;
    theta[14] = -0.03;
    theta[18..20].copy_from_slice(&[-0.6, 0.8]);
    let truth = NominalModel::Strain(truth.with_parameters(&theta));
    let actuators = DMatrix::from_fn(SAMPLES, 2, |t, a| 2.8 * (t as f64 * [0.013, 0.0007][a]).sin());

    let clock = Instant::now();
    let clean = truth.predict(&actuators);
    println!("predict   {SAMPLES} samples: {:8.2} ms", 1e3 * clock.elapsed().as_secs_f64());

    let measured = DMatrix::from_fn(SAMPLES, 3, |t, o| clean[(t, o)] + 0.005 * (t as f64 * 1.7 + o as f64).sin());
    let data = Observations { actuators, measured, at: vec![1.0] };
    for spec in [NominalSpec::Strain(arm), NominalSpec::Polynomial { degree: 3 }] {
        let clock = Instant::now();
        let found = calibrate(&spec, &data)?;
        let seconds = clock.elapsed().as_secs_f64();
        println!(
            "calibrate {} parameters: {:8.2} ms, 3-D RMS {:.2} mm",
            found.parameters.len(),
            1e3 * seconds,
            1e3 * found.rms_total
        );
        for stage in &found.stages {
            println!(
                "  {:10} {:6.2} mm, {} iterations, {:?}",
                stage.name,
                1e3 * stage.rms,
                stage.iterations,
                stage.stopped
            );
        }
    }
    Ok(())
}
