//! Campaigns whose errors are known by hand.

use super::{campaign::Campaign, study};

const ARM: &str = "[arm]\nlength = { value = 0.62, unit = \"m\" }\n";

/// Actuators of sample `k` in trial `c` of four: q1 sweeps, q2 is held at 0, 0.4, 0.8, 1.2.
fn actuators(c: usize, k: usize) -> [f64; 2] {
    [(0.13 * k as f64 + c as f64).sin(), 0.4 * c as f64]
}

/// A linear robot, the third of whose calibration trials is off by (3, 4, 12) mm, that is 13 mm.
fn linear() -> Campaign {
    let campaign = Campaign::new();
    for file in super::campaign::TRIALS {
        std::fs::remove_file(campaign.path(&format!("data/{file}.csv"))).unwrap();
    }
    for c in 0..4 {
        let off = if c == 2 { 1e-3 } else { 0.0 };
        let row = |k: usize| {
            let [q1, q2] = actuators(c, k);
            let tip = [0.2 * q1 + 3.0 * off, 0.1 * q2 + 4.0 * off, -0.6 + 0.02 * q1 - 0.01 * q2 + 12.0 * off];
            format!("{},{q1},{q2},0,{},{},{}\n", k as f64 / 10.0, tip[0], tip[1], tip[2])
        };
        let table: String = std::iter::once("t,q1,q2,wind,x,y,z\n".into()).chain((0..120).map(row)).collect();
        campaign.write(&format!("data/c{c}.csv"), &table);
    }
    let roles = "[roles]\ncalibration = [\"c0\", \"c1\", \"c2\", \"c3\"]\n";
    let manifest = super::campaign::MANIFEST.split("[roles]").next().unwrap();
    campaign.write("data/manifest.toml", &format!("{manifest}{ARM}{roles}"));
    campaign
}

/// Oracle: a plane through three exact trials is the robot, so what is left out is missed by what it is off: by 13 mm
/// for the third. The other trials are then fitted to a plane that three trials bend, and err by less.
#[test]
fn a_trial_left_out_is_missed_by_what_the_others_do_not_know() {
    let campaign = linear();
    campaign.write("tiny.toml", "data = \"data\"\n[nominal]\ncomparator_degree = 1\n");
    campaign.write("nominal.toml", "study = \"nominal\"\nquestion = \"How well?\"\nbase = \"tiny.toml\"\n");
    campaign.program().args(["--config", "nominal.toml", "--out", "out"]).assert().success();
    let said = study(&campaign.path("out"));
    assert_eq!((&said["swept"], &said["orders"]["trial"]), (&0.into(), &"c0".into()), "q2 = 0 bends in one plane");
    let model = &said["models"][0];
    assert_eq!((model["key"].as_str(), model["parameters"].as_array().unwrap().len()), (Some("polynomial"), 9));
    let left_out = &model["left_out"]["trials"][2]["rms"];
    for (o, expected) in [3e-3, 4e-3, 12e-3].into_iter().enumerate() {
        assert!((left_out["components"][o].as_f64().unwrap() - expected).abs() < 1e-12, "{left_out}");
    }
    assert!((left_out["total"].as_f64().unwrap() - 13e-3).abs() < 1e-12);
    let fitted = |trial: usize| model["fitted"]["trials"][trial]["rms"]["total"].as_f64().unwrap();
    assert!((0..4).all(|trial| fitted(trial) < 13e-3 && fitted(trial) > 1e-3), "the fit shares the 13 mm out");
}

#[test]
fn one_calibration_trial_leaves_none_to_fit_without_it() {
    let campaign = linear();
    let manifest = String::from_utf8(campaign.read("data/manifest.toml")).unwrap();
    let one = manifest.replace("\"c0\", \"c1\", \"c2\", \"c3\"]", "\"c1\"]\nexcluded = [\"c0\", \"c2\", \"c3\"]");
    campaign.write("data/manifest.toml", &one);
    campaign.write("nominal.toml", "study = \"nominal\"\nbase = \"tiny.toml\"\n");
    campaign.write("tiny.toml", "data = \"data\"\n");
    let output = campaign.program().args(["--config", "nominal.toml", "--out", "out"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let said = study(&campaign.path("out"));
    assert!(said["models"][0]["left_out"].is_null());
    assert!(said["notes"][0].as_str().unwrap().contains("without trial c1"), "{}", said["notes"]);
}

/// Oracle: by hand. The data's own prediction is off by (3, −4, 12) mm in every sample, so each root mean square is 13
/// mm, each mean is the offset and each spread is 0. There is no altitude and no arm, and the robot holds nothing.
#[test]
fn a_constant_residual_is_itself_everywhere() {
    let campaign = Campaign::new();
    for (trial, name) in super::campaign::TRIALS.iter().enumerate() {
        let row = |k: usize| {
            let ([q1, q2, wind], [x, y, z]) = (super::campaign::inputs(trial, k), super::campaign::tip(trial, k));
            let (a, b, c) = (x + 3e-3, y - 4e-3, z + 12e-3);
            format!("{},{q1},{q2},{wind},{a},{b},{c},{x},{y},{z}\n", k as f64 / 10.0)
        };
        let head = "t,q1,q2,wind,x,y,z,px,py,pz\n".to_string();
        let table: String = std::iter::once(head).chain((0..super::campaign::SAMPLES).map(row)).collect();
        campaign.write(&format!("data/{name}.csv"), &table);
    }
    let own = ["px", "py", "pz"].map(|c| format!("[[predicted]]\ncolumn = \"{c}\"\nunit = \"m\"\n")).concat();
    campaign.write("data/manifest.toml", &super::campaign::MANIFEST.replace("[roles]", &format!("{own}[roles]")));
    campaign.write("residual.toml", "study = \"residual\"\nbase = \"tiny.toml\"\n");
    campaign.program().args(["--config", "residual.toml", "--out", "out"]).assert().success();
    let said = study(&campaign.path("out"));
    let near = |value: &serde_json::Value, expected: f64| (value.as_f64().unwrap() - expected).abs() < 1e-12;
    assert!(near(&said["overall"]["total"], 13e-3) && near(&said["overall"]["components"][1], 4e-3));
    assert_eq!(said["trials"].as_array().unwrap().len(), 5, "three development and two held-out trials");
    assert_eq!(said["slices"].as_array().unwrap().len(), 1);
    for bin in said["slices"][0]["bins"].as_array().unwrap() {
        for (o, expected) in [3e-3, -4e-3, 12e-3].into_iter().enumerate() {
            assert!(near(&bin["mean"][o], expected) && near(&bin["sd"][o], 0.0), "{bin}");
        }
    }
    assert!(said["altitudes"].as_array().unwrap().is_empty() && said["backbones"].as_array().unwrap().is_empty());
    let notes = said["notes"].to_string();
    for part in ["Held-out trials", "altitude", "no slices", "no arm"] {
        assert!(notes.contains(part), "`{part}` is not in {notes}");
    }
    let table = super::Table::read(&campaign.path("out/predictions/residual.parquet"));
    assert!(!table.has("altitude") && table.has("actuator_q2"));
}
