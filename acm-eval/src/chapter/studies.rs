//! A study's folder as a chapter, whatever kind of study it is.

use std::path::Path;

use acm_train::{
    config::Kind,
    run::record::{DataStamp, Versions},
};
use maud::{Markup, html};
use serde::Deserialize;

use super::{Chapter, Shown, best, best_sequences, list, nominal, residual, sequences};
use crate::{error::EvalError, figures::Drawing, json::versioned, run::name_of, tables::Table};

/// Returns whether a folder is a study's.
pub fn is_one(folder: &Path) -> bool {
    folder.join("study.json").is_file()
}

/// Returns the name of its chapter in file names.
pub fn name(folder: &Path) -> String {
    name_of(folder)
}

/// Reads a study, and draws everything.
///
/// # Errors
/// A file is missing, damaged or of another format, or a run of the study is not finished.
pub fn chapter(folder: &Path, slug: String) -> Result<Chapter, EvalError> {
    #[derive(Deserialize)]
    struct Asked {
        kind: Kind,
    }
    match versioned::<Asked>(&folder.join("study.json"))?.kind {
        Kind::Sweep | Kind::Ablation | Kind::Comparison | Kind::Inputs => list::chapter(folder, slug),
        Kind::Best if best_sequences::is_one(folder)? => best_sequences::chapter(folder, slug),
        Kind::Best => best::chapter(folder, slug),
        Kind::Nominal => {
            let study = nominal::read(folder)?;
            let record = &study.record;
            let described = Described {
                title: "The nominal model",
                question: &record.question,
                config: &record.config,
                data: &record.data,
                versions: &record.versions,
                notes: &record.notes,
            };
            Ok(described.chapter(folder, slug, nominal::tables(&study), nominal::figures(&study)))
        }
        Kind::Residual => {
            let study = residual::read(folder)?;
            let record = &study.record;
            let described = Described {
                title: "What the nominal model misses",
                question: &record.question,
                config: &record.config,
                data: &record.data,
                versions: &record.versions,
                notes: &record.notes,
            };
            Ok(described.chapter(folder, slug, residual::tables(&study), residual::figures(&study)))
        }
        Kind::Sequences => {
            let study = sequences::read(folder)?;
            let described = Described {
                title: "What elapsed time tells",
                question: &study.record.question,
                config: &study.record.config,
                data: &study.data,
                versions: &study.runs[0].versions,
                notes: &[],
            };
            Ok(described.chapter(folder, slug, sequences::tables(&study), sequences::figures(&study)))
        }
    }
}

/// Common parts of the records of descriptive studies.
struct Described<'a> {
    title: &'a str,
    question: &'a str,
    /// Name of the file that asked.
    config: &'a str,
    data: &'a DataStamp,
    versions: &'a Versions,
    /// Parts that were left out, with reasons.
    notes: &'a [String],
}

impl Described<'_> {
    fn chapter(
        self,
        folder: &Path,
        slug: String,
        tables: Vec<Table>,
        figures: Vec<(&'static str, &'static str, Drawing)>,
    ) -> Chapter {
        let Versions { acm, burn, commit } = self.versions;
        let commit = commit.as_ref().map_or(String::new(), |commit| format!(", commit {commit}"));
        let command = format!("acm-train --config {}", self.config);
        let shown = |(name, question, drawing): (&'static str, &'static str, Drawing)| Shown {
            name,
            question: question.into(),
            drawing,
        };
        Chapter {
            slug,
            title: self.title.into(),
            data: self.data.clone(),
            missing: vec![],
            lead: Markup::default(),
            notes: self.notes.to_vec(),
            questions: vec![(String::new(), self.question.into())],
            main: tables.first().map_or("", |table| table.name),
            tables,
            figures: figures.into_iter().map(shown).collect(),
            provenance: vec![
                ("Made by", html! { code { (command) } ", in " code { (folder.display()) } }),
                ("Versions", html! { "acm " (acm) ", burn " (burn) (commit) }),
            ],
        }
    }
}
