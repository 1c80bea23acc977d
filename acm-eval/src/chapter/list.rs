//! A sweep, an ablation or a comparison as a chapter.
//!
//! | kind       | tables                                | figures                                                  |
//! | ---------- | ------------------------------------- | -------------------------------------------------------- |
//! | sweep      | best settings, all settings           | parallel coordinates                                     |
//! | ablation   | error and difference of each variant  | differences with intervals                               |
//! | inputs     | every set that was tried              |                                                          |
//! | comparison | those of runs on the first variant's trials, error under each protocol, differences in pairs | those of runs, error under each protocol |

mod differences;
mod intervals;
mod parallel;
mod protocols;
mod settings;

use std::path::Path;

use acm_train::config::Kind;
use acm_train::run::evaluation::summary::display;
use acm_train::run::record::RunRecord;
use acm_train::schedule::study::record::{Runs, StudyRecord, folder as run_folder};
use acm_train::schedule::study::table::{Group, groups, scored};
use maud::{Markup, html};

use super::{Chapter, chosen, of_section};
use crate::error::EvalError;
use crate::figures::canvas::palette;
use crate::json::versioned;
use crate::page::provenance::versions;
use crate::run::{Run, missing};
use crate::section::sections;
use crate::unit::{Display, total_name};

/// A list of experiments with its runs, each checked against its table of predictions.
pub struct List {
    /// Configuration of the study.
    pub study: StudyRecord,
    /// Runs of each member.
    pub runs: Vec<Run>,
    /// Display of errors.
    pub display: Display,
}

impl List {
    /// Reads the folder of a study.
    ///
    /// # Errors
    /// See [`Run::read`]; a member without runs: the study is not finished.
    pub fn read(folder: &Path) -> Result<Self, EvalError> {
        let study: StudyRecord = versioned(&folder.join("study.json"))?;
        let read = |id: &String| Run::read(&run_folder(folder, id));
        let runs = study.members.iter().map(|member| read(&member.id)).collect::<Result<Vec<_>, _>>();
        let runs = runs.map_err(|error| unfinished(folder, error))?;
        let Some(first) = runs.first() else {
            let file = folder.join("study.json");
            return Err(EvalError::Record { file, reason: "it names no experiment".into() });
        };
        let parts = runs.iter().flat_map(|run| &run.records).map(scored);
        let display = display(&first.records[0].data.unit, parts);
        Ok(Self { study, runs, display })
    }

    /// Returns the rows that are compared with each other, as acm-train prints them.
    pub fn groups(&self) -> Vec<Group<'_>> {
        groups(&self.study, &self.members())
    }

    /// Returns the members, each with its runs.
    fn members(&self) -> Vec<Runs<'_>> {
        let of = |(member, run)| {
            let run: &Run = run;
            Runs { member, records: &run.records }
        };
        self.study.members.iter().zip(&self.runs).map(of).collect()
    }

    /// Returns the colour of each base: that of its kind of network on every page.
    pub fn colours(&self) -> Vec<(&str, &'static str)> {
        let mut networks = palette::Networks::default();
        let mut colours: Vec<(&str, &'static str)> = vec![];
        for (member, run) in self.study.members.iter().zip(&self.runs) {
            if !colours.iter().any(|(base, _)| *base == member.base) {
                colours.push((&member.base, networks.next(&run.kind())));
            }
        }
        colours
    }

    /// Returns the name of the error over all outputs.
    pub fn total(&self) -> &'static str {
        total_name(&self.first().data.unit, self.first().outputs.len())
    }

    /// Returns the first run, from which the common settings are read.
    pub fn first(&self) -> &RunRecord {
        &self.runs[0].records[0]
    }
}

/// Reads a study, and draws everything.
///
/// # Errors
/// As [`List::read`].
pub fn chapter(folder: &Path, slug: String) -> Result<Chapter, EvalError> {
    let mut list = List::read(folder)?;
    let data = list.first().data.clone();
    let tables = match list.study.kind {
        Kind::Sweep => settings::tables(&list),
        Kind::Ablation => vec![differences::table(&list)],
        Kind::Inputs => chosen::table(&list.study, &list.members()).into_iter().collect(),
        _ => protocols::tables(&list),
    };
    let figures = match list.study.kind {
        Kind::Sweep => parallel::draw(&list),
        Kind::Ablation => intervals::draw(&list),
        Kind::Inputs => vec![],
        _ => protocols::draw(&list),
    };
    let command = format!("acm-train --config {}", list.study.config);
    let experiments =
        html! { div { code { (command) } } div { (list.runs.len()) " experiments in " code { (folder.display()) } } };
    let versions = html! { @for line in versions(&list.runs) { div { (line) } } };
    let missing: Vec<String> = list.runs.iter().filter_map(missing::sentence).collect();
    let chapter = Chapter {
        slug,
        title: title(list.study.kind).into(),
        data,
        lead: html! { (lead(&list)) (super::missing(&missing)) },
        missing,
        notes: vec![],
        questions: vec![(String::new(), list.study.question.clone())],
        main: tables.first().map_or("", |table| table.name),
        tables,
        figures: figures.into_iter().collect(),
        provenance: vec![("Made by", experiments), ("Versions", versions)],
    };
    match list.study.kind {
        Kind::Comparison => with_runs(chapter, &mut list),
        _ => Ok(chapter),
    }
}

/// Adds the chapter of the runs under the first protocol to that of a comparison.
fn with_runs(chapter: Chapter, list: &mut List) -> Result<Chapter, EvalError> {
    let first = list.study.members[0].variant.clone();
    let members = list.study.members.iter().zip(list.runs.drain(..));
    let named = members
        .filter(|(member, _)| member.variant == first)
        .map(|(member, run)| Run { name: member.base.clone(), ..run });
    let Some(section) = sections(named.collect())?.into_iter().next() else { return Ok(chapter) };
    let runs = of_section(&section, chapter.slug.clone());
    // Those of the section stand in its lead.
    let others: Vec<String> = chapter.missing.iter().filter(|told| !runs.missing.contains(told)).cloned().collect();
    let others = super::missing(&others);
    Ok(Chapter {
        lead: html! { (runs.lead) (others) },
        main: runs.main,
        tables: runs.tables.into_iter().chain(chapter.tables).collect(),
        figures: runs.figures.into_iter().chain(chapter.figures).collect(),
        provenance: chapter.provenance.into_iter().chain(runs.provenance).collect(),
        ..chapter
    })
}

fn title(kind: Kind) -> &'static str {
    match kind {
        Kind::Sweep => "Selection of settings",
        Kind::Ablation => "What each input is worth",
        Kind::Inputs => "Which inputs are worth having",
        _ => "Models compared",
    }
}

/// Writes the result in one sentence.
fn lead(list: &List) -> Markup {
    let total =
        |records: &[RunRecord]| acm_train::schedule::study::table::validation_error(records).unwrap_or(f64::NAN);
    html! {
        @if list.study.kind == Kind::Inputs { (chosen::lead(&list.study, &list.members())) }
        @if list.study.kind == Kind::Sweep {
            @for group in list.groups() {
                @if let Some((name, runs)) = group.rows.first() {
                    p.lead {
                        (group.title) ": the smallest validation error, "
                        b { (list.display.show(total(runs.records))) }
                        ", belongs to " (name) ", of " (group.rows.len()) " settings."
                    }
                }
            }
        }
    }
}

/// Converts the error of a missing run to that of a study that was stopped.
fn unfinished(folder: &Path, error: EvalError) -> EvalError {
    match error {
        EvalError::NoFolder { path } | EvalError::NotARun { path, .. } | EvalError::NoRecords { path } => {
            EvalError::Unfinished { folder: folder.into(), run: path }
        }
        other => other,
    }
}
