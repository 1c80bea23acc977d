//! Columns: inputs, outputs with their markers, predictions, the vehicle.

use std::collections::BTreeMap;

use super::Check;
use crate::join::Rule;
use crate::manifest::{Manifest, Measured, Signal};
use crate::units::Dimension;

impl Check<'_> {
    pub(super) fn signals(&mut self, list: &str, signals: &[Signal]) {
        for (i, signal) in signals.iter().enumerate() {
            let dimension = self.column(list, i, &signal.column, &signal.unit);
            if signal.fill == Some(Rule::None) {
                self.say(
                    &[list, &i.to_string(), "fill"],
                    "`fill` is \"previous\" or \"linear\"; choose one, or delete it",
                );
            }
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

    pub(super) fn measured(&mut self, manifest: &Manifest) {
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

    pub(super) fn predicted(&mut self, manifest: &Manifest) {
        self.signals("predicted", &manifest.predicted);
        let (predicted, measured) = (manifest.predicted.len(), manifest.measured.len());
        if predicted != 0 && predicted != measured {
            let message =
                format!("{predicted} [[predicted]] for {measured} [[measured]]; give one each, in the same order");
            self.say(&["predicted"], message);
        }
    }

    /// Time is neither an actuator nor an output; it may be a context signal.
    pub(super) fn no_time(&mut self, manifest: &Manifest) {
        let Some(time) = manifest.table.time.column.as_deref().filter(|time| !time.is_empty()) else { return };
        let of = |signals: &[Signal]| signals.iter().map(|signal| signal.column.clone()).collect::<Vec<_>>();
        let outputs = manifest.measured.iter().map(|output| output.column.clone()).collect();
        let position = manifest.vehicle.as_ref().map_or(Vec::new(), |vehicle| vehicle.position.clone());
        let attitude = manifest.vehicle.as_ref().map_or(Vec::new(), |vehicle| vehicle.attitude.clone());
        let lists: [(&[&str], Vec<String>, &str); 5] = [
            (&["actuator"], of(&manifest.actuator), "an actuator; name the column that is commanded"),
            (&["measured"], outputs, "an output; name the column that is measured"),
            (&["predicted"], of(&manifest.predicted), "a prediction; name the column that is predicted"),
            (&["vehicle", "position"], position, "a position; name its column"),
            (&["vehicle", "attitude"], attitude, "an attitude; name its column"),
        ];
        for (list, columns, remedy) in lists {
            for (i, _) in columns.iter().enumerate().filter(|(_, column)| *column == time) {
                let message = format!("column {time:?} is the time (`time` in [table]) and cannot be {remedy}");
                self.say(&[list, &[i.to_string().as_str()]].concat(), message);
            }
        }
    }

    /// A name must tell one input from another, and no output may be its own input.
    pub(super) fn names(&mut self, manifest: &Manifest) {
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

    pub(super) fn vehicle(&mut self, manifest: &Manifest) {
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
                self.say(&key, "three angles have an angle's unit, the four of a quaternion have \"1\"; correct it");
            }
            (count, _) => {
                let message = format!("{count} columns of attitude; name three angles or the four of a quaternion");
                self.say(&["vehicle", "attitude"], message);
            }
        }
    }
}
