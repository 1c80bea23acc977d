//! The remaining residual: noise, probes, events, and a formula where one was found.

use acm_core::display::with_symbol;
use acm_trace::finding::{Event, Finding, Probe, Symbolic};
use maud::{Markup, html};

use super::beside::figure_name;
use super::markup::{Column, cell, entry, figure, heading, named, table};
use crate::closed_loop::figures;
use crate::closed_loop::quantity::{percent, plain, significant};

/// Writes all results about the remaining residual.
pub fn section(finding: &Finding) -> Markup {
    let left = &finding.left;
    let unit = finding.errors.unit.as_str();
    html! {
        (heading("left", "What remains", &finding.data))
        @for drawing in &(figures::AUTOCORRELATION.draw)(finding) {
            (figure(&figure_name(figures::AUTOCORRELATION.name, 0), figures::AUTOCORRELATION.question, drawing, &finding.data))
        }
        dl {
            (entry("Beyond the noise", &html! {
                (with_symbol(&significant(left.rms, 3), unit)) " root mean square, cross-validated on development trials"
            }))
            (entry("Predicted by inputs", &match &left.probe {
                Some(found) => probe(found, unit, "a regression on all inputs and their past"),
                None => html! { "not asked: too few blocks to leave any out" },
            }))
            @if let Some(found) = &left.network {
                (entry("Predicted by a network", &probe(found, unit, "a small recurrent network on all inputs")))
            }
            @if let Some(offset) = finding.trial_offset {
                (entry("Offset of each trial", &html! {
                    (with_symbol(&significant(offset, 3), unit)) " root mean square, which no recorded signal tells"
                }))
            }
            (entry("Events", &html! {
                @if left.events.is_empty() { "none: no slip, no spectral line, no offset of single trials" }
                @else { (left.events.len()) " found, see below" }
            }))
        }
        @if !left.events.is_empty() { (events(&left.events)) }
        @if let Some(symbolic) = &finding.symbolic { (formula(symbolic, unit)) }
    }
}

fn probe(probe: &Probe, unit: &str, by: &str) -> Markup {
    let finds = probe.finds();
    html! {
        b { @if finds { "yes: " } @else { "no: " } }
        (by) " explains " (percent(probe.explained))
        " of the variance of what is left, on blocks left out; the same on residuals shifted in time reaches "
        (percent(probe.by_chance)) " by chance in one case of twenty (" (chance(probe.p)) ")"
        @if finds { ". What it explains is " (with_symbol(&significant(probe.rms, 3), unit)) " root mean square" }
        "."
    }
}

fn chance(p: f64) -> String {
    if p < 0.001 { "p < 0.001".into() } else { format!("p = {}", plain(p, if p < 0.1 { 3 } else { 2 })) }
}

fn events(events: &[Event]) -> Markup {
    let columns: [Column; 3] = [("Event", true), ("Share of what is left", false), ("What", true)];
    let row = |event: &Event| vec![named(&event.kind), cell(percent(event.share)), html! { div.wrap { (event.what) } }];
    let rows: Vec<Vec<Markup>> = events.iter().map(row).collect();
    html! {
        h3 { "What happened once, or without any input" }
        (table("events", "Events", &columns, &rows))
    }
}

fn formula(symbolic: &Symbolic, unit: &str) -> Markup {
    let columns: [Column; 3] = [("Acts on", true), ("Term", true), ("Coefficient (SI)", false)];
    let rows: Vec<Vec<Markup>> = symbolic
        .terms
        .iter()
        .map(|term| vec![named(&term.on), html! { code { (term.term) } }, cell(significant(term.coefficient, 3))])
        .collect();
    html! {
        h3 { "A formula for what no known effect explains" }
        p.formula { code { (symbolic.formula) } }
        p {
            "With it the cross-validated error on development trials is " (with_symbol(&significant(symbolic.error, 3), unit))
            ". It was searched among products of signals; it describes, and does not say why."
        }
        @if !rows.is_empty() { (table("formula", "Terms of the formula", &columns, &rows)) }
    }
}
