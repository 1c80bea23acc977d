//! Parallel coordinates: a line for each setting of a sweep, through its values and its error.

use acm_train::study::{record::MemberRecord, table::validation_error};
use kuva::{
    plot::parallel::ParallelPlot,
    render::{layout::Layout, plots::Plot},
};

use super::{List, settings::last};
use crate::{
    chapter::Shown,
    figures::{
        canvas::{FONTS, Panels, TEXT},
        legend::{Key, Mark},
        palette,
    },
    unit::total_name,
};

/// One panel for each base; the best eighth of the settings is drawn strongly.
pub fn draw(list: &List) -> Vec<Shown> {
    let keys: Vec<&String> =
        list.study.members.first().map_or(vec![], |member| member.values.iter().map(|(key, _)| key).collect());
    let total = format!("{} RMSE [{}]", total_name(list.first().outputs.len()), list.display.symbol);
    let names = || keys.iter().map(|key| last(key)).chain([total.clone()]);
    let mut panels = vec![];
    let mut series = 0;
    for group in list.groups() {
        let best = group.rows.len().div_ceil(8);
        let mut plot = ParallelPlot::new().with_axis_names(names()).with_tick_count(4);
        for (place, (_, runs)) in group.rows.iter().enumerate().rev() {
            let error = list.display.factor * validation_error(runs.records).unwrap_or(0.0);
            let values: Vec<f64> = keys.iter().map(|key| number(list, runs.member, key)).chain([error]).collect();
            plot = plot.with_row_group(if place < best { "best" } else { "other" }, values);
        }
        series += group.rows.len();
        let plot = plot
            .with_group_colors(vec!["#b9b9b9".to_string(), palette::BLUE.to_string()])
            .with_stroke_width(1.8)
            .with_opacity(0.85);
        let layout = Layout::new((0.0, 1.0), (0.0, 1.0)).with_title(&group.title).with_font_family(FONTS);
        panels.push((vec![Plot::Parallel(plot)], layout.with_body_size(TEXT).with_tick_size(TEXT - 1)));
    }
    if panels.is_empty() {
        return vec![];
    }
    let key = |label: &str, colour: &str| Key { label: label.into(), colour: colour.into(), mark: Mark::Line };
    let legend = vec![key("best eighth of the settings", palette::BLUE), key("the other settings", "#b9b9b9")];
    let explanation = "A line is one setting: it crosses each upright axis at the value that was tried, and the last one at \
        the error in cross-validation, mean over folds. Where the strong lines come together, a value matters; where they \
        fan out, it does not. Words stand in the order in which they were listed."
        .to_string();
    let columns = if keys.len() > 4 { 1 } else { panels.len().min(2) };
    let size = (880.0 / columns as f64, 360.0);
    let drawing = Panels { columns, panels, size, legend }.draw(&list.first().data, series, explanation);
    vec![Shown { name: "settings", question: "Which settings err least?".into(), drawing }]
}

/// A value as a place on its axis: a number as it is, a word by the order of first appearance.
fn number(list: &List, member: &MemberRecord, key: &str) -> f64 {
    let of = |member: &MemberRecord| -> Option<String> {
        member.values.iter().find(|(known, _)| known == key).map(|(_, text)| text.clone())
    };
    let Some(text) = of(member) else { return 0.0 };
    text.parse().unwrap_or_else(|_| {
        let mut words: Vec<String> = vec![];
        list.study.members.iter().filter_map(of).for_each(|word| {
            if !words.contains(&word) {
                words.push(word)
            }
        });
        words.iter().position(|word| *word == text).unwrap_or(0) as f64
    })
}
