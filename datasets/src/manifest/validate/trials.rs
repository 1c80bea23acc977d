//! Roles of trials, and cuts.

use std::collections::BTreeMap;

use super::Check;
use crate::manifest::{Manifest, Role};

impl Check<'_> {
    pub(super) fn roles(&mut self, manifest: &Manifest) {
        let mut seen: BTreeMap<&str, &str> = BTreeMap::new();
        for role in Role::ALL {
            for (i, trial) in manifest.roles.of(role).iter().enumerate() {
                let key = ["roles", role.name(), &i.to_string()];
                if let Some(first) = seen.insert(trial, role.name()) {
                    let message =
                        format!("trial {trial:?} is in {first} already; a trial has exactly one role: delete one");
                    self.say(&key, message);
                }
                if manifest.cut.contains_key(trial) {
                    let message = format!(
                        "trial {trial:?} is cut: its parts have their roles in [cut.{trial:?}]; delete it here"
                    );
                    self.say(&key, message);
                }
            }
        }
    }

    pub(super) fn cuts(&mut self, manifest: &Manifest) {
        for (trial, parts) in &manifest.cut {
            if parts.is_empty() {
                self.say(&["cut", trial], "the cut has no parts; add head = { until = …, role = \"…\" } or delete it");
            }
            let open: Vec<&String> = parts.iter().filter(|(_, p)| p.until.is_none()).map(|(name, _)| name).collect();
            if open.len() != 1 && !parts.is_empty() {
                let message = format!("{} parts have no `until`; exactly one takes the rest of the trial", open.len());
                let key: Vec<&str> = ["cut", trial].into_iter().chain(open.first().map(|name| name.as_str())).collect();
                self.say(&key, message);
            }
            let mut ends: Vec<f64> = Vec::new();
            for (name, part) in parts {
                let key = ["cut", trial, name];
                if part.role.is_none() {
                    self.say(&key, "the part has no role; add role = \"calibration\", \"development\", \"held_out\" or \"excluded\"");
                }
                if let Some(until) = part.until {
                    if !until.is_finite() {
                        self.say(&key, format!("until = {until}; give a finite time in s"));
                    } else if ends.contains(&until) {
                        self.say(&key, format!("two parts end at {until} s; correct `until`"));
                    }
                    ends.push(until);
                }
            }
        }
    }
}
