//! The page as a reader gets it: in one file, marked where synthetic, and no wider than the window.

mod browser;
mod fixture;

use std::path::{Path, PathBuf};

use assert_cmd::cargo::cargo_bin_cmd;
use browser::{DESK_AND_PHONE, UNMARKED, Window, browser, links_resolve};
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
        assert_eq!(html.contains("role=\"note\""), synthetic, "the note above all numbers of a chapter");
        let badges = |part: &str| part.matches(">synthetic data</span>").count();
        let (first, rest) = html.split_once("<nav").unwrap();
        assert_eq!(badges(first), usize::from(synthetic), "one mark on the first screen");
        assert!(!synthetic || badges(rest) >= rest.matches("<h3").count(), "a table or figure without its mark");
        html.to_lowercase().matches("synthetic").count()
    };
    assert!(marks(true) > 10);
    // The style sheet names the class of the mark once; nothing else may speak of it.
    assert_eq!(marks(false), 2, "measured data are marked as synthetic");
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

/// The fixture's network misses less than the nominal model in every fold by the same amount, so the standard error is 0.
#[test]
fn the_page_says_whether_the_network_is_worth_it() {
    for (gain, folds, said) in [
        (1.0, 3, "The cfc is worth it here"),
        (100.0, 3, "No network is worth it here"),
        (100.0, 3, "Use the nominal model as it is"),
        (1.0, 1, "cannot be told from 1 fold:"),
        (1.0, 0, "cannot be told from 0 folds"),
    ] {
        let root = tempfile::tempdir().unwrap();
        let html =
            std::fs::read_to_string(page(&[Fixture { gain, folds, ..Fixture::default() }], root.path())).unwrap();
        let (first, _) = html.split_once("<nav").unwrap();
        assert!(first.contains(said), "{said}: {first}");
    }
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
    let text = acm_train::store::hashed::verify(&std::fs::read(&path).unwrap()).unwrap();
    let mut nominal: serde_json::Value = serde_json::from_str(&text).unwrap();
    nominal.as_object_mut().unwrap().remove("runs").unwrap();
    acm_train::store::hashed::write(&path, &nominal).unwrap();
    let (said, _) = told(&cut);
    assert!(said.contains("1 of 5 seeds: seed 2, seed 3, seed 4, seed 5 are missing"), "{said}");
}

/// A page that fetches nothing can be mailed, archived and opened without a network.
#[test]
fn the_page_loads_nothing() {
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(page(&[Fixture::default()], root.path())).unwrap();
    browser::loads_nothing("the page", &html);
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
    assert!(!html.contains("<script>alert") && html.contains("&lt;script&gt;"));
    assert!(run.join("report/tables/script-alert-1-script-errors.csv").is_file());
}

fn three_networks(root: &Path) -> PathBuf {
    let fixtures = [
        Fixture { kind: "mlp", gain: 3.0, ..Fixture::default() },
        Fixture { kind: "gru", gain: 2.0, ..Fixture::default() },
        Fixture::default(),
    ];
    page(&fixtures, root)
}

/// In a browser: no identifier twice, and nothing wider than the window of a phone or a screen.
#[test]
fn nothing_sticks_out_of_the_window() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let fixtures = [
        Fixture { kind: "mlp", folds: 3, gain: 3.0, ..Fixture::default() },
        Fixture { folds: 3, ..Fixture::default() },
        Fixture { data: "a-data-set-with-a-rather-long-name", hash: "beef", synthetic: false, ..Fixture::default() },
    ];
    let html = std::fs::read_to_string(page(&fixtures, root.path())).unwrap();
    let script = "document.querySelectorAll('details').forEach(folded => folded.open = true); \
        const ids = [...document.querySelectorAll('[id]')].map(x => x.id); \
        const first = document.querySelector('.answer .card'), over = innerWidth < 1000 ? 0 : first.scrollWidth - first.clientWidth; \
        return `page ${document.documentElement.scrollWidth - document.documentElement.clientWidth} px too wide, \
        first figure ${over}, identifiers repeated ${ids.length - new Set(ids).size}`;";
    for width in [400, 1000, 1119, 1120, 1200, 1400, 1600] {
        let said = Window { width, height: 800, dark: false }.ask(browser, &html, script);
        assert_eq!(said, "page 0 px too wide, first figure 0, identifiers repeated 0", "{width} px");
    }
}

/// The first screen says what data it is, marks it once, and has the main number and a figure; hashes come last.
#[test]
fn the_answer_is_on_the_first_screen() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(three_networks(root.path())).unwrap();
    let script = "const box = x => x.getBoundingClientRect(), seen = x => box(x).bottom <= innerHeight; \
        const cells = [...document.querySelectorAll('table td')]; \
        const number = cells.find(x => x.textContent.startsWith('13.0')); \
        const marks = [...document.querySelectorAll('.badge, .synthetic')].filter(x => box(x).top < innerHeight); \
        const drawn = Math.min(innerHeight, box(document.querySelector('figure svg')).bottom) \
            - box(document.querySelector('figure svg')).top; \
        const hash = [...document.querySelectorAll('.hash')]; \
        const right = number && box(number).right <= innerWidth; \
        const whole = innerWidth < 1000 || document.querySelector('.scroll').scrollWidth <= document.querySelector('.scroll').clientWidth; \
        return `title ${seen(document.querySelector('h1'))}, number ${!!number && seen(number) && right}, \
        marks ${marks.length}, table whole ${whole}, figure ${drawn >= 150}, \
        hashes after figures ${hash.every(x => box(x).top > box([...document.querySelectorAll('figure')].at(-1)).bottom)}`;";
    for window in DESK_AND_PHONE {
        let said = window.ask(browser, &html, script);
        let wanted = "title true, number true, marks 1, table whole true, figure true, hashes after figures true";
        assert_eq!(said, wanted, "{} px", window.width);
    }
}

#[test]
fn what_is_wider_than_its_box_scrolls_and_shows_it() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(three_networks(root.path())).unwrap();
    let phone = DESK_AND_PHONE[1].ask(browser, &html, UNMARKED);
    assert_eq!(phone, "some wide; silent: ");
    let desk = DESK_AND_PHONE[0].ask(browser, &html, UNMARKED);
    assert!(desk.ends_with("silent: "), "{desk}");
}

/// In the dark no figure is a white slab, in the light it stands on white; the marks of a figure are seen in both.
#[test]
fn figures_follow_the_dark() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(three_networks(root.path())).unwrap();
    let figures = html.matches("<figure ").count();
    assert!(figures >= 5);
    for figure in 0..figures {
        let script = format!("document.body.replaceChildren(document.querySelectorAll('figure .card')[{figure}]);");
        let of = |dark| Window { width: 1200, height: 500, dark }.look(browser, &html, &script);
        let (light, dark) = (of(false).white(), of(true).white());
        assert!(light > 0.6, "figure {figure} is {light} white in the light");
        assert!(dark < 0.02, "figure {figure} is {dark} white in the dark");
    }
}

#[test]
fn names_of_files_are_links_that_lead_somewhere() {
    let root = tempfile::tempdir().unwrap();
    links_resolve(&three_networks(root.path()));
}
