//! Tables of the nominal study.

use acm_train::schedule::descriptive::{nominal::Errors, rms::Rms};

use super::Study;
use crate::{
    tables::{Cell, Column, Row, Table},
    unit::total_name,
};

/// Returns the tables of orders, of models over all trials, and of models trial by trial.
pub fn all(study: &Study) -> Vec<Table> {
    vec![orders(study), models(study), trials(study)]
}

fn errors(rms: &Rms) -> impl Iterator<Item = Cell> {
    rms.components.iter().chain([&rms.total]).map(|value| Cell::number(*value))
}

fn error_columns(study: &Study) -> impl Iterator<Item = Column> {
    let outputs = &study.record.outputs;
    let total = total_name(&study.record.data.unit, outputs.len());
    outputs.iter().map(String::as_str).chain([total]).map(|name| Column::measure(name, &study.display))
}

fn orders(study: &Study) -> Table {
    let orders = &study.record.orders;
    let mut columns = vec![Column::text("Order")];
    for protocol in ["frozen", "refitted"] {
        columns.push(Column::number(format!("Parameters, {protocol}"), "", 0));
        columns.push(Column::measure(format!("Binned, {protocol}"), &study.display));
        columns.push(Column::measure(format!("Raw, {protocol}"), &study.display));
    }
    let row = |row: &acm_train::schedule::descriptive::nominal::OrderRow| {
        let mut cells = vec![Cell::Text(row.order.to_string())];
        for fitted in [&row.frozen, &row.refitted] {
            let errors = [fitted.binned, fitted.raw].map(Cell::number);
            cells.extend([vec![Cell::Count(fitted.parameters)], errors.to_vec()].concat());
        }
        Row { cells, ..Row::default() }
    };
    let [u, v] = &orders.plane;
    Table {
        name: "orders",
        title: format!("Strain orders on trial {}", orders.trial),
        note: format!(
            "Root mean square error in the plane of {u} and {v}. Each model is fitted to the means of {} bins over {} \
             (all three coordinates), and scored on these bins and on all {} samples. Frozen: actuation map from the \
             fit of order 1, and only the strain parameters are fitted; refitted: both are. Parameters are those \
             that were free.",
            orders.bins,
            study.swept().name,
            orders.samples
        ),
        columns,
        rows: orders.rows.iter().map(row).collect(),
        folded: false,
    }
}

fn models(study: &Study) -> Table {
    let mut columns = vec![Column::text("Model"), Column::text("Trials"), Column::number("Parameters", "", 0)];
    columns.extend(error_columns(study));
    let mut rows = vec![];
    let parts: [(&str, fn(&acm_train::schedule::descriptive::nominal::ModelRow) -> Option<&Errors>); 2] =
        [("fitted", |model| Some(&model.fitted)), ("left out", |model| model.left_out.as_ref())];
    for (part, of) in parts {
        let first = rows.len();
        for model in &study.record.models {
            let Some(own) = of(model) else { continue };
            let head = [Cell::Text(model.label.clone()), Cell::Text(part.into()), Cell::Count(model.parameters.len())];
            let cells = head.into_iter().chain(errors(&own.all)).collect();
            rows.push(Row { cells, opens: first > 0 && rows.len() == first, ..Row::default() });
        }
    }
    Table {
        name: "models",
        title: "Nominal models on the calibration trials".into(),
        note: "Root mean square error over all calibration samples. Fitted: on the trials that the model was fitted to. \
               Left out: each trial as predicted by a fit to the others; a trial at the border of the workspace is then \
               extrapolated to."
            .into(),
        columns,
        rows,
        folded: false,
    }
}

fn trials(study: &Study) -> Table {
    let total = total_name(&study.record.data.unit, study.record.outputs.len());
    let mut columns = vec![Column::text("Trial"), Column::text("Model"), Column::number("Samples", "", 0)];
    columns.extend(error_columns(study));
    columns.push(Column::measure(format!("{total}, left out"), &study.display));
    let names = study.record.models.first().map_or(&[][..], |model| &model.fitted.trials);
    let mut rows: Vec<Row> = vec![];
    for (place, name) in names.iter().enumerate() {
        for (index, model) in study.record.models.iter().enumerate() {
            let own = &model.fitted.trials[place].rms;
            let head = [Cell::Text(name.trial.clone()), Cell::Text(model.label.clone()), Cell::Count(own.samples)];
            let left_out = model.left_out.as_ref().and_then(|errors| errors.trials.get(place));
            let left_out = left_out.map_or(Cell::Empty, |trial| Cell::number(trial.rms.total));
            let cells = head.into_iter().chain(errors(own)).chain([left_out]).collect();
            rows.push(Row { cells, opens: index == 0 && place > 0, ..Row::default() });
        }
    }
    Table {
        name: "trials",
        title: "Nominal models, trial by trial".into(),
        note: "As above. The last column: the same trial as predicted by a fit to the others.".into(),
        columns,
        rows,
        folded: true,
    }
}
