//! The loop's configuration: its defaults, its edits, and what is refused with which words.

#![allow(missing_docs)]

use std::path::{Path, PathBuf};

use acm_eval::question::config::LoopConfig;
use acm_train::config::ConfigError;

const TEXT: &str = r#"# What is missing?
question = "What is missing?"
data     = "set"

[effects]
only = ["dead_time", "backlash"]

[search]
max_effects = 2

[networks]
experiment = "net.toml"
"#;

struct Folder(tempfile::TempDir);

impl Folder {
    fn with(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("set")).unwrap();
        std::fs::write(folder.path().join("net.toml"), "").unwrap();
        std::fs::write(folder.path().join("loop.toml"), text).unwrap();
        Self(folder)
    }

    fn file(&self) -> PathBuf {
        self.0.path().join("loop.toml")
    }

    fn refusal(&self, edits: &[&str]) -> String {
        let edits: Vec<String> = edits.iter().map(ToString::to_string).collect();
        LoopConfig::read(&self.file(), &edits).map(|_| ()).map_or_else(|error| words(&error), |()| String::new())
    }
}

fn words(error: &ConfigError) -> String {
    let help = remedy(error);
    assert_eq!(error.exit_code(), 2);
    format!("{error}\n{help}")
}

fn remedy(error: &ConfigError) -> String {
    match error {
        ConfigError::Experiment(complaint) => complaint.help.clone(),
        ConfigError::Unreadable { help, .. } => help.clone(),
        other => panic!("{other}"),
    }
}

#[test]
fn a_file_names_only_what_differs() {
    let folder = Folder::with(TEXT);
    let (config, source) = LoopConfig::read(&folder.file(), &["search.seed=7".into()]).unwrap();
    assert_eq!((config.search.max_effects, config.search.samples, config.search.seed), (2, 3000, 7));
    assert!(config.tries("dead_time") && config.tries("backlash") && !config.tries("creep"));
    assert_eq!(config.data_folder(&source).unwrap(), folder.0.path().join("set"));
    assert_eq!(config.experiment_file(&source).unwrap(), Some(folder.0.path().join("net.toml")));
    let defaults = LoopConfig::default();
    assert_eq!((defaults.search.max_effects, defaults.search.samples, defaults.search.seed), (6, 3000, 1));
    assert!(acm_core::effects::ALL.iter().all(|effect| defaults.tries(effect.name())));
}

/// Files of before have another name for it.
#[test]
fn most_is_max_effects() {
    let folder = Folder::with(&TEXT.replace("max_effects", "most"));
    let (config, _) = LoopConfig::read(&folder.file(), &[]).unwrap();
    assert_eq!((config.search.max_effects, config.options().criteria.max_effects), (2, 2));
    let (config, _) = LoopConfig::for_folder(Path::new("src"), &["search.most=3".into()]).unwrap();
    assert_eq!(config.options().criteria.max_effects, 3);
    let refused = Folder::with(&TEXT.replace("max_effects = 2", "most = 0")).refusal(&[]);
    assert!(refused.contains("loop.toml:9:1") && refused.contains("`search.most` is 0"), "{refused}");
}

#[test]
fn a_folder_alone_is_enough() {
    let edits = ["effects.without=[\"creep\"]".to_string(), "nominal.model=polynomial".into()];
    let (config, source) = LoopConfig::for_folder(Path::new("src"), &edits).unwrap();
    assert_eq!(config.data, Path::new("src"));
    assert_eq!(config.data_folder(&source).unwrap(), Path::new("src"));
    assert!(!config.tries("creep") && config.tries("backlash"));
    assert_eq!(config.experiment_file(&source).unwrap(), None);
    let twice = LoopConfig::for_folder(Path::new("src"), &["data=other".into()]).unwrap_err();
    assert!(words(&twice).contains("given twice"), "{twice}");
}

#[test]
fn what_cannot_be_is_refused_with_its_place_and_a_remedy() {
    let cases: &[(&str, &str, &[&str])] = &[
        (
            "max_effects = 2",
            "max_effect = 2",
            &["loop.toml:9:1", "search", "unknown field `max_effect`", "`samples`", "close-loop --help"],
        ),
        ("max_effects = 2", "max_effects = 0", &["loop.toml:9:1", "search.max_effects", "is 0", "1 to 12"]),
        ("max_effects = 2", "max_effects = -2", &["loop.toml:9:1", "search.max_effects", "-2", "whole number"]),
        ("max_effects = 2", "samples = 10", &["search.samples", "is 10", "200 or more"]),
        ("max_effects = 2", "samples = 9223372036854775807", &["search.samples", "is 9223372036854775807", "at most"]),
        (
            "max_effects = 2",
            "seed = 18446744073709551615",
            &["loop.toml:9:8", "`search.seed` is 18446744073709551615", "9223372036854775807"],
        ),
        ("\"set\"", "\"\"", &["loop.toml:3:1", "`data` is empty"]),
        (
            "[search]",
            "[nominal]\nmodel = 3\n[search]",
            &["loop.toml:9:1", "`nominal.model`", "expected a text in quotes"],
        ),
        ("[search]", "[serach]", &["loop.toml:8:2", "unknown field `serach`", "`search`"]),
        ("backlash", "back_lash", &["loop.toml:6:22", "effects.only.1", "back_lash", "known effects: ", " backlash "]),
        ("[search]", "without = [\"dead_time\", \"backlash\"]\n[search]", &["`effects`", "no effect to try"]),
        (
            "[\"dead_time\", \"backlash\"]",
            "[]",
            &["loop.toml:6:1", "`effects.only`", "no effect to try", "without the key"],
        ),
        ("[search]", "[nominal]\nlength = nan\n[search]", &["loop.toml:9:1", "nominal.length", "finite"]),
        ("[search]", "[nominal]\ndegree = 0\n[search]", &["loop.toml:9:1", "nominal.degree", "is 0"]),
        ("[search]", "[nominal]\nmodel = \"magic\"\n[search]", &["loop.toml:9:1", "nominal.model", "magic", "strain"]),
        ("[search]", "[nominal]\naugmented = \"m.json\"\n[search]", &["nominal.augmented", "acm-train", "data"]),
        ("[search]", "[search", &["loop.toml:8"]),
    ];
    for (from, to, parts) in cases {
        assert!(TEXT.contains(from), "{from}");
        let message = Folder::with(&TEXT.replacen(from, to, 1)).refusal(&[]);
        for part in *parts {
            assert!(message.contains(part), "{to:?}: no {part:?} in\n{message}");
        }
    }
    let folder = Folder::with(TEXT);
    assert_eq!(folder.refusal(&[]), "");
    assert!(folder.refusal(&["search.most"]).contains("key=value"));
    let message = folder.refusal(&["effects.without=[\"magic\"]"]);
    assert!(message.contains("--set effects.without") && message.contains("known effects"), "{message}");
    assert!(words(&LoopConfig::read(Path::new("no.toml"), &[]).unwrap_err()).contains("no.toml"));
}

#[test]
fn what_is_named_and_is_not_there_is_refused() {
    let folder = Folder::with(&TEXT.replace("\"set\"", "\"sett\"").replace("net.toml", "nett.toml"));
    let (config, source) = LoopConfig::read(&folder.file(), &[]).unwrap();
    let message = words(&config.data_folder(&source).unwrap_err());
    assert!(message.contains("loop.toml:3:1") && message.contains("sett"), "{message}");
    let message = words(&config.experiment_file(&source).unwrap_err());
    assert!(message.contains("loop.toml:12:1") && message.contains("nett.toml"), "{message}");
}

#[test]
fn a_configuration_is_read_back_as_it_was() {
    let folder = Folder::with(TEXT);
    let (config, _) = LoopConfig::read(&folder.file(), &[]).unwrap();
    let stored = serde_json::to_string(&config).unwrap();
    assert_eq!(serde_json::from_str::<LoopConfig>(&stored).unwrap(), config);
}

/// Files in `experiments/` that this program answers name data and networks that are there.
#[test]
fn every_question_to_the_loop_can_be_read() {
    let folder = std::path::absolute("../experiments").unwrap();
    let mut names = vec![];
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    for file in files.filter(|file| file.is_file()) {
        let text = std::fs::read_to_string(&file).unwrap();
        if !text.contains("#     cargo run -p acm-eval -- close-loop --config experiments/") {
            continue;
        }
        let (config, source) = LoopConfig::read(&file, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert!(config.question.ends_with('?'), "{file:?}: {}", config.question);
        assert!(config.data_folder(&source).unwrap().join("manifest.toml").exists(), "{file:?}");
        config.experiment_file(&source).unwrap_or_else(|error| panic!("{error}"));
        names.push(file.file_stem().unwrap().to_string_lossy().into_owned());
    }
    let asked = [
        "close-the-loop",
        "trunk-loop",
        "trunk-payload",
        "pneumatic-cylinder",
        "faster",
        "grasper",
        "band-brake",
        "cascaded-tanks",
    ];
    for name in asked {
        assert!(names.contains(&name.to_string()), "{name} is not among {names:?}");
    }
}
