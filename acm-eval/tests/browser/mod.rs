//! Chromium, as a reader who measures.

#![allow(dead_code)] // each test file uses its part

use std::{path::Path, process::Command};

/// The name under which this machine has a browser.
pub fn browser() -> Option<&'static str> {
    let works = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find(works)
}

/// Widths of pages when each is shown in a frame of `width` px, everything unfolded: (name, width of the content).
pub fn widths(browser: &str, pages: &[(&str, String)], width: u32, root: &Path) -> Vec<(String, u32)> {
    let script = "<script>addEventListener('load', () => { \
        document.querySelectorAll('details').forEach(folded => folded.open = true); \
        parent.postMessage(name + '=' + document.documentElement.scrollWidth, '*'); });</script>";
    let frame = |(name, html): &(&str, String)| {
        std::fs::write(root.join(format!("{name}.html")), html.replace("</body>", &format!("{script}</body>")))
            .unwrap();
        format!("<iframe name=\"{name}\" src=\"{name}.html\" style=\"width:{width}px;height:800px;border:0\"></iframe>")
    };
    let frames: String = pages.iter().map(frame).collect();
    let listener = "<script>addEventListener('message', m => document.body.append('«' + m.data + '»'));</script>";
    std::fs::write(root.join("frames.html"), format!("<!doctype html><body>{listener}{frames}")).unwrap();
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
            "--virtual-time-budget=20000",
            "--dump-dom",
        ])
        .args(["--window-size=1500,900", "--allow-file-access-from-files"])
        .arg(format!("--user-data-dir={}", root.join("browser").display()))
        .arg(format!("file://{}", root.join("frames.html").display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let answers = dom.split('«').filter_map(|rest| rest.split_once('»')?.0.split_once('='));
    answers.filter_map(|(name, width)| Some((name.to_string(), width.parse().ok()?))).collect()
}
