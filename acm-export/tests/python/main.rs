//! ONNX and torch against acm-stream, by the scripts that an export leaves.
//!
//! `ACM_PYTHON` names the interpreter, `python3` where it is not set. A script that lacks a package says so, and is skipped.

#[path = "../c99/robots.rs"]
#[allow(dead_code)]
mod robots;

use std::process::Command;

use acm_export::{ExportError, File, Origin, onnx, parameters, torch};
use acm_stream::{Nominal, Parts, StateRule};
use robots::{bodies, ensemble, hanging, parts};

/// What a script returns where a package is missing.
const SKIPPED: i32 = 77;

type Export = fn(&Parts, &Origin) -> Result<Vec<File>, ExportError>;

/// Runs the script of an export; none where it was skipped.
fn agrees(export: Export, script: &str, parts: &Parts, change: impl Fn(&mut File)) -> Option<bool> {
    let folder = tempfile::tempdir().expect("a folder");
    let origin = Origin { name: "estimator".into(), source: "a test".into(), recorded: None };
    for mut file in export(parts, &origin).expect("it can be written") {
        change(&mut file);
        std::fs::write(folder.path().join(file.path), file.bytes).expect("a file");
    }
    let python = std::env::var("ACM_PYTHON").unwrap_or_else(|_| "python3".into());
    let Ok(output) = Command::new(&python).arg(folder.path().join(script)).output() else {
        eprintln!("skipped: {python} is not installed");
        return None;
    };
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    println!("{script}, {:?}: {}", parts.network.body, said.trim());
    match output.status.code() {
        Some(SKIPPED) => {
            eprintln!("{}", said.trim());
            None
        }
        code => Some(code == Some(0)),
    }
}

fn every_network_agrees(export: Export, script: &str) {
    for (k, body) in bodies().into_iter().enumerate() {
        let state = if k % 3 == 0 { StateRule::Window(5) } else { StateRule::Running };
        let one = parts(body, Nominal::Model(hanging()), state);
        let parts = if k % 4 == 1 { ensemble(one, 3) } else { one };
        match agrees(export, script, &parts, |_| ()) {
            Some(agrees) => assert!(agrees, "{:?}", parts.network.body),
            None => return,
        }
    }
    // One weight in a thousand: the script must find it.
    let mut wrong = parts(bodies()[0].clone(), Nominal::Model(hanging()), StateRule::Running);
    let origin = Origin { name: "estimator".into(), source: String::new(), recorded: None };
    let right = export(&wrong, &origin).expect("it can be written");
    wrong.weights[40] += 1e-2;
    let put_back = |file: &mut File| {
        let recorded =
            right.iter().find(|right| right.path == file.path && file.path.extension() == Some("json".as_ref()));
        recorded.into_iter().for_each(|recorded| file.bytes.clone_from(&recorded.bytes));
    };
    assert_ne!(agrees(export, script, &wrong, put_back), Some(true), "a changed weight");
}

#[test]
fn onnx_agrees() {
    every_network_agrees(onnx::export, "estimator_onnx_check.py");
}

#[test]
fn torch_agrees() {
    every_network_agrees(torch::export, "estimator_torch.py");
}

/// Names and shapes by hand, as ncps 1.0 and torch have them.
#[test]
fn parameters_have_the_names_of_torch_and_ncps() {
    let of = |k: usize| {
        let parts = parts(bodies()[k].clone(), Nominal::Given(3), StateRule::Running);
        let list = parameters(&parts.network, &parts.weights);
        assert_eq!(list.iter().map(|p| p.values.len()).sum::<usize>(), parts.weights.len());
        list.into_iter().map(|p| format!("{} {:?}", p.name, p.shape)).collect::<Vec<_>>().join(", ")
    };
    let heads = "rnn_cell.ff1.weight [9, 12], rnn_cell.ff1.bias [9]";
    assert!(of(1).starts_with(&format!("rnn_cell.backbone.0.weight [12, 14], rnn_cell.backbone.0.bias [12], {heads}")));
    assert!(of(2).contains("rnn_cell.backbone.2.weight [12, 12]"));
    assert!(of(6).starts_with("rnn_cell.w_tau [1, 9], rnn_cell.A [1, 9], rnn_cell.ff1.weight [9, 14]"));
    assert!(of(15).starts_with("rnn.weight_ih_l0 [21, 5], rnn.weight_hh_l0 [21, 7], rnn.bias_ih_l0 [21]"));
    assert!(of(15).ends_with("fc.weight [3, 7], fc.bias [3]"), "{}", of(15));
}
