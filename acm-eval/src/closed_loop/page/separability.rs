//! The page and the summary of separability: effects that a set of trials can distinguish, before any claim is made
//! from it.

use acm_trace::finding::{Group, Separability};
use maud::{Markup, html};

use std::path::{Path, PathBuf};

use acm_core::display::shown;
use acm_datasets::files::{atomic, owned};
use acm_datasets::text::terminal::paragraph;

use super::apart::member;
use super::beside::{self, figure_name};
use super::markup::{Column, badge, banner, cell, document, figure, heading, table};
use super::stamp;
use crate::closed_loop::figures::matrix;
use crate::closed_loop::quantity::percent;
use crate::closed_loop::words::effect;
use crate::error::EvalError;
use crate::ownership;

/// Largest number of pairs in the list of the closest.
const PAIRS: usize = 15;
/// Share of imitation below which a pair is easy to distinguish, and not listed.
const CLOSE: f64 = 0.5;

/// Returns the whole page.
pub fn separability_page(separability: &Separability) -> String {
    let data = &separability.data;
    let body = html! {
        header {
            h1 { "What these trials can tell apart" (badge(data)) }
            p.aside { (data.title) }
        }
        p.sentence { (sentence(separability)) }
        p {
            "Before an error is traced to its cause: could these trials tell the causes apart at all? Every effect was \
            given the same size, " (shown(separability.size, &separability.unit))
            " root mean square, and every other was asked how much of it it could take over."
        }
        (banner(data))
        (heading("groups", "What cannot be told apart, and the experiment that would", data))
        (groups(&separability.groups))
        (heading("matrix", "Every pair", data))
        @match matrix::draw(separability) {
            Some(drawing) => (figure(&figure_name(matrix::NAME, 0), matrix::QUESTION, &drawing, data)),
            None => p { "No effect can act on this rig, so there is nothing to tell apart." }
        }
        (closest_pairs(separability))
        (recalibration(separability))
        (heading("data", "Data", data))
        (stamp::data(data))
        footer {
            p {
                "Made by acm-eval " (separability.version) "; layout " (separability.format)
                ". The same numbers, for programs: " code { "separability.json" } "."
            }
        }
    };
    document(&format!("What these trials can tell apart: {}", data.name), &body)
}

/// Name of the numbers, by which the folder of a result is known.
const NUMBERS: &str = "separability.json";

/// Refuses a folder that holds anything but an earlier result.
///
/// # Errors
/// Such a folder, or one that cannot be read.
pub fn claim_separability(folder: &Path) -> Result<(), EvalError> {
    let file = folder.join(NUMBERS);
    let own = |head: &[u8]| head.starts_with(b"{\n  \"format\": ");
    owned::claim(&file, own).map_err(EvalError::Table)?;
    if file.exists() || !folder.is_dir() {
        return Ok(());
    }
    let found = ownership::first_foreign(folder, |_| false).map_err(|source| EvalError::read(folder, source))?;
    let Some(name) = found else { return Ok(()) };
    let (folder, what) = (folder.into(), format!("it holds {name} and no {NUMBERS}"));
    Err(EvalError::NotOwned { folder, made: "separability", what })
}

/// Writes the numbers, figures and tables, and the page into a folder; returns where the page is. From the numbers on the folder is that
/// of a result.
///
/// # Errors
/// A folder that holds something else ([`claim_separability`]); a file cannot be written, or a figure drawn.
pub fn write_separability(found: &Separability, folder: &Path) -> Result<PathBuf, EvalError> {
    claim_separability(folder)?;
    let (page, file) = (folder.join("separability.html"), folder.join(NUMBERS));
    let numbers = serde_json::to_vec_pretty(found).map_err(|error| EvalError::write(&file, error.into()))?;
    let beside = beside::of_separability(found)?.into_iter().map(|(name, bytes)| (folder.join(name), bytes));
    let all = std::iter::once((file.clone(), numbers)).chain(beside);
    for (path, bytes) in all.chain([(page.clone(), separability_page(found).into_bytes())]) {
        atomic::write_bytes(&path, &bytes).map_err(EvalError::Table)?;
    }
    Ok(page)
}

/// Writes the text for a terminal: each group with the experiment that would separate it, and the closest pairs.
pub fn separability_summary(separability: &Separability) -> String {
    let mut parts: Vec<String> = vec![];
    if separability.data.synthetic {
        parts.push("SYNTHETIC DATA, made by a simulator".into());
    }
    parts.push(paragraph(&sentence(separability), ""));
    for group in &separability.groups {
        parts.push(paragraph(&format!("≈ {}", group.effects.join(", ")), "  "));
        parts.push(paragraph(&format!("next experiment: {}", group.experiment), "  "));
    }
    for (share, a, b) in pairs(separability).iter().take(5) {
        parts.push(paragraph(&format!("{} of {a} can be imitated by {b}", percent(*share)), "  "));
    }
    parts.join("\n")
}

fn sentence(separability: &Separability) -> String {
    let (effects, groups) = (separability.effects.len(), separability.groups.len());
    let members: usize = separability.groups.iter().map(|group| group.effects.len()).sum();
    match (effects, groups) {
        (0, _) => "No effect that the tool knows can act on this rig.".into(),
        (_, 0) => format!("These trials tell all {effects} effects apart."),
        (_, 1) => format!("Of {effects} effects, {members} cannot be told apart by these trials."),
        _ => format!(
            "Of {effects} effects, {members} cannot be told apart by these trials: they fall into {groups} groups."
        ),
    }
}

fn groups(groups: &[Group]) -> Markup {
    html! {
        @if groups.is_empty() { p { "Every effect leaves a trace of its own in these trials." } }
        @for group in groups {
            div.effect {
                ul.names {
                    @for name in &group.effects {
                        (member(name))
                    }
                }
                div.next { b { "Next experiment: " } (group.experiment) }
            }
        }
    }
}

/// Returns (share, effect, imitator), the closest first.
fn pairs(separability: &Separability) -> Vec<(f64, &str, &str)> {
    let names = &separability.effects;
    let mut pairs: Vec<(f64, &str, &str)> = vec![];
    for (a, (name, row)) in names.iter().zip(&separability.imitated).enumerate() {
        let others = row.iter().zip(names).enumerate().filter(|(b, (share, _))| *b != a && **share >= CLOSE);
        pairs.extend(others.map(|(_, (share, other))| (*share, name.as_str(), other.as_str())));
    }
    pairs.sort_by(|x, y| y.0.total_cmp(&x.0));
    pairs
}

fn closest_pairs(separability: &Separability) -> Markup {
    let pairs = pairs(separability);
    let columns: [Column; 3] = [("Effect", true), ("Imitated by", true), ("Share", false)];
    let row = |(share, a, b): &(f64, &str, &str)| vec![effect(a), effect(b), cell(percent(*share))];
    let rows: Vec<Vec<Markup>> = pairs.iter().take(PAIRS).map(row).collect();
    html! {
        @if !rows.is_empty() {
            h3 { "The closest pairs" }
            p.note {
                "Pairs of which half or more can be imitated: " (pairs.len())
                @if pairs.len() > PAIRS { ", of which the first " (PAIRS) " are listed" } "."
            }
            (table("pairs", "The closest pairs", &columns, &rows))
        }
    }
}

fn recalibration(separability: &Separability) -> Markup {
    let mut effects: Vec<(&str, f64)> =
        separability.effects.iter().map(String::as_str).zip(separability.by_recalibration.iter().copied()).collect();
    effects.retain(|(_, share)| *share >= CLOSE);
    effects.sort_by(|a, b| b.1.total_cmp(&a.1));
    let columns: [Column; 2] = [("Effect", true), ("Taken over by recalibration", false)];
    let rows: Vec<Vec<Markup>> =
        effects.iter().take(PAIRS).map(|(name, share)| vec![effect(name), cell(percent(*share))]).collect();
    html! {
        @if !rows.is_empty() {
            h3 { "What looks like a wrong calibration" }
            p.note {
                "Effects of which recalibration alone takes over half or more: with these trials they are hard to find."
            }
            (table("recalibration", "Effects that recalibration takes over", &columns, &rows))
        }
    }
}
