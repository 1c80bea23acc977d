//! The contract of a figure: each one in the list draws the made-up runs, alike every time.

mod fixture;

use acm_eval::{
    chapter::{Chapter, Shown},
    figures,
    report::Report,
    run::Run,
    section::sections,
};
use fixture::{Fixture, write};

fn three_runs() -> (tempfile::TempDir, Report) {
    let root = tempfile::tempdir().unwrap();
    let mlp = Fixture { kind: "mlp", gain: 3.0, ..Fixture::default() };
    let gru = Fixture { kind: "gru", gain: 2.0, ..Fixture::default() };
    let folders = [
        write(&mlp, root.path(), "mlp"),
        write(&gru, root.path(), "gru"),
        write(&Fixture::default(), root.path(), "cfc"),
    ];
    let report = Report::of(&folders, "acm-eval report mlp gru cfc".into()).unwrap();
    (root, report)
}

fn chapter(report: &Report) -> &Chapter {
    &report.chapters[0]
}

fn shown<'a>(report: &'a Report, name: &str) -> &'a Shown {
    chapter(report).figures.iter().find(|shown| shown.name == name).unwrap()
}

#[test]
fn every_figure_draws() {
    let (_root, report) = three_runs();
    let drawn: Vec<&str> = chapter(&report).figures.iter().map(|shown| shown.name).collect();
    let listed: Vec<&str> = figures::ALL.iter().map(|figure| figure.name).collect();
    assert_eq!(drawn, listed);
    for Shown { name, question, drawing } in &chapter(&report).figures {
        let svg = drawing.svg(name, question, "command");
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>"), "{name}");
        assert!(question.ends_with('?') && svg.contains(question), "{name}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name} has a coordinate that is no number");
        assert!(svg.contains("SYNTHETIC DATA"), "{name} leaves the page without its mark");
    }
}

/// Oracle: counted by hand for three networks, two baselines, three seeds, two held-out trials of two segments each.
#[test]
fn every_figure_has_its_series() {
    let (_root, report) = three_runs();
    let count = |name: &str| shown(&report, name).drawing.series;
    assert_eq!(count("rmse"), 5 * 4, "estimators × (x, y, z, 3D)");
    assert_eq!(count("r2"), 3 * 3, "networks × coordinates");
    assert_eq!(count("residual"), 3 * 3, "networks × coordinates");
    assert_eq!(count("time"), 3 * 2 * 2 * 2, "networks × (nominal, its own) × trials × segments");
    assert_eq!(
        count("arm"),
        2 * (2 + 5),
        "trials × (arm, arrow, tips of the measurement, the nominal model, three networks)"
    );
    assert_eq!(count("learning"), 3 * 3 * 3, "networks × seeds × (training, validation, kept epoch)");
}

/// Up to two networks share a panel with the nominal model; more have a row each, for their lines would hide each other.
#[test]
fn no_panel_of_time_has_more_than_three_models() {
    for (networks, panels) in [(1, 2), (2, 2), (3, 3 * 2), (6, 6 * 2)] {
        let root = tempfile::tempdir().unwrap();
        let kinds = ["mlp", "gru", "cfc", "mlp", "gru", "cfc"];
        let run = |k: usize| write(&Fixture { kind: kinds[k], ..Fixture::default() }, root.path(), &format!("run{k}"));
        let folders: Vec<_> = (0..networks).map(run).collect();
        let report = Report::of(&folders, "command".into()).unwrap();
        let svg = shown(&report, "time").drawing.svg("time", "question", "command");
        let titles = svg.matches("Trial ").count() + svg.matches(", trial ").count();
        assert_eq!(titles, panels, "{networks} networks");
    }
}

/// Marks of the drawings themselves: bars and whiskers, cut lines, dots.
#[test]
fn the_svg_holds_what_was_counted() {
    let (root, report) = three_runs();
    let svg = |name: &str| shown(&report, name).drawing.svg(name, "question", "command");
    let runs = ["mlp", "gru", "cfc"].map(|name| Run::read(&root.path().join(name)).unwrap());
    let section = &sections(runs.into()).unwrap()[0];
    for estimator in &section.estimators {
        let bars = svg("rmse").matches(&format!("fill=\"{}\"", estimator.colour)).count();
        assert_eq!(bars, 4 + 1, "{}: four bars and a key", estimator.label);
    }
    let nominal = &section.estimators[0];
    assert_eq!(
        svg("time").matches(&format!("stroke=\"{}\"", nominal.colour)).count(),
        3 * 2 * 2 + 1,
        "segments in each network's row, and a key"
    );
    assert_eq!(svg("residual").matches("<circle").count(), 9 * 240 + 3, "all time stamps, and three keys");
}

#[test]
fn a_picture_decodes_and_is_not_blank() {
    let (root, report) = three_runs();
    report.write(&root.path().join("report")).unwrap();
    for figure in figures::ALL {
        let path = root.path().join("report/figures").join(format!("made-up-{}.png", figure.name));
        let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(&path).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert!(info.width > 1000 && info.height > 400, "{}: {} × {}", figure.name, info.width, info.height);
        let channels = pixels.len() / (info.width * info.height) as usize;
        let inked = pixels.chunks(channels).filter(|pixel| pixel[..3] != [255; 3]).count();
        assert!(inked > 5_000, "{} has {inked} pixels that are not white", figure.name);
    }
}

/// The plotting library counts its clip paths through the process; a figure must not depend on what was drawn before.
#[test]
fn the_same_records_give_the_same_bytes() {
    let (root, report) = three_runs();
    report.write(&root.path().join("a")).unwrap();
    let folders: Vec<_> = ["mlp", "gru", "cfc"].map(|name| root.path().join(name)).to_vec();
    Report::of(&folders, "acm-eval report mlp gru cfc".into()).unwrap().write(&root.path().join("b")).unwrap();
    let mut compared = 0;
    for inside in ["figures", "tables", ""] {
        for entry in std::fs::read_dir(root.path().join("a").join(inside)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                let other = root.path().join("b").join(inside).join(path.file_name().unwrap());
                assert!(std::fs::read(&path).unwrap() == std::fs::read(&other).unwrap(), "{} differs", path.display());
                compared += 1;
            }
        }
    }
    assert!(compared > 15, "{compared} files");
}
