//! The page of a finding: one self-contained HTML file, in the order of a reader's questions.
//!
//! What was found? May I believe it? Which values? Does the residual vanish where it should? What is left? What
//! else could it be? How was it searched?

pub(super) mod apart;
pub mod beside;
pub(super) mod confirmation;
mod effects;
mod left;
mod markup;
pub(super) mod numbers;
mod search;
pub(super) mod separability;
mod stamp;
pub(super) mod verdict;

use acm_trace::finding::{Confirmation, Finding};
use maud::{Markup, html};

use super::figures::{self, Figure};
use super::outcome::Outcome;
use super::quantity::{common_decimals, percent, plain, significant};
use super::readable::readable;
use super::words::in_unit;
use crate::page::answers;
use beside::{figure_name, table_file};
use markup::{Column, badge, banner, cell, document, figure, folded, heading, named, table};

/// Returns the whole page.
pub fn page(finding: &Finding) -> String {
    let tables = numbers::of_finding(finding);
    let finding = &readable(finding);
    let data = &finding.data;
    let body = html! {
        header {
            h1 { "What the model lacks" (badge(data)) }
            p.aside { (data.title) }
        }
        p.sentence { (finding.sentence) }
        (concluded(finding))
        (banner(data))
        (outcome(finding))
        (effects::section(finding))
        (residual(finding))
        (trials(finding))
        (left::section(finding))
        (apart::section(finding))
        (networks(finding))
        (search::section(finding))
        (stamp::section(finding))
        @for table in &tables { (answers::csv(&table_file(table.name), &table.csv())) }
    };
    document(&format!("What the model lacks: {}", data.name), &body)
}

/// Writes the page for a notebook: the page down to the remaining residual, as a page of its own.
pub fn head(finding: &Finding) -> String {
    let finding = &readable(finding);
    let body = html! {
        p.sentence { (finding.sentence) (badge(&finding.data)) }
        (concluded(finding))
        (banner(&finding.data))
        (drawn(&figures::INTERVALS, finding))
        (drawn(&figures::CARRIER, finding))
        (drawn(&figures::TRACE, finding))
    };
    document(&format!("What the model lacks: {}", finding.data.name), &body)
}

/// Writes the verdict and confirmation; where held-out trials refute the model, the confirmation comes first.
fn concluded(finding: &Finding) -> Markup {
    let words = verdict::words(finding);
    let (confirmation, means) = confirmation::words(finding);
    let is_refuted = finding.confirmation == Confirmation::Refuted;
    let class = if is_refuted { "open" } else { words.class };
    html! {
        div class={ "verdict " (class) } {
            @if is_refuted {
                span { "Held-out trials: " } span.mark { "refuted" }
                p { "Refuted by held-out trials: " (means) "." }
                p { b { "What to do: " } "Do not use the model. Record more trials, and more varied ones; what was found on these \
                    does not carry over." }
                p { "On development trials alone the verdict would be: " b { (words.label) } ". " (words.means) }
            } @else {
                span { "Verdict: " } span.mark { (words.label) }
                p { (words.means) }
                p { b { "Held-out trials: " } (confirmation) "; " (means) "." }
                p { b { "What to do: " } (words.next) }
            }
        }
    }
}

/// Draws every drawing of a figure, with identifiers of their own.
fn drawn(shown: &Figure, finding: &Finding) -> Markup {
    html! {
        @for (index, drawing) in (shown.draw)(finding).iter().enumerate() {
            (figure(&figure_name(shown.name, index), shown.question, drawing, &finding.data))
        }
    }
}

fn outcome(finding: &Finding) -> Markup {
    let outcome = Outcome::of(finding);
    let columns: [Column; 4] = [("Model", true), ("Error", false), ("95 % interval", false), ("What it is", true)];
    let digits = |value: f64| plain(value, outcome.decimals);
    let mut rows: Vec<Vec<Markup>> = vec![];
    for row in outcome.rows() {
        let [low, high] = row.error.interval;
        let error = html! { @if row.is_after { b { (digits(row.error.value)) } } @else { (digits(row.error.value)) } };
        rows.push(vec![
            cell(row.name()),
            error,
            cell(format!("{} to {}", digits(low), digits(high))),
            cell(row.meaning),
        ]);
    }
    let noise = "scatter of the measurement, from second differences";
    rows.push(vec![cell("white noise"), cell(significant(outcome.noise, 2)), Markup::default(), cell(noise)]);
    html! {
        (heading("before-and-after", "Before and after", &finding.data))
        (drawn(&figures::INTERVALS, finding))
        p.note {
            "Root mean square error over all outputs on " (count(finding.data.held_out.len(), "held-out trial"))
            (in_unit(outcome.unit)) ". Intervals: bootstrap over trials (or blocks)."
        }
        (table("before-and-after", "Before and after", &columns, &rows))
        (removed(&outcome))
    }
}

fn removed(outcome: &Outcome) -> Markup {
    html! {
        @match outcome.removed {
            Some(share) => {
                p {
                    b { "F = " (percent(share)) } " of the removable error is gone"
                    @if share < 0.0 { ": what was added made it worse on held-out trials" }
                    ". F = (b² − a²) / (b² − n²), with b the best baseline, a after, and n the noise, which no model \
                    removes."
                    @if share > 1.0 {
                        " More than 100 % means that the error fell below the estimated noise: both are estimates."
                    }
                }
            }
            None => p { "No share F of the removable error is given: " (why_no_share(outcome)) "." }
        }
    }
}

fn why_no_share(outcome: &Outcome) -> &'static str {
    let best = outcome.rows().into_iter().find(|row| row.is_best_baseline).map(|row| row.error);
    match best {
        Some(best) if best.interval[0] <= outcome.noise => "the best baseline is as good as the noise allows",
        _ if outcome.found => "errors or noise are not known",
        _ => "nothing was added that could have removed it",
    }
}

/// Writes `1 trial`, `3 trials`.
fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn residual(finding: &Finding) -> Markup {
    html! {
        @if !finding.figures.carriers.is_empty() || finding.figures.trace.is_some() {
            (heading("residual", "What the model missed, and what is left of it", &finding.data))
            (drawn(&figures::CARRIER, finding))
            (drawn(&figures::TRACE, finding))
        }
    }
}

fn trials(finding: &Finding) -> Markup {
    let trials = &finding.figures.trials;
    let unit = finding.errors.unit.as_str();
    let columns: [Column; 4] =
        [("Trial", true), ("Nominal", false), ("Best baseline", false), ("With what was found", false)];
    let decimals = common_decimals(trials.iter().flat_map(|trial| [trial.nominal, trial.best_baseline, trial.after]));
    let rows: Vec<Vec<Markup>> = trials
        .iter()
        .map(|trial| {
            let numbers = [trial.nominal, trial.best_baseline, trial.after].map(|value| cell(plain(value, decimals)));
            [named(&trial.name)].into_iter().chain(numbers).collect()
        })
        .collect();
    html! {
        @if !trials.is_empty() {
            (heading("trials", "Trial by trial", &finding.data))
            (drawn(&figures::TRIALS, finding))
            (folded("The same as numbers", &html! {
                p.note { "Root mean square error" (in_unit(unit)) "." }
                (table("trials", "Errors of each held-out trial", &columns, &rows))
            }))
        }
    }
}

fn networks(finding: &Finding) -> Markup {
    let rows = &finding.networks;
    let decimals = common_decimals(rows.iter().map(|row| row.error));
    let columns: [Column; 3] = [("Model", true), ("Error", false), ("Standard deviation over seeds", false)];
    let shown: Vec<Vec<Markup>> = rows
        .iter()
        .map(|row| {
            let error = plain(row.error, decimals);
            vec![named(&row.model), cell(error), cell(row.sd.map_or("–".into(), |sd| plain(sd, decimals)))]
        })
        .collect();
    html! {
        @if !rows.is_empty() {
            (heading("networks", "And a network on top?", &finding.data))
            p.note {
                "Root mean square error on held-out trials" (in_unit(&finding.errors.unit)) ", at identical time stamps. \
                Where effect and network are no better than the effect alone, the effect has taken \
                all that a network can learn; where they are better, something learnable is left."
            }
            (table("networks", "Nominal model, effect and network", &columns, &shown))
        }
    }
}
