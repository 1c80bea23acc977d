//! What is said of a finding: how sure it is, how far it is confirmed, and what is not known.

use acm_eval::closed_loop::{page, summary};
use acm_trace::finding::sentence::sentence;
use acm_trace::finding::{Baselines, Confirmation, Doubt, Errors, Estimate, Finding, Level, Probe, Verdict};

use crate::{findings, words};

/// Oracle: written by hand.
#[test]
fn the_sentence_says_how_sure_and_how_far_confirmed() {
    let said = |change: &dyn Fn(&mut Finding)| {
        let mut finding = findings::named();
        change(&mut finding);
        sentence(&finding).replace('\u{a0}', " ")
    };
    for (level, word) in [(Level::Sure, "surely"), (Level::Likely, "likely"), (Level::Possible, "possibly")] {
        let said = said(&|finding| finding.effects[0].confidence.level = level);
        assert!(said.starts_with(&format!("The model {word} lacks backlash of q1 (")), "{said}");
    }
    let numbers = "error on held-out trials 23.3 mm → 2.65 mm (best baseline 8.71 mm, noise 2.60 mm)";
    for (confirmation, words) in [
        (Confirmation::Confirmed, "; confirmed on held-out trials: "),
        (Confirmation::Open, "; neither confirmed nor refuted on held-out trials: "),
        (Confirmation::NotTested, "; not tested on held-out trials: "),
    ] {
        let said = said(&|finding| finding.confirmation = confirmation);
        assert!(said.ends_with(&format!("{words}{numbers}.")), "{said}");
    }
    let untested = said(&|finding| {
        finding.confirmation = Confirmation::NotTested;
        finding.data.held_out.clear();
    });
    assert!(untested.ends_with("; not tested on held-out trials: there is none."), "{untested}");
    let refuted = said(&|finding| finding.confirmation = Confirmation::Refuted);
    let lead = format!("Refuted by held-out trials: {numbers}. On development trials: the model surely lacks backlash");
    assert!(refuted.starts_with(&lead), "{refuted}");
    let none = said(&|finding| (finding.effects, finding.verdict) = (vec![], Verdict::NoEffect));
    assert!(none.starts_with("Nothing is missing") && none.contains("; confirmed"), "{none}");
    let second = said(&|finding| {
        let mut second = finding.effects[0].clone();
        (second.name, second.carrier, second.confidence.level) = ("creep".into(), None, Level::Possible);
        finding.effects.push(second);
    });
    assert!(second.contains("surely lacks backlash") && second.contains(", and possibly creep ("), "{second}");
    let surest = said(&|finding| {
        let mut second = finding.effects[0].clone();
        (second.name, second.carrier, finding.effects[0].confidence.level) = ("creep".into(), None, Level::Likely);
        finding.effects.push(second);
    });
    assert!(surest.contains("surely lacks creep (") && surest.contains(", and likely backlash of q1 ("), "{surest}");
}

#[test]
fn a_page_says_why_a_name_is_not_sure() {
    let mut finding = findings::form_imperfect();
    let effect = &mut finding.effects[0];
    effect.confidence.level = Level::Likely;
    effect.doubts = vec![Doubt::Equivalent, Doubt::Followed];
    effect.follows = Some(0.0006);
    let doubts = "likely: chosen again in 97 % of resamples; not sure, since another effect predicts as well, and 0.60 mm of what is left \
                  follows it: another of its kind may act";
    let said = words(&page(&finding));
    assert!(said.contains(doubts), "{said}");
}

/// A refuted model stands first everywhere, and no page says to use it.
#[test]
fn a_refuted_model_leads() {
    let finding = findings::refuted();
    let (said, told) = (words(&page(&finding)), summary(&finding));
    for text in [&said, &told] {
        let (refuted, lacks) = (text.find("Refuted by held-out trials"), text.find("lacks backlash"));
        assert!(refuted.is_some() && refuted < lacks, "{text}");
        assert!(text.contains("refuted.json"), "{text}");
    }
    assert!(said.contains("Do not use the model") && !said.contains("Put the effect into the model"), "{said}");
    assert!(!words(&page(&findings::named())).contains("efuted"));
}

#[test]
fn another_clock_is_no_effect() {
    let finding = findings::clock();
    let said = sentence(&finding).replace('\u{a0}', " ");
    assert!(
        said.starts_with("The actuators' clock is 850 ms late; shift their stamps. No effect is missing; confirmed"),
        "{said}"
    );
    assert!(said.ends_with("Each trial has an offset of its own (2.10 mm)."), "{said}");
    let mut early = finding.clone();
    let clock = early.clock_correction.as_mut().unwrap();
    (clock.value, clock.interval) = (-0.85, [-0.87, -0.83]);
    let early = sentence(&early).replace('\u{a0}', " ");
    assert!(early.starts_with("The actuators' clock is 850 ms early"), "{early}");
    let mut both = finding.clone();
    both.effects = findings::named().effects;
    let both = sentence(&both).replace('\u{a0}', " ");
    assert!(both.starts_with("The model surely lacks backlash"), "{both}");
    assert!(both.contains(". The actuators' clock is 850 ms late; shift their stamps. Each trial"), "{both}");
    let shown = words(&page(&finding));
    for part in ["Clock: the actuators' clock is 850 ms late", "No effect was added", "offsets removed 2.6"] {
        assert!(shown.contains(part), "{part}: {shown}");
    }
    assert!(summary(&finding).contains("with what was found"));
}

/// That no signal explains what is left may be said only where both probes were asked and find nothing.
#[test]
fn nothing_recorded_explains_it_is_said_of_two_probes_alone() {
    let nothing = Probe { explained: -0.03, by_chance: 0.03, p: 0.81, rms: 0.0 };
    let something = Probe { explained: 0.2, by_chance: 0.03, p: 0.01, rms: 1e-4 };
    for (network, sentence_says, page_says) in [
        (None, "no linear combination of recorded signals with memory explains it", "unexplained"),
        (Some(nothing), "no recorded signal explains it", "unmeasured disturbance"),
        (Some(something), "recorded signals explain a small part of it at most", "unexplained"),
    ] {
        let mut finding = findings::unmeasured();
        finding.left.network = network;
        let said = sentence(&finding);
        assert!(said.contains(sentence_says), "{said}");
        finding.sentence = said;
        let shown = words(&page(&finding));
        assert!(shown.contains(&format!("Verdict: {page_says}")), "{shown}");
        assert_eq!(shown.contains("unmeasured disturbance"), page_says == "unmeasured disturbance", "{shown}");
        assert!(summary(&finding).contains(&format!("Verdict: {page_says}")));
    }
}

/// A size of 0 ± 6·10¹⁵⁷ is no result: neither sentence nor page nor summary shows it as one.
#[test]
fn a_value_that_the_data_leave_open_is_no_number() {
    let mut finding = findings::named();
    let open = &mut finding.effects[0].parameters[0];
    (open.value, open.interval, open.undetermined) = (2e140, [-6.3e157, 6.3e157], true);
    let said = sentence(&finding);
    assert!(said.contains("its values are not determined by these data") && !said.contains("10¹"), "{said}");
    for said in [words(&page(&finding)), summary(&finding)] {
        assert!(said.contains("not determined by these data") && !said.contains("· 10¹"), "{said}");
    }
    let said = sentence(&findings::named()).replace('\u{a0}', " ");
    assert!(
        said.contains("backlash of q1 (width of q1 0.0524 rad (3.00°); chosen again in 97 % of resamples)"),
        "{said}"
    );
}

/// Errors of 0.2 mN·m are 0.2 mN·m on the page, in the sentence and in the terminal.
#[test]
fn errors_in_small_units_keep_their_digits() {
    let mut finding = findings::newtons();
    let estimate = |value: f64| Estimate { value, interval: [0.93 * value, 1.08 * value] };
    finding.errors = Errors {
        unit: "N*m".into(),
        noise: 4.1e-5,
        baselines: Baselines {
            nominal: estimate(6.09e-4),
            static_map: estimate(3.4e-4),
            recalibrated: estimate(2.2e-4),
        },
        after: estimate(1.29e-4),
        ..finding.errors
    };
    let said = sentence(&finding).replace('\u{a0}', " ");
    assert!(said.contains("609 µN·m → 129 µN·m (best baseline 220 µN·m, noise 41.0 µN·m)"), "{said}");
    let said = summary(&finding);
    assert!(said.contains("error [µN·m]") && said.contains("129") && said.contains("609"), "{said}");
    let said = words(&page(&finding));
    assert!(said.contains("609") && said.contains("in µN·m"), "{said}");
}
