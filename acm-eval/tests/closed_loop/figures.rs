//! Figures: complete, counted, readable in the dark.

use acm_eval::closed_loop::figures::{self, matrix};
use acm_eval::closed_loop::{page, separability_page, separability_summary};
use acm_trace::finding::Separability;

use crate::{browser, findings, words};

#[test]
fn every_figure_draws_what_was_found() {
    for (name, finding) in findings::all() {
        for figure in figures::ALL {
            for drawing in (figure.draw)(&finding) {
                let svg = drawing.svg(figure.name, figure.question, "fixture");
                assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>"), "{name}: {}", figure.name);
                assert!(figure.question.ends_with('?') && drawing.explanation.lines().count() == 2, "{}", figure.name);
                assert!(
                    !svg.contains("NaN") && !svg.contains("inf\"") && !svg.contains("<script"),
                    "{name}: {}",
                    figure.name
                );
                assert_eq!(svg.contains("SYNTHETIC DATA"), finding.data.synthetic, "{name}: {}", figure.name);
                assert!(drawing.series > 0 && drawing.png(figure.name).is_ok(), "{name}: {}", figure.name);
            }
        }
    }
    let drawn: Vec<usize> = figures::ALL.iter().map(|figure| (figure.draw)(&findings::named()).len()).collect();
    assert_eq!(drawn, [1, 1, 1, 1, 1]);
    let none = (figures::TRIALS.draw)(&findings::no_effect());
    let svg = none[0].svg("trials", figures::TRIALS.question, "fixture");
    assert!(svg.contains(">nothing added<") && none[0].explanation.contains("Nothing was added"));
    let many: Vec<usize> = figures::ALL.iter().map(|figure| (figure.draw)(&findings::nine_outputs()).len()).collect();
    assert_eq!(many, [1, 5, 1, 1, 1], "one carrier for each of five effects");
}

/// Marks in the drawings: rows, dots and cells, counted by hand.
#[test]
fn the_svg_holds_what_was_counted() {
    let finding = findings::named();
    let svg = |figure: &figures::Figure| (figure.draw)(&finding)[0].svg(figure.name, figure.question, "fixture");
    assert_eq!(svg(&figures::INTERVALS).matches("<circle").count(), 4 + 1, "three baselines, after, and a key");
    assert_eq!(svg(&figures::TRIALS).matches("<circle").count(), 2 * 3 + 3, "trials × models, and three keys");
    assert_eq!(
        svg(&figures::CARRIER).matches("<circle").count(),
        2 * 900 + 2,
        "samples before and after, and two keys"
    );
    assert!(svg(&figures::INTERVALS).contains("+ recalibrated (best baseline)"));
    let cells = matrix::draw(&findings::separability()).unwrap().svg("matrix", matrix::QUESTION, "fixture");
    assert_eq!(cells.matches("<rect").count(), 1 + 9 * 9 + 9, "paper, pairs, and recalibration");
    assert!(cells.contains(">97<") || cells.contains(">94<"));
}

/// No effect, one effect, rows that are too short, numbers that are none, and more effects than a sheet holds.
#[test]
fn a_matrix_of_any_size_and_shape_is_shown() {
    let sized = |count: usize| Separability {
        effects: (0..count).map(|k| format!("effect {k}")).collect(),
        imitated: vec![vec![f64::NAN; count.saturating_sub(1)]; count / 2],
        by_recalibration: vec![2.0; count / 3],
        groups: vec![],
        ..findings::separability()
    };
    for count in [0, 1, 7, 80] {
        let html = separability_page(&sized(count));
        assert!(html.ends_with("</html>") && !words(&html).contains("NaN"), "{count} effects");
        assert!(!separability_summary(&sized(count)).is_empty());
    }
    assert!(matrix::draw(&sized(0)).is_none());
}

#[test]
fn figures_follow_the_dark_and_what_is_wide_scrolls() {
    let Some(name) = browser::browser() else { return eprintln!("skipped: no chromium on this machine") };
    let pages = [page(&findings::form_imperfect()), separability_page(&findings::separability())];
    for html in &pages {
        let phone = browser::DESK_AND_PHONE[1].ask(name, html, browser::UNMARKED);
        assert_eq!(phone, "some wide; silent: ");
        for figure in 0..html.matches("<figure ").count() {
            let script = format!(
                "const shown = document.querySelectorAll('figure svg')[{figure}]; \
                 document.body.replaceChildren(shown.parentElement.parentElement);"
            );
            let of = |dark| browser::Window { width: 1200, height: 500, dark }.look(name, html, &script).white();
            let (light, dark) = (of(false), of(true));
            assert!(light > 0.5, "figure {figure} is {light} white in the light");
            assert!(dark < 0.02, "figure {figure} is {dark} white in the dark");
        }
    }
}
