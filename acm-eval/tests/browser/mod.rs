//! Chromium, as a reader who measures and looks.

#![allow(dead_code)] // each test file uses its part

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The name under which this machine has a browser.
pub fn browser() -> Option<&'static str> {
    let works = |name: &&str| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find(works)
}

/// Refuses a page that loads anything: it can be mailed, archived and opened without a network.
pub fn loads_nothing(name: &str, html: &str) {
    for loading in [
        "src=",
        "<link",
        "<script src",
        "fetch(",
        "XMLHttpRequest",
        "@import",
        "url(http",
        "href=\"http",
        "<image",
        "<iframe",
    ] {
        assert!(!html.contains(loading), "{name} has {loading}");
    }
}

/// How a reader's window is.
#[derive(Clone, Copy)]
pub struct Window {
    /// px.
    pub width: u32,
    /// px.
    pub height: u32,
    /// Whether the reader prefers dark pages.
    pub dark: bool,
}

/// 1200 × 800 and 400 × 800 px, in the light.
pub const DESK_AND_PHONE: [Window; 2] =
    [Window { width: 1200, height: 800, dark: false }, Window { width: 400, height: 800, dark: false }];

impl Window {
    /// What `script`, an expression of JavaScript, says of the page.
    pub fn ask(self, browser: &str, html: &str, script: &str) -> String {
        let script = format!(
            "<script>addEventListener('load', () => parent.postMessage(String((() => {{ {script} }})()), '*'));</script>"
        );
        let root = tempfile::tempdir().unwrap();
        let frame = self.frame(&html.replace("</body>", &format!("{script}</body>")), root.path());
        let output = self.command(browser, root.path()).arg("--dump-dom").arg(frame).output().unwrap();
        let dom = String::from_utf8_lossy(&output.stdout).into_owned();
        // The script's own text has the marks, too: the answer is after the last one.
        let answer = dom.rsplit_once('«').and_then(|(_, rest)| rest.split_once('»'));
        answer.map(|(answer, _)| answer.to_string()).unwrap_or_else(|| panic!("the page did not answer: {dom}"))
    }

    /// The window as pixels, after `script` ran.
    pub fn look(self, browser: &str, html: &str, script: &str) -> Picture {
        let script = format!("<script>addEventListener('load', () => {{ {script} }});</script>");
        let root = tempfile::tempdir().unwrap();
        let frame = self.frame(&html.replace("</body>", &format!("{script}</body>")), root.path());
        let file = root.path().join("seen.png");
        let output = self
            .command(browser, root.path())
            .arg("--hide-scrollbars")
            .arg(format!("--screenshot={}", file.display()))
            .arg(frame)
            .output()
            .unwrap();
        assert!(file.is_file(), "no screenshot: {}", String::from_utf8_lossy(&output.stderr));
        Picture::read(&file).cut(self.width, self.height)
    }

    /// The page in a frame, for a headless window has a least width.
    fn frame(self, html: &str, root: &Path) -> String {
        let Self { width, height, .. } = self;
        let frame = format!(
            "<!doctype html><meta name=\"color-scheme\" content=\"light dark\"><body style=\"margin:0\">\
             <iframe src=\"inside.html\" style=\"display:block;width:{width}px;height:{height}px;border:0\"></iframe>\
             <script>addEventListener('message', m => document.body.append('«' + m.data + '»'));</script>"
        );
        fs::write(root.join("inside.html"), html).unwrap();
        fs::write(root.join("frame.html"), frame).unwrap();
        format!("file://{}", root.join("frame.html").display())
    }

    fn command(self, browser: &str, root: &Path) -> Command {
        let mut command = Command::new(browser);
        command
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"])
            .args(["--disable-component-update", "--disable-sync", "--no-first-run"])
            .args(["--virtual-time-budget=20000", "--allow-file-access-from-files"])
            .arg(format!("--window-size=1500,{}", self.height.max(900)))
            .arg(format!("--blink-settings=preferredColorScheme={}", u8::from(!self.dark)))
            .arg(format!("--user-data-dir={}", root.join("browser").display()));
        command
    }
}

/// Pixels, red, green and blue.
pub struct Picture {
    /// px.
    pub width: usize,
    /// Row by row.
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    fn read(file: &PathBuf) -> Self {
        let mut decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(file).unwrap()));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        let pixels = bytes.chunks(info.color_type.samples()).map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
        Self { width: info.width as usize, pixels }
    }

    fn cut(&self, width: u32, height: u32) -> Self {
        let rows = self.pixels.chunks(self.width).take(height as usize);
        Self { width: width as usize, pixels: rows.flat_map(|row| &row[..width as usize]).copied().collect() }
    }

    /// Share of the pixels that are white, or nearly.
    pub fn white(&self) -> f64 {
        let white = self.pixels.iter().filter(|pixel| pixel.iter().all(|channel| *channel > 240)).count();
        white as f64 / self.pixels.len() as f64
    }
}

/// Everything unfolded: of each box that is wider inside than outside, what tells a reader that it scrolls, and the boxes
/// that do not tell.
pub const UNMARKED: &str = "document.querySelectorAll('details').forEach(folded => folded.open = true); \
    let wide = 0; const silent = []; \
    for (const box of document.querySelectorAll('body *')) { \
        if (box.closest('svg') || box.scrollWidth <= box.clientWidth + 1 || !box.clientWidth) continue; \
        const style = getComputedStyle(box); \
        if (style.overflowX === 'visible' && style.display === 'inline') continue; \
        wide++; \
        const shadows = style.backgroundAttachment.includes('local') && style.backgroundAttachment.includes('scroll'); \
        const bar = box.offsetHeight - box.clientHeight; \
        if (style.overflowX !== 'auto' || !shadows || bar < 6) \
            silent.push(box.tagName + '.' + box.className + ' ' + style.overflowX + ' ' + shadows + ' ' + bar); \
    } \
    return (wide > 0 ? 'some' : 'none') + ' wide; silent: ' + silent.slice(0, 5).join(', ');";

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

/// Targets of the page's links to files, each as it is written.
pub fn links(html: &str) -> Vec<String> {
    let targets = html.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next());
    targets.filter(|target| !target.starts_with('#')).map(String::from).collect()
}

/// Every link leads to a file that is there and has something in it; and every file in `figures` and `tables` is linked.
pub fn links_resolve(page: &Path) {
    let folder = page.parent().unwrap();
    let links = links(&fs::read_to_string(page).unwrap());
    for link in &links {
        let file = folder.join(link);
        assert!(fs::metadata(&file).is_ok_and(|file| file.is_file() && file.len() > 0), "{link} leads nowhere");
    }
    for inside in ["figures", "tables"] {
        let mut found = 0;
        for entry in fs::read_dir(folder.join(inside)).unwrap() {
            let name = format!("{inside}/{}", entry.unwrap().file_name().to_string_lossy());
            assert!(links.contains(&name), "nothing links to {name}");
            found += 1;
        }
        assert!(found > 0, "no file in {inside}");
    }
}
