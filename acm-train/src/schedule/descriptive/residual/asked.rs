//! Configuration of a residual study.

use std::path::PathBuf;

use acm_datasets::Role;
use serde::{Deserialize, Serialize};

use crate::config::Fault;

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct File {
    /// Kind of the study: `residual`.
    pub study: String,
    /// Question in one sentence.
    pub question: String,
    /// Experiment whose data and nominal model are studied, relative to this file.
    pub base: PathBuf,
    /// Settings of the table `[residual_study]`.
    pub residual_study: Asked,
}

/// `[residual_study]`: the settings of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Asked {
    /// Roles of the trials that are described.
    pub roles: Vec<Role>,
    /// Context signal that is the altitude. Left out: the one that the manifest declares, by quantity or name.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub altitude: Option<String>,
    /// Trials whose mean altitudes are no further apart belong together, m.
    pub altitude_tolerance: f64,
    /// Number of bins over the swept actuator.
    pub bins: usize,
    /// Samples that a bin needs to be shown.
    pub least_in_bin: usize,
    /// Largest distance between values of held actuators in one slice, as a share of their range.
    pub slice_tolerance: f64,
    /// Number of nominal backbones that are drawn for each slice.
    pub backbones: usize,
}

impl Default for File {
    fn default() -> Self {
        Self {
            study: "residual".into(),
            question: "What does the nominal model miss in flight?".into(),
            base: "cfc.toml".into(),
            residual_study: Asked::default(),
        }
    }
}

impl Default for Asked {
    fn default() -> Self {
        Self {
            roles: vec![Role::Development, Role::HeldOut],
            altitude: None,
            altitude_tolerance: 0.1,
            bins: 24,
            least_in_bin: 10,
            slice_tolerance: 0.1,
            backbones: 5,
        }
    }
}

impl File {
    /// Returns every fault that can be found without the data.
    pub fn faults(&self) -> Vec<Fault> {
        let asked = &self.residual_study;
        let mut faults = vec![];
        for (name, value, least, most) in [
            ("bins", asked.bins, 2, 1000),
            ("least_in_bin", asked.least_in_bin, 2, 1_000_000),
            ("backbones", asked.backbones, 0, 20),
        ] {
            if !(least..=most).contains(&value) {
                let key = format!("residual_study.{name}");
                let help = format!("write a whole number, {least} to {most}");
                faults.push(Fault::new(&key, format!("is {value}"), help));
            }
        }
        for (name, value, unit) in
            [("altitude_tolerance", asked.altitude_tolerance, " m"), ("slice_tolerance", asked.slice_tolerance, "")]
        {
            if value < 0.0 {
                let key = format!("residual_study.{name}");
                faults.push(Fault::new(&key, format!("is {value}{unit}"), "write a number, 0 or more"));
            }
        }
        if asked.roles.is_empty() {
            let help = "name roles of trials: roles = [\"development\", \"held_out\"]";
            faults.push(Fault::new("residual_study.roles", "is empty, so there is nothing to describe", help));
        }
        faults
    }
}
