//! `acm-data predict`: a nominal model of one's own as a program that answers lines. The programs here are those of POSIX.

use acm_datasets::{Campaign, Role};
use assert_cmd::Command;
use std::path::Path;
use std::{fs, str};
use tempfile::TempDir;

const MANIFEST: &str = r#"
name = "two joints"
[table]
files = ["*.csv"]
time = { column = "ms", unit = "ms" }
[[actuator]]
column = "motor"
unit = "deg"
name = "q"
[[context]]
column = "load"
unit = "N"
quantity = "throttle"
[[measured]]
column = "x"
unit = "mm"
[[measured]]
column = "time"
unit = "mm"
name = "y"
[vehicle]
position = ["px", "py", "pz"]
unit = "cm"
[conditions.b]
payload = { value = 45, unit = "g" }
[conditions."a 1"]
payload = { value = 30, unit = "g" }
[conditions.c]
payload = { value = 10, unit = "g" }
[roles]
calibration = ["b"]
development = ["a 1"]
[cut.c]
first = { until = 1.0, role = "development" }
rest = { role = "held_out" }
"#;

fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("set")).unwrap();
    fs::write(folder.path().join("set/manifest.toml"), MANIFEST).unwrap();
    for (k, name) in ["a 1", "b", "c"].into_iter().enumerate() {
        let mut text = "ms,motor,load,x,time,px,py,pz\n".to_string();
        for t in 0..120 {
            let q = (0.05 * f64::from(t) + k as f64).sin() * 40.0;
            // A lost marker.
            let x = if t == 17 { String::new() } else { (q * 3.0 + 0.1).to_string() };
            text += &format!("{},{q},{},{x},{},{t},2,3\n", 20 * t, 5 + k, -q / 7.0);
        }
        fs::write(folder.path().join(format!("set/{name}.csv")), text).unwrap();
    }
    folder
}

fn predict(folder: &Path, out: &str, program: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::new(assert_cmd::cargo_bin!("acm-data"));
    command.current_dir(folder).args(["predict", "set", "--out", out, "--"]).args(program).assert()
}

fn refused(folder: &Path, code: i32, program: &[&str], parts: &[&str]) {
    let done = predict(folder, "never", program).code(code);
    let said = str::from_utf8(&done.get_output().stderr).unwrap().to_string();
    parts.iter().for_each(|part| assert!(said.contains(part), "{program:?}: {part:?} in {said}"));
    assert!(!folder.join("never/manifest.toml").exists() && !folder.join("never/recordings.parquet").exists());
}

/// x̂ = 2 q + 1 in mm of deg, ŷ = payload in g.
const LINEAR: &[&str] =
    &["awk", "-F,", "NR == 1 { print $0 > \"header\" } NR > 1 { printf \"%.17g %.17g\\n\", 2*$2 + 1, $4 }"];

/// Oracle: the equation, on the recordings as they are read without it.
#[test]
fn predictions_stand_beside_the_recordings_and_nothing_else_changes() {
    let folder = folder();
    let done = predict(folder.path(), "out", LINEAR).success();
    let said = str::from_utf8(&done.get_output().stdout).unwrap().to_string();
    // 360 samples, and the 50 before the second part of c, which are inputs of that part too.
    assert!(
        said.contains("410 rows")
            && said.contains("acm-eval")
            && said.contains(
                "close-loop out
"
            ),
        "{said}"
    );
    assert_eq!(fs::read_to_string(folder.path().join("header")).unwrap(), "time,q,load,payload\n");
    let read = |name: &str| Campaign::read(&folder.path().join(name), None).unwrap();
    let (before, after) = (read("set"), read("out"));
    assert_eq!(after.trials.len(), 4);
    for (own, new) in before.trials.iter().zip(&after.trials) {
        assert_eq!((&own.name, own.role, &own.time), (&new.name, new.role, &new.time));
        assert_eq!((&own.actuators, &own.context, &own.measured), (&new.actuators, &new.context, &new.measured));
        assert_eq!((&own.vehicle, &own.conditions), (&new.vehicle, &new.conditions));
        let lost = |trial: &acm_datasets::Trial| {
            trial.unmeasured.as_ref().map(|lost| (lost.time.clone(), lost.actuators.clone()))
        };
        assert_eq!(lost(own), lost(new), "{}", own.name);
        let predicted = new.predicted.as_ref().unwrap();
        for t in 0..own.samples() {
            let x = 1e-3 * (2.0 * own.actuators[(t, 0)].to_degrees() + 1.0);
            assert!((predicted[(t, 0)] - x).abs() < 1e-15, "{} {t}: {} {x}", own.name, predicted[(t, 0)]);
            assert!((predicted[(t, 1)] - own.conditions["payload"]).abs() < 1e-15);
        }
    }
    assert_eq!(after.trials(Role::HeldOut).count(), 1);
    assert_eq!(after.manifest.context[0].quantity, before.manifest.context[0].quantity);
    assert!(after.manifest.provenance().contains("awk -F,"), "{}", after.manifest.provenance());
    // The same again, in the place of the former.
    let bytes = fs::read(folder.path().join("out/recordings.parquet")).unwrap();
    predict(folder.path(), "out", LINEAR).success();
    assert_eq!(fs::read(folder.path().join("out/recordings.parquet")).unwrap(), bytes);
}

/// A program may remember its trial, and hears of no other.
#[test]
fn each_trial_starts_the_program_anew() {
    let folder = folder();
    predict(folder.path(), "out", &["awk", "NR > 1 { print NR - 1, 0 }"]).success();
    let read = Campaign::read(&folder.path().join("out"), None).unwrap();
    for trial in &read.trials {
        let (whole, _) = trial.with_unmeasured();
        let counted: Vec<f64> = whole.predicted.as_ref().unwrap().column(0).iter().map(|x| x * 1e3).collect();
        (1..).zip(&counted).for_each(|(k, x)| assert!((x - f64::from(k)).abs() < 1e-9, "{} {k}: {x}", trial.name));
    }
}

#[test]
fn what_is_no_answer_is_refused_with_its_place() {
    let folder = folder();
    let folder = folder.path();
    refused(folder, 3, &["true"], &["trial `a 1`", "`true` answered 0 of 120 lines", "print one line for each"]);
    refused(folder, 3, &["cat"], &["trial `a 1`", "answered \"time,q,load,payload\" to line 1", "2 numbers"]);
    refused(folder, 3, &["yes", "1 2"], &["answered more than the 120 lines", "no header"]);
    refused(folder, 3, &["awk", "NR > 1 { print 1, (NR == 9 ? \"nan\" : 2) }"], &["sample 8", "NaN", "finite"]);
    refused(folder, 3, &["awk", "NR > 1 { print 1 }"], &["answered \"1\" to line 1", "2 numbers"]);
    refused(folder, 3, &["awk", "NR > 1 { print 1, 2 } END { exit 7 }"], &["ended with exit status: 7"]);
    refused(folder, 3, &["awk", "NR == 40 { exit } NR > 1 { print 1, 2 }"], &["answered 38 of 120 lines"]);
    refused(folder, 2, &["no-such-program"], &["no-such-program cannot be started"]);
    refused(folder, 2, &[], &["<PROGRAM>"]);
}

#[test]
fn recordings_are_never_overwritten() {
    let folder = folder();
    let done = predict(folder.path(), "set", LINEAR).code(2);
    assert!(str::from_utf8(&done.get_output().stderr).unwrap().contains("would be lost"));
    assert_eq!(fs::read_to_string(folder.path().join("set/manifest.toml")).unwrap(), MANIFEST);
    // Nor are tables that have no manifest yet.
    fs::create_dir(folder.path().join("new")).unwrap();
    fs::write(folder.path().join("new/mine.csv"), "t,q\n").unwrap();
    let done = predict(folder.path(), "new", LINEAR).code(2);
    assert!(str::from_utf8(&done.get_output().stderr).unwrap().contains("mine.csv"));
    assert_eq!(fs::read_dir(folder.path().join("new")).unwrap().count(), 1);
}
