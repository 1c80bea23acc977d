//! `acm-eval report`: runs side by side, and studies, on one page.

use std::path::PathBuf;

use acm_eval::{
    error::EvalError,
    report::{Report, default_folder},
    terminal,
};
use clap::Args;

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval report runs/cfc                          one run → runs/cfc/report/report.html
  acm-eval report runs/mlp runs/gru runs/cfc        three runs, one table → runs/report/report.html
  acm-eval report runs/cfc runs/trunk --out page    two data sets, two sections → page/report.html
  acm-eval report runs/nominal runs/sweep runs/cfc  studies, a chapter each, and a run";

/// What may be asked for.
#[derive(Args)]
pub struct ReportArgs {
    /// Folders of runs or studies, as acm-train wrote them, such as runs/mlp runs/gru runs/cfc runs/ablation
    ///
    /// Runs on the same data share one table; they must have been scored at the same target time stamps. Runs on other
    /// data get a section of their own, and so does each study.
    #[arg(required = true, value_name = "RUN")]
    runs: Vec<PathBuf>,
    /// Folder of the report [default: RUN/report for one run, report beside the first of several]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Writes the page; prints the main table and where the page is.
pub fn run(args: &ReportArgs) -> Result<(), EvalError> {
    let runs = runs(args);
    let out = args.out.clone().unwrap_or_else(|| default_folder(&runs));
    let report = Report::of(&runs, command(args))?;
    let page = report.write(&out)?;
    report.chapters.iter().flat_map(|chapter| &chapter.missing).for_each(|told| eprintln!("warning: {told}"));
    terminal::print(&format!("{}\n\n{}", terminal::summary(&report), page.display()))
}

/// Returns the runs without earlier reports, which `acm-eval report runs/*` includes.
fn runs(args: &ReportArgs) -> Vec<PathBuf> {
    let is_report = |path: &PathBuf| path.join("report.html").is_file() && !path.join("records").exists();
    let (reports, runs): (Vec<PathBuf>, Vec<PathBuf>) = args.runs.iter().cloned().partition(is_report);
    reports
        .iter()
        .for_each(|report| eprintln!("note: {} is a report, not a run, and is passed over", report.display()));
    if runs.is_empty() { reports } else { runs }
}

/// The command as typed, which every figure carries.
fn command(args: &ReportArgs) -> String {
    let runs = args.runs.iter().map(|run| run.display().to_string());
    let out = args.out.iter().map(|out| format!("--out {}", out.display()));
    let words: Vec<String> = ["acm-eval report".to_string()].into_iter().chain(runs).chain(out).collect();
    words.join(" ")
}
