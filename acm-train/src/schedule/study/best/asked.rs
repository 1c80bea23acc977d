//! `[best]`: configuration of a search for the best model.
//!
//! ```toml
//! study    = "best"
//! question = "Which model shall I use?"
//! [best]
//! loop    = "runs/loop-my-robot/model.json"  # left out: no model that `acm-eval close-loop` made
//! average = 4                                # models in an average at most; 1: none
//! robot   = true                             # choose only among what `acm-eval stream` answers with; left out: among all
//! [[base]]                                   # as many as wanted, each an experiment file
//! name       = "GRU"
//! experiment = "my-robot.toml"
//! ```

use std::path::PathBuf;

use serde::Deserialize;

use crate::config::Fault;

/// Name of the model without a network.
pub const NOMINAL: &str = "nominal";
/// Name of the loop's model without a network.
pub const LOOP: &str = "loop";

/// Largest number of models in an average. More would be chosen by chance.
const MOST: usize = 8;

/// The table `[best]`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Asked {
    /// `model.json` of a closed loop, found as `data` is: a candidate, and the nominal model of each base once more.
    #[serde(rename = "loop")]
    pub augmented: Option<PathBuf>,
    /// Loop models fitted without the trials of each fold, in the order of the folds, so that no model has seen the
    /// fold that it is scored on.
    pub loop_folds: Vec<PathBuf>,
    /// Largest number of models in an average.
    pub average: usize,
    /// Whether only models that can run on a robot may be chosen: networks, nominal models and averages of these.
    pub robot: bool,
}

impl Default for Asked {
    fn default() -> Self {
        Self { augmented: None, loop_folds: vec![], average: 4, robot: false }
    }
}

/// Returns the faults of the table, and of keys that it excludes.
pub fn faults(asked: Option<&Asked>, bases: &[&String], no_variant: bool, no_sweep: bool) -> Vec<Fault> {
    let mut faults = vec![];
    if !no_variant {
        let help = "delete it: all bases are compared under the same folds; [set] edits all of them";
        faults.push(Fault::new("variant", "is not a key of study = \"best\"", help));
    }
    if !no_sweep {
        let help = "delete it, or run the sweep first and give its best-….toml as a base";
        faults.push(Fault::new("sweep", "is not a key of study = \"best\"", help));
    }
    if let Some(place) = bases.iter().position(|name| [NOMINAL, LOOP].contains(&name.as_str())) {
        let what = format!("is {:?}, which is what a model without anything learned is called", bases[place]);
        faults.push(Fault::new(&format!("base.{place}.name"), what, "give it another name"));
    }
    let average = asked.map_or(1, |asked| asked.average);
    if !(1..=MOST).contains(&average) {
        faults.push(Fault::new(
            "best.average",
            format!("is {average}"),
            format!("write 1 to {MOST}; 4 is the default"),
        ));
    }
    if asked.is_some_and(|asked| asked.augmented.is_none() && !asked.loop_folds.is_empty()) {
        let help = "name the model of all development trials too: it is what the winner is made of";
        faults.push(Fault::new("best.loop_folds", "is set without best.loop", help));
    }
    faults
}
