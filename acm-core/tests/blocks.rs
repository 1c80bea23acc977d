//! Samples side by side: the bits of one sample do not depend on its company.

use acm_core::axis::Axis;
use acm_core::registration::RegistrationSpec;
use acm_core::strain::StrainBasis;
use acm_core::tip_model::STRIDE;
use acm_core::{ArmSpec, NominalModel, StrainModel};
use nalgebra::DMatrix;

/// Every basis, several markers, an arm that refines its steps, and curvature through several turns in a few samples.
fn models() -> Vec<StrainModel> {
    let bases = [
        StrainBasis::Legendre { order: 0 },
        StrainBasis::Legendre { order: 1 },
        StrainBasis::Legendre { order: 3 },
        StrainBasis::Piecewise { segments: 3 },
    ];
    let with = |(k, strain): (usize, StrainBasis)| {
        let arm = ArmSpec {
            strain,
            degree: 1 + k % 3,
            axis: Axis::ALL[k],
            tolerance: (k == 2).then_some(1e-9),
            registration: RegistrationSpec::Identified { twist: true },
            ..ArmSpec::default()
        };
        let model = StrainModel::new(&arm, 2, &[0.4, 1.0]).unwrap();
        let theta: Vec<f64> = (0..model.parameters().len()).map(|j| 1.5 * (1.0 + 1.7 * j as f64).sin()).collect();
        model.with_parameters(&theta)
    };
    bases.into_iter().enumerate().map(with).collect()
}

/// Small values, zero, and a few that bend the arm so far that a step turns by more than two radians.
fn actuator(sample: usize, a: usize) -> f64 {
    match sample % 13 {
        0 => 0.0,
        7 => 6.0 - 9.0 * a as f64,
        k => (k as f64 * 0.7 + a as f64 + sample as f64 * 0.01).sin(),
    }
}

/// Oracle: the same sample alone, output by output, for numbers of samples that fill registers and that do not.
#[test]
fn company_changes_no_bit() {
    for model in models() {
        let free: Vec<usize> = (0..model.parameters().len()).rev().step_by(2).collect();
        let mut block = model.block_with_all_slopes(&free);
        let (width, outputs) = (model.parameters().len(), model.outputs());
        for samples in [1, 5, STRIDE] {
            for a in 0..2 {
                block.actuator_mut(a).iter_mut().enumerate().for_each(|(t, q)| *q = actuator(t, a));
            }
            model.fill(model.parameters(), samples, &mut block);
            let mut scratch = model.scratch();
            let (mut out, mut alone) = (vec![0.0; outputs], vec![0.0; outputs]);
            let (mut slopes, mut by_actuator) = (vec![0.0; outputs * width], vec![0.0; outputs * 2]);
            for t in 0..samples {
                let q = [actuator(t, 0), actuator(t, 1)];
                model.jacobians_with(model.parameters(), &q, &mut scratch, &mut out, &mut slopes, &mut by_actuator);
                model.predict(&q, &mut scratch, &mut alone);
                for o in 0..outputs {
                    assert_eq!(block.output(o)[t].to_bits(), out[o].to_bits(), "sample {t}, output {o}");
                    assert_eq!(alone[o].to_bits(), out[o].to_bits(), "sample {t}, output {o}");
                    for (column, &j) in free.iter().enumerate() {
                        assert_eq!(
                            block.by_parameter(o, column)[t],
                            slopes[o * width + j],
                            "sample {t}, parameter {j}"
                        );
                    }
                    for a in 0..2 {
                        assert_eq!(block.by_actuator(o, a)[t], by_actuator[o * 2 + a], "sample {t}, actuator {a}");
                    }
                }
            }
        }
    }
}

/// Oracle: one sample at a time, over more samples than a block holds.
#[test]
fn long_records_are_put_together_in_order() {
    for model in models() {
        let actuators = DMatrix::from_fn(3 * STRIDE + 7, 2, actuator);
        let predicted = NominalModel::Strain(model.clone()).predict(&actuators);
        let (mut scratch, mut out) = (model.scratch(), vec![0.0; model.outputs()]);
        for (t, row) in predicted.row_iter().enumerate() {
            model.predict(&[actuator(t, 0), actuator(t, 1)], &mut scratch, &mut out);
            assert!(row.iter().eq(&out), "sample {t}");
        }
    }
}

/// One sample with its memory at hand asks for none; a block asks for as much whether it holds one sample or many.
#[test]
fn no_sample_allocates() {
    for model in models() {
        let theta = model.parameters();
        let (mut scratch, mut out) = (model.scratch(), vec![0.0; model.outputs()]);
        let (mut slopes, mut by_actuator) = (vec![0.0; out.len() * theta.len()], vec![0.0; out.len() * 2]);
        let alone = allocation_counter::measure(|| {
            model.predict(&[0.3, -0.4], &mut scratch, &mut out);
            model.jacobians_with(theta, &[0.3, -0.4], &mut scratch, &mut out, &mut slopes, &mut by_actuator);
        });
        assert_eq!(alone.count_total, 0);
        let mut block = model.block_with_all_slopes(&[0, 1]);
        let mut of = |samples| allocation_counter::measure(|| model.fill(theta, samples, &mut block)).count_total;
        // What the processor can do is asked for once.
        of(1);
        assert_eq!(of(1), of(STRIDE));
    }
}
