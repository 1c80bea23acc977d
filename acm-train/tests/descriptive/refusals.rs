//! What a person gets wrong in a study file: each case with its exit code and what the message must say.

use super::campaign::Campaign;

fn refuses(campaign: &Campaign, text: &str, code: i32, parts: &[&str]) {
    campaign.write("asked.toml", text);
    let output = campaign.program().args(["--config", "asked.toml", "--out", "out"]).output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    let missing: Vec<&&str> = parts.iter().filter(|part| !message.contains(**part)).collect();
    assert!(
        output.status.code() == Some(code) && missing.is_empty() && !message.contains("panicked"),
        "{text}\nexit {:?} for {code}, without {missing:?}\n{message}",
        output.status.code()
    );
    assert!(!campaign.path("out/study.json").exists());
}

#[test]
fn study_files() {
    let campaign = Campaign::new();
    let arm = "[arm]\nlength = { value = 0.62, unit = \"m\" }\n";
    campaign.write("data/manifest.toml", &super::campaign::MANIFEST.replace("[roles]", &format!("{arm}[roles]")));
    let nominal = |rest: &str| format!("study = \"nominal\"\nbase = \"tiny.toml\"\n[nominal_study]\n{rest}\n");
    let residual = |rest: &str| format!("study = \"residual\"\nbase = \"tiny.toml\"\n[residual_study]\n{rest}\n");
    let cases: &[(String, &[&str])] = &[
        (nominal("trail = \"c1\""), &["asked.toml:4:1", "nominal_study.trail", "unknown field", "`trial`"]),
        (nominal("trial = \"99\""), &["asked.toml:4:1", "\"99\"", "no calibration trial", "c1"]),
        (nominal("trial = \"d1\""), &["asked.toml:4:1", "\"d1\"", "no calibration trial"]),
        (nominal("bins = 3"), &["asked.toml:4:1", "nominal_study.bins", "is 3", "8 to 1000"]),
        (nominal("bins = \"many\""), &["asked.toml:4:1", "nominal_study.bins", "whole number"]),
        (nominal("orders = []"), &["asked.toml:4:1", "nominal_study.orders", "empty"]),
        (nominal("orders = [1, 12]"), &["asked.toml:4:1", "order 12", "0 to 8"]),
        (nominal("orders = [1, 1]"), &["asked.toml:4:1", "order 1 twice"]),
        ("study = \"nominal\"\nbase = \"lost.toml\"\n".into(), &["asked.toml:2:1", "lost.toml", "as seen from"]),
        ("study = \"nominal\"\nbaes = \"tiny.toml\"\n".into(), &["asked.toml:2:1", "baes", "unknown field", "`base`"]),
        ("study = \"nominel\"\n".into(), &["asked.toml:1:1", "nominel", "nominal", "residual"]),
        (residual("rolls = []"), &["asked.toml:4:1", "residual_study.rolls", "unknown field", "`roles`"]),
        (residual("roles = []"), &["asked.toml:4:1", "residual_study.roles", "empty"]),
        (residual("roles = [\"flown\"]"), &["asked.toml:4", "residual_study.roles", "flown", "held_out"]),
        (residual("roles = [\"excluded\"]"), &["asked.toml:4:1", "leaves no trial"]),
        (residual("altitude = \"height\""), &["asked.toml:4:1", "\"height\"", "no context signal", "wind"]),
        (residual("altitude_tolerance = -0.1"), &["asked.toml:4:1", "altitude_tolerance", "-0.1", "0 or more"]),
        (residual("slice_tolerance = nan"), &["asked.toml:4:1", "slice_tolerance", "finite"]),
        (residual("backbones = 99"), &["asked.toml:4:1", "residual_study.backbones", "is 99"]),
    ];
    for (text, parts) in cases {
        refuses(&campaign, text, 2, parts);
    }
}

/// A fault of the base experiment is told with that file's name.
#[test]
fn the_base_experiment() {
    let campaign = Campaign::new();
    let text = "study = \"nominal\"\nbase = \"tiny.toml\"\n";
    refuses(&campaign, text, 2, &["asked.toml:2:1", "no strain model", "[arm]"]);
    campaign.write("tiny.toml", "data = \"data\"\nqestion = \"?\"\n");
    refuses(&campaign, text, 2, &["tiny.toml:2:1", "qestion", "unknown field"]);
    campaign.write("tiny.toml", "data = \"nowhere\"\n");
    refuses(&campaign, text, 2, &["tiny.toml:1:1", "nowhere", "no such folder"]);
}
