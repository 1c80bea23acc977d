//! What Slurm does not do, and what a task says when it is called in vain. Stand-ins take the place of Slurm's programs.

use std::{
    ffi::OsStr,
    fs,
    path::Path,
    process::{Command, Output},
};

use crate::{
    campaign::{Campaign, program},
    slurm::sweep::make_executable,
};

/// Slurm takes everything, runs nothing, and has forgotten it.
const TAKES: [(&str, &str); 3] = [
    ("sbatch", "/bin/cat \"$2\" > script; echo 7"),
    ("squeue", "exit 0"),
    ("scontrol", "echo 'MaxArraySize            = 5'"),
];

struct Cluster(Campaign);

impl Cluster {
    fn new() -> Self {
        let cluster = Self(Campaign::new());
        fs::create_dir(cluster.0.path("bin")).unwrap();
        TAKES.iter().for_each(|(name, what)| cluster.stand_in(name, what));
        cluster
    }

    fn stand_in(&self, name: &str, what: &str) {
        let file = format!("bin/{name}");
        self.0.write(&file, &format!("#!/bin/sh\n{what}\n"));
        make_executable(&self.0.path(&file));
    }

    fn command(&self, arguments: &[&str]) -> Command {
        self.start(program(), arguments)
    }

    fn start(&self, program: impl AsRef<OsStr>, arguments: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.args(arguments).env("PATH", self.0.path("bin")).current_dir(self.0.folder.path());
        command
    }

    fn submit(&self, more: &[&str]) -> Output {
        let arguments = [&["--config", "tiny.toml", "--out", "out", "--engine", "slurm", "--quiet"], more].concat();
        self.command(&arguments).output().unwrap()
    }

    #[track_caller]
    fn refused(&self, more: &[&str], code: i32, words: &[&str]) {
        let output = self.submit(more);
        let message = String::from_utf8_lossy(&output.stderr).replace("\n  │ ", " ");
        assert_eq!(output.status.code(), Some(code), "{message}");
        words.iter().for_each(|word| assert!(message.contains(word), "{word:?} is not in\n{message}"));
    }

    /// The run of an index of the first list.
    fn task(&self, index: &str) -> Command {
        let mut command = self.command(&["--task", "out/slurm/0001.json", "--quiet"]);
        command.env("SLURM_ARRAY_TASK_ID", index);
        command
    }

    fn lists(&self) -> usize {
        let entries = fs::read_dir(self.0.path("out/slurm")).into_iter().flatten().flatten();
        entries.filter(|entry| entry.path().extension().is_some_and(|e| e == "json")).count()
    }
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn what_slurm_says_is_shown_whole_and_nothing_is_left_behind() {
    let cluster = Cluster::new();
    let refuses =
        "echo 'sbatch: error: invalid partition specified: nope' >&2\necho 'sbatch: error: and more' >&2\nexit 1";
    cluster.stand_in("sbatch", refuses);
    cluster.refused(&[], 2, &["invalid partition specified: nope", "and more", "--dry-run"]);
    assert_eq!(cluster.lists(), 0);
    cluster.stand_in("sbatch", "exit 0");
    cluster.refused(&[], 2, &["no number of a job"]);
    fs::remove_file(cluster.0.path("bin/sbatch")).unwrap();
    cluster.refused(&[], 2, &["cannot start sbatch", "--engine slurm"]);
    TAKES.iter().for_each(|(name, what)| cluster.stand_in(name, what));
    assert!(cluster.submit(&[]).status.success());
    cluster.stand_in("squeue", "echo 'slurm_load_jobs error: Unable to contact slurm controller' >&2\nexit 1");
    cluster.refused(&[], 4, &["does not answer", "nothing is lost"]);
    assert_eq!(cluster.lists(), 1);
}

#[test]
fn options_are_passed_on_and_ours_come_last() {
    let cluster = Cluster::new();
    let more =
        ["--partition", "gpu", "--time", "1:00:00", "--cpus", "2", "--sbatch=--qos=low", "--sbatch=--array=0-99"];
    assert!(cluster.submit(&[&more[..], &["--dry-run"]].concat()).status.success());
    assert!(!cluster.0.path("out").exists(), "a dry run leaves something behind");
    let dry = text(&cluster.submit(&[&more[..], &["--dry-run"]].concat()));
    assert!(cluster.submit(&more).status.success());
    let script = String::from_utf8(cluster.0.read("out/slurm/0001.sh")).unwrap();
    assert!(dry.contains(&script), "{dry}\nhas no\n{script}");
    for line in ["--partition=gpu", "--time=1:00:00", "--cpus-per-task=2", "--qos=low"] {
        assert!(script.contains(&format!("#SBATCH {line}\n")), "{script}");
    }
    assert!(script.find("--array=0-99") < script.find("--array=0-1\n"), "{script}");
    let collector = String::from_utf8(cluster.0.read("script")).unwrap();
    assert!(collector.contains("--dependency=afterany:7\n") && collector.contains("'--engine' 'slurm'"), "{collector}");
}

#[test]
fn a_long_list_becomes_several_arrays() {
    let cluster = Cluster::new();
    let seeds = ["--set", "protocol.seeds=[1, 2, 3, 4, 5, 6, 7]", "--array-limit", "2"];
    let said = text(&cluster.submit(&seeds));
    assert!(said.contains("7 runs: 0 done, 7 submitted as job 7, 7"), "{said}");
    let script = |number: u32| String::from_utf8(cluster.0.read(&format!("out/slurm/000{number}.sh"))).unwrap();
    assert!(script(1).contains("--array=0-4%2\n") && !script(1).contains("--dependency"));
    assert!(script(2).contains("--array=0-1%2\n") && script(2).contains("--dependency=afterany:7\n"));
}

/// Oracle: what a run on this machine writes.
#[test]
fn a_task_does_one_run_once() {
    let cluster = Cluster::new();
    assert!(cluster.submit(&[]).status.success());
    let long = ["--set", "training.epochs=400", "--set", "training.patience=400"];
    let other = ["--config", "tiny.toml", "--out", "long", "--engine", "slurm", "--quiet"];
    assert!(cluster.command(&[&other[..], &long[..]].concat()).status().unwrap().success());
    let mut first = cluster.command(&["--task", "long/slurm/0001.json", "--quiet"]);
    let mut first = first.env("SLURM_ARRAY_TASK_ID", "0").spawn().unwrap();
    while !cluster.0.path("long/checkpoints/final-seed1.safetensors").exists() {
        assert!(first.try_wait().unwrap().is_none(), "the task ended without a checkpoint");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let mut second = cluster.command(&["--task", "long/slurm/0001.json", "--quiet"]);
    let second = second.env("SLURM_ARRAY_TASK_ID", "0").output().unwrap();
    assert!(second.status.success() && text(&second).contains("another task works on it"), "{}", text(&second));
    let local = cluster.command(&["--config", "tiny.toml", "--out", "long", "--resume"]).args(long).output().unwrap();
    assert_eq!(local.status.code(), Some(5), "{}", String::from_utf8_lossy(&local.stderr));
    first.kill().unwrap();
    first.wait().unwrap();

    assert!(cluster.task("1").status().unwrap().success());
    let again = cluster.task("1").output().unwrap();
    assert!(again.status.success() && text(&again).contains("has its record already"));
    assert!(!cluster.0.path("out/records/final-seed1.json").exists());
    for index in ["", "2", "-1", "one"] {
        let refused = cluster.task(index).output().unwrap();
        let message = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{message}");
        assert!(message.contains("SLURM_ARRAY_TASK_ID") && message.contains("runs 0 to 1"), "{message}");
    }
    cluster.0.learn("local", &[]);
    let table = "predictions/final-seed2.parquet";
    assert_eq!(cluster.0.read(&format!("out/{table}")), cluster.0.read(&format!("local/{table}")));
    // What is left is done here, where nobody else is at it any more.
    cluster.0.command(&["--out", "out", "--resume"]).assert().success();
    assert_eq!(cluster.0.read("out/training.log"), cluster.0.read("local/training.log"));
}

#[test]
fn a_run_that_fails_again_and_again_is_left_alone_until_somebody_asks() {
    let cluster = Cluster::new();
    assert!(cluster.submit(&["--attempts", "2"]).status.success());
    fs::rename(cluster.0.path("data"), cluster.0.path("gone")).unwrap();
    for index in ["0", "1"] {
        assert_eq!(cluster.task(index).status().unwrap().code(), Some(2));
        assert_eq!(cluster.task(index).status().unwrap().code(), Some(2));
        let third = cluster.task(index).output().unwrap();
        let message = String::from_utf8_lossy(&third.stderr).into_owned();
        assert!(message.contains("2 times") && message.contains("left alone"), "{message}");
    }
    fs::rename(cluster.0.path("gone"), cluster.0.path("data")).unwrap();
    let log = Path::new("slurm/logs/0001_0.log");
    let words =
        ["0 of 2 runs", "final-seed1 was begun 2 times", "no such folder", &log.display().to_string(), "--attempts"];
    cluster.refused(&["--attempts", "2"], 2, &words);
    assert!(text(&cluster.submit(&["--attempts", "3"])).contains("2 submitted"));
}

#[test]
fn a_changed_list_or_changed_data_are_found() {
    let cluster = Cluster::new();
    assert!(cluster.submit(&[]).status.success());
    let table = String::from_utf8(cluster.0.read("data/d1.csv")).unwrap();
    cluster.0.write("data/d1.csv", &table.replacen("0.1,", "0.11,", 1));
    let refused = cluster.task("0").output().unwrap();
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(3), "{message}");
    assert!(message.contains("have changed"), "{message}");
    let list = String::from_utf8(cluster.0.read("out/slurm/0001.json")).unwrap();
    cluster.0.write("out/slurm/0001.json", &list.replacen("\"units\": 4", "\"units\": 5", 1));
    let refused = cluster.task("0").output().unwrap();
    assert_eq!(refused.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("0001.json"));
}

#[test]
fn a_collector_answers_the_question_that_it_was_submitted_for() {
    let cluster = Cluster::new();
    assert!(cluster.submit(&["--set", "training.epochs=2"]).status.success());
    let script = String::from_utf8(cluster.0.read("script")).unwrap();
    let call = script.lines().last().unwrap().to_string();
    let collect = || cluster.start("/bin/sh", &["-c", &call]).output().unwrap();
    assert!(collect().status.success());
    let text = String::from_utf8(cluster.0.read("tiny.toml")).unwrap();
    cluster.0.write("tiny.toml", &format!("{text}\n# another time\n"));
    let refused = collect();
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("tiny.toml") && message.contains("has changed since"), "{message}");
}

#[test]
fn options_of_the_other_engine_are_refused() {
    let cluster = Cluster::new();
    cluster.refused(&["--jobs", "2"], 2, &["--jobs", "--array-limit"]);
    let local = cluster.command(&["--config", "tiny.toml", "--partition", "gpu"]).output().unwrap();
    assert_eq!(local.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&local.stderr).contains("--partition is for Slurm"));
}
