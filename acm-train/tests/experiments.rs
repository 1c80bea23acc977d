//! Every file in `experiments/` opens with its question in a comment and says by which command it is answered; those of
//! this program can be read, and name a data set that is there.

use std::{
    fs,
    path::{Path, PathBuf},
};

use acm_train::{
    config::{Experiment, Kind, Source, find_folder, kind, read},
    schedule::study::list,
};

#[test]
fn each_is_an_experiment_or_a_question_to_the_loop() {
    let folder = std::path::absolute("../experiments").unwrap();
    let mut own = vec![];
    for file in files(&folder).into_iter().chain(files(&folder.join("paper"))) {
        let text = fs::read_to_string(&file).unwrap();
        let name = file.strip_prefix(&folder).unwrap().with_extension("").to_string_lossy().into_owned();
        assert!(text.starts_with("# ") && text.lines().next().is_some_and(|line| line.ends_with('?')), "{file:?}");
        if text.contains(&format!("#     cargo run -p acm-train -- --config experiments/{name}.toml\n")) {
            check(&file);
            own.push(name);
        } else {
            let command = format!("#     cargo run -p acm-eval -- close-loop --config experiments/{name}.toml\n");
            assert!(text.contains(&command), "{file:?} does not say which command answers it");
        }
    }
    for name in ["mlp", "gru", "cfc", "trunk", "paper/mlp", "paper/gru", "paper/cfc"] {
        assert!(own.contains(&name.to_string()), "{name} is not among {own:?}");
    }
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let all = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    all.filter(|path| path.is_file()).collect()
}

fn check(file: &Path) {
    let source = Source::read(file, &[]).unwrap_or_else(|error| panic!("{error}"));
    match kind(&source).unwrap_or_else(|error| panic!("{error}")) {
        None => check_experiment(&read(file, &[]).unwrap_or_else(|error| panic!("{error}")).0, file),
        Some(kind @ (Kind::Sweep | Kind::Ablation | Kind::Comparison)) => check_list(&source, kind, file),
        Some(Kind::Nominal | Kind::Residual) => {
            let said = |key: &str| source.tree[key].as_str().unwrap().to_string();
            assert!(said("question").ends_with('?'), "{file:?}");
            check(&file.with_file_name(said("base")));
        }
        Some(kind @ (Kind::Inputs | Kind::Best)) => {
            let list = list::read(&source, kind).unwrap_or_else(|error| panic!("{error}"));
            assert!(list.question.ends_with('?'), "{file:?}");
            list.base.iter().for_each(|base| check(&file.with_file_name(&base.experiment)));
        }
        // Their own tests run them.
        Some(_) => {}
    }
}

fn check_list(source: &Source, kind: Kind, file: &Path) {
    let list = list::read(source, kind).unwrap_or_else(|error| panic!("{error}"));
    assert!(list.question.ends_with('?'), "{file:?}: {}", list.question);
    for member in list.members(source).unwrap_or_else(|error| panic!("{error}")) {
        check_experiment(&member.experiment, file);
    }
}

fn check_experiment(experiment: &Experiment, file: &Path) {
    assert!(experiment.question.ends_with('?'), "{file:?}: {}", experiment.question);
    let data = find_folder(&experiment.data, file).unwrap_or_else(|| panic!("{file:?}: no {:?}", experiment.data));
    assert!(data.join("manifest.toml").exists(), "{data:?}");
}

#[test]
fn the_models_of_one_table_are_scored_on_the_same_targets() {
    let folder = std::path::absolute("../experiments").unwrap();
    let asked = |name: &str| read(&folder.join(name), &[]).unwrap().0;
    let [mlp, gru, cfc] = ["mlp.toml", "gru.toml", "cfc.toml"].map(asked);
    for other in [&mlp, &gru] {
        let targets = |e: &Experiment| (e.data.clone(), e.windows.reach, e.windows.evaluation_stride, e.inputs.clone());
        assert_eq!(targets(other), targets(&cfc));
    }
}

/// Arithmetic by hand: the paper's five inputs and its split, whatever the defaults become.
#[test]
fn the_papers_own_settings_are_kept() {
    let folder = std::path::absolute("../experiments/paper").unwrap();
    for name in ["mlp.toml", "gru.toml", "cfc.toml"] {
        let (asked, _) = read(&folder.join(name), &[]).unwrap();
        let inputs = ["q1", "q2", "rate(q1)", "altitude", "throttle"].map(String::from).to_vec();
        assert_eq!((asked.inputs.channels, asked.inputs.select), (Some(inputs), false), "{name}");
        assert_eq!((asked.protocol.validation_fold, asked.protocol.leave_out), (Some(0), None), "{name}");
        assert_eq!(asked.protocol.folds.unwrap(), [["1", "5", "9"], ["2", "6", "7"], ["3", "4", "8"]], "{name}");
    }
}

#[test]
fn a_resolved_experiment_is_read_back_as_it_was() {
    let text = toml::to_string(&Experiment::default()).unwrap();
    assert_eq!(toml::from_str::<Experiment>(&text).unwrap(), Experiment::default());
}
