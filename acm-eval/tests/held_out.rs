//! Held-out trials judge what was found, and choose nothing.

mod delayed;

use std::fs;

use delayed::{MANIFEST, Rig, read_json};
use serde_json::{Value, json};

/// A rig that is late while it is searched, and punctual in its held-out trials.
fn changed_rig() -> Rig {
    let (late, punctual) = (Rig::new(), Rig::with(0.0));
    for name in ["h1", "h2"] {
        let table = fs::read_to_string(punctual.path(&format!("arm/{name}.csv"))).unwrap();
        late.write(&format!("arm/{name}.csv"), &table);
    }
    late
}

/// Oracle: a dead time of 0.3 s makes the model of a punctual rig worse, so held-out trials of such a rig refute it.
#[test]
fn a_refuted_model_is_no_model() {
    let rig = changed_rig();
    let (printed, found) = rig.close(&["arm"], "out");
    assert_eq!((&found["effects"][0]["name"], &found["confirmation"]), (&json!("dead_time"), &json!("refuted")));
    assert!(found["errors"]["change"]["interval"][0].as_f64().unwrap() > 0.0, "{}", found["errors"]["change"]);
    assert!(found["sentence"].as_str().unwrap().starts_with("Refuted by held-out trials: "), "{}", found["sentence"]);
    assert!(printed.contains("Refuted by held-out trials") && printed.contains("refuted.json"), "{printed}");
    assert!(rig.path("out/refuted.json").exists() && !rig.path("out/model.json").exists());
    assert!(read_json(&rig.path("out/refuted.json")).to_string().contains("dead_time"));
    let page = fs::read_to_string(rig.path("out/loop.html")).unwrap();
    assert!(page.contains("Refuted by held-out trials"));
}

/// One folder, one result: the model file of an earlier one goes, whichever name it has.
#[test]
fn only_one_model_file_is_there() {
    let (late, changed) = (Rig::new(), changed_rig());
    let there = |rig: &Rig| ["model.json", "refuted.json"].map(|name| rig.path("out").join(name).exists());
    late.close(&["arm"], "out");
    assert_eq!(there(&late), [true, false]);
    for name in ["h1", "h2"] {
        let table = fs::read_to_string(changed.path(&format!("arm/{name}.csv"))).unwrap();
        late.write(&format!("arm/{name}.csv"), &table);
    }
    late.close(&["arm"], "out");
    assert_eq!(there(&late), [false, true]);
    fs::remove_file(late.path("out/loop.json")).unwrap();
    late.close(&["arm", "--set", "effects.only=[\"creep\"]"], "out");
    assert!(there(&late)[0] != there(&late)[1], "{:?}", there(&late));
}

/// What was found, as text with every digit.
fn found(rig: &Rig, out: &str) -> Vec<String> {
    let (_, found) = rig.close(&["arm"], out);
    let keys = ["verdict", "effects", "equivalent", "steps", "left", "clock_correction", "trial_offset", "symbolic"];
    let mut all: Vec<String> = keys.iter().map(|key| found[*key].to_string()).collect();
    let model = ["model.json", "refuted.json"].map(|name| rig.path(out).join(name));
    let model = read_json(model.iter().find(|path| path.exists()).unwrap());
    let parts = ["rig", "nominal", "static_map", "effects", "clock_correction"];
    all.extend(parts.iter().map(|key| model[*key].to_string()));
    assert!(all[1].contains("dead_time") && all.iter().any(|text| text.contains("offsets") || text.contains("values")));
    all
}

/// Outputs of held-out trials times a thousand, and a further held-out trial: what was found keeps every bit.
#[test]
fn held_out_trials_leave_what_is_found_as_it_is() {
    let rig = Rig::new();
    let as_it_is = found(&rig, "first");
    for name in ["h1", "h2"] {
        let table = fs::read_to_string(rig.path(&format!("arm/{name}.csv"))).unwrap();
        let row = |line: &str| {
            let (inputs, output) = line.rsplit_once(',').unwrap();
            output.parse::<f64>().map_or_else(|_| line.to_string(), |x| format!("{inputs},{}", 1000.0 * x))
        };
        let spoilt: Vec<String> = table.lines().map(row).collect();
        rig.write(&format!("arm/{name}.csv"), &spoilt.join("\n"));
    }
    assert_eq!(as_it_is, found(&rig, "second"), "outputs of held-out trials leak");
    let other = fs::read_to_string(Rig::with(0.1).path("arm/h2.csv")).unwrap();
    rig.write("arm/h3.csv", &other);
    rig.write("arm/manifest.toml", &MANIFEST.replace("[\"h1\", \"h2\"]", "[\"h2\", \"h3\"]"));
    fs::remove_file(rig.path("arm/h1.csv")).unwrap();
    assert_eq!(as_it_is, found(&rig, "third"), "other held-out trials change what is found");
    let errors = |out: &str| read_json(&rig.path(out).join("loop.json"))["errors"].clone();
    assert_ne!(errors("first"), errors("second"));
    assert_ne!(errors("second")["after"], Value::Null);
}

/// The output is lost for 0.3 s every 1.5 s. Oracle: the rig's delay and noise. A lost output is not compared, but its command still acts
/// later.
#[test]
fn commands_act_where_the_output_was_lost() {
    let rig = Rig::new();
    for name in ["c1", "d1", "d2", "d3", "d4", "h1", "h2"] {
        let text = fs::read_to_string(rig.path(&format!("arm/{name}.csv"))).unwrap();
        let row = |(k, line): (usize, &str)| match k > 0 && k % 30 < 6 {
            true => line.rsplit_once(',').unwrap().0.to_string() + ",\n",
            false => line.to_string() + "\n",
        };
        rig.write(&format!("arm/{name}.csv"), &text.lines().enumerate().map(row).collect::<String>());
    }
    let (printed, found) = rig.close(&["arm"], "out");
    assert_eq!((&found["effects"][0]["name"], found["effects"].as_array().unwrap().len()), (&json!("dead_time"), 1));
    let delay = &found["effects"][0]["parameters"][0]["value"];
    assert!((delay.as_f64().unwrap() - delayed::DELAY).abs() < 0.005, "{delay}");
    let error = found["errors"]["after"]["value"].as_f64().unwrap();
    assert!(error < 1.1e-3 * delayed::NOISE_MM, "{error}: {printed}");
}
