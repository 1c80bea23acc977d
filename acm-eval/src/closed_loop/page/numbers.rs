//! The tables of a page with every digit, as files beside it.

use acm_trace::finding::{Finding, Separability};

use super::confirmation::{self, level};
use crate::closed_loop::outcome::Outcome;
use crate::{
    spread::Spread,
    tables::{Cell, Column, Row, Table},
};

/// Names of the tables of a finding.
pub const OF_FINDING: [&str; 9] =
    ["before-and-after", "effects", "parameters", "trials", "events", "formula", "networks", "steps", "candidates"];

/// Names of the tables of separability.
pub const OF_SEPARABILITY: [&str; 2] = ["pairs", "recalibration"];

/// Returns the tables of a finding that have a row.
pub fn of_finding(finding: &Finding) -> Vec<Table> {
    let unit = finding.errors.unit.as_str();
    let [before_and_after, effects, parameters, trials, events, formula, networks, steps, candidates] = OF_FINDING;
    let tables = vec![
        table(before_and_after, outcome_columns(unit), outcome(finding)),
        table(effects, effect_columns(unit), effect_rows(finding)),
        table(parameters, parameter_columns(), parameter_rows(finding)),
        table(trials, [vec![Column::text("Trial")], errors(&["Nominal", "Best baseline", "After"], unit)].concat(), {
            let row = |trial: &acm_trace::finding::TrialErrors| {
                vec![word(&trial.name), number(trial.nominal), number(trial.best_baseline), number(trial.after)]
            };
            finding.figures.trials.iter().map(row).collect()
        }),
        table(events, vec![Column::text("Event"), plain("Share of what is left"), Column::text("What")], {
            let events = finding.left.events.iter();
            events.map(|event| vec![word(&event.kind), number(event.share), word(&event.what)]).collect()
        }),
        table(formula, vec![Column::text("Acts on"), Column::text("Term"), plain("Coefficient (SI)")], {
            let terms = finding.symbolic.iter().flat_map(|symbolic| &symbolic.terms);
            terms.map(|term| vec![word(&term.on), word(&term.term), number(term.coefficient)]).collect()
        }),
        table(
            networks,
            [vec![Column::text("Model")], errors(&["Error", "Standard deviation over seeds"], unit)].concat(),
            {
                let row = |row: &acm_trace::finding::NetworkRow| {
                    vec![word(&row.model), number(row.error), row.sd.map_or(Cell::Empty, number)]
                };
                finding.networks.iter().map(row).collect()
            },
        ),
        table(steps, step_columns(unit), step_rows(finding)),
        table(candidates, candidate_columns(unit), candidate_rows(finding)),
    ];
    tables.into_iter().filter(|table| !table.rows.is_empty()).collect()
}

/// Returns the tables of separability that have a row.
pub fn of_separability(separability: &Separability) -> Vec<Table> {
    let names = &separability.effects;
    let [pairs, recalibration] = OF_SEPARABILITY;
    let mut rows = vec![];
    for (a, (name, shares)) in names.iter().zip(&separability.imitated).enumerate() {
        let others = shares.iter().zip(names).enumerate().filter(|(b, _)| *b != a);
        rows.extend(others.map(|(_, (share, other))| vec![word(name), word(other), number(*share)]));
    }
    let alone = names.iter().zip(&separability.by_recalibration).map(|(name, share)| vec![word(name), number(*share)]);
    let tables = [
        table(pairs, vec![Column::text("Effect"), Column::text("Imitated by"), plain("Share")], rows),
        table(
            recalibration,
            vec![Column::text("Effect"), plain("Share that recalibration takes over")],
            alone.collect(),
        ),
    ];
    tables.into_iter().filter(|table| !table.rows.is_empty()).collect()
}

fn outcome_columns(unit: &str) -> Vec<Column> {
    let numbers = errors(&["Error", "95 % from", "95 % to"], unit);
    [vec![Column::text("Model")], numbers, ["What it is", "Held-out trials"].map(Column::text).to_vec()].concat()
}

fn outcome(finding: &Finding) -> Vec<Vec<Cell>> {
    let outcome = Outcome::of(finding);
    let mut rows: Vec<Vec<Cell>> = vec![];
    for row in outcome.rows() {
        let [low, high] = row.error.interval;
        let said = if row.is_after { word(confirmation::words(finding).0) } else { Cell::Empty };
        let numbers = [row.error.value, low, high].map(number);
        rows.push([word(row.label)].into_iter().chain(numbers).chain([word(row.meaning), said]).collect());
    }
    rows.push(vec![word("white noise"), number(outcome.noise), Cell::Empty, Cell::Empty, Cell::Empty, Cell::Empty]);
    rows
}

fn effect_columns(unit: &str) -> Vec<Column> {
    let words = ["Effect", "Carried by"].map(Column::text).into_iter();
    let size = errors(&["Size"], unit);
    let sure = [Column::text("Confidence"), plain("Share of resamples"), Column::text("Chosen in its place")];
    words.chain(size).chain(sure).collect()
}

fn effect_rows(finding: &Finding) -> Vec<Vec<Cell>> {
    let row = |effect: &acm_trace::finding::FoundEffect| {
        let others: Vec<String> =
            effect.replaced_by().map(|other| format!("{} {}", or_none(&other.name), other.share)).collect();
        vec![
            word(&effect.name),
            effect.carrier.as_deref().map_or(Cell::Empty, word),
            number(effect.size),
            word(level(effect.confidence.level)),
            number(effect.confidence.share),
            word(&others.join("; ")),
        ]
    };
    finding.effects.iter().map(row).collect()
}

/// Returns `no effect` for the empty name.
fn or_none(name: &str) -> &str {
    if name.is_empty() { "no effect" } else { name }
}

fn parameter_columns() -> Vec<Column> {
    let words = ["Effect", "Carried by", "Parameter"].map(Column::text);
    let numbers = ["Value", "95 % from", "95 % to"].map(plain);
    words.into_iter().chain(numbers).chain(["Unit", "Times the signal"].map(Column::text)).collect()
}

fn parameter_rows(finding: &Finding) -> Vec<Vec<Cell>> {
    let mut rows = vec![];
    for effect in &finding.effects {
        let carrier = effect.carrier.as_deref().map_or(Cell::Empty, word);
        for parameter in &effect.parameters {
            let numbers = [parameter.value, parameter.interval[0], parameter.interval[1]].map(number);
            let signal = parameter.depends_on.as_deref().map_or(Cell::Empty, word);
            let names = [word(&effect.name), carrier.clone(), word(&parameter.name)];
            rows.push(names.into_iter().chain(numbers).chain([word(&parameter.unit), signal]).collect());
        }
    }
    rows
}

fn step_columns(unit: &str) -> Vec<Column> {
    let error = errors(&["Error"], unit);
    let numbers = ["Gain", "By chance", "Standard errors"].map(plain).to_vec();
    [vec![Column::text("Model")], error, numbers, vec![Column::text("Accepted"), plain("Candidates")]].concat()
}

fn step_rows(finding: &Finding) -> Vec<Vec<Cell>> {
    let row = |step: &acm_trace::finding::Step| {
        let [gain, chance, sure] =
            [step.gain, step.by_chance, step.significance].map(|value| value.map_or(Cell::Empty, number));
        let accepted = word(if step.accepted { "yes" } else { "no" });
        vec![word(&step.model), number(step.error), gain, chance, sure, accepted, Cell::Count(step.candidates.len())]
    };
    finding.steps.iter().map(row).collect()
}

fn candidate_columns(unit: &str) -> Vec<Column> {
    [vec![Column::text("For"), Column::text("Candidate")], errors(&["Error"], unit)].concat()
}

fn candidate_rows(finding: &Finding) -> Vec<Vec<Cell>> {
    let steps = finding.steps.iter().flat_map(|step| step.candidates.iter().map(move |candidate| (step, candidate)));
    let row = |(step, candidate): (&acm_trace::finding::Step, &acm_trace::finding::Candidate)| {
        vec![word(&step.model), word(&candidate.name), number(candidate.error)]
    };
    steps.map(row).collect()
}

fn table(name: &'static str, columns: Vec<Column>, rows: Vec<Vec<Cell>>) -> Table {
    let rows = rows.into_iter().map(|cells| Row { cells, ..Row::default() }).collect();
    Table { name, title: String::new(), note: String::new(), columns, rows, folded: false }
}

/// Returns the columns of errors in this unit.
fn errors(titles: &[&str], unit: &str) -> Vec<Column> {
    titles.iter().map(|title| Column::number(*title, unit, 0)).collect()
}

/// Returns a column of numbers without a unit of their own.
fn plain(title: &str) -> Column {
    Column::number(title, "", 0)
}

fn word(text: &str) -> Cell {
    Cell::Text(text.into())
}

/// Writes a number; empty where it is none; zero has no sign.
fn number(value: f64) -> Cell {
    if value.is_finite() { Cell::Number(Spread { mean: value + 0.0, sd: None }) } else { Cell::Empty }
}
