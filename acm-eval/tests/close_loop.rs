//! `acm-eval close-loop` from a folder of recordings to a finding. Oracle: a delay planted by the formula of `delayed`.

mod browser;
mod delayed;

use std::fs;

use delayed::{DELAY, MANIFEST, NOISE_MM, Rig, read_json};
use serde_json::{Value, json};

fn names(list: &Value) -> Vec<&str> {
    list.as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect()
}

#[test]
fn a_planted_dead_time_is_named_and_goes_into_the_model() {
    let rig = Rig::new();
    let (printed, found) = rig.close(&["arm"], "out");
    assert_eq!(found["verdict"], "named", "{printed}");
    let effect = &found["effects"][0];
    assert_eq!((&effect["name"], &effect["site"]), (&json!("dead_time"), &json!("actuation")));
    assert_eq!(found["effects"].as_array().unwrap().len(), 1);
    let delay = &effect["parameters"][0];
    assert_eq!((&delay["unit"], &delay["depends_on"]), (&json!("s"), &Value::Null));
    assert!(delay["name"].as_str().unwrap().starts_with("delay"));
    assert!((delay["value"].as_f64().unwrap() - DELAY).abs() < 0.01, "{delay}");
    let bound = |k: usize| delay["interval"][k].as_f64().unwrap();
    assert!(bound(0) < DELAY + 0.005 && DELAY - 0.005 < bound(1) && bound(1) - bound(0) < 0.1, "{delay}");
    assert!(names(&found["equivalent"]).contains(&"dead_time"));
    let number = |value: &Value| value.as_f64().unwrap();
    // Second differences of 24 mm of residual that moves at 5 rad/s add to those of the noise.
    let errors = &found["errors"];
    assert_eq!((&found["format"], &errors["unit"]), (&json!(2), &json!("m")));
    assert!((0.9..1.4).contains(&(1e3 * number(&errors["noise"]) / NOISE_MM)), "{}", errors["noise"]);
    for baseline in ["nominal", "static_map", "recalibrated"] {
        assert!(number(&errors["baselines"][baseline]["value"]) > 0.01, "{baseline}: {}", errors["baselines"]);
    }
    assert!(1e3 * number(&errors["after"]["value"]) < 1.2 * NOISE_MM && errors["after"]["interval"].is_array());
    assert!(number(&errors["change"]["interval"][1]) < 0.0, "{}", errors["change"]);
    assert_eq!((&found["confirmation"], &effect["confidence"]["level"]), (&json!("confirmed"), &json!("sure")));
    assert!(number(&found["removed"]) > 0.99);
    assert!(found["left"]["probe"].is_object() && found["left"]["not_tried"].is_array());
    assert_eq!(found["data"]["hash"].as_str().unwrap().len(), 64);
    assert_eq!(names(&found["data"]["held_out"]), ["h1", "h2"]);
    assert_eq!(found["configuration"]["search"]["max_effects"], 6);
    assert_eq!(found["version"], env!("CARGO_PKG_VERSION"));
    let model = read_json(&rig.path("out/model.json"));
    assert!(model.to_string().contains("dead_time"));
    // What tells this robot from another of the same signals: on the calibration trial little more than the noise is left.
    let origin = &model["origin"];
    assert_eq!((&origin["data"], &origin["trials"]), (&json!("late-arm"), &json!(["c1"])));
    assert!((0.9..2.0).contains(&(1e3 * number(&origin["rms"][0]) / NOISE_MM)), "{origin}");
    let page = fs::read_to_string(rig.path("out/loop.html")).unwrap();
    assert!(page.contains("dead_time") && page.contains("</html>"));
    assert!(printed.contains("dead_time") && printed.trim_end().ends_with("loop.html"), "{printed}");
}

/// The same words at any width, and no line that is wider.
#[test]
fn the_summary_follows_the_width_of_the_terminal() {
    let rig = Rig::new();
    let printed = |columns: &str| {
        let mut command = rig.program(&["close-loop", "arm", "--out", "out"]);
        let done = command.env("COLUMNS", columns).assert().success();
        String::from_utf8(done.get_output().stdout.clone()).unwrap()
    };
    let prose = |text: &str| {
        let lines = text.lines().filter(|line| !line.starts_with(['│', '┌', '└', '╞', '├']));
        lines.flat_map(str::split_whitespace).map(String::from).collect::<Vec<_>>()
    };
    let (narrow, wide) = (printed("70"), printed("140"));
    for (text, columns) in [(&narrow, 70), (&wide, 140)] {
        assert!(text.lines().all(|line| line.chars().count() <= columns), "{columns}\n{text}");
    }
    assert!(!narrow.contains('…') && narrow.contains("confirmed on held-out trials"), "{narrow}");
    assert_eq!(prose(&narrow), prose(&wide));
}

#[test]
fn where_nothing_is_missing_nothing_is_named() {
    let rig = Rig::with(0.0);
    let (_, found) = rig.close(&["arm"], "out");
    assert_eq!((&found["verdict"], &found["effects"]), (&json!("no effect"), &json!([])));
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let rig = Rig::new();
    let timeless = |out: &str| {
        let mut found = read_json(&rig.path(out).join("loop.json"));
        found["seconds"] = Value::Null;
        (found.to_string(), fs::read(rig.path(out).join("model.json")).unwrap())
    };
    for (threads, out) in [("1", "one"), ("2", "two")] {
        let mut command = rig.program(&["close-loop", "arm", "--out", out]);
        command.env("RAYON_NUM_THREADS", threads).assert().success();
    }
    assert!(timeless("one") == timeless("two"), "numbers depend on the number of threads");
}

#[test]
fn a_configuration_and_its_edits_decide_what_is_tried() {
    let rig = Rig::new();
    rig.write("late.toml", "data = \"arm\"\n[effects]\nwithout = [\"dead_time\"]\n");
    let (_, found) = rig.close(&["--config", "late.toml", "--set", "search.max_effects=1"], "out");
    assert!(found["effects"].as_array().unwrap().iter().all(|effect| effect["name"] != "dead_time"));
    assert!(found["effects"].as_array().unwrap().len() <= 1);
    assert_eq!(found["configuration"]["effects"]["without"], json!(["dead_time"]));
    let lost = found["left"]["not_tried"].as_array().unwrap().iter().any(|lost| lost["name"] == "dead_time");
    assert!(lost, "what the configuration left out is said");
}

#[test]
fn trials_without_others_are_cut_and_the_finding_says_so() {
    let rig = Rig::new();
    let roles = "[roles]\ndevelopment = [\"c1\", \"d1\", \"d2\", \"d3\", \"d4\", \"h1\", \"h2\"]\n";
    rig.write("arm/manifest.toml", &format!("{}{roles}", MANIFEST.split("[roles]").next().unwrap()));
    let (_, found) = rig.close(&["arm"], "out");
    assert_eq!(found["effects"][0]["name"], "dead_time");
    let cautions = found["cautions"].to_string();
    assert!(cautions.contains("No trial is held out") && cautions.contains("No trial only calibrates"), "{cautions}");
}

/// A sample that is 5 m off is told beside the result that it spoils.
#[test]
fn what_looks_wrong_in_the_recordings_is_a_caution() {
    let rig = Rig::new();
    let table = fs::read_to_string(rig.path("arm/d2.csv")).unwrap();
    let mut rows: Vec<String> = table.lines().map(String::from).collect();
    rows[60] = rows[60].rsplit_once(',').unwrap().0.to_string() + ",5.0";
    rig.write("arm/d2.csv", &rows.join("\n"));
    let (_, found) = rig.close(&["arm"], "out");
    let cautions = found["cautions"].to_string();
    assert!(cautions.contains("d2.csv") && cautions.contains("row 61"), "{cautions}");
}

#[test]
fn an_earlier_result_is_replaced_and_a_foreign_folder_is_not() {
    let rig = Rig::new();
    rig.close(&["arm", "--set", "effects.without=[\"dead_time\"]", "--set", "search.max_effects=1"], "out");
    let (_, again) = rig.close(&["arm"], "out");
    assert_eq!(again["effects"][0]["name"], "dead_time");
    let listed = |folder: &str| {
        let entries = fs::read_dir(rig.path(folder)).unwrap();
        let mut left: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
        left.sort();
        left
    };
    assert_eq!(listed("out"), [".lock", "figures", "loop.html", "loop.json", "model.json", "tables"]);
    browser::links_resolve(&rig.path("out/loop.html"));

    // A figure of an earlier result that the new one lacks goes; what somebody put there stays.
    rig.write("out/figures/carrier-9.svg", "earlier");
    rig.write("out/figures/for-the-paper.svg", "mine");
    rig.write("out/tables/mine.csv", "mine");
    rig.close(&["arm"], "out");
    assert!(!rig.path("out/figures/carrier-9.svg").exists());
    for own in ["out/figures/for-the-paper.svg", "out/tables/mine.csv"] {
        assert_eq!(fs::read_to_string(rig.path(own)).unwrap(), "mine", "{own}");
    }
}

/// One refusal: exit code, and words of the message.
fn refused(rig: &Rig, arguments: &[&str], code: i32, words: &[&str]) {
    let done = rig.program(&["close-loop"]).args(arguments).assert().failure();
    let message = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert_eq!(done.get_output().status.code(), Some(code), "{arguments:?}: {message}");
    words.iter().for_each(|word| assert!(message.contains(word), "{arguments:?}: {word} is not in\n{message}"));
}

#[test]
fn what_cannot_be_done_is_refused_with_a_remedy() {
    let rig = Rig::new();
    rig.write("file", "");
    rig.write("key.toml", "data = \"arm\"\n[search]\nmax_effect = 3\n");
    rig.write("effect.toml", "data = \"arm\"\n[effects]\nonly = [\"backlach\"]\n");
    rig.write("away.toml", "data = \"nowhere\"\n");
    fs::create_dir(rig.path("thesis")).unwrap();
    rig.write("thesis/thesis.tex", "");
    refused(&rig, &[], 2, &["FOLDER"]);
    refused(&rig, &["arm", "--config", "key.toml"], 2, &["--config"]);
    refused(&rig, &["nowhere"], 4, &["nowhere"]);
    refused(&rig, &["--config", "away.toml"], 2, &["away.toml:1:1", "nowhere"]);
    refused(&rig, &["--config", "key.toml"], 2, &["key.toml:3:1", "max_effect", "max_effects"]);
    refused(&rig, &["--config", "effect.toml"], 2, &["effect.toml:3:", "backlach", "backlash"]);
    refused(&rig, &["arm", "--set", "nominal.model=none"], 2, &["nominal.model", "polynomial"]);
    refused(&rig, &["arm", "--set", "nominal.model=strain"], 2, &["late-arm", "[arm]"]);
    refused(&rig, &["arm", "--out", "thesis"], 2, &["thesis.tex", "--out"]);
    refused(&rig, &["arm", "--out", "file/out"], 4, &["file/out", "--out"]);
    assert!(!rig.path("runs").exists(), "a refusal leaves nothing behind");
}

#[test]
fn data_that_cannot_be_used_are_refused_with_their_place() {
    let rig = Rig::new();
    let roles = "[roles]\nheld_out = [\"c1\", \"d1\", \"d2\", \"d3\", \"d4\", \"h1\", \"h2\"]\n";
    rig.write("arm/manifest.toml", &format!("{}{roles}", MANIFEST.split("[roles]").next().unwrap()));
    refused(&rig, &["arm"], 3, &["late-arm", "development", "[roles]"]);
    rig.write("arm/manifest.toml", MANIFEST);
    let table = fs::read_to_string(rig.path("arm/d2.csv")).unwrap();
    let spoilt: Vec<String> =
        table.lines().enumerate().map(|(k, line)| if k == 7 { "0.3,oops,0".into() } else { line.into() }).collect();
    rig.write("arm/d2.csv", &spoilt.join("\n"));
    refused(&rig, &["arm"], 3, &["d2.csv", "oops", "q", "8"]);
}

#[test]
fn networks_are_trained_on_what_is_left_at_the_same_time_stamps() {
    let rig = Rig::new();
    rig.write("tiny.toml", TINY);
    let arguments = ["arm", "--set", "networks.experiment=\"tiny.toml\""];
    let (printed, found) = rig.close(&arguments, "out");
    let rows = found["networks"].as_array().unwrap();
    let models: Vec<&str> = rows.iter().map(|row| row["model"].as_str().unwrap()).collect();
    assert_eq!(models, ["nominal", "nominal + effect", "nominal + network", "nominal + effect + network"]);
    let error = |k: usize| rows[k]["error"].as_f64().unwrap();
    assert!(error(0) > 0.01 && 1e3 * error(1) < 1.2 * NOISE_MM, "in m: {printed}");
    assert!(rows[0]["sd"].is_null() && rows[3]["sd"].is_f64(), "two seeds of a network, one nominal model");
    let first = fs::metadata(rig.path("out/networks/augmented/nominal.json")).unwrap().len();
    assert!(first > 0);
    let (_, again) = rig.close(&arguments, "out");
    assert_eq!(found["networks"], again["networks"], "finished runs are taken over");

    rig.write("tiny.toml", &TINY.replace("[protocol]", "[protocol]\nfinal = false\ncross_validation = true"));
    refused(&rig, &["arm", "--set", "networks.experiment=\"tiny.toml\""], 2, &["tiny.toml", "protocol.final"]);
    refused(&rig, &["arm", "--set", "networks.experiment=\"none.toml\""], 2, &["none.toml", "networks.experiment"]);
}

const TINY: &str = r#"
data = "elsewhere"
[windows]
length = 5
reach  = 5
[inputs]
domain_filter = "none"
[network]
kind  = "gru"
units = 4
[training]
epochs = 2
batch  = 64
[protocol]
seeds = [1, 2]
"#;
