//! Campaigns of the arm with undeclared mechanisms, as data sets.

mod manifest;
pub mod store;

use crate::Campaign;
use crate::manifest::Role;
use crate::trial::Trial;
use acm_sim::twin::TwinError;
use acm_sim::twin::undeclared::{self as simulator, Design, Kind, Truth, Undeclared, UndeclaredTrial};
use nalgebra::DMatrix;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::PathBuf;

pub use store::write;

/// A campaign and what is true of it.
#[derive(Clone, Debug, PartialEq)]
pub struct UndeclaredCampaign {
    /// As [`Campaign::read`] would give it, but for the folder, which is empty, and the hash, which is over the numbers
    /// and not over files.
    pub campaign: Campaign,
    /// Truth of the campaign.
    pub truth: Truth,
}

/// Makes a campaign; the kind is drawn from the seed where none is given.
///
/// # Errors
/// An arm without equilibrium.
pub fn generate(seed: u64, design: Design, kind: Option<Kind>) -> Result<UndeclaredCampaign, TwinError> {
    Ok(campaign(simulator::generate(seed, design, kind)?))
}

/// Makes the same campaign as it would be recorded without noise.
///
/// # Errors
/// An arm without equilibrium.
pub fn generate_without_noise(seed: u64, design: Design, kind: Option<Kind>) -> Result<UndeclaredCampaign, TwinError> {
    Ok(campaign(simulator::generate_without_noise(seed, design, kind)?))
}

fn campaign(made: Undeclared) -> UndeclaredCampaign {
    let trials: Vec<Trial> = made.trials.iter().map(trial).collect();
    let manifest = manifest::manifest(made.design, made.length, &trials);
    let hash = hash(&trials);
    let campaign = Campaign { manifest, trials, hash, warnings: vec![], folder: PathBuf::new(), alignments: vec![] };
    UndeclaredCampaign { campaign, truth: made.truth }
}

/// SHA-256 over all numbers of the trials, hex.
pub(super) fn hash(trials: &[Trial]) -> String {
    let mut hash = Sha256::new();
    for trial in trials {
        hash.update(trial.name.as_bytes());
        let vehicle = trial.vehicle.iter().flat_map(|vehicle| vehicle.iter());
        let signals = trial.actuators.iter().chain(trial.context.iter()).chain(trial.measured.iter()).chain(vehicle);
        trial.time.iter().chain(signals).for_each(|value| hash.update(value.to_le_bytes()));
    }
    acm_hashed::hexadecimal(&hash.finalize())
}

fn trial(made: &UndeclaredTrial) -> Trial {
    let rows = made.time.len();
    let columns = |columns: &[&Vec<f64>]| DMatrix::from_fn(rows, columns.len(), |row, column| columns[column][row]);
    let [q1, q2] = &made.actuators;
    let [px, py, pz] = &made.vehicle;
    Trial {
        name: made.number.to_string(),
        role: role(made.role),
        time: made.time.clone(),
        actuators: columns(&[q1, q2]),
        context: columns(&[&made.altitude, &made.throttle]),
        measured: DMatrix::from_fn(rows, 3, |row, axis| made.tip[row][axis]),
        predicted: None,
        vehicle: Some(columns(&[px, py, pz])),
        conditions: made.payload.map(|mass| ("payload".to_string(), mass)).into_iter().collect(),
        dropped: BTreeMap::new(),
        file: store::TABLE.into(),
        unmeasured: None,
    }
}

/// The role of a simulated trial in a data set.
pub(super) fn role(role: acm_sim::Role) -> Role {
    match role {
        acm_sim::Role::Calibration => Role::Calibration,
        acm_sim::Role::Development => Role::Development,
        acm_sim::Role::HeldOut => Role::HeldOut,
    }
}
