//! Summaries for a terminal.

use acm_eval::closed_loop::{separability_page, separability_summary, summary};
use acm_trace::finding::title::parameter_title;

use crate::{findings, words};

#[test]
fn the_summary_fits_a_terminal_and_cuts_nothing() {
    let letters = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>();
    for (name, finding) in findings::all() {
        let said = summary(&finding);
        let texts = finding.cautions.iter().chain(&finding.next_experiment).chain([&finding.sentence]);
        for text in texts {
            assert!(letters(&said).contains(&letters(text)), "{name} lacks {text}\n{said}");
        }
        for parameter in finding.effects.iter().flat_map(|effect| &effect.parameters) {
            let title = parameter_title(&parameter.name);
            assert!(letters(&said).contains(&letters(&title)), "{name} lacks {title}\n{said}");
        }
        assert!(said.lines().all(|line| line.chars().count() <= 100), "{name}\n{said}");
    }
    let said = summary(&findings::named()).replace('\u{a0}', " ");
    for part in [
        "has backlash",
        "Verdict: named; F = 99.6 %",
        "8.71",
        "2.65",
        "width of q1 = 0.0524 rad (3.00°), 95 %: 0.0511 to",
    ] {
        assert!(said.contains(part), "{part} is missing:\n{said}");
    }
    for part in ["Equally good: backlash, prandtl_ishlinskii", "Next experiment: Reverse", "Caution: Only two"] {
        assert!(said.contains(part), "{part} is missing:\n{said}");
    }
    let many = summary(&findings::nine_outputs());
    assert!(["backlash:", "tip_load:", "measurement_lag:"].iter().all(|part| many.contains(part)), "{many}");
}

#[test]
fn separability_is_said_in_a_sentence_groups_and_pairs() {
    let separability = findings::separability();
    let said = words(&separability_page(&separability));
    let parts = [
        "Of 9 effects",
        "7 cannot be told apart by these trials: they fall into 3 groups",
        "three speeds or more",
        "The closest pairs",
        "misregistration 99.0 %",
    ];
    assert!(parts.iter().all(|part| said.contains(part)), "{said}");
    let terminal = separability_summary(&separability).replace('\u{a0}', " ");
    assert!(terminal.contains("94 % of dead_time can be imitated by actuator_lag"), "{terminal}");
    assert!(terminal.lines().all(|line| line.chars().count() <= 100), "{terminal}");
}
