//! Where the numbers of a page come from, and how to make them again.

use maud::{Markup, html};

use crate::{page::badge, run::Run, section::Section};

/// Data, experiments and versions, as a list of terms.
pub fn provenance(section: &Section) -> Markup {
    let data = &section.data;
    html! {
        h3 { "Provenance" }
        dl {
            (entry("Data set", html! { (data.name) ": " (data.title) (badge(section)) }))
            (entry("Source", html! { (data.source) }))
            (entry("Licence", html! { (data.licence) }))
            (entry("SHA-256", html! { code.hash { (data.hash) } }))
            (entry("Experiments", html! { @for run in &section.runs { (experiment(run)) } }))
            (entry("Versions", html! { @for line in versions(section) { div { (line) } } }))
        }
    }
}

fn entry(term: &str, meaning: Markup) -> Markup {
    html! { dt { (term) } dd { (meaning) } }
}

/// The resolved experiment file, and the command that runs it again.
fn experiment(run: &Run) -> Markup {
    let folder = run.folder.display().to_string();
    let folder = folder.trim_end_matches('/');
    html! {
        div { code { "acm-train --config " (folder) "/experiment.toml --out " (folder) "-again" } }
    }
}

/// Every distinct set of versions, with the runs it made.
fn versions(section: &Section) -> Vec<String> {
    let mut lines: Vec<(String, Vec<&str>)> = Vec::new();
    for run in &section.runs {
        for record in &run.records {
            let v = &record.versions;
            let commit = v.commit.as_ref().map_or(String::new(), |commit| format!(", commit {commit}"));
            let line = format!("acm {}, burn {}{commit}, device {}", v.acm, v.burn, record.experiment.device);
            match lines.iter_mut().find(|(known, _)| *known == line) {
                Some((_, runs)) if !runs.contains(&run.name.as_str()) => runs.push(&run.name),
                Some(_) => {}
                None => lines.push((line, vec![&run.name])),
            }
        }
    }
    match lines.as_slice() {
        [(line, _)] => vec![line.clone()],
        _ => lines.iter().map(|(line, runs)| format!("{line} ({})", runs.join(", "))).collect(),
    }
}
