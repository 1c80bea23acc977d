//! Caveats of the conclusion, and its data and settings.

use acm_trace::finding::{Data, Finding};
use acm_train::run::names::some;
use maud::{Markup, html};

use super::markup::{badge, entry, folded, heading};
use crate::closed_loop::quantity::significant;

/// Writes cautions, then data, configuration and version.
pub fn section(finding: &Finding) -> Markup {
    let configuration = match &finding.configuration {
        serde_json::Value::Null => "not recorded".to_string(),
        resolved => serde_json::to_string_pretty(resolved).unwrap_or_default(),
    };
    html! {
        (heading("cautions", "Cautions", &finding.data))
        @if finding.cautions.is_empty() {
            p { "None beyond those that hold for every such analysis: an effect that was not tried cannot be found." }
        } @else {
            ul.caution { @for caution in &finding.cautions { li { (caution) } } }
        }
        (heading("data", "Data and settings", &finding.data))
        (data(&finding.data))
        (folded("Configuration", &html! { pre tabindex="0" { code { (configuration) } } }))
        footer {
            p {
                "Made by acm-eval " (finding.version) " in " (significant(finding.seconds, 2))
                " s of computing; layout " (finding.format) ". The same numbers, for programs: "
                code { "loop.json" } "."
            }
        }
    }
}

/// Writes the names of the recordings by role.
pub fn data(data: &Data) -> Markup {
    html! {
        dl {
            (entry("Data set", &html! { (data.name) @if data.title != data.name { ": " (data.title) } (badge(data)) }))
            (entry("SHA-256", &html! { code.hash { (data.hash) } }))
            (entry("Calibration trials", &names(&data.calibration, "the nominal model was fitted to them")))
            (entry("Development trials", &names(&data.development, "effects were searched and fitted on them")))
            (entry("Held-out trials", &names(&data.held_out, "they were not used in the search, and test its result")))
        }
    }
}

fn names(names: &[String], role: &str) -> Markup {
    html! {
        @if names.is_empty() { "none" } @else { (some(names, ", ")) span.aside { ": " (role) } }
    }
}
