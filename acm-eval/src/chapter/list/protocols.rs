//! A comparison under several protocols: errors under each, and models in pairs.

use acm_train::{
    run::record::RunRecord,
    schedule::study::{
        paired::Difference,
        record::Runs,
        table::{Group, pairs, score},
    },
};

use super::List;
use crate::chapter::Shown;
use crate::figures::canvas::bars::{Bar, highest, keys, panel_of};
use crate::figures::canvas::{Panels, palette};
use crate::spread::Spread;
use crate::tables::{BOLD, Cell, Column, Repeated, Row, Table};

/// Returns the errors under each protocol, where there are several; then differences in pairs.
pub fn tables(list: &List) -> Vec<Table> {
    let groups = list.groups();
    let several = (groups.len() > 1).then(|| protocols(list, &groups));
    several.into_iter().chain([in_pairs(list, &groups)]).collect()
}

/// Returns the names of the models in the order of the study.
fn names<'a>(groups: &[Group<'a>]) -> Vec<&'a str> {
    let mut names: Vec<&str> = vec![];
    groups.iter().flat_map(|group| &group.rows).for_each(|(name, _)| {
        if !names.contains(name) {
            names.push(name);
        }
    });
    names
}

fn runs<'a>(group: &Group<'a>, name: &str) -> Option<Runs<'a>> {
    group.rows.iter().find(|(known, _)| *known == name).map(|(_, runs)| *runs)
}

/// Returns the mean ± sd over seeds of a model, or of the nominal model.
fn error(runs: Runs, estimator: Option<&str>) -> Option<Repeated> {
    let total = |record: &RunRecord| Some((record.id.clone(), score(record, estimator)?.rmse_total));
    Repeated::of(runs.records.iter().filter_map(total).collect())
}

/// Returns the row of a model: its error under each protocol, and their mean.
fn row(groups: &[Group], name: &str, estimator: Option<&str>) -> Vec<Option<Repeated>> {
    let of = |group: &Group| {
        let runs = if estimator.is_some() { group.rows.first().map(|(_, runs)| *runs) } else { runs(group, name) };
        error(runs?, estimator)
    };
    groups.iter().map(of).collect()
}

fn protocols(list: &List, groups: &[Group]) -> Table {
    let mut columns = vec![Column::text("Model")];
    columns.extend(groups.iter().map(|group| Column::measure(&group.title, &list.display)));
    columns.push(Column::measure("Mean", &list.display));
    let cells = |label: &str, errors: Vec<Option<Repeated>>| {
        let means: Option<Vec<f64>> = errors.iter().map(|error| Some(error.as_ref()?.spread().mean)).collect();
        let mean = means.and_then(|means| Spread::of(&means)).map_or(Cell::Empty, |means| Cell::number(means.mean));
        let errors = errors.into_iter().map(|error| error.map_or(Cell::Empty, Cell::Repeated));
        Row { cells: std::iter::once(Cell::Text(label.into())).chain(errors).chain([mean]).collect(), ..Row::default() }
    };
    let mut rows = vec![cells("Nominal", row(groups, "", Some("nominal")))];
    rows.extend(names(groups).into_iter().map(|name| cells(name, row(groups, name, None))));
    let note = format!(
        "{} root mean square error on the trials that each protocol holds out, mean ± sample standard deviation over seeds; \
         last column: mean over the protocols. {BOLD}",
        list.total()
    );
    let mut table =
        Table { name: "protocols", title: "Error under each protocol".into(), note, columns, rows, folded: false };
    (1..table.columns.len()).for_each(|column| table.mark_best(column, false, 0..table.rows.len()));
    table
}

fn in_pairs(list: &List, groups: &[Group]) -> Table {
    let measure = |title: &str| Column::measure(title, &list.display);
    let mut columns = vec![
        Column::text("Held out"),
        Column::text("Model"),
        Column::text("less than"),
        Column::number("Pairs", "", 0),
    ];
    columns.extend(["by", "95 % from", "to"].map(measure));
    let mut rows = vec![];
    for group in groups {
        let mut ranked: Vec<(&str, Runs, f64)> = (group.rows.iter())
            .filter_map(|(name, runs)| Some((*name, *runs, error(*runs, None)?.spread().mean)))
            .collect();
        ranked.sort_by(|a, b| a.2.total_cmp(&b.2));
        for (index, (better, a, _)) in ranked.iter().enumerate() {
            for (other, b, _) in &ranked[index + 1..] {
                let Some(difference) = Difference::of(&pairs(a.records, b.records)) else { continue };
                let end = |sign: f64| {
                    difference.reach.map_or(Cell::Empty, |reach| Cell::number(difference.mean + sign * reach))
                };
                let words = [group.title.as_str(), better, other].map(|word| Cell::Text(word.into()));
                let numbers = [Cell::Count(difference.pairs), Cell::number(difference.mean), end(-1.0), end(1.0)];
                let opens = index == 0 && *other == ranked[1].0;
                rows.push(Row { cells: words.into_iter().chain(numbers).collect(), opens, bound: false });
            }
        }
    }
    Table {
        name: "pairs",
        title: "Models in pairs".into(),
        note: format!(
            "By how much the {} error of the first model is smaller than that of the second, seed by seed, with Student's 95 % \
             interval of the mean. It covers what seeds do, on these trials; other trials may differ by more. A model without \
             seeds is paired with every seed of the other.",
            list.total()
        ),
        columns,
        rows,
        folded: groups.len() > 1,
    }
}

/// Draws bars of every model under each protocol, where there are several.
pub fn draw(list: &List) -> Vec<Shown> {
    let groups = list.groups();
    if groups.len() < 2 {
        return vec![];
    }
    let shown = |error: Option<Repeated>| error.map_or(0.0, |error| list.display.factor * error.spread().mean);
    let heights = |errors: Vec<Option<Repeated>>| errors.into_iter().map(shown).collect();
    let nominal = Bar {
        label: "Nominal".into(),
        colour: palette::baseline("nominal"),
        values: heights(row(&groups, "", Some("nominal"))),
    };
    let bar = |(name, colour): (&str, &'static str)| Bar {
        label: name.into(),
        colour,
        values: heights(row(&groups, name, None)),
    };
    let bars: Vec<Bar> = std::iter::once(nominal).chain(list.colours().into_iter().map(bar)).collect();
    let titles: Vec<String> = groups.iter().map(|group| group.title.clone()).collect();
    let total = list.total();
    let y = list.display.label(&format!("{total} RMSE"));
    let panel = panel_of("", "trials that took no part", &y, &titles, &bars, highest(&bars));
    let explanation = format!(
        "{total} root mean square error on the trials that each protocol holds out, mean over seeds. Where the order of the \
         models changes from group to group, no single altitude decides."
    );
    let panels = Panels { columns: 1, panels: vec![panel], size: (880.0, 380.0), legend: keys(&bars) };
    let drawing = panels.draw(&list.first().data, bars.len(), explanation);
    vec![Shown { name: "protocols", question: "Does the order of the models hold on other trials?".into(), drawing }]
}
