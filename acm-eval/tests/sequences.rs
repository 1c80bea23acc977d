//! A study of sequences as a chapter: conducted small, read, drawn.

use acm_eval::{chapter::sequences, report::Report};
use acm_train::schedule::study::of_sequences::best::record as best;
use acm_train::{
    config::{Source, kind},
    run::{progress::Progress, sequences::record, stop::Stop},
    schedule::{request::Request, study::conduct},
};

const SHORT: [&str; 7] = [
    "data.training=400",
    "data.test=100",
    "data.length=8",
    "network.units=4",
    "network.backbone_units=4",
    "training.epochs=2",
    "seeds=[1, 2]",
];

/// Oracle: the records themselves, averaged here.
#[test]
fn a_study_of_sequences_has_its_chapter() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("xor");
    let file = std::path::absolute("../experiments/xor.toml").unwrap();
    let source = Source::read(&file, &SHORT.map(String::from)).unwrap();
    let (progress, stop) = (Progress::Quiet, Stop::default());
    let request = Request::new(&out, &progress, &stop);
    conduct(kind(&source).unwrap().unwrap(), source, &request).unwrap();

    let study = sequences::read(&out).unwrap();
    let csv = sequences::tables(&study)[0].csv();
    let of = |seed: u64| record::read(&out.join(format!("records/measured-seed{seed}.json"))).unwrap();
    let mean = 50.0 * (of(1).scored().accuracy.unwrap() + of(2).scored().accuracy.unwrap());
    let row = csv.lines().find(|line| line.contains("as measured")).unwrap();
    assert!(
        row.split(',').any(|cell| cell.parse().is_ok_and(|found: f64| (found - mean).abs() < 1e-9)),
        "{mean}\n{csv}"
    );
    assert!(csv.contains("71.87") && csv.lines().count() == 4, "{csv}");

    let report = Report::of(std::slice::from_ref(&out), "command".into()).unwrap();
    let chapter = &report.chapters[0];
    assert_eq!((chapter.figures.len(), chapter.figures[0].drawing.series), (1, 8));
    assert!(chapter.data.synthetic && chapter.questions[0].1.ends_with('?'));
    let svg = chapter.figures[0].drawing.svg("learning", sequences::read(&out).unwrap().record.question.as_str(), "c");
    assert!(svg.contains("SYNTHETIC DATA") && !svg.contains("NaN"), "{svg}");
}

/// Oracle: the scores of the record; labels of such short streams cannot be told from few, so only their presence is asked.
#[test]
fn a_choice_among_sequences_has_its_chapter() {
    let root = tempfile::tempdir().unwrap();
    let (out, file) = (root.path().join("best"), root.path().join("best.toml"));
    let experiment = std::path::absolute("../experiments/xor.toml").unwrap();
    let base = |name: &str, units: usize| {
        let set: String = SHORT.iter().map(|edit| format!("set.{edit}\n")).collect();
        let set = set.replace("units=4", &format!("units={units}"));
        format!("[[base]]\nname = {name:?}\nexperiment = {experiment:?}\n{set}\n")
    };
    let study = format!("study = \"best\"\nquestion = \"Which?\"\n{}{}", base("four", 4), base("five", 5));
    std::fs::write(&file, study).unwrap();
    let source = Source::read(&file, &[]).unwrap();
    let (progress, stop) = (Progress::Quiet, Stop::default());
    let request = Request::new(&out, &progress, &stop);
    conduct(kind(&source).unwrap().unwrap(), source, &request).unwrap();

    let record = best::read(&out).unwrap();
    let tested = record.test.as_ref().unwrap();
    let report = Report::of(std::slice::from_ref(&out), "command".into()).unwrap();
    let chapter = &report.chapters[0];
    assert!(chapter.data.synthetic && chapter.title.contains("Which model"));
    assert_eq!(chapter.tables[0].rows.len(), record.candidates.len());
    let test = chapter.tables.iter().find(|table| table.name == "best-test").unwrap().csv();
    assert!(test.contains(&tested.winner.loss.to_string()) && test.contains("the mean"), "{test}");
}
