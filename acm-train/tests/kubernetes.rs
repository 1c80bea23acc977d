//! An Indexed Job: its manifest, and its tasks run by hand.

mod campaign;

use assert_cmd::Command;
use campaign::{Campaign, bytes_below};

/// What a command that ends with `code` says.
fn said(command: &mut Command, code: i32) -> String {
    let output = command.assert().code(code).get_output().clone();
    String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
}

const ENGINE: [&str; 9] =
    ["--engine", "kubernetes", "--image", "lab/acm:1", "--claim", "runs", "--cpus", "1", "--array-limit=2"];

/// The pods of a job that was written give the bits of a run on this machine, and the same command then prints the table.
#[test]
fn tasks_by_hand_give_the_bits_of_a_local_run() {
    let campaign = Campaign::new();
    campaign.learn("local", &["--threads", "1"]);
    let mut write = campaign.command(&["--out", "pods"]);
    let text = said(write.args(ENGINE).args(["--memory", "4Gi", "--queue", "team"]), 0);
    assert!(text.contains("2 runs are open"), "{text}");
    let yaml = String::from_utf8(campaign.read("pods/kubernetes/0001.yaml")).unwrap();
    for line in
        ["completionMode: Indexed", "completions: 2", "parallelism: 2", "memory: \"4Gi\"", "queue-name: \"team\""]
    {
        assert!(yaml.contains(line), "{line} in\n{yaml}");
    }
    for index in ["0", "1"] {
        let mut task = campaign.program();
        task.env("JOB_COMPLETION_INDEX", index).args(["--task", "pods/kubernetes/0001.json", "--threads", "1"]);
        task.assert().success();
    }
    let table = said(campaign.command(&["--out", "pods"]).args(ENGINE), 0);
    assert!(table.contains("Held-out trials"), "{table}");
    assert_eq!(bytes_below(&campaign.path("pods")), bytes_below(&campaign.path("local")));
}

#[test]
fn what_is_missing_or_of_another_engine_is_refused() {
    let campaign = Campaign::new();
    let refused = |arguments: &[&str], words: &'static str| {
        let text = said(&mut campaign.command(arguments), 2);
        assert!(text.contains(words), "{text}");
    };
    refused(&["--engine", "kubernetes", "--claim", "runs"], "needs --image");
    refused(&["--image", "lab/acm:1"], "--image is for Kubernetes");
    refused(&[&ENGINE[..], &["--partition", "gpu"]].concat(), "--partition is not for Kubernetes");
    refused(&[&ENGINE[..], &["--jobs", "2"]].concat(), "--jobs is not for Kubernetes");
}
