//! Conformal intervals about the predictions: half-width and coverage of each output.

use acm_train::run::evaluation::intervals::percent;

use super::{Cell, Column, Row, Table};
use crate::section::Section;
use crate::section::estimator::Estimator;

/// Returns the table with networks whose run left out two units or more in rows, output by output.
pub fn table(section: &Section) -> Option<Table> {
    let rows: Vec<Row> = section.networks().flat_map(|network| of_network(section, network)).collect();
    let share = |title: &str| Column::number(title, "%", 0);
    let columns = vec![
        Column::text("Model"),
        Column::text("Output"),
        share("Level"),
        Column::measure("Half-width", &section.display),
        share("Left out, held"),
        share("Held-out, held"),
    ];
    let title = "Intervals: how far off may a prediction be?".into();
    let table = Table { name: "intervals", title, note: note(section), columns, rows, folded: false };
    (!table.rows.is_empty()).then(|| table.say_once())
}

fn of_network(section: &Section, network: &Estimator) -> Vec<Row> {
    let Some(intervals) = &section.runs[network.run].intervals else { return vec![] };
    let share = |share: f64| Cell::number(100.0 * share);
    let row = |(o, of): (usize, &acm_train::run::evaluation::intervals::Interval)| {
        let cells = vec![
            Cell::Text(network.label.clone()),
            Cell::Text(of.output.clone()),
            share(intervals.level),
            Cell::number(of.half_width),
            share(of.left_out),
            of.held_out.map_or(Cell::Empty, share),
        ];
        Row { cells, opens: o == 0, ..Row::default() }
    };
    intervals.outputs.iter().enumerate().map(row).collect()
}

fn note(section: &Section) -> String {
    let of = |network: &Estimator| {
        let intervals = section.runs[network.run].intervals.as_ref()?;
        let asked =
            (intervals.level < intervals.wanted).then(|| format!("; {} was asked for", percent(intervals.wanted)));
        Some(format!("{}: {}{}", network.label, intervals.title(), asked.unwrap_or_default()))
    };
    let titles: Vec<String> = section.networks().filter_map(of).collect();
    format!(
        "Prediction ± half-width, from the errors on trials left out of training. k trials attain no level beyond k/(k + 1). \
         Left out: coverage of each unit by the half-width of the others; held-out: coverage of the trials that took no part. \
         {}.",
        titles.join("; ")
    )
}
