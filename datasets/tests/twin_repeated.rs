//! The campaign many times over: every trial simulated, the same bytes on any number of threads, taken up where it was left.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use acm_datasets::generate::write_repeated;
use acm_datasets::{Campaign, Role};
use acm_sim::twin::{SEED, TwinSettings, generate};

type Outcome = Result<(), Box<dyn std::error::Error>>;

/// A coarse arm and long steps: a tenth of the work.
fn coarse() -> TwinSettings {
    let mut settings = TwinSettings::default();
    settings.solver.step = 0.2;
    settings.arm.joints = 4;
    settings
}

fn write(folder: &Path, threads: usize) -> Outcome {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    Ok(pool.install(|| write_repeated(&coarse(), SEED, 2, folder, &|_, _| {}))?)
}

fn files(folder: &Path) -> Result<Vec<(String, Vec<u8>)>, Box<dyn std::error::Error>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if name != ".lock" {
            files.push((name, fs::read(entry.path())?));
        }
    }
    files.sort();
    Ok(files)
}

#[test]
fn every_repetition_is_a_campaign_of_its_own_and_the_first_is_that_of_the_seed() -> Outcome {
    let folder = tempfile::tempdir()?;
    write(folder.path(), 2)?;
    let read = Campaign::check(folder.path(), None, 50, 0.5)?;
    let once = generate(&coarse(), SEED, &|_, _| {})?;
    assert_eq!((read.trials.len(), read.manifest.synthetic), (42, true));
    for trial in &once.trials {
        let tips: Vec<f64> = trial.tip.iter().map(|tip| tip.x).collect();
        let of = |repetition: usize| read.trial(&format!("{}-{repetition}", trial.number)).ok_or("no such trial");
        assert_eq!(of(0)?.measured.column(0).as_slice(), tips);
        // another hand, another flight, other noise: no value of the tip is that of the first, but by rounding
        let alike = of(1)?.measured.column(0).iter().zip(&tips).filter(|(a, b)| a == b).count();
        assert!(alike < tips.len() / 20, "{alike} of {} samples of trial {}", tips.len(), trial.number);
    }
    let names = |role: Role| read.trials(role).map(|trial| trial.name.as_str()).collect::<Vec<_>>();
    assert_eq!(names(Role::HeldOut), ["10-0", "10-1", "11-0", "11-1", "12-0", "12-1"]);
    let folds = read.folds();
    assert_eq!(folds.to_string(), "one altitude left out at a time (3 folds)");
    assert_eq!(folds.validation.iter().flatten().collect::<BTreeSet<_>>().len(), 18);
    Ok(())
}

#[test]
fn neither_threads_nor_an_interruption_change_a_byte() -> Outcome {
    let (one, two) = (tempfile::tempdir()?, tempfile::tempdir()?);
    write(one.path(), 1)?;
    write(two.path(), 2)?;
    let whole = files(one.path())?;
    assert_eq!(whole.len(), 22);
    assert!(whole == files(two.path())?, "the number of threads shows");
    // as a killed process leaves it: some tables, whole, and the others not there
    for number in 8..=21 {
        fs::remove_file(two.path().join(format!("trial-{number:02}.parquet")))?;
    }
    fs::write(two.path().join(".writing-half"), "PAR1")?;
    let kept = fs::metadata(two.path().join("trial-07.parquet"))?.modified()?;
    write(two.path(), 2)?;
    assert!(whole == files(two.path())?, "the interruption shows");
    assert_eq!(kept, fs::metadata(two.path().join("trial-07.parquet"))?.modified()?);
    Ok(())
}

#[test]
fn a_folder_in_use_and_a_set_that_was_not_generated_are_left_alone() -> Outcome {
    let command = |folder: &Path| -> Result<(Option<i32>, String), Box<dyn std::error::Error>> {
        let mut command = assert_cmd::Command::cargo_bin("acm-data")?;
        let output = command.args(["generate", "--scale", "2", "--out"]).arg(folder).output()?;
        Ok((output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned()))
    };
    let held = tempfile::tempdir()?;
    let lock = acm_datasets::files::lock::take(&held.path().join(".lock"));
    let (code, text) = command(held.path())?;
    assert!(code == Some(5) && text.contains(&format!("is in use by process {}", std::process::id())), "{text}");
    drop(lock);
    let own = tempfile::tempdir()?;
    fs::write(own.path().join("manifest.toml"), "name = \"my robot\"\n")?;
    let (code, text) = command(own.path())?;
    assert!(code == Some(2) && text.contains("manifest.toml: this command did not write this file"), "{text}");
    assert_eq!(files(own.path())?.len(), 1);
    Ok(())
}

#[test]
fn the_command_refuses_what_it_cannot_make() -> Outcome {
    for (arguments, said) in [
        (vec!["--scale", "0"], "a number from 1 to 1000"),
        (vec!["--scale", "1001"], "a number from 1 to 1000"),
        (vec!["--scale", "2", "--floors"], "cannot be used with"),
    ] {
        let output = assert_cmd::Command::cargo_bin("acm-data")?.arg("generate").args(arguments).output()?;
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(2) && text.contains(said), "{text}");
    }
    Ok(())
}
