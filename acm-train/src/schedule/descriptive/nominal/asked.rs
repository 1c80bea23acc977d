//! Configuration of a nominal study.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::config::Fault;

/// Range of the number of bins. With fewer, no curve can be distinguished from another; with more, each holds too few
/// samples.
const BINS: std::ops::RangeInclusive<usize> = 8..=1000;
/// Largest Legendre order. Beyond it, a fit of forty bins is a fit of noise.
const HIGHEST_ORDER: usize = 8;

/// The whole file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct File {
    /// Kind of the study: `nominal`.
    pub study: String,
    /// Question in one sentence.
    pub question: String,
    /// Experiment whose data and nominal model are studied, relative to this file.
    pub base: PathBuf,
    /// Settings of the table `[nominal_study]`.
    pub nominal_study: Asked,
}

/// `[nominal_study]`: the settings of the study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Asked {
    /// Calibration trial of the order study. Left out: the one in which all actuators but the swept one are nearest to
    /// zero, so that the arm bends in one plane.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trial: Option<String>,
    /// Number of bins over the swept actuator.
    pub bins: usize,
    /// Legendre orders that are compared.
    pub orders: Vec<usize>,
}

impl Default for File {
    fn default() -> Self {
        Self {
            study: "nominal".into(),
            question: "How well does the nominal model know the arm at rest?".into(),
            base: "cfc.toml".into(),
            nominal_study: Asked::default(),
        }
    }
}

impl Default for Asked {
    fn default() -> Self {
        Self { trial: None, bins: 40, orders: vec![0, 1, 2, 3] }
    }
}

impl File {
    /// Returns every fault that can be found without the data.
    pub fn faults(&self) -> Vec<Fault> {
        let Asked { bins, orders, .. } = &self.nominal_study;
        let (least, most) = (BINS.start(), BINS.end());
        let bins = (!BINS.contains(bins)).then(|| {
            Fault::new("nominal_study.bins", format!("is {bins}"), format!("write a whole number, {least} to {most}"))
        });
        let key = "nominal_study.orders";
        let too_high = orders.iter().find(|order| **order > HIGHEST_ORDER).map(|order| {
            Fault::new(key, format!("names order {order}"), format!("write orders from 0 to {HIGHEST_ORDER}"))
        });
        let twice = (1..orders.len()).find(|&k| orders[..k].contains(&orders[k]));
        let twice = twice.map(|k| Fault::new(key, format!("names order {} twice", orders[k]), "name each order once"));
        let none = orders.is_empty().then(|| Fault::new(key, "is empty", "write at least one: orders = [0, 1]"));
        [bins, too_high, twice, none].into_iter().flatten().collect()
    }
}
