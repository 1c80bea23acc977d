//! The page of all studies in a browser: nothing wider than the window, no empty figure, no word on the console.

use std::process::Command;

use super::{
    browser::{browser, links_resolve},
    conducted::folder,
};

#[test]
fn a_browser_shows_it_whole() {
    let Some(browser) = browser() else {
        eprintln!("skipped: no chromium on this machine");
        return;
    };
    let html = std::fs::read_to_string(folder().join("page/report.html")).unwrap();
    let figures = html.matches("<figure ").count();
    assert!(figures >= 5 + 3 + 1 + 1 + 6, "{figures} figures");
    for width in [400, 1200, 1400] {
        let (answer, console) = look(browser, &html, width);
        assert_eq!(
            answer,
            format!("page {width} of {width}, {figures} figures, empty 0, identifiers repeated 0, broken links 0")
        );
        assert!(!console.contains("CONSOLE"), "{console}");
    }
}

/// The page in a frame of the given width, everything unfolded, with a script that measures it; and what the browser logged.
fn look(browser: &str, html: &str, width: u32) -> (String, String) {
    let script = "<script>addEventListener('load', () => { const d = document, e = d.documentElement; \
        d.querySelectorAll('details').forEach(folded => folded.open = true); \
        const ids = [...d.querySelectorAll('[id]')].map(x => x.id); \
        const boxes = [...d.querySelectorAll('figure .sheet:not([hidden]) svg')].map(svg => svg.getBBox()); \
        const empty = boxes.filter(box => box.width < 200 || box.height < 100).length; \
        const broken = [...d.querySelectorAll('a[href^=\"#\"]')].filter(a => !d.getElementById(a.hash.slice(1))).length; \
        parent.postMessage(`page ${e.scrollWidth} of ${innerWidth}, ${boxes.length} figures, empty ${empty}, \
        identifiers repeated ${ids.length - new Set(ids).size}, broken links ${broken}`, '*'); });</script>";
    let frame = format!(
        "<!doctype html><iframe src=\"inside.html\" style=\"width:{width}px;height:800px;border:0\"></iframe>\
         <script>addEventListener('message', m => document.body.append('«' + m.data + '»'));</script>"
    );
    let root = tempfile::tempdir().unwrap();
    std::fs::write(root.path().join("inside.html"), html.replace("</body>", &format!("{script}</body>"))).unwrap();
    std::fs::write(root.path().join("frame.html"), frame).unwrap();
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--virtual-time-budget=20000"])
        .args(["--window-size=1500,900", "--allow-file-access-from-files", "--enable-logging=stderr", "--dump-dom"])
        .arg(format!("--user-data-dir={}", root.path().join("browser").display()))
        .arg(format!("file://{}", root.path().join("frame.html").display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let answer = dom.rsplit_once('«').and_then(|(_, rest)| rest.split_once('»')).map(|(answer, _)| answer.to_string());
    let console = String::from_utf8_lossy(&output.stderr).into_owned();
    (answer.unwrap_or_else(|| panic!("the page did not answer: {dom}")), console)
}

#[test]
fn every_table_and_figure_has_its_files() {
    let page = folder().join("page");
    let html = std::fs::read_to_string(page.join("report.html")).unwrap();
    let count = |inside: &str, extension: &str| {
        let files = std::fs::read_dir(page.join(inside)).unwrap().map(|entry| entry.unwrap().path());
        files.filter(|path| path.extension().is_some_and(|found| found == extension)).count()
    };
    let (figures, tables) = (html.matches("<figure ").count(), html.matches("<table").count());
    assert_eq!([count("figures", "svg"), count("figures", "png")], [figures; 2]);
    // The first screen has its main table twice: in brief, and whole.
    assert_eq!([count("tables", "csv"), count("tables", "tex")], [tables - 1; 2]);
    links_resolve(&page.join("report.html"));
    let tex = std::fs::read_to_string(page.join("tables/ablation-ablation.tex")).unwrap();
    assert!(tex.contains("\\begin{tabular}") && tex.contains("Synthetic data"), "{tex}");
}

/// A study that was stopped has runs without records.
#[test]
fn an_unfinished_study_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let study = root.path().join("ablation");
    std::fs::create_dir_all(study.join("runs")).unwrap();
    std::fs::copy(folder().join("ablation/study.json"), study.join("study.json")).unwrap();
    let output = assert_cmd::cargo::cargo_bin_cmd!("acm-eval").arg("report").arg(&study).assert().code(2);
    let message = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
    assert!(message.contains("not finished") && message.contains("--resume"), "{message}");
}
