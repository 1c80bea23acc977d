//! Runs that are disturbed, on the real program: short versions of what the examples `kills`, `races` and `mutations` do at
//! length.

#[path = "../campaign/mod.rs"]
mod campaign;
#[cfg(target_os = "linux")]
mod disturbed;
#[path = "mod.rs"]
mod faults;

use campaign::program;
use faults::{
    kills::{Signals, kill},
    mutations::mutate,
    questions::Question,
    races::races,
    saved,
};

#[track_caller]
fn survives(name: &'static str, runs: usize, signals: Signals) {
    let outcome = kill(&Question::new(name), &program(), runs, signals, 2);
    assert!(outcome.same == runs, "{name}: {:#?}", outcome.faults);
}

#[test]
fn a_killed_mlp_is_resumed_to_the_same_bits() {
    survives("mlp", 8, Signals::Kill);
}

#[test]
fn a_killed_gru_is_resumed_to_the_same_bits() {
    survives("gru", 8, Signals::Kill);
}

#[test]
fn a_killed_cfc_is_resumed_to_the_same_bits() {
    survives("cfc", 8, Signals::Kill);
}

#[test]
fn runs_that_are_asked_to_stop_are_resumed_to_the_same_bits() {
    survives("cfc", 4, Signals::Term);
}

#[test]
fn killed_baselines_are_begun_again_to_the_same_bits() {
    survives("ridge", 2, Signals::Mixed);
    survives("boosted_trees", 2, Signals::Mixed);
}

#[test]
fn killed_studies_are_resumed_to_the_same_tables() {
    survives("ablation", 3, Signals::Mixed);
    survives("sweep", 3, Signals::Mixed);
    survives("halving", 2, Signals::Mixed);
}

#[test]
fn killed_studies_that_describe_are_made_again_to_the_same_bits() {
    survives("nominal", 1, Signals::Mixed);
    survives("residual", 2, Signals::Mixed);
}

#[test]
fn killed_questions_about_sequences_are_resumed_to_the_same_bits() {
    survives("sequences", 3, Signals::Mixed);
}

#[test]
fn of_several_processes_on_one_folder_one_works_and_the_others_say_who() {
    let outcome = races(&Question::new("gru"), &program(), 5);
    assert!(outcome.clean == 5, "{:#?}", outcome.faults);
}

#[test]
fn mutated_checkpoints_records_and_tables_are_refused_by_their_names() {
    let outcome = mutate(&saved::all(&program()), 600, 2);
    assert!(outcome.refused == 600, "{:#?}", outcome.faults);
}
