//! `[[source]]`: files, clocks, offsets.

use std::collections::{BTreeMap, BTreeSet};

use super::Check;
use crate::manifest::{ByTrial, Clock, Drift, Manifest, OffsetTable, Source, Table};
use crate::units::{Dimension, Unit};

impl Check<'_> {
    pub(super) fn sources(&mut self, manifest: &Manifest) {
        let sources = &manifest.source.list;
        if manifest.table != Table::default() {
            self.say(&["table"], "the manifest has [table] and [[source]]; keep one of them");
        }
        if sources.len() > 1 || sources.iter().any(|s| s.clock.is_some()) {
            let references = sources.iter().filter(|source| source.is_reference()).count();
            if references != 1 {
                let message = format!("{references} sources are the reference; give one of them clock = \"reference\"");
                self.say(&["source"], message);
            }
        }
        let mut names = BTreeSet::new();
        for (i, source) in sources.iter().enumerate() {
            let number = i.to_string();
            if source.name.is_empty() || source.name.contains(['.', ' ']) {
                let message =
                    format!("`name` is {:?}; give a name without dots and blanks, such as \"mocap\"", source.name);
                self.say(&["source", &number, "name"], message);
            } else if !names.insert(&source.name) {
                self.say(&["source", &number, "name"], format!("{:?} is there twice; rename one of them", source.name));
            }
            self.source_files(&number, source);
            self.source_clock(&number, source);
            self.source_columns(&number, source, manifest);
        }
        for (list, i, column, _) in manifest.signal_columns() {
            let known = sources.iter().any(|source| source.column(&column).is_some());
            if !known && !column.is_empty() {
                let names = sources.iter().map(|s| format!("{}.…", s.name)).collect::<Vec<_>>().join(" or ");
                self.say(
                    &[list, &i.to_string(), "column"],
                    format!("column {column:?} names no source; write {names}"),
                );
            }
        }
    }

    fn source_files(&mut self, number: &str, source: &Source) {
        if source.files.is_empty() {
            self.say(
                &["source", number],
                "`files` is missing; name the source's files, e.g. files = [\"*_mocap.csv\"]",
            );
        }
        self.patterns(&["source", number, "files"], &source.files);
        if source.trial.column.is_some() {
            let message = "the files of a source are one trial each; write trial = { file = \"(.*)_mocap\" }";
            self.say(&["source", number, "trial"], message);
        } else if !source.shared {
            self.file_pattern(&["source", number, "trial", "file"], &source.trial);
        } else if source.is_reference() {
            self.say(&["source", number, "shared"], "the reference has one file for each trial; delete `shared`");
        }
        self.signs(&["source", number], source.separator.as_deref(), source.decimal.as_deref());
        let key = ["source", number, "time"];
        match (source.format, source.time == Default::default()) {
            (Some(format), false) if !format.is_table() => {
                self.say(&key, format!("files of format {} have times of their own; delete `time`", format.name()));
            }
            (_, false) => self.clock_of(&key, &source.time),
            (Some(_), true) if source.format.is_some_and(crate::formats::Format::is_table) => {
                let forms = "{ column = \"t\", unit = \"s\" } or { rate_hz = 20.0 }";
                self.say(&key, format!("`time` of a table is missing; say time = {forms}"));
            }
            _ => {}
        }
        if let Some(gap) = &source.gap {
            let dimension = self.quantity(&["source", number, "gap"], gap);
            if dimension.is_some_and(|d| d != Dimension::Time) || gap.value <= 0.0 {
                self.say(&["source", number, "gap"], "`gap` is a time above 0; write { value = 0.2, unit = \"s\" }");
            }
        }
    }

    fn source_clock(&mut self, number: &str, source: &Source) {
        let key = ["source", number, "offset"];
        match (&source.clock, &source.offset) {
            (Some(Clock::Reference | Clock::Same), Some(_)) => {
                self.say(&key, "this clock has no offset; delete `offset` or `clock`");
            }
            (None, None) if !source.is_reference() => {
                let message = "its clock is not known: write offset = \"estimate\", offset = { value = …, unit = \"s\" }, or clock = \
                               \"same\" where one computer stamped both";
                self.say(&["source", number], message);
            }
            (None, Some(offset)) => self.offset(&key, &offset.table()),
            _ => {}
        }
        match &source.drift {
            Some(_) if source.offset.is_none() => {
                self.say(&["source", number, "drift"], "`drift` without `offset`; delete it");
            }
            Some(Drift::Table(given)) if !(given.ppm.abs() < 1e4) => {
                let message = format!("{} ppm is no drift of a clock; give parts per million", given.ppm);
                self.say(&["source", number, "drift"], message);
            }
            Some(Drift::Word(_)) if source.offset.as_ref().is_some_and(|o| o.table().estimate.is_none()) => {
                self.say(
                    &["source", number, "drift"],
                    "a drift is estimated with the offset; write offset = \"estimate\"",
                );
            }
            _ => {}
        }
    }

    fn offset(&mut self, key: &[&str], offset: &OffsetTable) {
        let forms = [offset.value.is_some(), offset.estimate.is_some(), offset.event.is_some()];
        if forms.iter().filter(|form| **form).count() != 1 {
            let message =
                "write one of { value = …, unit = \"s\" }, { estimate = \"estimate\" } and { event = \"column\", … }";
            return self.say(key, message);
        }
        for (name, numbers) in [("value", &offset.value), ("around", &offset.around)] {
            for (trial, number) in numbers.iter().flat_map(ByTrial::numbers).filter(|(_, number)| !number.is_finite()) {
                let key: Vec<&str> = key.iter().copied().chain([name]).chain(trial).collect();
                self.say(&key, format!("the offset is {number}; give a finite number"));
            }
        }
        if offset.value.is_some() {
            let unit = offset.unit.as_deref().and_then(|unit| Unit::parse(unit).ok());
            if unit.is_none_or(|unit| unit.dimension != Dimension::Time) {
                self.say(key, "the unit of `value` is missing or no time; write unit = \"s\"");
            }
        }
        if offset.event.is_some()
            && (offset.reference.is_none() || offset.above.is_none() || offset.reference_above.is_none())
        {
            let message = "an event has { event = \"column\", above = …, reference = \"column of the reference\", \
                           reference_above = … }";
            self.say(key, message);
        }
        if !offset.by.is_empty() && offset.by.len() != 2 {
            self.say(key, "`by` names two columns: the reference's, and the source's");
        }
        if offset.within.is_some_and(|within| !(within > 0.0 && within.is_finite())) {
            self.say(key, "`within` is a number of seconds above 0");
        }
    }

    fn source_columns(&mut self, number: &str, source: &Source, manifest: &Manifest) {
        let full = |column: &String| format!("{}.{column}", source.name);
        let angles: Vec<String> = source.angles.iter().map(full).collect();
        self.periodic(&["source", number], &angles, &source.counters, manifest);
    }

    /// Angles have a unit of an angle, and counters a range.
    pub(super) fn periodic(
        &mut self,
        key: &[&str],
        angles: &[String],
        counters: &BTreeMap<String, f64>,
        manifest: &Manifest,
    ) {
        for (i, column) in angles.iter().enumerate().filter(|(_, column)| manifest.turn(column).is_none()) {
            let message =
                format!("{column:?} is declared nowhere with a unit of an angle; declare it, or delete it here");
            self.say(&[key, &["angles", &i.to_string()]].concat(), message);
        }
        for (column, range) in counters.iter().filter(|(_, range)| !(range.is_finite() && **range > 0.0)) {
            let message = format!("the range of a counter is {range}; write how many values it has, such as 65536");
            self.say(&[key, &["counters", column]].concat(), message);
        }
    }
}
