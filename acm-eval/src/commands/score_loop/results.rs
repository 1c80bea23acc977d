//! Results of a run: figures as JSON, and the reliability diagram.

use std::path::Path;

use acm_datasets::files::{atomic, owned};
use acm_eval::error::EvalError;
use acm_eval::scoring::answer::Answer;
use acm_eval::scoring::figures::{QUESTION, diagram, reliability};
use acm_eval::terminal::print;
use serde::Serialize;

use super::args::ScoreArgs;

/// Writes a score where a folder is named.
pub fn keep(args: &ScoreArgs, name: &str, score: &impl Serialize) -> Result<(), EvalError> {
    args.out.as_ref().map_or(Ok(()), |out| write(&out.join(name), score))
}

/// How results of this command begin: scores, other figures, and a table of aliases.
const OWN: [&str; 3] = ["{\n  \"format\": ", "{\n  \"configuration\": ", "{\n  \"command\": \"acm-eval score-loop"];

/// Refuses to replace what is no result of this command.
pub fn claim(file: &Path) -> Result<(), EvalError> {
    owned::claim(file, |head| OWN.iter().any(|own| head.starts_with(own.as_bytes()))).map_err(EvalError::Table)
}

/// Refuses to replace pictures that are not reliability diagrams. A PNG says nothing of itself: the SVG beside it speaks for both.
pub fn claim_pictures(name: &Path) -> Result<(), EvalError> {
    let (svg, png) = (name.with_extension("svg"), name.with_extension("png"));
    let own = |head: &[u8]| head.windows(DIAGRAM.len()).any(|part| part == DIAGRAM.as_bytes());
    owned::claim(&svg, own).and_then(|()| owned::claim(&png, |_| svg.exists())).map_err(EvalError::Table)
}

/// Name of every diagram in its file.
const DIAGRAM: &str = "<title id=\"reliability-title\">";

/// Writes a value as JSON, and prints where.
pub fn write(file: &Path, value: &impl Serialize) -> Result<(), EvalError> {
    claim(file)?;
    let mut text = serde_json::to_vec_pretty(value).map_err(|e| EvalError::write(file, e.into()))?;
    text.push(b'\n');
    put(file, &text)
}

/// Draws the reliability diagram as SVG and PNG.
pub fn draw(name: &Path, answers: &[Answer]) -> Result<(), EvalError> {
    claim_pictures(name)?;
    let claims: usize = answers.iter().map(|answer| answer.claims.len()).sum();
    let drawing = diagram(&reliability(answers), &format!("{} campaigns and rigs, {claims} claims", answers.len()));
    put(&name.with_extension("svg"), drawing.svg("reliability", QUESTION, &drawing.explanation).as_bytes())?;
    put(&name.with_extension("png"), &drawing.png("reliability")?)
}

fn put(file: &Path, bytes: &[u8]) -> Result<(), EvalError> {
    if let Some(folder) = file.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(|e| EvalError::write(folder, e))?;
    }
    atomic::write_bytes(file, bytes).map_err(EvalError::Table)?;
    print(&file.display().to_string())
}
