//! Every file in `experiments/` opens with its question in a comment, can be read, and names a data set that is there.

use std::{fs, path::Path};

use acm_train::experiment::{Experiment, find_folder, read};

#[test]
fn each_is_an_experiment() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments");
    let files: Vec<_> = fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let names: Vec<String> = files.iter().filter_map(|f| Some(f.file_stem()?.to_string_lossy().into_owned())).collect();
    for name in ["mlp", "gru", "cfc", "trunk"] {
        assert!(names.contains(&name.to_string()), "{name} is not among {names:?}");
    }
    for file in &files {
        let (experiment, _) = read(file, &[]).unwrap_or_else(|error| panic!("{error}"));
        let text = fs::read_to_string(file).unwrap();
        assert!(text.starts_with("# ") && text.lines().next().is_some_and(|line| line.ends_with('?')), "{file:?}");
        assert!(experiment.question.ends_with('?'), "{file:?}: {}", experiment.question);
        let data = find_folder(&experiment.data, file).unwrap_or_else(|| panic!("{file:?}: no {:?}", experiment.data));
        assert!(data.join("manifest.toml").exists(), "{data:?}");
    }
}

#[test]
fn the_models_of_one_table_are_scored_on_the_same_targets() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../experiments");
    let asked = |name: &str| read(&folder.join(name), &[]).unwrap().0;
    let [mlp, gru, cfc] = ["mlp.toml", "gru.toml", "cfc.toml"].map(asked);
    for other in [&mlp, &gru] {
        let targets = |e: &Experiment| (e.data.clone(), e.windows.reach, e.windows.evaluation_stride, e.inputs.clone());
        assert_eq!(targets(other), targets(&cfc));
    }
}

#[test]
fn a_resolved_experiment_is_read_back_as_it_was() {
    let text = toml::to_string(&Experiment::default()).unwrap();
    assert_eq!(toml::from_str::<Experiment>(&text).unwrap(), Experiment::default());
}
