//! What a manifest must satisfy beyond its types, each with the place in the file, the value and the remedy.

use std::collections::BTreeMap;

use super::{Arm, Manifest, Measured, Quantity, Signal, Table, Time, TrialName};
use crate::toml_file::{TomlError, TomlSource};
use crate::units::{Dimension, Unit};

/// A longer arm was measured in millimetres, m.
const LONGEST_ARM: f64 = 100.0;

/// Problems that are told; of more, the number.
const TOLD: usize = 100;

struct Check<'a> {
    source: &'a TomlSource,
    problems: Vec<TomlError>,
    more: usize,
}

impl Manifest {
    /// All problems of the manifest itself.
    pub fn validate(&self, source: &TomlSource) -> Vec<TomlError> {
        let mut check = Check { source, problems: Vec::new(), more: 0 };
        check.table(&self.table);
        check.signals("actuator", &self.actuator);
        check.signals("context", &self.context);
        check.measured(self);
        check.predicted(self);
        check.names(self);
        check.vehicle(self);
        if let Some(arm) = &self.arm {
            check.arm(arm);
        }
        check.roles(self);
        check.cuts(self);
        for (trial, constants) in &self.conditions {
            for (name, quantity) in constants {
                check.quantity(&["conditions", trial, name], quantity);
            }
        }
        if check.more > 0 {
            let message = format!("{} more problems; mend these first", check.more);
            check.problems.push(check.source.problem(&[], message));
        }
        check.problems
    }
}

impl Check<'_> {
    fn say(&mut self, key: &[&str], message: impl Into<String>) {
        if self.problems.len() >= TOLD {
            self.more += 1;
            return;
        }
        let key_and_message = format!("`{}`: {}", dotted(key), message.into());
        self.problems.push(self.source.problem(key, key_and_message));
    }

    fn table(&mut self, table: &Table) {
        if table.files.is_empty() {
            self.say(&["table"], "`files` is missing in [table]; name the data files, e.g. files = [\"*.csv\"]");
        }
        for (list, patterns) in [("files", &table.files), ("ignore", &table.ignore)] {
            for (i, pattern) in patterns.iter().enumerate() {
                let key = ["table", list, &i.to_string()];
                if let Err(e) = glob::Pattern::new(pattern) {
                    self.say(&key, format!("the pattern {pattern:?} is malformed ({}); correct it", e.msg));
                }
                if leaves_folder(pattern) {
                    self.say(&key, format!("the pattern {pattern:?} leaves the data folder; make it relative to it"));
                }
            }
        }
        if let Some(folder) = table.folder.as_deref().filter(|f| f.is_empty() || leaves_folder(f)) {
            self.say(
                &["table", "folder"],
                format!("{folder:?} leaves the shared data; write a path below it, such as \"data/arm\""),
            );
        }
        if let Some(separator) = table.separator.as_deref().filter(|s| ![",", ";", "\t", "|", " "].contains(s)) {
            let message = format!("separator {separator:?} is not one of \",\" \";\" \"\\t\" \"|\" and a space");
            self.say(&["table", "separator"], message);
        }
        self.trial_name(&table.trial);
        self.time(&table.time);
    }

    fn trial_name(&mut self, trial: &TrialName) {
        let key = ["table", "trial"];
        match (&trial.column, &trial.file) {
            (Some(_), Some(_)) => self.say(&key, "`trial` has both `column` and `file`; delete one of them"),
            (None, Some(pattern)) => match regex::Regex::new(pattern) {
                Err(e) => {
                    let reason = e.to_string();
                    let reason = reason.lines().last().unwrap_or_default().to_string();
                    self.say(
                        &["table", "trial", "file"],
                        format!("{pattern:?} is no regular expression ({reason}); write one such as \"run_(.*)\""),
                    );
                }
                Ok(regex) if regex.captures_len() < 2 => {
                    let message =
                        format!("{pattern:?} has no group; put the trial's name in parentheses, as in \"run_(.*)\"");
                    self.say(&["table", "trial", "file"], message);
                }
                Ok(_) => {}
            },
            (Some(column), None) if column.is_empty() => self.say(&key, "`column` is empty; name the column"),
            _ => {}
        }
    }

    fn time(&mut self, time: &Time) {
        let key = ["table", "time"];
        if let Some(rate) = time.rate_hz.filter(|r| !r.is_finite() || *r <= 0.0) {
            self.say(&["table", "time", "rate_hz"], format!("rate_hz is {rate}; give a finite rate above 0"));
        }
        match (&time.column, &time.unit, time.rate_hz) {
            (None, _, None) => {
                let forms = "{ column = \"t\", unit = \"s\" } or { rate_hz = 20.0 }";
                self.say(&key, format!("`time` is missing in [table]; say time = {forms}"));
            }
            (None, Some(_), Some(_)) => self.say(&key, "`unit` without `column`; name the column or delete `unit`"),
            (Some(_), None, _) => self.say(&key, "the unit of `time` is missing; add unit = \"s\" or \"sample\""),
            (Some(_), Some(unit), rate) => match self.unit(&["table", "time", "unit"], unit) {
                Some(Dimension::Sample) if rate.is_none() => {
                    self.say(&key, "time counts samples; add rate_hz, the samples per second");
                }
                Some(Dimension::Time) if rate.is_some() => {
                    self.say(&key, "the file has time stamps and `rate_hz` is given too; delete rate_hz");
                }
                Some(Dimension::Sample | Dimension::Time) | None => {}
                Some(_) => {
                    self.say(&["table", "time", "unit"], format!("{unit:?} is no unit of time; use s, ms or sample"))
                }
            },
            (None, None, Some(_)) => {}
        }
    }

    fn unit(&mut self, key: &[&str], name: &str) -> Option<Dimension> {
        match Unit::parse(name) {
            Ok(unit) => Some(unit.dimension),
            Err(e) => {
                self.say(key, e.to_string());
                None
            }
        }
    }

    fn column(&mut self, list: &str, i: usize, column: &str, unit: &str) -> Option<Dimension> {
        let i = i.to_string();
        if column.is_empty() {
            self.say(&[list, &i], format!("a [[{list}]] has no `column`; name its column in the files"));
        }
        if unit.is_empty() {
            let message = format!("`unit` of {column:?} is missing; add it (\"1\" for a plain number)");
            self.say(&[list, &i, "unit"], message);
            return None;
        }
        self.unit(&[list, &i, "unit"], unit)
    }

    fn signals(&mut self, list: &str, signals: &[Signal]) {
        for (i, signal) in signals.iter().enumerate() {
            let dimension = self.column(list, i, &signal.column, &signal.unit);
            let Some(quantity) = signal.quantity else { continue };
            let (key, name) = ([list, &i.to_string(), "quantity"], quantity.name());
            if list != "context" {
                self.say(&key, "`quantity` belongs to a [[context]]; delete it");
            } else if let Some(first) = signals[..i].iter().find(|other| other.quantity == signal.quantity) {
                self.say(&key, format!("{:?} is the {name} already; delete one `quantity`", first.name()));
            } else if dimension.is_some_and(|d| !quantity.fits(d)) {
                let message =
                    format!("{:?} is no unit of {}; correct the unit or delete `quantity`", signal.unit, name);
                self.say(&key, message);
            }
        }
    }

    fn measured(&mut self, manifest: &Manifest) {
        let measured = &manifest.measured;
        if measured.is_empty() {
            self.say(&["measured"], "no [[measured]]; declare at least one output");
        }
        if manifest.actuator.is_empty() && manifest.context.is_empty() {
            self.say(&["actuator"], "neither [[actuator]] nor [[context]]; declare at least one input");
        }
        for (i, output) in measured.iter().enumerate() {
            let dimension = self.column("measured", i, &output.column, &output.unit);
            let number = i.to_string();
            if manifest.has_markers() && dimension.is_some_and(|d| d != Dimension::Length) {
                let message =
                    format!("{:?} is a coordinate of a marker, and {:?} is no length", output.column, output.unit);
                self.say(&["measured", &number, "unit"], message + "; correct the unit, or delete [arm] and `at`");
            }
            if let Some(at) = output.at.filter(|at| !(*at > 0.0 && *at <= 1.0)) {
                self.say(&["measured", &number, "at"], format!("at = {at}; it is s/L, above 0 and up to 1 (the tip)"));
            }
        }
        if manifest.has_markers() && !measured.is_empty() {
            self.markers(manifest, measured);
        }
    }

    fn markers(&mut self, manifest: &Manifest, measured: &[Measured]) {
        if !measured.len().is_multiple_of(3) {
            let count = measured.len();
            return self
                .say(&["measured"], format!("{count} outputs; a marker has three: declare its x, y and z in turn"));
        }
        for (k, marker) in measured.chunks(3).enumerate() {
            let at = marker[0].at.unwrap_or(1.0);
            if let Some(j) = marker.iter().position(|m| m.at.unwrap_or(1.0) != at) {
                let message = format!("marker {} has different `at` in its x, y and z; give all three the same", k + 1);
                self.say(&["measured", &(3 * k + j).to_string()], message);
            }
        }
        let places = manifest.marker_places();
        for (k, at) in places.iter().enumerate() {
            if let Some(first) = places[..k].iter().position(|other| other == at) {
                let message = format!("markers {} and {} are both at {at}; correct `at`", first + 1, k + 1);
                self.say(&["measured", &(3 * k).to_string()], message);
            }
        }
        if !places.contains(&1.0) {
            self.say(&["measured"], "no marker is at the tip; give one `at = 1.0`: errors are reported for it");
        }
    }

    fn predicted(&mut self, manifest: &Manifest) {
        self.signals("predicted", &manifest.predicted);
        let (predicted, measured) = (manifest.predicted.len(), manifest.measured.len());
        if predicted != 0 && predicted != measured {
            let message =
                format!("{predicted} [[predicted]] for {measured} [[measured]]; give one each, in the same order");
            self.say(&["predicted"], message);
        }
    }

    /// A name must tell one input from another, and no output may be its own input.
    fn names(&mut self, manifest: &Manifest) {
        let inputs = [("actuator", &manifest.actuator), ("context", &manifest.context)];
        let mut seen: BTreeMap<&str, &str> = BTreeMap::new();
        for (list, signals) in inputs {
            for (i, signal) in signals.iter().enumerate() {
                let key = [list, &i.to_string()];
                if let Some(first) = seen.insert(signal.name(), list) {
                    let message =
                        format!("the name {:?} is taken by [[{first}]] already; add `name = …`", signal.name());
                    self.say(&key, message);
                }
                if manifest.measured.iter().any(|m| m.column == signal.column && !m.column.is_empty()) {
                    let message =
                        format!("column {:?} is [[measured]] too; an output cannot be an input", signal.column);
                    self.say(&key, message);
                }
            }
        }
        let mut columns: BTreeMap<&str, usize> = BTreeMap::new();
        let mut names: BTreeMap<&str, usize> = BTreeMap::new();
        for (i, output) in manifest.measured.iter().enumerate() {
            let twice = columns.insert(&output.column, i).is_some() || names.insert(output.name(), i).is_some();
            if twice && !output.column.is_empty() {
                let message = format!("output {:?} is declared twice; delete one or add `name = …`", output.name());
                self.say(&["measured", &i.to_string()], message);
            }
        }
    }

    fn vehicle(&mut self, manifest: &Manifest) {
        let Some(vehicle) = &manifest.vehicle else { return };
        if vehicle.position.len() != 3 {
            let count = vehicle.position.len();
            self.say(&["vehicle", "position"], format!("{count} columns of position; name three: x, y, z"));
        }
        if self.unit(&["vehicle", "unit"], &vehicle.unit).is_some_and(|d| d != Dimension::Length) {
            self.say(
                &["vehicle", "unit"],
                format!("{:?} is no length; correct the unit of the position", vehicle.unit),
            );
        }
        let key = ["vehicle", "attitude_unit"];
        let dimension = vehicle.attitude_unit.as_deref().and_then(|u| self.unit(&key, u));
        match (vehicle.attitude.len(), dimension) {
            (0, _) | (3, Some(Dimension::Angle)) | (4, None | Some(Dimension::One)) => {}
            (3, None) => self.say(&key, "three angles need attitude_unit = \"rad\" or \"deg\""),
            (3 | 4, _) => {
                self.say(&key, "three angles have an angle's unit, the four of a quaternion have \"1\"; correct it")
            }
            (count, _) => {
                let message = format!("{count} columns of attitude; name three angles or the four of a quaternion");
                self.say(&["vehicle", "attitude"], message);
            }
        }
    }

    fn quantity(&mut self, key: &[&str], quantity: &Quantity) -> Option<Dimension> {
        if !quantity.value.is_finite() {
            let message = format!("the value is {}; give a finite number", quantity.value);
            self.say(&[key, &["value"]].concat(), message);
        }
        let key = [key, &["unit"]].concat();
        if quantity.unit.is_empty() {
            self.say(&key, "the unit is missing; write { value = …, unit = \"…\" }");
            return None;
        }
        self.unit(&key, &quantity.unit)
    }

    fn arm(&mut self, arm: &Arm) {
        if self.quantity(&["arm", "length"], &arm.length).is_some_and(|d| d != Dimension::Length) {
            self.say(&["arm", "length", "unit"], format!("{:?} is no length; use m or mm", arm.length.unit));
        }
        if arm.length.value <= 0.0 {
            self.say(
                &["arm", "length", "value"],
                format!("the arm is {} long; give a length above 0", arm.length.value),
            );
        }
        if arm.length.si() > LONGEST_ARM {
            let message = format!("the arm is {} m long; correct its unit: 620 mm are 0.62 m", arm.length.si());
            self.say(&["arm", "length", "unit"], message);
        }
        for (name, axis) in [("axis", &arm.axis), ("down", &arm.down)] {
            if let Some(axis) = axis.as_deref().filter(|a| !["x", "y", "z", "-x", "-y", "-z"].contains(a)) {
                self.say(&["arm", name], format!("{name} {axis:?} is not one of x y z -x -y -z; choose one"));
            }
        }
        let before = self.problems.len();
        self.strain(arm);
        self.registration(arm);
        if let (true, Err(e)) = (self.problems.len() == before && arm.length.si() > 0.0, arm.spec().validate()) {
            self.say(&[&["arm"], arm_key(&e)].concat(), e.to_string());
        }
    }

    fn registration(&mut self, arm: &Arm) {
        let Some(registration) = &arm.registration else { return };
        let key = ["arm", "registration"];
        let pose = registration.rotation.is_some() || registration.translation.is_some();
        match registration.kind.as_deref() {
            Some("identified") if pose => {
                let message = "`rotation` and `translation` belong to kind = \"fixed\"; correct it, or delete them";
                self.say(&["arm", "registration", "kind"], message);
            }
            Some("fixed") if registration.twist.is_some() => {
                self.say(
                    &["arm", "registration", "twist"],
                    "it belongs to kind = \"identified\"; delete one of the two",
                );
            }
            Some("identified" | "fixed") => {}
            Some(other) => {
                self.say(&["arm", "registration", "kind"], format!("unknown kind {other:?}; known: identified, fixed"));
            }
            None => self.say(&key, "`kind` is missing; say kind = \"identified\" or \"fixed\""),
        }
    }

    fn strain(&mut self, arm: &Arm) {
        let (strain, key) = (&arm.strain, ["arm", "strain"]);
        match (strain.basis.as_deref(), strain.order, strain.segments) {
            (None, None, None) | (Some("legendre"), _, None) | (Some("piecewise"), None, Some(_)) => {}
            (Some("piecewise"), None, None) => self.say(&key, "a piecewise basis needs `segments`"),
            (Some("legendre"), _, Some(_)) => self.say(&key, "`segments` belongs to basis = \"piecewise\""),
            (Some("piecewise"), Some(_), _) => self.say(&key, "`order` belongs to basis = \"legendre\""),
            (Some(other), _, _) => {
                self.say(&["arm", "strain", "basis"], format!("unknown basis {other:?}; known: legendre, piecewise"));
            }
            (None, _, _) => self.say(&key, "`basis` is missing; say basis = \"legendre\" or \"piecewise\""),
        }
    }

    fn roles(&mut self, manifest: &Manifest) {
        let mut seen: BTreeMap<&str, &str> = BTreeMap::new();
        for role in super::Role::ALL {
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

    fn cuts(&mut self, manifest: &Manifest) {
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

/// `actuator[0].unit`, as serde's own messages have it.
fn dotted(key: &[&str]) -> String {
    key.iter().fold(String::new(), |path, part| match part.parse::<usize>() {
        Ok(index) if !path.is_empty() => format!("{path}[{index}]"),
        _ if path.is_empty() => part.to_string(),
        _ => format!("{path}.{part}"),
    })
}

/// The key that an error of the physics is about.
fn arm_key(error: &acm_core::arm::ArmError) -> &'static [&'static str] {
    use acm_core::arm::ArmError;
    match error {
        ArmError::Length { .. } => &["length", "value"],
        ArmError::OutOfRange { what: "strain.segments", .. } => &["strain", "segments"],
        ArmError::OutOfRange { what, .. } if what.starts_with("strain") => &["strain", "order"],
        ArmError::OutOfRange { what: "degree", .. } => &["actuation", "degree"],
        ArmError::OutOfRange { .. } => &["steps"],
        ArmError::Tolerance { .. } => &["tolerance"],
        ArmError::Registration { what: "rotation", .. } => &["registration", "rotation"],
        ArmError::Registration { .. } => &["registration", "translation"],
    }
}

fn leaves_folder(path: &str) -> bool {
    path.starts_with(['/', '\\', '~']) || path.contains(':') || path.split(['/', '\\']).any(|part| part == "..")
}
