//! Tables of the residual characterisation.

use acm_train::{run::names::some, schedule::descriptive::rms::Rms};

use super::Study;
use crate::{
    spread::Spread,
    tables::{Cell, Column, Row, Table},
    unit::total_name,
};

/// Returns the tables of groups of trials, trials and curves.
pub fn all(study: &Study) -> Vec<Table> {
    vec![groups(study), trials(study), curves(study)]
}

fn errors(rms: &Rms) -> Vec<Cell> {
    rms.components.iter().chain([&rms.total]).map(|value| Cell::number(*value)).collect()
}

fn error_columns(study: &Study) -> Vec<Column> {
    let outputs = &study.record.outputs;
    let total = total_name(&study.record.data.unit, outputs.len()).to_string();
    let names = outputs.iter().map(|output| format!("Δ{output}")).chain([total]);
    names.map(|name| Column::measure(name, &study.display)).collect()
}

fn words(role: &str) -> String {
    role.replace('_', " ")
}

fn groups(study: &Study) -> Table {
    let record = &study.record;
    let row = |name: String, trials: &[String], rms: &Rms, opens| {
        let head = vec![Cell::Text(name), Cell::Text(some(trials, ", ")), Cell::Count(rms.samples)];
        Row { cells: [head, errors(rms)].concat(), opens, ..Row::default() }
    };
    let names: Vec<String> = record.trials.iter().map(|trial| trial.trial.clone()).collect();
    let mut rows = vec![row("all".into(), &names, &record.overall, false)];
    rows.extend(record.roles.iter().map(|role| row(words(&role.role), &role.trials, &role.rms, false)));
    let altitudes = record.altitudes.iter().enumerate();
    rows.extend(
        altitudes.map(|(k, group)| row(format!("altitude {:.2} m", group.altitude), &group.trials, &group.rms, k == 0)),
    );
    let slices = record.slices.iter().enumerate().filter(|_| record.slices.len() > 1);
    rows.extend(slices.map(|(k, slice)| row(study.held(slice), &slice.trials, &slice.rms, k == 0)));
    let mut columns = vec![Column::text("Samples of"), Column::text("Trials"), Column::number("Samples", "", 0)];
    columns.extend(error_columns(study));
    Table {
        name: "groups",
        title: "What the nominal model misses in flight".into(),
        note: format!(
            "Root mean square of measured − nominal, over the samples in the calibrated domain. The nominal model was \
             calibrated on trials {}. It describes: nothing was chosen by it.{}",
            some(&record.calibrated_on, ", "),
            record.notes.iter().map(|note| format!(" {note}")).collect::<String>()
        ),
        columns,
        rows,
        folded: false,
    }
}

fn trials(study: &Study) -> Table {
    let record = &study.record;
    let mut columns = vec![
        Column::text("Trial"),
        Column::text("Role"),
        Column::text("Slice"),
        Column::number("Mean altitude", "m", 3),
        Column::number("Samples", "", 0),
    ];
    columns.extend(error_columns(study));
    let measure = |output: &String| Column::measure(format!("Mean Δ{output}"), &study.display);
    columns.extend(record.outputs.iter().map(measure));
    let row = |trial: &acm_train::schedule::descriptive::residual::TrialResidual| {
        let head = vec![
            Cell::Text(trial.trial.clone()),
            Cell::Text(words(&trial.role)),
            record.slices.get(trial.slice).map_or(Cell::Empty, |slice| Cell::Text(study.held(slice))),
            trial.altitude.map_or(Cell::Empty, Cell::number),
            Cell::Count(trial.rms.samples),
        ];
        let mean = trial.mean.iter().map(|value| Cell::number(*value)).collect();
        Row { cells: [head, errors(&trial.rms), mean].concat(), ..Row::default() }
    };
    Table {
        name: "trials",
        title: "The residual, trial by trial".into(),
        note: "Root mean square, and mean: what a constant correction of the trial would take away.".into(),
        columns,
        rows: record.trials.iter().map(row).collect(),
        folded: true,
    }
}

fn curves(study: &Study) -> Table {
    let record = &study.record;
    let swept = record.actuators.get(record.swept).map_or("1", |signal| signal.unit.as_str());
    let mut columns = vec![Column::text("Slice"), Column::number(format!("{}*", study.swept().name), swept, 3)];
    columns.push(Column::number("Samples", "", 0));
    columns.extend(record.outputs.iter().map(|output| Column::measure(format!("Δ{output}"), &study.display)));
    let mut rows = vec![];
    for (place, slice) in record.slices.iter().enumerate() {
        for (index, bin) in slice.bins.iter().enumerate() {
            let spread = |(mean, sd): (&f64, &f64)| Cell::Number(Spread { mean: *mean, sd: Some(*sd) });
            let head =
                vec![Cell::Text(study.held(slice)), Cell::number(bin.q - record.middle), Cell::Count(bin.samples)];
            let cells = [head, bin.mean.iter().zip(&bin.sd).map(spread).collect()].concat();
            rows.push(Row { cells, opens: index == 0 && place > 0, ..Row::default() });
        }
    }
    Table {
        name: "curves",
        title: format!("The residual against {}*", study.swept().name),
        note: format!(
            "Mean ± standard deviation of the samples in bins over {0}* = {0} − {1:.4}, counted from the middle of its \
             range. The deviation is the spread of samples, not the doubt of the mean.",
            study.swept().name,
            record.middle
        ),
        columns,
        rows,
        folded: true,
    }
}
