//! Order study on a planted linear arm: order one is enough, order zero is not.

use acm_core::calibration::{order_fits, order_study};
use acm_core::registration::RegistrationSpec;
use acm_core::{ArmSpec, NominalModel, Observations, StrainModel};
use nalgebra::DMatrix;

fn arm() -> ArmSpec {
    ArmSpec {
        registration: RegistrationSpec::Fixed { rotation: [0.0; 3], translation: [0.0, 0.0, 1.5] },
        ..ArmSpec::default()
    }
}

/// One sweep of q1 at q2 = 0, in the plane of x and z.
fn sweep() -> Observations {
    let model = StrainModel::new(&arm(), 2, &[1.0]).unwrap();
    let mut theta = model.parameters().to_vec();
    theta[9] = 1.1;
    theta[14] = -0.02;
    theta[19] = 1.2;
    let model = NominalModel::Strain(model.with_parameters(&theta));
    let actuators = DMatrix::from_fn(2000, 2, |t, a| if a == 0 { 3.0 * (t as f64 * 0.01).sin() } else { 0.0 });
    Observations { measured: model.predict(&actuators), actuators, at: vec![1.0] }
}

/// Oracle: the planted order. Averaging curved data in bins leaves a few tenths of a millimetre.
#[test]
fn the_planted_order_is_the_one_that_suffices() {
    let rows = order_study(&sweep(), &arm(), &[0, 1, 2, 3], 40).unwrap();
    println!("{rows:#?}");
    assert_eq!(rows.iter().map(|row| row.order).collect::<Vec<_>>(), [0, 1, 2, 3]);
    for row in &rows[1..] {
        assert!(row.frozen_rmse < 1e-3 && row.refitted_rmse < 1e-3, "{row:?}");
    }
    assert!(rows[0].frozen_rmse > 0.02, "{:?}", rows[0]);
    assert!(rows[0].refitted_rmse > 2e-3, "{:?}", rows[0]);
    // Refitting can only help, and so can a higher order.
    for row in &rows {
        assert!(row.refitted_rmse <= row.frozen_rmse * 1.000001, "{row:?}");
    }
    for pair in rows.windows(2) {
        assert!(pair[1].frozen_rmse <= pair[0].frozen_rmse * 1.000001);
    }
}

#[test]
fn too_few_bins_are_refused() {
    let error = order_study(&sweep(), &arm(), &[0, 1], 3).unwrap_err().to_string();
    assert!(error.contains("3 bins"), "{error}");
}

/// Oracle: hand count. Five sweeps of the second actuator over 0 to 0.99 at a hundred places make ten bins of fifty, and
/// the mean of a bin is the middle of its ten places.
#[test]
fn bins_are_over_the_actuator_that_sweeps() {
    let actuators = DMatrix::from_fn(500, 2, |t, a| if a == 1 { (t % 100) as f64 / 100.0 } else { 0.0 });
    let model = StrainModel::new(&arm(), 2, &[1.0]).unwrap();
    let mut theta = model.parameters().to_vec();
    theta[1] = 1.1;
    let measured = NominalModel::Strain(model.with_parameters(&theta)).predict(&actuators);
    let fits = order_fits(&Observations { measured, actuators, at: vec![1.0] }, &arm(), &[1], 10, 1).unwrap();
    assert_eq!(fits.samples, [50; 10]);
    for (bin, row) in fits.binned.actuators.row_iter().enumerate() {
        assert!((row[1] - (0.1 * bin as f64 + 0.045)).abs() < 1e-12 && row[0] == 0.0, "{row}");
    }
}
