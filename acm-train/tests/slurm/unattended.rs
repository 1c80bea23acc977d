//! One call, and nobody stays: collectors do the rest.

use std::fs;

use crate::{
    campaign::{Campaign, program},
    slurm::{loopback::Loopback, same::differences},
};

const QUESTION: &str = r#"
study    = "sequences"
question = "Is parity learned?"
seeds    = [1, 2]
loss     = "cross_entropy"
[data]
kind     = "bit_stream_xor"
training = 400
test     = 100
length   = 8
[network]
units          = 4
backbone_units = 4
[training]
epochs = 1
"#;

fn unattended(file: &str, out: &str) {
    let Some(slurm) = Loopback::start() else { return };
    let campaign = Campaign::new();
    campaign.write("question.toml", QUESTION);
    // A folder that shells, Slurm and this program might each read as something else.
    let work = campaign.path("it's \"50 %\" $HOME");
    fs::create_dir(&work).unwrap();
    for name in ["data", "tiny.toml", "question.toml"] {
        fs::rename(campaign.path(name), work.join(name)).unwrap();
    }
    let call = |more: &[&str]| {
        let mut command = slurm.command(program());
        command.args(["--config", file, "--quiet"]).args(more).current_dir(&work);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let table = |text: &str| text.split("\n\nrecords").next().unwrap_or_default().to_string();
    let local = table(&call(&["--out", "local"]));
    let said = call(&["--out", out, "--engine", "slurm", "--array-limit", "1"]);
    assert!(said.contains("2 runs: 0 done, 2 submitted as job"), "{said}");
    let log = work.join(out).join("slurm/logs/collector.log");
    let collected = || fs::read_to_string(&log).unwrap_or_default();
    slurm.until("the collector's table", || collected().contains("\n\nrecords"));
    assert!(collected().contains(&local), "{}\nis not\n{local}", collected());
    assert_eq!(differences(&work.join("local"), &work.join(out)), Vec::<String>::new());
    assert_eq!(table(&call(&["--out", out, "--engine", "slurm"])), local);
}

#[test]
fn an_experiment_is_collected_by_itself_whatever_its_folder_is_called() {
    unattended("tiny.toml", "run `1`; 100 %a");
}

#[test]
fn a_question_about_sequences_is_collected_by_itself() {
    unattended("question.toml", "cluster");
}
