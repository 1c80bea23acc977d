//! Tables of a nominal study: every sample and every bin with the prediction of each model.
//!
//! | table         | rows                     | columns                                                                  |
//! | ------------- | ------------------------ | ------------------------------------------------------------------------ |
//! | `orders`      | samples of the one trial | `time`, `actuator_q`, `measured_o`, `order0_frozen_o`, `order0_refitted_o`, … |
//! | `bins`        | its bins                 | `samples`, then the same                                                 |
//! | `calibration` | all calibration samples  | `trial`, `time`, `actuator_q`, `measured_o`, `polynomial_o`, `strain_o`, `strain_joint_o`, and each with `left_out_` |
//!
//! Values are SI.

use acm_datasets::Trial;
use acm_datasets::files::table::Column;
use nalgebra::DMatrix;

use super::{baseline::Model, orders::Orders, record::NominalStudy};
use crate::schedule::descriptive::rms::stacked;

type Columns = Vec<(String, Column)>;

/// Returns the samples of the trial of the order study.
pub fn samples(trial: &Trial, orders: &Orders, record: &NominalStudy) -> Columns {
    let mut columns = vec![("time".into(), Column::Number(trial.time.clone()))];
    actuators(&mut columns, &trial.actuators, record);
    outputs(&mut columns, "measured", &orders.raw, record);
    predictions(&mut columns, orders, 1, record);
    columns
}

/// Returns the columns of the bins.
pub fn bins(orders: &Orders, record: &NominalStudy) -> Columns {
    let counts = orders.samples.iter().map(|&samples| samples as f64).collect();
    let mut columns = vec![("samples".into(), Column::Number(counts))];
    actuators(&mut columns, &orders.actuators, record);
    outputs(&mut columns, "measured", &orders.measured, record);
    predictions(&mut columns, orders, 0, record);
    columns
}

/// Returns every sample of the calibration trials.
pub fn calibration(trials: &[&Trial], measured: &[DMatrix<f64>], models: &[Model], record: &NominalStudy) -> Columns {
    let name = |trial: &&Trial| std::iter::repeat_n(trial.name.clone(), trial.samples());
    let time = trials.iter().flat_map(|trial| trial.time.iter().copied()).collect();
    let mut columns: Columns = vec![
        ("trial".into(), Column::Text(trials.iter().flat_map(name).collect())),
        ("time".into(), Column::Number(time)),
    ];
    actuators(&mut columns, &stacked(trials.iter().map(|trial| &trial.actuators)), record);
    outputs(&mut columns, "measured", &stacked(measured), record);
    for model in models {
        outputs(&mut columns, model.key(), &stacked(&model.fitted), record);
    }
    for model in models {
        if let Some(tables) = &model.left_out {
            outputs(&mut columns, &format!("left_out_{}", model.key()), &stacked(tables), record);
        }
    }
    columns
}

/// Adds the predictions of every order at the bins (`place` 0) or at the samples (1).
fn predictions(columns: &mut Columns, orders: &Orders, place: usize, record: &NominalStudy) {
    for predicted in &orders.predicted {
        for (protocol, tables) in [("frozen", &predicted.frozen), ("refitted", &predicted.refitted)] {
            outputs(columns, &format!("order{}_{protocol}", predicted.order), &tables[place], record);
        }
    }
}

fn actuators(columns: &mut Columns, table: &DMatrix<f64>, record: &NominalStudy) {
    for (signal, column) in record.actuators.iter().zip(table.column_iter()) {
        columns.push((format!("actuator_{}", signal.name), Column::Number(column.iter().copied().collect())));
    }
}

fn outputs(columns: &mut Columns, estimate: &str, table: &DMatrix<f64>, record: &NominalStudy) {
    for (output, column) in record.outputs.iter().zip(table.column_iter()) {
        columns.push((format!("{estimate}_{output}"), Column::Number(column.iter().copied().collect())));
    }
}
