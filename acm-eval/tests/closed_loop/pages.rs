//! Pages: in the order in which readers ask, marked where synthetic, and whole whatever the numbers are.

use acm_eval::closed_loop::figures::matrix;
use acm_eval::closed_loop::{page, separability_page, separability_summary, summary};
use acm_trace::finding::{Errors, Finding, Verdict};

use crate::{browser, findings, words};

#[test]
fn a_page_says_what_was_found_in_the_order_in_which_readers_ask() {
    let html = page(&findings::form_imperfect());
    let said = words(&html);
    let parts = [
        "of a form that the library does not quite have",
        "named, form imperfect",
        "Held-out trials: confirmed",
        "Before and after",
        "F = 97 % of the removable error is gone",
        "backlash 8.30 sure: chosen again in 97 % of resamples creep of q2 2.0 %, no effect 1.0 %",
        "width of q1 width_q1 0.0524 rad (3.00°) 0.0511 to 0.0537 rad (2.93 to 3.08°)",
        "What the model missed, and what is left of it",
        "Trial by trial",
        "What remains",
        "Effects that could not be distinguished",
        "prandtl_ishlinskii",
        "Next experiment: Reverse the first actuator",
        "nominal + effect + network 2.71 0.04",
        "Candidates for + backlash",
        "needs a throttle signal: downwash, ground effect",
        "Only two trials are held out",
        "0f1e2d3c4b5a6978",
        "acm-eval 0.2.0",
    ];
    let mut from = 0;
    for part in parts {
        let place = said[from..].find(part).unwrap_or_else(|| panic!("{part:?} is missing, or too early, in {said}"));
        from += place;
    }
}

#[test]
fn what_remains_is_said_as_it_is() {
    let said = |finding: Finding| words(&page(&finding));
    let all = |finding: Finding, parts: &[&str]| {
        let said = said(finding);
        parts.iter().for_each(|part| assert!(said.contains(part), "{part:?} is missing in {said}"));
    };
    all(findings::named(), &["no: a regression", "explains 1.2 %", "p = 0.34", "0.310 mm root mean square"]);
    all(findings::partial(), &["yes: a regression", "explains 41 %", "p &lt; 0.001", "What it explains is 3.40 mm"]);
    all(findings::unknown_structure(), &["Δq1 = −0.090·q1·q2", "Δq1 q1·q2 −0.0903", "2.90 mm", "No effect was added"]);
    all(findings::event(), &["slip 91 % trial 17, at 42.3 s", "spectral line 4.0 % all trials: 7.2 Hz"]);
    all(findings::newtons(), &["2.31 · 10⁻⁶ N per Pa", "(force) + (force per pressure) × pressure", "5.66 to 6.58"]);
    all(
        findings::no_effect(),
        &["nothing added", "the best baseline is as good as the noise allows", "None beyond those that hold"],
    );
}

#[test]
fn every_verdict_is_explained_in_words_of_its_own() {
    let verdict = |finding: &Finding| {
        let html = page(finding);
        let (_, after) = html.split_once("class=\"mark\">").expect("a badge");
        words(&format!("<body><p>{}", after.split_once("</div>").expect("its end").0))
    };
    let mut said: Vec<String> = findings::all()[..7].iter().map(|(_, finding)| verdict(finding)).collect();
    assert!(said.iter().all(|words| words.contains("What to do:") && words.len() > 100), "{said:?}");
    said.sort();
    said.dedup();
    assert_eq!(said.len(), 7);
    assert_eq!(findings::all()[..7].iter().filter(|(_, f)| f.verdict == Verdict::Named).count(), 1);
}

/// A page that fetches nothing can be mailed; and no number, name or empty list may break it.
#[test]
fn whatever_was_found_the_page_is_whole() {
    let pages = findings::all().into_iter().map(|(name, finding)| (name, page(&finding)));
    for (name, html) in pages.chain([("separability", separability_page(&findings::separability()))]) {
        assert!(html.starts_with("<!DOCTYPE html>") && html.ends_with("</html>"), "{name}");
        browser::loads_nothing(name, &html);
        for number in ["NaN", " inf ", "Infinity", "null"] {
            assert!(!words(&html).contains(number), "{name} shows {number}");
        }
        let mut identifiers: Vec<&str> =
            html.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        identifiers.sort_unstable();
        let all = identifiers.len();
        identifiers.dedup();
        assert_eq!(identifiers.len(), all, "{name} has an identifier twice");
    }
}

#[test]
fn synthetic_data_is_marked_at_every_heading_with_numbers_and_measured_data_is_not() {
    for (name, finding) in findings::all() {
        let html = page(&finding);
        let badges = html.matches(">synthetic data</span>").count();
        if finding.data.synthetic {
            let sections = html.matches("<h2").count() + html.matches("<figure").count();
            assert!(html.contains("role=\"note\"") && badges > sections, "{name}: {badges} marks, {sections} headings");
            assert!(summary(&finding).starts_with("SYNTHETIC DATA"), "{name}");
        } else {
            assert_eq!((badges, html.contains("role=\"note\"")), (0, false), "{name}");
            assert!(
                !words(&html).to_lowercase().contains("synthetic") && !summary(&finding).contains("SYNTHETIC"),
                "{name}"
            );
        }
    }
    let separability = findings::separability();
    assert!(separability_page(&separability).contains("role=\"note\""));
    assert!(separability_summary(&separability).starts_with("SYNTHETIC DATA"));
}

/// Names stand second: what a reader meets first are words.
#[test]
fn headings_and_labels_are_words() {
    for (name, finding) in findings::all() {
        let html = page(&finding);
        for heading in html.split("<h3").skip(1).filter_map(|rest| rest.split("</h3>").next()) {
            let first = words(&format!("<body>{}", heading.split("<code").next().unwrap()));
            assert!(!first.contains('_') || name == "long-names", "{name}: {first}");
        }
    }
    let separability = findings::separability();
    let svg = matrix::draw(&separability).unwrap().svg("matrix", matrix::QUESTION, "fixture");
    assert!(svg.contains(">dead time<") && !svg.contains(">dead_time<"));
    let unitless = Errors { unit: "1".into(), noise: 0.1, ..findings::named().errors };
    let said = page(&Finding { errors: unitless, ..findings::named() });
    let said = words(&said);
    assert!(!said.contains("[1]") && !said.contains(" in 1.") && !said.contains(" 1 root mean square"));
}

/// In a browser: no page is wider than a phone or a screen, whatever its names are. Figures that are wider scroll.
#[test]
fn nothing_sticks_out_of_the_window() {
    let Some(name) = browser::browser() else {
        eprintln!("skipped: no chromium on this machine");
        return;
    };
    let mut pages: Vec<(&str, String)> =
        findings::all().into_iter().map(|(name, finding)| (name, page(&finding))).collect();
    pages.push(("separability", separability_page(&findings::separability())));
    for width in [400, 1200, 1400] {
        let root = tempfile::tempdir().unwrap();
        let measured = browser::widths(name, &pages, width, root.path());
        assert_eq!(measured.len(), pages.len(), "not every page answered: {measured:?}");
        assert!(measured.iter().all(|(_, found)| *found == width), "{width} px: {measured:?}");
    }
}
