//! The page as a reader gets it: in one file, marked where synthetic, and no wider than the window.

mod fixture;

use std::{
    path::{Path, PathBuf},
    process::Command,
};

use assert_cmd::cargo::cargo_bin_cmd;
use fixture::{Fixture, write};

fn page(fixtures: &[Fixture], root: &Path) -> PathBuf {
    let runs: Vec<_> =
        fixtures.iter().map(|fixture| write(fixture, root, &format!("{}-{}", fixture.kind, fixture.data))).collect();
    cargo_bin_cmd!("acm-eval").arg("report").args(runs).arg("--out").arg(root.join("report")).assert().success();
    root.join("report/report.html")
}

#[test]
fn synthetic_data_is_marked_wherever_its_numbers_are_and_measured_data_is_not() {
    let marks = |synthetic: bool| {
        let root = tempfile::tempdir().unwrap();
        let html = std::fs::read_to_string(page(&[Fixture { synthetic, ..Fixture::default() }], root.path())).unwrap();
        let headings = html.matches("<h3").count();
        assert_eq!(html.contains("role=\"note\""), synthetic, "the note above all numbers");
        (html.to_lowercase().matches("synthetic").count(), html.matches(">synthetic data</span>").count(), headings)
    };
    let (_, badges, headings) = marks(true);
    assert!(badges >= headings - 1 && headings > 8, "{badges} marks for {headings} headings");
    // The style sheet names the class of the mark once; nothing else may speak of it.
    assert_eq!(marks(false).0, 2, "measured data are marked as synthetic");
}

#[test]
fn the_terminal_prints_the_main_table_with_its_mark() {
    let root = tempfile::tempdir().unwrap();
    let run = write(&Fixture::default(), root.path(), "cfc");
    let output = cargo_bin_cmd!("acm-eval").arg("report").arg(&run).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("SYNTHETIC DATA") && said.contains("13.0") && said.contains("4.7 ± 2.4"), "{said}");
    assert!(said.trim_end().ends_with("cfc/report/report.html"), "{said}");
    assert!(said.lines().all(|line| line.chars().count() <= 100), "{said}");
}

/// What is missing is told on the page and in the terminal, and of a folder that is complete nothing is.
#[test]
fn runs_that_are_missing_are_told() {
    let root = tempfile::tempdir().unwrap();
    let fixture = Fixture { seeds: vec![1, 2], folds: 3, ..Fixture::default() };
    let (whole, cut) = (write(&fixture, root.path(), "whole"), write(&fixture, root.path(), "cut"));
    let told = |run: &Path| {
        let output = cargo_bin_cmd!("acm-eval").arg("report").arg(run).output().unwrap();
        let page = std::fs::read_to_string(run.join("report/report.html")).unwrap();
        (String::from_utf8(output.stderr).unwrap(), page)
    };
    let (said, page) = told(&whole);
    assert!(!said.contains("missing") && !page.contains("Incomplete"), "{said}");
    for lost in ["final-seed2", "fold1-seed1"] {
        std::fs::remove_file(cut.join(format!("records/{lost}.json"))).unwrap();
    }
    let (said, page) = told(&cut);
    for part in [
        "cut has 1 of 2 seeds: seed 2 is missing, and 2 of 3 runs of the folds: seed 1 of fold 1 is missing",
        "--resume",
    ] {
        assert!(said.contains(part) && page.contains(part), "no {part:?} in {said}");
    }
    assert!(said.starts_with("warning: ") && page.contains("<strong>Incomplete. </strong>"), "{said}");
    // A folder from before there was a list of runs: its protocol has five seeds.
    let path = cut.join("nominal.json");
    let text = acm_train::hashed::verify(&std::fs::read(&path).unwrap()).unwrap();
    let mut nominal: serde_json::Value = serde_json::from_str(&text).unwrap();
    nominal.as_object_mut().unwrap().remove("runs").unwrap();
    acm_train::hashed::write(&path, &nominal).unwrap();
    let (said, _) = told(&cut);
    assert!(said.contains("1 of 5 seeds: seed 2, seed 3, seed 4, seed 5 are missing"), "{said}");
}

/// A page that fetches nothing can be mailed, archived and opened without a network.
#[test]
fn the_page_loads_nothing() {
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(page(&[Fixture::default()], root.path())).unwrap();
    for loading in ["src=", "<link", "<script", "@import", "url(http", "href=\"http", "<image", "<iframe"] {
        assert!(!html.contains(loading), "the page has {loading}");
    }
    let addresses = html.matches("http").count();
    assert_eq!(
        addresses,
        html.matches("xmlns=\"http://www.w3.org/2000/svg\"").count(),
        "an address that is no namespace"
    );
}

#[test]
fn names_from_the_data_cannot_break_the_page() {
    let root = tempfile::tempdir().unwrap();
    let nasty = Fixture { data: "<script>alert(1)</script>&\"'", ..Fixture::default() };
    let run = write(&nasty, root.path(), "cfc");
    cargo_bin_cmd!("acm-eval").arg("report").arg(&run).assert().success();
    let html = std::fs::read_to_string(run.join("report/report.html")).unwrap();
    assert!(!html.contains("<script") && html.contains("&lt;script&gt;"));
    assert!(run.join("report/tables/script-alert-1-script-errors.csv").is_file());
}

/// In a browser: no identifier twice, and nothing wider than the window at 400 and at 1400 px.
#[test]
fn nothing_sticks_out_of_the_window() {
    let Some(browser) = browser() else {
        eprintln!("skipped: no chromium on this machine");
        return;
    };
    let root = tempfile::tempdir().unwrap();
    let fixtures = [
        Fixture { kind: "mlp", folds: 3, gain: 3.0, ..Fixture::default() },
        Fixture { folds: 3, ..Fixture::default() },
        Fixture { data: "a-data-set-with-a-rather-long-name", hash: "beef", synthetic: false, ..Fixture::default() },
    ];
    let html = std::fs::read_to_string(page(&fixtures, root.path())).unwrap();
    for width in [400, 1400] {
        let measured = measure(browser, &html, width, root.path());
        assert_eq!(measured, format!("page {width} of {width}, identifiers repeated 0"));
    }
}

fn browser() -> Option<&'static str> {
    let works = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find(works)
}

/// The page in a frame of the given width (a headless window has a least width), with a script that measures it.
fn measure(browser: &str, html: &str, width: u32, root: &Path) -> String {
    let script = "<script>addEventListener('load', () => { const d = document, e = d.documentElement; \
        const ids = [...d.querySelectorAll('[id]')].map(x => x.id); \
        d.title = `page ${e.scrollWidth} of ${innerWidth}, identifiers repeated ${ids.length - new Set(ids).size}`; \
        parent.postMessage(d.title, '*'); });</script>";
    let frame = format!(
        "<!doctype html><iframe src=\"inside.html\" style=\"width:{width}px;height:800px;border:0\"></iframe>\
         <script>addEventListener('message', m => document.body.append('«' + m.data + '»'));</script>"
    );
    std::fs::write(root.join("inside.html"), html.replace("</body>", &format!("{script}</body>"))).unwrap();
    std::fs::write(root.join("frame.html"), frame).unwrap();
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--virtual-time-budget=5000"])
        .args(["--window-size=1500,900", "--allow-file-access-from-files", "--dump-dom"])
        .arg(format!("--user-data-dir={}", root.join("browser").display()))
        .arg(format!("file://{}", root.join("frame.html").display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    // The script's own text has the marks, too: the answer is after the last one.
    let answer = dom.rsplit_once('«').and_then(|(_, rest)| rest.split_once('»')).map(|(answer, _)| answer.to_string());
    answer.unwrap_or_else(|| panic!("the page did not answer: {dom}"))
}
