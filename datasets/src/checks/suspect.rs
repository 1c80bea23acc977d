//! Samples that can be read and look spoiled: a single outlier, a stretch that is frozen, a marker written as 0 where it was
//! lost. Each is a warning with file, rows, columns, value and remedy; none of them changes what is read.
//!
//! Looked at are the outputs and the vehicle's position. Inputs may step, rest and be 0 as they please.

mod frozen;
mod spike;
mod zero;

use std::borrow::Cow;
use std::ops::Range;

use nalgebra::DMatrix;

use crate::checks::plausible::number;
use crate::ingest::layout::{Layout, Source};
use crate::text::rows::Rows;
use crate::trial::Trial;
use crate::units::Dimension;

/// Suspicious samples of a trial whose samples come from these rows of its file.
pub(crate) fn look(trial: &Trial, rows: &[usize], layout: &Layout) -> Vec<String> {
    let look = Look { trial, rows, inputs: inputs(trial) };
    let outputs = |columns: Range<usize>| Part {
        columns: columns.clone().map(|i| column(&trial.measured, i, &layout.measured[i])).collect(),
        driven: true,
        sensor: if layout.markers { "marker" } else { "sensor" },
    };
    let size = if layout.markers { 3 } else { layout.measured.len().max(1) };
    let starts = (0..layout.measured.len()).step_by(size);
    let mut parts: Vec<Part> = starts.map(|i| outputs(i..layout.measured.len().min(i + size))).collect();
    if let Some(vehicle) = trial.vehicle.as_ref().filter(|vehicle| vehicle.ncols() >= 3) {
        let position = (0..3).map(|i| column(vehicle, i, &layout.vehicle[i])).collect();
        parts.push(Part { columns: position, driven: false, sensor: "vehicle's marker" });
    }
    parts.iter().flat_map(|part| look.part(part)).collect()
}

/// Columns of one thing: the coordinates of a marker, or all outputs of a robot without markers.
struct Part<'a> {
    columns: Vec<Column<'a>>,
    /// The actuators move it; a vehicle hovers, whatever they do.
    driven: bool,
    sensor: &'static str,
}

struct Column<'a> {
    values: &'a [f64],
    source: &'a Source,
}

fn column<'a>(of: &'a DMatrix<f64>, index: usize, source: &'a Source) -> Column<'a> {
    Column { values: values(of, index), source }
}

/// A column of a matrix, which stores column after column.
fn values(of: &DMatrix<f64>, index: usize) -> &[f64] {
    &of.as_slice()[index * of.nrows()..(index + 1) * of.nrows()]
}

/// The actuators, or the context signals of a robot without any.
fn inputs(trial: &Trial) -> Vec<&[f64]> {
    let signals = if trial.actuators.ncols() > 0 { &trial.actuators } else { &trial.context };
    (0..signals.ncols()).map(|index| values(signals, index)).collect()
}

/// The samples of a signal but those that are left out.
struct Kept<'a> {
    out: &'a [usize],
    samples: Vec<usize>,
}

impl<'a> Kept<'a> {
    fn new(count: usize, out: &'a [usize]) -> Self {
        let samples = match out.is_empty() {
            true => Vec::new(),
            false => (0..count).filter(|i| out.binary_search(i).is_err()).collect(),
        };
        Self { out, samples }
    }

    fn of<'v>(&self, values: &'v [f64]) -> Cow<'v, [f64]> {
        match self.out.is_empty() {
            true => Cow::Borrowed(values),
            false => self.samples.iter().map(|i| values[*i]).collect(),
        }
    }

    /// The sample of a kept one.
    fn sample(&self, kept: usize) -> usize {
        if self.out.is_empty() { kept } else { self.samples[kept] }
    }
}

struct Look<'a> {
    trial: &'a Trial,
    rows: &'a [usize],
    inputs: Vec<&'a [f64]>,
}

impl Look<'_> {
    fn part(&self, part: &Part) -> Vec<String> {
        let columns: Vec<&[f64]> = part.columns.iter().map(|column| column.values).collect();
        // a force may be 0, a marker is not at the origin by chance
        let lengths = part.columns.iter().all(|column| column.source.unit.dimension == Dimension::Length);
        let zeros = if lengths { zero::find(&columns) } else { zero::Zeros::default() };
        let kept = Kept::new(self.trial.samples(), &zeros.samples);
        let mut said = Vec::new();
        said.extend((!zeros.samples.is_empty()).then(|| self.zero(part, &zeros)));
        said.extend(self.frozen(part, &kept));
        said.extend(self.spikes(part, &kept));
        said
    }

    fn zero(&self, part: &Part, zeros: &zero::Zeros) -> String {
        let all: Vec<&Column> = part.columns.iter().collect();
        format!(
            "{}: exactly 0 in {} samples, and {} {} away from there before and after; if the {} was lost, leave these cells empty",
            self.place(&zeros.samples, &all),
            zeros.samples.len(),
            number(zeros.distance),
            all[0].source.unit.si_name(),
            part.sensor,
        )
    }

    /// Stretches in which the inputs move and the output does not, each with all columns that are frozen in it.
    fn frozen(&self, part: &Part, kept: &Kept) -> Vec<String> {
        let mut found: Vec<(Range<usize>, Vec<&Column>)> = Vec::new();
        for column in part.columns.iter().filter(|_| part.driven) {
            for run in frozen::find(&kept.of(column.values)) {
                let run = Range { start: kept.sample(run.start), end: 1 + kept.sample(run.end - 1) };
                match found.iter_mut().find(|(other, _)| *other == run) {
                    Some((_, columns)) => columns.push(column),
                    None => found.push((run, vec![column])),
                }
            }
        }
        found.retain(|(run, columns)| frozen::inputs_move(&self.inputs, run, columns.len() == part.columns.len()));
        let text = |(run, columns): &(Range<usize>, Vec<&Column>)| {
            let at = columns.iter().map(|c| number(c.values[run.start])).collect::<Vec<_>>().join(", ");
            format!(
                "{}: {} samples in a row are exactly {at} {} while the actuators move; if the {} was lost or hung, leave these \
                 cells empty",
                self.place(&run.clone().collect::<Vec<_>>(), columns),
                run.len(),
                columns[0].source.unit.si_name(),
                part.sensor,
            )
        };
        found.iter().map(text).collect()
    }

    /// Outliers, with all columns that have them in the same samples.
    fn spikes(&self, part: &Part, kept: &Kept) -> Vec<String> {
        let mut found: Vec<(Vec<usize>, Vec<&Column>, spike::Spike)> = Vec::new();
        for column in &part.columns {
            let spikes = spike::find(&kept.of(column.values));
            let Some(worst) = spikes.iter().copied().max_by(|a, b| a.away.total_cmp(&b.away)) else { continue };
            let samples: Vec<usize> = spikes.iter().map(|spike| kept.sample(spike.sample)).collect();
            match found.iter_mut().find(|(other, _, _)| *other == samples) {
                Some((_, columns, _)) => columns.push(column),
                None => found.push((samples, vec![column], worst)),
            }
        }
        let text = |(samples, columns, worst): &(Vec<usize>, Vec<&Column>, spike::Spike)| {
            let unit = columns[0].source.unit.si_name();
            let alone = if samples.len() == 1 { "stands alone" } else { "and others stand alone" };
            format!(
                "{}: {} {unit} {alone}, {} {unit} away from the samples around; correct the cell, or leave it empty if the {} was \
                 lost",
                self.place(samples, columns),
                number(worst.value),
                number(worst.away),
                part.sensor,
            )
        };
        found.iter().map(text).collect()
    }

    fn place(&self, samples: &[usize], columns: &[&Column]) -> String {
        let rows: Rows = samples.iter().map(|i| self.rows[*i]).collect();
        let names = columns.iter().map(|c| format!("`{}`", c.source.column)).collect::<Vec<_>>().join(", ");
        let column = if columns.len() == 1 { "column" } else { "columns" };
        format!("{}, {rows}, {column} {names} of trial `{}`", self.trial.file.display(), self.trial.name)
    }
}
