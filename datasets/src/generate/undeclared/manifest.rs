//! Manifest of a campaign; it does not depend on the mechanism.

use super::store::TABLE;
use crate::manifest::{
    Actuation, Arm, Manifest, Measured, Quantity, Registration, Role, Roles, Signal, Strain, Table, Time, TrialName,
    Vehicle,
};
use crate::trial::Trial;
use acm_sim::twin::undeclared::Design;
use std::collections::BTreeMap;

/// The manifest of a campaign of these trials, of an arm of this length (m).
pub fn manifest(design: Design, length: f64, trials: &[Trial]) -> Manifest {
    let signal = |column: &str, unit: &str| Signal { column: column.into(), unit: unit.into(), ..Signal::default() };
    let tip = |column: &str| Measured { column: column.into(), unit: "m".into(), ..Measured::default() };
    let of = |role: Role| trials.iter().filter(|trial| trial.role == role).map(|trial| trial.name.clone()).collect();
    let condition = |trial: &Trial| {
        let quantities = trial.conditions.iter().map(|(name, value)| {
            let quantity = Quantity { value: *value, unit: "kg".into() };
            (name.clone(), quantity)
        });
        (trial.name.clone(), quantities.collect::<BTreeMap<_, _>>())
    };
    Manifest {
        name: format!("campaign-{}", design.name()),
        title: "Synthetic flight campaign of an aerial continuum manipulator (simulated, not measured)".into(),
        licence: "CC0-1.0".into(),
        source: format!("the simulator of this project (acm-datasets {})", env!("CARGO_PKG_VERSION")).into(),
        synthetic: true,
        table: Table {
            files: vec![TABLE.into()],
            ignore: vec!["sealed/*".into()],
            trial: TrialName { column: Some("trial".into()), file: None },
            time: Time { column: Some("t".into()), unit: Some("s".into()), rate_hz: None },
            ..Table::default()
        },
        actuator: vec![signal("q1", "rad"), signal("q2", "rad")],
        context: vec![signal("altitude", "m"), signal("throttle", "1")],
        measured: ["x", "y", "z"].map(tip).to_vec(),
        vehicle: Some(Vehicle {
            position: ["px", "py", "pz"].map(String::from).to_vec(),
            unit: "m".into(),
            attitude: vec![],
            attitude_unit: None,
        }),
        arm: Some(Arm {
            length: Quantity { value: length, unit: "m".into() },
            axis: Some("-z".into()),
            strain: Strain { basis: Some("legendre".into()), order: Some(1), segments: None },
            actuation: Actuation { degree: 3 },
            registration: Some(Registration { kind: Some("fixed".into()), ..Registration::default() }),
            ..Arm::default()
        }),
        roles: Roles {
            calibration: of(Role::Calibration),
            development: of(Role::Development),
            held_out: of(Role::HeldOut),
            excluded: vec![],
        },
        conditions: trials.iter().filter(|trial| !trial.conditions.is_empty()).map(condition).collect(),
        ..Manifest::default()
    }
}
