//! The page answers: what its script reads, sorts and saves is what the records say.
//!
//! Oracle of all values: the table of predictions as it lies in the run's folder, and where the figure's own lines were
//! drawn, which the script knows nothing of.

#[path = "answers/arm.rs"]
mod arm;
mod browser;
mod fixture;

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use acm_datasets::files::table::{Column, read_parquet};
use assert_cmd::cargo::cargo_bin_cmd;
use browser::{DESK_AND_PHONE, Window, browser};
use fixture::{Fixture, write};

const DESK: Window = DESK_AND_PHONE[0];

fn page(fixtures: &[Fixture], root: &Path) -> PathBuf {
    let runs: Vec<_> = fixtures.iter().map(|fixture| write(fixture, root, fixture.kind)).collect();
    cargo_bin_cmd!("acm-eval").arg("report").args(runs).arg("--out").arg(root.join("report")).assert().success();
    root.join("report/report.html")
}

/// Tools of a reader: `vertex(k)` is where the k-th point of the first drawn line lies on the screen, `point` moves the
/// mouse there, `said` is what the page says under it.
const READER: &str = "\
    const box = document.getElementById('made-up-time'), svg = box.querySelector('svg'); \
    box.scrollIntoView({ block: 'center' }); \
    const lines = [...svg.querySelectorAll('g[clip-path]')].map(panel => [...panel.querySelectorAll('path')]); \
    const vertex = (k, panel = 0) => { \
        const path = lines[panel][0], numbers = path.getAttribute('d').match(/[-0-9.e]+/g).map(Number); \
        return new DOMPoint(numbers[2 * k], numbers[2 * k + 1]).matrixTransform(path.getScreenCTM()); }; \
    const send = (type, at) => svg.dispatchEvent(new PointerEvent(type, { clientX: at.x, clientY: at.y, bubbles: true, \
        pointerType: 'mouse', button: 0, pointerId: 1, cancelable: true })); \
    const point = at => send('pointermove', at); \
    const tip = box.querySelector('.tip'); \
    const said = () => tip.hidden ? 'nothing' : [tip.querySelector('.where').textContent, \
        ...[...tip.querySelectorAll('b')].map(x => x.textContent)].join('|').replaceAll('\\u00a0', ' '); ";

/// (time in s, errors in mm) of what the page says: `time 7.3 s|12.3 mm|2.5 mm`.
fn numbers(said: &str) -> (f64, Vec<f64>) {
    let mut parts = said.split('|');
    let number = |part: &str, unit: &str| {
        let part = part.trim_start_matches("time ").strip_suffix(unit).unwrap_or_else(|| panic!("{said}"));
        part.trim().parse::<f64>().unwrap_or_else(|_| panic!("{said}"))
    };
    let time = number(parts.next().unwrap(), "s");
    (time, parts.map(|part| number(part, "mm")).collect())
}

/// Time (s) and 3-D error (mm) of nominal model and network on trial 10 for the seed with the median error.
fn recorded(root: &Path, kind: &str) -> Vec<(f64, [f64; 2])> {
    let table: BTreeMap<String, Column> =
        read_parquet(&root.join(kind).join("predictions/final-seed2.parquet")).unwrap().into_iter().collect();
    let words = |name: &str| match &table[name] {
        Column::Text(values) => values.clone(),
        _ => panic!("{name}"),
    };
    let values = |name: String| match &table[&name] {
        Column::Number(values) => values.clone(),
        _ => panic!("{name}"),
    };
    let (trial, part, time) = (words("trial"), words("part"), values("time".into()));
    let off = |estimate: &str, row: usize| {
        let square = |output| {
            let of = |what: &str| values(format!("{what}_{output}"))[row];
            (of("measured") - of(estimate)).powi(2)
        };
        1e3 * ["x", "y", "z"].map(square).iter().sum::<f64>().sqrt()
    };
    let rows = (0..time.len()).filter(|&row| trial[row] == "10" && part[row] == "held_out");
    rows.map(|row| (time[row], [off("nominal", row), off("predicted", row)])).collect()
}

fn assert_row(said: &str, (time, errors): &(f64, [f64; 2])) {
    let (at, read) = numbers(said);
    assert!((at - time).abs() < 5e-3, "{said}: at {at} s, not {time} s");
    for (read, error) in read.iter().zip(errors) {
        assert!((read - error).abs() <= 1e-3 * error + 1e-4, "{said}: {read} mm, not {error} mm");
    }
    assert_eq!(read.len(), 2, "{said}");
}

#[test]
fn what_stands_under_the_cursor_is_in_the_table_of_predictions() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(page(&[Fixture::default()], root.path())).unwrap();
    let rows = recorded(root.path(), "cfc");
    for window in DESK_AND_PHONE {
        for k in [0, 7, 31, 58] {
            let script = format!("{READER} point(vertex({k})); return said();");
            assert_row(&window.ask(browser, &html, &script), &rows[k]);
        }
    }
    let away = format!("{READER} point(vertex(7)); send('pointerleave', vertex(7)); return said();");
    assert_eq!(DESK.ask(browser, &html, &away), "nothing");
}

/// From the 10th to the 40th point: what was at the left edge is the 10th point then, and the first again afterwards.
#[test]
fn a_drag_zooms_and_a_double_click_goes_back() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(page(&[Fixture::default()], root.path())).unwrap();
    let rows = recorded(root.path(), "cfc");
    let script = format!(
        "{READER} const left = vertex(0), [a, b] = [vertex(10), vertex(40)]; \
         send('pointerdown', a); send('pointermove', b); send('pointerup', b); \
         point(left); const zoomed = said(), drawn = svg.querySelectorAll('.live').length; \
         svg.dispatchEvent(new MouseEvent('dblclick', {{ bubbles: true }})); \
         point(left); return [zoomed, said(), drawn, svg.querySelectorAll('.live').length].join(';');"
    );
    let said = DESK.ask(browser, &html, &script);
    let parts: Vec<&str> = said.split(';').collect();
    assert_row(parts[0], &rows[10]);
    assert_row(parts[1], &rows[0]);
    assert_eq!(parts[2..], ["1", "0"], "panels that are zoomed: that of trial 10, then none");
}

/// Arrow keys go from sample to sample, `+` zooms, `0` goes back; the figure is one stop of the tab key.
#[test]
fn the_keyboard_reads_and_zooms() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(page(&[Fixture::default()], root.path())).unwrap();
    let rows = recorded(root.path(), "cfc");
    let script = format!(
        "{READER} const card = box.querySelector('.card'); card.focus(); \
         const press = key => card.dispatchEvent(new KeyboardEvent('keydown', {{ key, bubbles: true, cancelable: true }})); \
         point(vertex(20)); press('ArrowRight'); press('ArrowRight'); press('ArrowLeft'); const read = said(); \
         press('+'); const zoomed = svg.querySelectorAll('.live').length; press('0'); \
         return [read, zoomed, svg.querySelectorAll('.live').length, card.tabIndex].join(';');"
    );
    let said = DESK.ask(browser, &html, &script);
    let parts: Vec<&str> = said.split(';').collect();
    assert_row(parts[0], &rows[21]);
    assert_eq!(parts[1..], ["1", "0", "0"]);
}

/// Three networks have a row of panels each, in each a panel of trial 10 and one of trial 11.
#[test]
fn one_cursor_goes_through_all_panels_of_a_trial() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let fixtures = ["mlp", "gru", "cfc"].map(|kind| Fixture { kind, ..Fixture::default() });
    let html = std::fs::read_to_string(page(&fixtures, root.path())).unwrap();
    let script = format!(
        "{READER} point(vertex(12)); const hairs = [...svg.querySelectorAll('.hair')]; \
         return [hairs.length, new Set(hairs.map(x => Math.round(x.x1.baseVal.value))).size, \
         lines.length, tip.querySelectorAll('b').length].join(' ');"
    );
    assert_eq!(DESK.ask(browser, &html, &script), "3 1 6 6", "hairs, their places, panels, values");
}

#[test]
fn a_table_is_sorted_by_any_column_and_back() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let gains = [("mlp", 3.0), ("gru", 20.0), ("cfc", 1.0)];
    let fixtures = gains.map(|(kind, gain)| Fixture { kind, gain, ..Fixture::default() });
    let html = std::fs::read_to_string(page(&fixtures, root.path())).unwrap();
    let script = "const table = document.getElementById('made-up-table-errors').nextElementSibling\
            .nextElementSibling.querySelector('table'); \
        const heads = [...table.tHead.rows[0].cells], column = heads.findIndex(x => x.textContent.startsWith('3-D')); \
        const shown = () => [...table.tBodies[0].rows].map(x => parseFloat(x.cells[column].textContent)).join(' '); \
        const said = [shown()]; \
        for (let turn = 0; turn < 3; turn++) { heads[column].querySelector('button').click(); \
            said.push(heads[column].getAttribute('aria-sort') + ' ' + shown()); } \
        return said.join(';');";
    let said = DESK.ask(browser, &html, script);
    let parts: Vec<&str> = said.split(';').collect();
    let values = |part: &str| -> Vec<f64> { part.split(' ').filter_map(|word| word.parse().ok()).collect() };
    let before = values(parts[0]);
    let mut sorted = before.clone();
    sorted.sort_by(f64::total_cmp);
    assert!(before.len() >= 5 && before != sorted, "{said}");
    assert!(parts[1].starts_with("ascending ") && values(parts[1]) == sorted, "{said}");
    sorted.reverse();
    assert!(parts[2].starts_with("descending ") && values(parts[2]) == sorted, "{said}");
    assert!(parts[3].starts_with("none ") && values(parts[3]) == before, "{said}");
}

/// A table's download is its file, byte for byte; a figure's has a line for each point of its file.
#[test]
fn downloads_are_the_files_beside_the_page() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let file = page(&[Fixture::default()], root.path());
    let html = std::fs::read_to_string(&file).unwrap();
    let beside = |name: &str| std::fs::read_to_string(file.parent().unwrap().join(name)).unwrap();
    // A download that is begun may keep the browser from ending: what it would hold is enough.
    let script = "const made = [], Real = Blob; HTMLAnchorElement.prototype.click = () => {}; \
        window.Blob = function (parts, kind) { made.push(parts.join('')); return new Real(parts, kind); }; \
        document.querySelector('button[aria-label=\"Download made-up-errors.csv\"]').click(); \
        [...document.getElementById('made-up-time').querySelectorAll('.tools button')].at(-1).click(); \
        return made.map(text => text.trimEnd().split('\\n').map(x => encodeURIComponent(x)).join('/')).join(';');";
    let said = DESK.ask(browser, &html, script);
    let (table, figure) = said.split_once(';').unwrap();
    let lines = |text: &str| text.split('/').map(String::from).collect::<Vec<String>>();
    let plain = |line: &str| line.replace("%2C", ",").replace("%20", " ").replace("%5B", "[").replace("%5D", "]");
    let table: Vec<String> = lines(table).iter().map(|line| plain(line)).collect();
    let wanted = beside("tables/made-up-errors.csv");
    let numbers = |line: &str| line.split(',').filter_map(|field| field.parse().ok()).collect::<Vec<f64>>();
    assert_eq!(table.len(), wanted.lines().count());
    for (line, wanted) in table.iter().zip(wanted.lines()) {
        assert_eq!(numbers(line), numbers(wanted), "{line}");
    }
    // Both trials, each of two models and 120 samples, below a heading.
    assert_eq!(lines(figure).len(), 1 + 2 * 2 * 120);
    assert_eq!(beside("figures/made-up-time.csv").lines().count(), 1 + 2 * 2 * 120);
}

/// Oracle: the formula of WCAG 2.1 on the colours that the browser computed, with one value of the page under the cursor.
const CONTRAST: &str = "\
    document.querySelectorAll('details').forEach(folded => folded.open = true); \
    const colour = text => { const v = text.match(/[\\d.]+/g).map(Number); return [v[0], v[1], v[2], v[3] ?? 1]; }; \
    const over = (a, b) => [0, 1, 2].map(k => a[3] * a[k] + (1 - a[3]) * b[k]).concat(1); \
    const light = c => { const [r, g, b] = c.map(v => v / 255).map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4); \
        return 0.2126 * r + 0.7152 * g + 0.0722 * b; }; \
    const ground = x => { const own = colour(getComputedStyle(x).backgroundColor); \
        return own[3] === 1 ? own : over(own, x.parentElement ? ground(x.parentElement) : [255, 255, 255, 1]); }; \
    const bad = []; let checked = 0; \
    for (const x of document.querySelectorAll('body *')) { \
        if (![...x.childNodes].some(n => n.nodeType === 3 && n.data.trim()) || !x.getClientRects().length) continue; \
        if (x.closest('button:disabled, script, title, desc')) continue; \
        const style = getComputedStyle(x), ink = x.closest('svg') ? style.fill : style.color, paper = ground(x); \
        const [a, b] = [light(over(colour(ink), paper)), light(paper)]; checked++; \
        const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05); \
        if (ratio < 4.5) bad.push(x.tagName + '.' + x.className + ' ' + x.textContent.slice(0, 20) + ' ' + ratio.toFixed(2)); \
    } \
    return (checked > 100) + ' ' + bad.slice(0, 5).join(', ');";

#[test]
fn words_stand_out_in_the_light_and_in_the_dark() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(page(&[Fixture::default()], root.path())).unwrap();
    for dark in [false, true] {
        let window = Window { width: 1200, height: 800, dark };
        let said = window.ask(browser, &html, &format!("{READER} point(vertex(7)); {CONTRAST}"));
        assert_eq!(said, "true ", "dark: {dark}");
    }
}

/// Whatever takes the focus has a name, and takes it in the order of the page.
#[test]
fn whatever_takes_the_focus_has_a_name_and_its_turn() {
    let Some(browser) = browser() else { return eprintln!("skipped: no chromium on this machine") };
    let root = tempfile::tempdir().unwrap();
    let html = std::fs::read_to_string(page(&[Fixture::default()], root.path())).unwrap();
    let script = "const stops = [...document.querySelectorAll('a[href], button, summary, select, input, [tabindex]')]; \
        const name = x => x.getAttribute('aria-label') || x.labels?.[0]?.firstChild.textContent.trim() || x.textContent.trim() || \
            document.getElementById(x.getAttribute('aria-labelledby'))?.textContent; \
        const nameless = stops.filter(x => !name(x)), forced = stops.filter(x => x.tabIndex > 0); \
        const box = x => x.getBoundingClientRect(); \
        const small = [...document.querySelectorAll('.tools :is(button, select, input), button.tool')].filter(x => x.getClientRects().length \
            && box(x).height < 24); \
        const back = [...document.querySelectorAll('figure')].flatMap(figure => { \
            const own = stops.filter(x => figure.contains(x) && x.getClientRects().length); \
            return own.slice(1).filter((x, k) => box(x).bottom <= box(own[k]).top || (box(x).top < box(own[k]).bottom \
                && box(own[k]).top < box(x).bottom && box(x).left < box(own[k]).left && !own[k].contains(x))); }); \
        return [stops.length > 40, document.querySelectorAll('input').length, nameless.length, forced.length, small.length, \
            back.map(x => x.outerHTML.slice(0, 60)).join()].join(' ');";
    for window in DESK_AND_PHONE {
        let said = window.ask(browser, &html, script);
        assert_eq!(said, "true 1 0 0 0 ", "stops, sliders, nameless, out of turn, too small, before what they follow");
    }
}
