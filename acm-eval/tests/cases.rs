//! Small arms, simulated, on which an earlier search said something wrong: a late tip, two clocks, and nothing the matter.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder of the sets; none where they are not at hand.
fn cases() -> Option<PathBuf> {
    let shared =
        std::env::var_os("ACM_SHARED").map_or_else(|| std::path::absolute("../../shared").unwrap(), PathBuf::from);
    let cases = shared.join("data/cases");
    if !cases.exists() {
        println!("skipped: {} is not there", cases.display());
        return None;
    }
    Some(cases)
}

/// loop.json of a set.
fn closed(cases: &Path, name: &str) -> Value {
    let out = tempfile::tempdir().unwrap();
    let folder = out.path().join("result");
    let run = Command::new(env!("CARGO_BIN_EXE_acm-eval"))
        .arg("close-loop")
        .arg(cases.join(name))
        .arg("--out")
        .arg(&folder)
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    serde_json::from_slice(&std::fs::read(folder.join("loop.json")).unwrap()).unwrap()
}

fn error(finding: &Value, of: &str) -> f64 {
    finding["errors"].pointer(of).and_then(Value::as_f64).unwrap()
}

/// Oracle: the tip was simulated 0.45 s after the motors, with noise of 0.88 mm.
#[test]
fn a_late_tip_has_its_delay_with_and_without_a_calibration_trial() {
    let Some(cases) = cases() else { return };
    for name in ["late-tip", "late-tip-calibrated"] {
        let finding = closed(&cases, name);
        let effects = finding["effects"].as_array().unwrap();
        assert_eq!((effects.len(), effects[0]["name"].as_str()), (1, Some("dead_time")), "{name}: {effects:?}");
        let delay = effects[0]["parameters"][0]["value"].as_f64().unwrap();
        assert!((delay - 0.45).abs() < 0.03, "{name}: {delay} s");
        assert_eq!(finding["confirmation"], "confirmed");
        assert!(error(&finding, "/after/value") < 1e-3, "{name}");
    }
}

/// Oracle: the clock of the commands was simulated 0.85 s late on balance.
#[test]
fn a_tip_before_its_commands_is_a_matter_of_clocks() {
    let Some(cases) = cases() else { return };
    let finding = closed(&cases, "clocks-1.3s-apart");
    assert_eq!(finding["effects"].as_array().map(Vec::len), Some(0), "{}", finding["sentence"]);
    let late = finding["clock_correction"]["value"].as_f64().unwrap();
    assert!((late - 0.85).abs() < 0.03, "{late} s");
}

#[test]
fn where_nothing_is_missing_nothing_is_named_and_no_baseline_runs_away() {
    let Some(cases) = cases() else { return };
    for name in ["in-step", "planar"] {
        let finding = closed(&cases, name);
        assert_eq!(finding["effects"].as_array().map(Vec::len), Some(0), "{name}: {}", finding["sentence"]);
        let nominal = error(&finding, "/baselines/nominal/value");
        let recalibrated = error(&finding, "/baselines/recalibrated/value");
        assert!(recalibrated < 1.05 * nominal, "{name}: {recalibrated} m beside {nominal} m");
        assert!(error(&finding, "/after/value") < 1.02 * nominal.min(recalibrated), "{name}");
    }
}
