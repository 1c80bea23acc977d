//! `acm-eval close-loop --effects FILE`: an effect that the library lacks, written by its user.

mod delayed;

use delayed::{MANIFEST, Rig, read_json};

/// An actuator whose gain falls as it heats up: no effect of the library does that.
const HEATING: &str = r#"
[[effect]]
name    = "self_heating"
meaning = "an actuator heats up under its own load, and its gain changes with the heat"
place   = "actuators"
unit    = "rad"
rate    = { heat = "((q/full)^2 - heat)/tau" }
output  = "q*(1 + g*heat)"
[effect.constants]
full = { value = 1, unit = "rad" }
[effect.parameters]
g   = { silent = 0, bounds = [-0.9, 0.9], guesses = [-0.3, -0.1, 0.1, 0.3] }
tau = { unit = "s", bounds = [0.1, 20], guesses = [0.5, 1.5, 5] }
"#;

/// The planted values.
const GAIN: f64 = -0.3;
const TAU: f64 = 2.0;

fn command(trial: usize, t: f64) -> f64 {
    let phase = 1.7 * trial as f64;
    0.7 * (0.9 * t + phase).sin() + 0.4 * (2.3 * t + 2.1 * phase).sin()
}

/// x = 0.1 p + 0.02 p² with p = q (1 + g heat), in steps of a millisecond, and noise of 0.3 mm.
fn table(trial: usize) -> String {
    let (mut heat, mut text) = (0.0, String::from("t,q,x\n"));
    let mut state = 77 + trial as u64;
    for step in 0..25_000 {
        let t = 1e-3 * f64::from(step);
        let q = command(trial, t);
        if step % 50 == 0 {
            state = state * 48271 % 2_147_483_647;
            let noise = 1e-3 * (state as f64 / 2_147_483_647.0 - 0.5);
            let p = q * (1.0 + GAIN * heat);
            text += &format!("{t},{q},{}\n", 0.1 * p + 0.02 * p * p + noise);
        }
        heat += 1e-3 * (q * q - heat) / TAU;
    }
    text
}

fn heated() -> Rig {
    let rig = Rig::with(0.0);
    rig.write("arm/manifest.toml", &MANIFEST.replace(r#"calibration = ["c1"]"#, r#"excluded = ["c1"]"#));
    for (trial, name) in ["d1", "d2", "d3", "d4", "h1", "h2"].into_iter().enumerate() {
        rig.write(&format!("arm/{name}.csv"), &table(trial));
    }
    rig.write("my_effects.toml", HEATING);
    rig
}

/// Oracle: the planted values.
#[test]
fn an_effect_of_ones_own_is_found_saved_and_shown() {
    let rig = heated();
    let (printed, found) = rig.close(&["arm", "--effects", "my_effects.toml"], "out");
    let effects = found["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{printed}");
    assert_eq!(effects[0]["name"], "self_heating", "{printed}");
    for (name, planted) in [("g", GAIN), ("tau", TAU)] {
        let parameters = effects[0]["parameters"].as_array().unwrap();
        let parameter = parameters.iter().find(|parameter| parameter["name"] == name).unwrap();
        let value = parameter["value"].as_f64().unwrap();
        assert!((value / planted - 1.0).abs() < 0.15, "{name} = {value}, planted {planted}");
    }
    let model = std::fs::read_to_string(rig.path("out/model.json")).unwrap();
    assert!(model.contains("((q/full)^2 - heat)/tau"), "the model holds the definition");
    assert!(std::fs::read_to_string(rig.path("out/loop.html")).unwrap().contains("my_effects.toml"));
    // The same from a configuration; what the run repeats of its question names the file.
    rig.write("own.toml", "data = \"arm\"\neffects = \"my_effects.toml\"\n");
    let (_, again) = rig.close(&["--config", "own.toml"], "again");
    assert_eq!(again["effects"], found["effects"]);
    assert_eq!(read_json(&rig.path("again/loop.json"))["configuration"]["effects"]["file"], "my_effects.toml");
    // The same with the definition within the configuration.
    let within = HEATING.replace("[[effect]]", "[[effects.define]]").replace("[effect.", "[effects.define.");
    rig.write("within.toml", &format!("data = \"arm\"\n{within}"));
    let (_, within) = rig.close(&["--config", "within.toml"], "within");
    assert_eq!(within["effects"][0]["parameters"], found["effects"][0]["parameters"]);
}

#[test]
fn definitions_within_a_configuration_are_refused_with_their_place() {
    let rig = heated();
    let within = HEATING.replace("[[effect]]", "[[effects.define]]").replace("[effect.", "[effects.define.");
    let refused = |text: &str, parts: &[&str]| {
        rig.write("own.toml", &format!("data = \"arm\"\n{text}"));
        let done = rig.program(&["close-loop", "--config", "own.toml", "--out", "never"]).assert().code(2);
        let said = String::from_utf8(done.get_output().stderr.clone()).unwrap();
        parts.iter().for_each(|part| assert!(said.contains(part), "{part}: {said}"));
    };
    refused(&within.replace("- heat)/tau", "- heat)/g"), &["own.toml", "self_heating", "rate.heat"]);
    refused(&within.replace("silent = 0, ", "loud = 0, "), &["own.toml", "loud"]);
    refused(&format!("[effects]\nfile = \"my_effects.toml\"\n{within}"), &["self_heating", "both define"]);
    refused(&within.replace("rad", "V"), &["own.toml", "self_heating"]);
}

#[test]
fn a_file_of_effects_that_cannot_be_used_is_refused_with_its_place() {
    let rig = heated();
    let refused = |file: &str, parts: &[&str]| {
        let done = rig.program(&["close-loop", "arm", "--effects", file, "--out", "never"]).assert().code(2);
        let said = String::from_utf8(done.get_output().stderr.clone()).unwrap();
        parts.iter().for_each(|part| assert!(said.contains(part), "{part}: {said}"));
        assert!(!rig.path("never").exists());
    };
    refused("nowhere.toml", &["nowhere.toml", "no such file"]);
    rig.write("units.toml", &HEATING.replace(r#"value = 1, unit = "rad""#, r#"value = 1, unit = "m""#));
    refused("units.toml", &["units.toml", "self_heating", "rate"]);
    rig.write("name.toml", &HEATING.replace("\"self_heating\"", "\"backlash\""));
    refused("name.toml", &["name.toml", "backlash"]);
    rig.write("text.toml", "[[effect]\n");
    refused("text.toml", &["text.toml"]);
}
