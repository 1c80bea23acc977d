//! Recorded loads on an arm: their direction, and their size where a signal measures it.
//!
//! | load     | where  | size                                             | told by                        |
//! | -------- | ------ | ------------------------------------------------ | ------------------------------ |
//! | weight   | arm    | not known: its direction alone                   | `[arm]`: which way is down     |
//! | payload  | tip    | m g, N                                           | a signal or condition, kg      |
//! | downwash | arm    | the throttle, to which its pressure is taken to be proportional | a context signal |
//!
//! All three push downwards ([`acm_core::rig::Mounting`]), as the effects of [`acm_core::effects`] take them.

use acm_datasets::{
    Campaign, Trial,
    rig::{record, rig},
};
use serde::{Deserialize, Serialize};

use crate::run::data::Data;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.80665;

/// A load along one trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// Name of the load: `weight`, `payload` or `downwash`.
    pub name: String,
    /// Place of the load.
    pub place: Place,
    /// Unit vector in the measurement frame.
    pub direction: [f64; 3],
    /// Unit of the sizes.
    pub unit: String,
    /// Size at each time; empty where only the direction is known.
    pub size: Vec<f64>,
}

/// Place of a load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// Along the whole arm.
    Arm,
    /// At the tip.
    Tip,
}

/// Returns the loads of a trial at the samples `rows`; none where the data describe no arm.
pub fn of(data: &Data, trial: &Trial, rows: &[usize]) -> Vec<Load> {
    let campaign = Campaign {
        manifest: data.manifest.clone(),
        trials: vec![trial.clone()],
        hash: data.hash.clone(),
        warnings: vec![],
        folder: data.folder.clone(),
        alignments: vec![],
    };
    let rig = rig(&campaign, &[trial]);
    let Some(arm) = &rig.arm else { return vec![] };
    let (contexts, whole) = (record(&campaign, trial).contexts, trial.with_unmeasured().1);
    let at = |signal: usize, factor: f64| rows.iter().map(|&row| factor * contexts[signal][whole[row]]).collect();
    let load = |name: &str, place, unit: &str, size: Vec<f64>| Load {
        name: name.into(),
        place,
        direction: arm.down.into(),
        unit: unit.into(),
        size,
    };
    let mut loads = vec![load("weight", Place::Arm, "", vec![])];
    loads.extend(rig.payload.map(|signal| load("payload", Place::Tip, "N", at(signal, GRAVITY))));
    loads.extend(rig.throttle.map(|signal| load("downwash", Place::Arm, &rig.contexts[signal].unit, at(signal, 1.0))));
    loads.retain(|load| load.size.is_empty() || load.size.iter().any(|size| *size != 0.0));
    loads
}
