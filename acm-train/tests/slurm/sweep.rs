//! A sweep of 24 runs in two batches, disturbed in every way that a cluster knows, against the same sweep left in peace on
//! this machine.
//!
//! | what happens                                            | to whom                        |
//! | ------------------------------------------------------- | ------------------------------ |
//! | the program cannot be started                           | one task of the first array    |
//! | the program is killed as soon as it has a checkpoint    | another                        |
//! | a task is killed at work                                | whoever it is                  |
//! | the controller is killed, and comes back after a second | all                            |
//! | who waits for the runs is killed, and asks again        | the second batch               |

use std::{
    fs::{self, File},
    path::{Path, PathBuf},
    process::{Child, Stdio},
};

use super::{
    loopback::{Loopback, kill},
    same::{differences, records},
};
use crate::campaign::{Campaign, program};

/// Runs of the sweep: 8 settings with 3 folds.
pub const RUNS: usize = 24;

const SWEEP: &str = r#"
study    = "sweep"
question = "Which size, if tasks fail?"
[[base]]
name       = "gru"
experiment = "tiny.toml"
[set]
protocol = { cross_validation = true, final = false, seeds = [3] }
training = { epochs = 25, patience = 25 }
[sweep]
sampler = "bayes"
count   = 8
batch   = 4
[sweep.space]
"network.units"          = [2, 3, 5]
"training.learning_rate" = { low = 1e-4, high = 1e-1, log = true }
"#;

/// In the place of acm-train: two tasks of the first array fail, the first time.
const WRAPPER: &str = r#"#!/bin/sh
case "$2 $SLURM_ARRAY_TASK_ID" in
*"/0001.json 1")
    echo "no such module: acm" >&2
    exit 1 ;;
*"/0001.json 2")
    "$ACM_TRAIN" "$@" &
    until ls "$ACM_OUT"/runs/*/checkpoints/*.safetensors >/dev/null 2>&1; do sleep 0.01; done
    kill -9 $!
    exit 137 ;;
esac
exec "$ACM_TRAIN" "$@"
"#;

/// What came of it.
pub struct Outcome {
    /// Records in the folder, of [`RUNS`].
    pub records: usize,
    /// What is not as it should be.
    pub faults: Vec<String>,
}

/// Runs it both ways.
pub fn sweep(slurm: &mut Loopback) -> Outcome {
    let campaign = Campaign::new();
    campaign.write("sweep.toml", SWEEP);
    campaign.write("wrapper", WRAPPER);
    make_executable(&campaign.path("wrapper"));
    let local = campaign.program().args(["--config", "sweep.toml", "--out", "local", "--quiet"]).output().unwrap();
    assert!(local.status.success(), "{}", String::from_utf8_lossy(&local.stderr));
    let out = campaign.path("cluster");
    let done = || records(&out).len();

    let mut first = wait(slurm, &campaign, "first");
    let mut stays = || {
        let ended = first.try_wait().unwrap();
        assert!(ended.is_none(), "{}", fs::read_to_string(campaign.path("first.err")).unwrap_or_default());
        false
    };
    slurm.until("a task works", || stays() || worker(&out).is_some());
    if let Some(pid) = worker(&out) {
        kill(&pid);
    }
    slurm.until("five runs are done", || stays() || done() >= 5);
    slurm.controller_dies_and_comes_back();
    slurm.until("the second batch has begun", || stays() || done() > RUNS / 2);
    end(first);
    let mut second = wait(slurm, &campaign, "second");
    slurm.until("the last call ends", || second.try_wait().unwrap().is_some());
    let status = second.wait().unwrap();

    let said = |name: &str| fs::read_to_string(campaign.path(name)).unwrap();
    let mut faults = vec![];
    if !status.success() {
        faults.push(format!("the last call failed: {}", said("second.err")));
    }
    let table = |text: &str| text.split("\n\nrecords and").next().unwrap().to_string();
    if table(&said("second.out")) != table(&String::from_utf8_lossy(&local.stdout)) {
        faults.push(format!("another table:\n{}", said("second.out")));
    }
    faults.extend(differences(&campaign.path("local"), &out).into_iter().map(|file| format!("{file} differs")));
    faults.extend(twice(&out));
    let lists = fs::read_dir(out.join("slurm")).unwrap().count();
    let again = wait(slurm, &campaign, "again").wait().unwrap();
    if !again.success()
        || said("again.out") != said("second.out")
        || fs::read_dir(out.join("slurm")).unwrap().count() != lists
    {
        faults.push(format!("asked again, it does something: {}", said("again.err")));
    }
    Outcome { records: done(), faults }
}

fn wait(slurm: &Loopback, campaign: &Campaign, name: &str) -> Child {
    let file = |extension: &str| File::create(campaign.path(&format!("{name}.{extension}"))).unwrap();
    let mut command = slurm.command(program());
    command.args(["--config", "sweep.toml", "--out", "cluster", "--engine", "slurm", "--wait"]);
    command.args(["--program", "./wrapper", "--attempts", "4", "--memory", "100M"]);
    command.env("ACM_TRAIN", program()).env("ACM_OUT", campaign.path("cluster")).current_dir(campaign.folder.path());
    command.stdin(Stdio::null()).stdout(file("out")).stderr(file("err")).spawn().unwrap()
}

/// The process that works on some run: its lock says who it is.
fn worker(out: &Path) -> Option<String> {
    let mut locks: Vec<PathBuf> = vec![];
    for member in fs::read_dir(out.join("slurm/tries/runs")).into_iter().flatten().flatten() {
        locks.extend(fs::read_dir(member.path()).into_iter().flatten().flatten().map(|entry| entry.path()));
    }
    let pid = |lock: &PathBuf| {
        let text = fs::read_to_string(lock).ok().filter(|_| lock.extension().is_some_and(|e| e == "lock"))?;
        let pid = text.strip_prefix("process ")?.split(' ').next()?.to_string();
        let line = fs::read(format!("/proc/{pid}/cmdline")).unwrap_or_default();
        String::from_utf8_lossy(&line).contains("--task").then_some(pid)
    };
    locks.iter().find_map(pid)
}

/// Runs that more than one task, or none, brought to its end. A task that was killed between its record and the note of its end
/// has brought it there, too.
fn twice(out: &Path) -> Vec<String> {
    let ends = |record: &PathBuf| {
        let (member, run) = (record.parent().unwrap().parent().unwrap(), record.file_name().unwrap());
        let tries = out.join("slurm/tries/runs").join(member.file_name().unwrap()).join(run);
        let text = fs::read_to_string(&tries).unwrap_or_default();
        let (ended, killed) = (text.matches("\"code\": 0").count(), text.contains("\"end\": null"));
        (ended > 1 || (ended == 0 && !killed)).then(|| format!("{}:\n{text}", tries.display()))
    };
    records(out).iter().filter_map(ends).collect()
}

fn end(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

/// Lets the file be started.
pub fn make_executable(file: &Path) {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(file, fs::Permissions::from_mode(0o755)).unwrap();
}
