//! Columns of a trial as recorded, on the reference's clock, without resampling.

use super::plan::Plan;
use crate::error::DataError;

/// One column of one source.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The source.
    pub source: String,
    /// Name in the manifest.
    pub name: String,
    /// Unit in the manifest, or as the file says it.
    pub unit: Option<String>,
    /// Time stamps of the reference `[N]`, s.
    pub time: Vec<f64>,
    /// In the source's unit `[N]`; NaN is an empty cell.
    pub values: Vec<f64>,
}

impl Plan {
    /// Every column of a trial that is read, source by source; none where its clocks could not be brought together.
    pub fn view(&self, trial: &str) -> Result<Vec<Line>, DataError> {
        let Some((signals, alignments)) = self.aligned_signals(trial)? else { return Ok(Vec::new()) };
        let mut lines = Vec::new();
        for (signals, alignment) in signals.iter().zip(alignments) {
            for (column, (axis, values)) in &signals.columns {
                let name = format!("{}.{column}", alignment.source);
                let unit = self.unit(&name).or_else(|| signals.units.get(column).cloned());
                let time = signals.axes.get(*axis).map_or(&[][..], |axis| &axis.time);
                let time = time.iter().map(|t| alignment.reference_time(*t)).collect();
                lines.push(Line { source: alignment.source.clone(), name, unit, time, values: values.clone() });
            }
        }
        Ok(lines)
    }
}
