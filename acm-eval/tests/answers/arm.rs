//! The arm in space: what the slider shows is in the table of predictions, and lies on the paper where the projection says.
//!
//! Oracles: the table as it lies in the run's folder, and the axonometric formula on its numbers.

use std::path::Path;

use acm_datasets::files::table::read_parquet;

use super::{
    DESK, DESK_AND_PHONE, Fixture, READER,
    browser::{Window, browser},
    page, recorded,
};

/// Tools of a reader: `slide(k)` moves the slider, `tip(name)` is a drawn tip with the numbers that it carries.
const ARM: &str = "\
    const arm = document.getElementById('made-up-arm'), stage = arm.querySelector('.stage svg'); \
    const slider = arm.querySelector('input[type=range]'); \
    const slide = k => { slider.value = k; slider.dispatchEvent(new Event('input', { bubbles: true })); }; \
    const tip3 = name => stage.querySelector(`circle[data-name=\"${name}\"]`); \
    const at = name => [tip3(name).cx.baseVal.value, tip3(name).cy.baseVal.value]; \
    const state = () => [stage.dataset.trial, stage.dataset.time, stage.dataset.azimuth, stage.dataset.elevation, \
        stage.dataset.scale, tip3('measured').dataset.point, tip3('Nominal').dataset.point, at('measured').join(' '), \
        at('Nominal').join(' ')].join('|'); ";

/// What the page shows.
#[derive(Debug)]
struct Shown {
    trial: String,
    time: f64,
    azimuth: f64,
    elevation: f64,
    scale: f64,
    /// Measured and nominal tip, mm.
    tips: [[f64; 3]; 2],
    /// The same on the paper, px.
    drawn: [[f64; 2]; 2],
}

fn numbers<const N: usize>(text: &str) -> [f64; N] {
    let all: Vec<f64> = text.split(' ').map(|word| word.parse().unwrap()).collect();
    all.try_into().unwrap()
}

impl Shown {
    fn of(said: &str) -> Self {
        let parts: Vec<&str> = said.split('|').collect();
        let [time, azimuth, elevation, scale] = [1, 2, 3, 4].map(|k: usize| parts[k].parse().unwrap());
        let tips = [numbers(parts[5]), numbers(parts[6])];
        let drawn = [numbers(parts[7]), numbers(parts[8])];
        Self { trial: parts[0].into(), time, azimuth, elevation, scale, tips, drawn }
    }

    /// The way from the nominal tip to the measured one is drawn as the projection says, to a tenth of a px.
    fn assert_projected(&self) {
        let [measured, nominal] = self.tips;
        let [x, y, z]: [f64; 3] = std::array::from_fn(|o| measured[o] - nominal[o]);
        let ((sa, ca), (se, ce)) = (self.azimuth.to_radians().sin_cos(), self.elevation.to_radians().sin_cos());
        let wanted = [self.scale * (y * ca - x * sa), -self.scale * (z * ce - (x * ca + y * sa) * se)];
        for (k, wanted) in wanted.into_iter().enumerate() {
            let found = self.drawn[0][k] - self.drawn[1][k];
            assert!((found - wanted).abs() < 0.1, "{found} px, not {wanted}: {self:?}");
        }
    }
}

/// Time (s), measured and nominal tip (mm) of every held-out sample of a trial.
fn table(root: &Path, trial: &str) -> Vec<(f64, [[f64; 3]; 2])> {
    let columns = read_parquet(&root.join("cfc/predictions/final-seed1.parquet")).unwrap();
    let column = |name: &str| &columns.iter().find(|(known, _)| known == name).unwrap().1;
    let words = |name: &str| column(name).text().unwrap();
    let values = |name: String| column(&name).numbers().unwrap().to_vec();
    let (trials, parts, time) = (words("trial"), words("part"), values("time".into()));
    let tips = ["measured", "nominal"].map(|what| ["x", "y", "z"].map(|output| values(format!("{what}_{output}"))));
    let rows = (0..time.len()).filter(|&row| trials[row] == trial && parts[row] == "held_out");
    rows.map(|row| (time[row], [0, 1].map(|w| [0, 1, 2].map(|o| 1e3 * tips[w][o][row])))).collect()
}

fn html(root: &Path, fixture: Fixture) -> String {
    std::fs::read_to_string(page(&[fixture], root)).unwrap()
}

/// The poses have every second row of the table.
#[test]
fn the_slider_shows_the_rows_of_the_table() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = html(root.path(), Fixture::default());
    let rows = table(root.path(), "10");
    for window in DESK_AND_PHONE {
        for k in [0, 13, 59] {
            let shown = Shown::of(&window.ask(browser, &html, &format!("{ARM} slide({k}); return state();")));
            let (time, tips) = rows[2 * k];
            assert_eq!(shown.trial, "10");
            assert!((shown.time - time).abs() < 1e-4, "{shown:?}, not at {time} s");
            for (found, wanted) in shown.tips.as_flattened().iter().zip(tips.as_flattened()) {
                assert!((found - wanted).abs() < 1e-3, "{shown:?}, not {tips:?}");
            }
            shown.assert_projected();
        }
    }
}

/// Keys turn by five degrees, with Shift by thirty; a drag of 100 px by fifty; 0 goes back.
#[test]
fn keys_and_a_drag_turn_the_arm() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = html(root.path(), Fixture::default());
    let script = format!(
        "{ARM} const card = arm.querySelector('.card'), said = [state()]; slide(13); \
         const press = (key, more = {{}}) => card.dispatchEvent(new KeyboardEvent('keydown', {{ key, bubbles: true, ...more }})); \
         const send = (type, x, y) => stage.dispatchEvent(new PointerEvent(type, {{ clientX: x, clientY: y, bubbles: true, \
             pointerType: 'mouse', button: 0, pointerId: 1, cancelable: true }})); \
         press('ArrowRight'); press('ArrowUp', {{ shiftKey: true }}); said.push(state()); \
         send('pointerdown', 300, 300); send('pointermove', 400, 320); send('pointerup', 400, 320); \
         send('pointermove', 500, 500); said.push(state()); \
         press('+'); said.push(state()); press('0'); said.push(state()); return said.join(';');"
    );
    let said = DESK.ask(browser, &html, &script);
    let shown: Vec<Shown> = said.split(';').map(Shown::of).collect();
    shown.iter().for_each(Shown::assert_projected);
    let views: Vec<(f64, f64)> = shown.iter().map(|shown| (shown.azimuth, shown.elevation)).collect();
    assert_eq!(views, [(-60.0, 18.0), (-55.0, 48.0), (-105.0, 58.0), (-105.0, 58.0), (-60.0, 18.0)]);
    assert!((shown[3].scale / shown[2].scale - 1.5).abs() < 1e-9 && shown[4].scale == shown[0].scale, "{said}");
}

/// The arrow of the residual is as many times longer as is told, and loads are drawn with their sizes.
#[test]
fn the_scale_of_the_arrow_is_told() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = html(root.path(), Fixture::default());
    let script = format!(
        "{ARM} slide(13); const select = [...arm.querySelectorAll('select')].at(-1); \
         const length = () => stage.querySelector('.residual').getTotalLength(), said = []; \
         const off = Math.hypot(at('measured')[0] - at('Nominal')[0], at('measured')[1] - at('Nominal')[1]); \
         for (const factor of ['1', '5']) {{ select.value = factor; select.dispatchEvent(new Event('change')); \
             const legend = arm.querySelector('.reads').textContent; \
             said.push((length() / off).toFixed(1) + (legend.includes('\\u00d7' + factor) ? ' told' : ' not told')); }} \
         const legend = arm.querySelector('.reads').textContent; \
         return [...said, legend.includes('weight, its direction alone'), /downwash 0.4125/.test(legend), \
             stage.querySelector('.backbone').dataset.points].join(', ');"
    );
    assert_eq!(DESK.ask(browser, &html, &script), "1.0 told, 5.0 told, true, true, 5");
}

/// The slider moves the cursor of the errors over time, and that cursor moves the slider.
#[test]
fn one_cursor_goes_through_the_errors_and_the_arm() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = html(root.path(), Fixture::default());
    let script = format!(
        "{READER} {ARM} point(vertex(14)); const followed = slider.value, time = stage.dataset.time; \
         slide(20); const hairs = [...svg.querySelectorAll('.hair')], x = vertex(40).x; \
         const screen = new DOMPoint(hairs[0].x1.baseVal.value, 0).matrixTransform(hairs[0].getScreenCTM()).x; \
         return [followed, time, hairs.length, Math.abs(screen - x) < 0.5].join(' ');"
    );
    let time = recorded(root.path(), "cfc")[14].0;
    assert_eq!(DESK.ask(browser, &html, &script), format!("7 {time} 1 true"), "slider, time, cursors, on the sample");
}

#[test]
fn another_trial_has_its_own_samples() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = html(root.path(), Fixture { delay: 2.0, ..Fixture::default() });
    let script = format!(
        "{ARM} const select = arm.querySelector('select'); select.value = '11'; select.dispatchEvent(new Event('change')); \
         slide(13); return state();"
    );
    let shown = Shown::of(&DESK.ask(browser, &html, &script));
    let (time, tips) = table(root.path(), "11")[26];
    assert!(shown.trial == "11" && (shown.time - time).abs() < 1e-4, "{shown:?}, not at {time} s");
    assert!((shown.tips[0][2] - tips[0][2]).abs() < 1e-3, "{shown:?}");
}

/// A download has a line for each line of the file beside the page.
#[test]
fn its_download_is_its_file() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = html(root.path(), Fixture::default());
    let script = format!(
        "{ARM} const made = [], Real = Blob; HTMLAnchorElement.prototype.click = () => {{}}; \
         window.Blob = function (parts, kind) {{ made.push(parts.join('')); return new Real(parts, kind); }}; \
         [...arm.querySelectorAll('.tools button')].at(-1).click(); \
         const lines = made[0].trimEnd().split('\\n'); return [lines.length, lines[0], lines[5], lines[6]].join(';');"
    );
    let said = DESK.ask(browser, &html, &script);
    let file = std::fs::read_to_string(root.path().join("report/figures/made-up-arm.csv")).unwrap();
    let lines: Vec<&str> = file.lines().collect();
    // Two trials of 60 samples, each of an arm of 5 points and 3 tips.
    assert_eq!(lines.len(), 1 + 2 * 60 * (5 + 3));
    let parts: Vec<&str> = said.split(';').collect();
    assert_eq!(parts[..2], [lines.len().to_string().as_str(), lines[0]]);
    let values = |line: &str| line.split(',').filter_map(|field| field.parse().ok()).collect::<Vec<f64>>();
    for (found, wanted) in parts[2..].iter().zip(&lines[5..7]) {
        assert!(values(found).iter().zip(values(wanted)).all(|(a, b)| (a - b).abs() < 0.06), "{found}, not {wanted}");
    }
}

/// Without poses the tip alone is drawn, and why is said; without a script the drawing stands, and no control without use.
#[test]
fn the_tip_alone_is_drawn_where_there_is_no_arm() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = html(root.path(), Fixture { poses: false, ..Fixture::default() });
    assert!(html.contains("The tip alone is drawn: the nominal model is a polynomial, which knows no arm."));
    let script = format!("{ARM} slide(7); return [state(), stage.querySelectorAll('.backbone').length].join('#');");
    let said = DESK.ask(browser, &html, &script);
    let (state, arms) = said.split_once('#').unwrap();
    Shown::of(state).assert_projected();
    assert_eq!(arms, "0");
    let (still, _) = html.rsplit_once("<script>").unwrap();
    let script = "const box = document.getElementById('made-up-arm'); \
        return [box.querySelector('svg').getBoundingClientRect().width > 300, box.querySelectorAll('button, input').length].join(' ');";
    assert_eq!(DESK.ask(browser, &format!("{still}</body></html>"), script), "true 0");
}

/// From 400 to 1600 px, in the light and in the dark, the drawing fills its card and nothing of it sticks out.
#[test]
fn it_is_drawn_as_wide_as_the_window_allows() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = html(root.path(), Fixture::default());
    let script = format!(
        "{ARM} slide(30); const card = arm.querySelector('.card'), box = stage.getBoundingClientRect(); \
         const out = [...stage.querySelectorAll('circle, .backbone, text')].filter(x => {{ const r = x.getBoundingClientRect(); \
             return r.left < box.left - 1 || r.right > box.right + 1 || r.top < box.top - 1 || r.bottom > box.bottom + 1; }}); \
         return [card.scrollWidth <= card.clientWidth, box.width > 0.9 * card.clientWidth, out.length, \
             document.documentElement.scrollWidth <= innerWidth].join(' ');"
    );
    for width in [400, 1000, 1600] {
        let window = Window { width, height: 800, dark: width == 1000 };
        assert_eq!(window.ask(browser, &html, &script), "true true 0 true", "{width} px");
    }
}
