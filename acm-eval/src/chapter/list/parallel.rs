//! Parallel coordinates: a line for each setting of a sweep, through its values and its error.
//!
//! Few values of a key stand evenly spaced in the order of their size; many stand where they are, logarithmically where they
//! span more than a factor of 20. Lines through the same value lie side by side in the order of their errors.

use acm_train::schedule::study::table::{Group, validation_error};
use kuva::render::render::TextAnchor;

use super::{List, settings::last};
use crate::chapter::Shown;
use crate::closed_loop::figures::scale::Scale;
use crate::closed_loop::figures::sheet::{Mark, SMALL, Sheet, TEXT};
use crate::figures::canvas::palette;
use crate::figures::short::short;

const WIDTH: f64 = 900.0;
/// Width of one panel, with its title and the names of its axes.
const PANEL: f64 = 330.0;
const LEFT: f64 = 110.0;
const RIGHT: f64 = 90.0;
const ABOVE: f64 = 62.0;
const BELOW: f64 = 24.0;
/// Settings that are the best: one in so many.
const BEST: usize = 8;
/// Largest number of values that are drawn at their own positions.
const FEW: usize = 9;
const OTHERS: &str = palette::PALE_GREY;

/// Draws one panel for each base.
pub fn draw(list: &List) -> Vec<Shown> {
    let groups = list.groups();
    let legend = [
        ("best eighth of the settings", palette::BLUE, Mark::Line(None)),
        ("the other settings", OTHERS, Mark::Line(None)),
    ];
    let data = &list.first().data;
    let mut sheet = Sheet::of(WIDTH, PANEL * groups.len() as f64, &legend, &data.name, data.synthetic);
    let tops = (0..groups.len()).map(|place| sheet.top + PANEL * place as f64).collect::<Vec<_>>();
    for (group, top) in groups.iter().zip(tops) {
        panel(&mut sheet, list, group, top);
        sheet.series += group.rows.len();
    }
    let drawing = sheet.finish(
        "A line is one setting: it crosses each upright axis at the value that was tried, and the last one at the error in \
         cross-validation, mean over folds. Where the strong lines come together, a value matters; where they fan out, it \
         does not. Lines through the same value lie side by side, the better ones below.",
    );
    vec![Shown { name: "settings", question: "Which settings err least?".into(), drawing }]
}

/// Vertical axis: where each row crosses it, as a share of its height, and its labels.
struct Axis {
    title: String,
    shares: Vec<f64>,
    ticks: Vec<(f64, String)>,
}

fn panel(sheet: &mut Sheet, list: &List, group: &Group, top: f64) {
    let axes = axes(list, group);
    let step = (WIDTH - LEFT - RIGHT) / (axes.len().max(2) - 1) as f64;
    let x = |place: usize| LEFT + step * place as f64;
    let y = |share: f64| top + PANEL - BELOW - (PANEL - ABOVE - BELOW) * share;
    sheet.words(16.0, top + 18.0, &group.title, TEXT + 1, TextAnchor::Start, palette::INK, true);
    let best = group.rows.len().div_ceil(BEST);
    for row in (0..group.rows.len()).rev() {
        let (colour, width) = if row < best { (palette::BLUE, 2.6) } else { (OTHERS, 1.3) };
        for (place, pair) in axes.windows(2).enumerate() {
            let ends = [(x(place), y(pair[0].shares[row])), (x(place + 1), y(pair[1].shares[row]))];
            sheet.line(ends[0], ends[1], colour, width, None);
        }
    }
    for (place, axis) in axes.iter().enumerate() {
        sheet.line((x(place), y(0.0)), (x(place), y(1.0)), palette::INK, 1.4, None);
        sheet.words(x(place), top + 44.0, &axis.title, TEXT, TextAnchor::Middle, palette::INK, false);
        for (share, words) in &axis.ticks {
            let (words, reach) = (short(words, 12), 8.0 * words.chars().count().min(12) as f64);
            let (from, end) = if place + 1 == axes.len() {
                (x(place) + 6.0, x(place) + 8.0)
            } else {
                (x(place) - 8.0 - reach, x(place) - 8.0)
            };
            sheet.area(from, y(*share) - 8.0, reach + 2.0, 16.0, "white");
            sheet.line((x(place) - 4.0, y(*share)), (x(place) + 4.0, y(*share)), palette::INK, 1.4, None);
            let anchor = if place + 1 == axes.len() { TextAnchor::Start } else { TextAnchor::End };
            sheet.words(end, y(*share) + 4.5, &words, SMALL, anchor, palette::INK, false);
        }
    }
}

fn axes(list: &List, group: &Group) -> Vec<Axis> {
    let keys: Vec<&String> =
        group.rows.first().map_or(vec![], |(_, runs)| runs.member.values.iter().map(|(key, _)| key).collect());
    let values = |key: &String| -> Vec<String> {
        let of =
            |values: &[(String, String)]| values.iter().find(|(known, _)| known == key).map(|(_, text)| text.clone());
        group.rows.iter().map(|(_, runs)| of(&runs.member.values).unwrap_or_default()).collect()
    };
    let errors: Vec<f64> = (group.rows.iter())
        .map(|(_, runs)| list.display.factor * validation_error(runs.records).unwrap_or(f64::NAN))
        .collect();
    let scale = Scale::holding(errors.iter().copied(), 6);
    let error = Axis {
        title: list.display.label(&format!("{} RMSE", list.total())),
        shares: errors.iter().map(|error| scale.share(*error).unwrap_or(0.0)).collect(),
        ticks: scale.ticks().into_iter().filter_map(|(at, words)| Some((scale.share(at)?, words))).collect(),
    };
    keys.into_iter().map(|key| axis(last(key), &values(key))).chain([error]).collect()
}

/// Returns the axis of `values` in the order of the errors, as TOML writes them.
fn axis(title: String, values: &[String]) -> Axis {
    let number = |text: &String| text.parse::<f64>().unwrap_or(f64::NAN);
    let mut distinct: Vec<&String> = vec![];
    values.iter().for_each(|value| {
        if !distinct.contains(&value) {
            distinct.push(value);
        }
    });
    let numbers: Vec<f64> = values.iter().map(number).collect();
    let all_numbers = numbers.iter().all(|value| value.is_finite());
    if all_numbers && distinct.len() > FEW {
        let low = numbers.iter().copied().fold(f64::INFINITY, f64::min);
        let log = low > 0.0 && numbers.iter().any(|value| *value > 20.0 * low);
        let shown = |value: f64| if log { value.log10() } else { value };
        let scale = Scale::holding(numbers.iter().map(|value| shown(*value)), 5);
        let shares = numbers.iter().map(|value| scale.share(shown(*value)).unwrap_or(0.0)).collect();
        let words = |at: f64, words: String| if log { format!("{:.1e}", 10f64.powf(at)) } else { words };
        let tick = |(at, text): (f64, String)| Some((scale.share(at)?, words(at, text)));
        return Axis { title, shares, ticks: scale.ticks().into_iter().filter_map(tick).collect() };
    }
    if all_numbers {
        distinct.sort_by(|a, b| number(a).total_cmp(&number(b)));
    }
    let slot = 1.0 / distinct.len() as f64;
    let middle = |place: usize| slot * (place as f64 + 0.5);
    let mut met = vec![0usize; distinct.len()];
    let mut shares = vec![];
    for value in values {
        let place = distinct.iter().position(|known| *known == value).unwrap_or(0);
        let crowd = values.iter().filter(|other| *other == value).count();
        let aside = if crowd > 1 { met[place] as f64 / (crowd - 1) as f64 - 0.5 } else { 0.0 };
        met[place] += 1;
        shares.push(middle(place) + 0.5 * slot * aside);
    }
    let tick = |(place, value): (usize, &&String)| (middle(place), value.trim_matches('"').to_string());
    Axis { title, shares, ticks: distinct.iter().enumerate().map(tick).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand, three slots of a third each.
    #[test]
    fn few_values_are_spaced_evenly_and_lines_through_one_lie_side_by_side() {
        let values = ["4e-3", "1e-3", "4e-3", "2e-3"].map(String::from);
        let axis = axis("rate".into(), &values);
        assert_eq!(axis.ticks.iter().map(|(_, words)| words.as_str()).collect::<Vec<_>>(), ["1e-3", "2e-3", "4e-3"]);
        let third = 1.0 / 3.0;
        for (found, expected) in axis.shares.iter().zip([2.25 * third, 0.5 * third, 2.75 * third, 1.5 * third]) {
            assert!((found - expected).abs() < 1e-12, "{:?}", axis.shares);
        }
    }

    #[test]
    fn many_values_stand_where_they_are() {
        let values: Vec<String> = (0..11).map(|k| format!("{}", 10f64.powf(-4.0 + 0.3 * f64::from(k)))).collect();
        let axis = axis("rate".into(), &values);
        let steps: Vec<f64> = axis.shares.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps.iter().all(|step| (step - steps[0]).abs() < 1e-9), "{steps:?}");
    }
}
