//! `acm-eval separability`: what these trials could tell apart at all, before any claim is made from them.

use std::path::{Path, PathBuf};

use acm_datasets::{Campaign, atomic};
use acm_eval::{
    closed_loop::{separability_page, separability_summary},
    error::EvalError,
    loop_config::LoopConfig,
    recordings::{Recordings, recordings},
};
use acm_trace::{
    close::About,
    finding::{Data, Separability},
    separability::separability,
};
use acm_train::{experiment::Source, nominal::choose};
use clap::Args;

use super::steps::Steps;

/// Above the options, in full.
pub const ABOUT: &str = "\
Says which physical effects your trials could tell apart at all, and which experiment would tell the rest apart

Every effect that can act on the rig is given the same size, 10 mm root mean square (a tenth of the spread of outputs \
that are no lengths), and every other effect is asked how much of it it could take over, calibration included. Only the \
excitation decides: how the actuators and the carrier moved. Run it before close-loop, and before the next campaign.";

/// Below the options.
pub const EXAMPLES: &str = "\
Examples:
  acm-eval separability my-robot                          your recordings: a folder with manifest.toml
  acm-eval separability my-robot --data ~/recordings      the same, with the tables elsewhere
  acm-eval separability --config experiments/close-the-loop.toml
                                                          with the nominal model and effects of that file
  acm-eval separability my-robot --set 'effects.only=[\"backlash\",\"actuator_lag\",\"creep\"]'

How to read it: a share of 97 % in the row of backlash and the column of actuator_lag says that a lag, fitted to what a
play does in these trials, leaves 3 % of its mean square. Effects of one group imitate each other by 90 % or more of
what recalibration leaves: a claim for one of them is a claim for any of them.

Results in DIR: separability.html for people, separability.json for programs.

Exit codes: 0 done; 2 usage or configuration; 3 data (with file, row and column); 4 file system.";

/// What may be asked for.
#[derive(Args)]
pub struct SeparabilityArgs {
    /// Data set: a folder with manifest.toml
    #[arg(required_unless_present = "config", conflicts_with = "config")]
    folder: Option<PathBuf>,
    /// Configuration of close-loop, which names the data set
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Folder with the tables, where they do not lie beside the manifest
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Folder of the result [default: runs/separability- and the name of the folder or of the configuration]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace one value of the configuration, as a dotted key and a TOML value; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
}

/// Writes the result; prints the groups, the strongest confusions and where the page is.
pub fn run(args: &SeparabilityArgs) -> Result<(), EvalError> {
    let (config, source, folder) = asked(args)?;
    let campaign = Campaign::read(&folder, args.data.as_deref()).map_err(EvalError::Table)?;
    campaign.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    let found = judged(&config, &source, &campaign)?;
    let page = write(&found, &out(args, &folder))?;
    println!("{}\n", separability_summary(&found));
    if let Some(matrix) = matrix(&found) {
        println!("{matrix}\n");
    }
    println!("{}", page.display());
    Ok(())
}

/// The configuration, where its values were written, and the folder of the data set.
fn asked(args: &SeparabilityArgs) -> Result<(LoopConfig, Source, PathBuf), EvalError> {
    let Some(file) = &args.config else {
        let folder = args.folder.clone().unwrap_or_else(|| ".".into());
        let (config, source) = LoopConfig::for_folder(&folder, &args.set)?;
        return Ok((config, source, folder));
    };
    let (config, source) = LoopConfig::read(file, &args.set)?;
    let folder = config.data_folder(&source)?;
    Ok((config, source, folder))
}

fn out(args: &SeparabilityArgs, folder: &Path) -> PathBuf {
    let name = || {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.into());
        let name = args.config.as_ref().map_or(folder.file_name(), |file| file.file_stem());
        name.map_or("data".into(), |name| name.to_string_lossy().into_owned())
    };
    args.out.clone().unwrap_or_else(|| Path::new("runs").join(format!("separability-{}", name())))
}

fn judged(config: &LoopConfig, source: &Source, campaign: &Campaign) -> Result<Separability, EvalError> {
    let choice = choose(&config.nominal, source, campaign)?;
    let nominal = choice.spec().cloned().unwrap_or_else(|| campaign.nominal_spec());
    let Recordings { case, cautions } = recordings(campaign, nominal, choice.spec().is_none())?;
    let manifest = &campaign.manifest;
    let data = Data {
        name: manifest.name.clone(),
        title: manifest.title.clone(),
        hash: campaign.hash.clone(),
        synthetic: manifest.synthetic,
        calibration: vec![],
        development: vec![],
        untouched: vec![],
    };
    let configuration = serde_json::to_value(config).map_err(|error| EvalError::Usage(error.to_string()))?;
    let about = About { data, configuration, version: env!("CARGO_PKG_VERSION").into(), cautions };
    let steps = Steps::new(&case.rig);
    steps.begin("asking of every effect how much of it the others could imitate");
    let found = separability(case, about, &config.options());
    steps.end();
    found.map_err(|error| {
        EvalError::Data(format!(
            "{}: the nominal model cannot be calibrated: {error}; choose another [nominal] model (strain, polynomial, \
             predicted), or give more calibration trials",
            manifest.name
        ))
    })
}

/// Writes the page, then the numbers; returns where the page is.
fn write(found: &Separability, folder: &Path) -> Result<PathBuf, EvalError> {
    let (page, file) = (folder.join("separability.html"), folder.join("separability.json"));
    let numbers = serde_json::to_vec_pretty(found).map_err(|error| EvalError::write(&file, error.into()))?;
    for (path, bytes) in [(&page, separability_page(found).into_bytes()), (&file, numbers)] {
        atomic::write_bytes(path, &bytes).map_err(EvalError::Table)?;
    }
    Ok(page)
}

/// Effects in the matrix of the terminal, at most: so many columns fit 100 letters.
const SHOWN: usize = 10;

/// Letters of a name in it.
const NAME: usize = 28;

/// The effects that are confused most, in percent; none for fewer than two.
fn matrix(found: &Separability) -> Option<String> {
    let count = found.effects.len();
    if count < 2 {
        return None;
    }
    // Of what recalibration leaves; what it takes over whole is in a group of its own.
    let of_rest = |a: usize, b: usize| {
        let taken = found.by_recalibration[a];
        if taken < 0.9 { (found.imitated[a][b] - taken) / (1.0 - taken) } else { 0.0 }
    };
    let mutual = |a: usize, b: usize| of_rest(a, b).min(of_rest(b, a));
    let worst = |a: usize| (0..count).filter(|&b| b != a).map(|b| mutual(a, b)).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| worst(b).total_cmp(&worst(a)));
    order.truncate(SHOWN);
    order.sort_unstable();
    let mut text = String::from("How many percent of the effect of a row the effects of the columns imitate:\n");
    text.push_str(&" ".repeat(NAME + 3));
    (1..=order.len()).for_each(|column| text.push_str(&format!("{column:>5}")));
    text.push_str("   calibration");
    for (row, &a) in order.iter().enumerate() {
        let name: String = found.effects[a].chars().take(NAME).collect();
        text.push_str(&format!("\n{:>2} {name:<NAME$}", row + 1));
        for &b in &order {
            let share = format!("{:.0}", 100.0 * found.imitated[a][b]);
            text.push_str(&format!("{:>5}", if a == b { "·" } else { &share }));
        }
        text.push_str(&format!("{:>14.0}", 100.0 * found.by_recalibration[a]));
    }
    Some(text)
}
