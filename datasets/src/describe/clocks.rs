//! The clocks of several sources, trial by trial, as a table.

use comfy_table::Table;

use crate::join::{Alignment, How};
use crate::recordings::Recordings;

/// Of more clocks than these, the first are listed.
const MOST: usize = 200;

/// Offsets, rates, jitter, overlaps and what the sources lack.
pub fn table(data: &Recordings) -> Table {
    let header = [
        "trial",
        "source",
        "clock",
        "offset s",
        "± ms",
        "drift ppm",
        "rate Hz",
        "jitter ms",
        "overlap s",
        "occlusions",
        "longest s",
    ];
    let mut table = super::table::table(&header, 3);
    data.alignments.iter().take(MOST).for_each(|alignment| {
        table.add_row(row(alignment));
    });
    if data.alignments.len() > MOST {
        table.add_row([format!("{} more", data.alignments.len() - MOST)]);
    }
    table
}

fn row(alignment: &Alignment) -> Vec<String> {
    let how = match &alignment.how {
        How::Same => "reference's",
        How::Given => "given",
        How::Event => "event",
        How::Estimated { .. } => "estimated",
        How::Common(_) => "common",
    };
    let quality = &alignment.quality;
    let shown = |text: String, known: bool| if known { text } else { "–".into() };
    let estimated = alignment.how != How::Same && alignment.how != How::Given;
    vec![
        alignment.trial.clone(),
        alignment.source.clone(),
        how.into(),
        shown(format!("{:+.4}", alignment.offset), alignment.how != How::Same),
        shown(format!("{:.2}", 1e3 * alignment.interval), estimated),
        shown(format!("{:+.1}", 1e6 * alignment.drift), alignment.drift != 0.0),
        format!("{:.2}", alignment.rates.1),
        format!("{:.2}", 1e3 * quality.jitter),
        format!("{:.2}", alignment.overlap),
        quality.occlusions.to_string(),
        shown(format!("{:.3}", quality.longest), quality.occlusions > 0),
    ]
}
