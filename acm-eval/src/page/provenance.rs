//! Origin of the numbers of a page, and commands that reproduce them.

use maud::{Markup, html};

use crate::run::Run;

/// Returns experiments and versions, as terms with their meanings.
pub fn provenance(runs: &[Run]) -> Vec<(&'static str, Markup)> {
    vec![
        ("Experiments", html! { @for run in runs { (experiment(run)) } }),
        ("Versions", html! { @for line in versions(runs) { div { (line) } } }),
    ]
}

/// The resolved experiment file, and the command that runs it again.
fn experiment(run: &Run) -> Markup {
    let folder = run.folder.display().to_string();
    let folder = folder.trim_end_matches('/');
    html! {
        div { code { "acm-train --config " (folder) "/experiment.toml --out " (folder) "-again" } }
    }
}

/// Returns every distinct set of versions, with the runs it made.
pub fn versions(runs: &[Run]) -> Vec<String> {
    let mut lines: Vec<(String, Vec<&str>)> = Vec::new();
    for run in runs {
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
