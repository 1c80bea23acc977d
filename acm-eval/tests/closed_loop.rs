//! What is shown of a finding: complete, marked where synthetic, and whole whatever the numbers are.

mod browser;
mod findings;

use acm_eval::closed_loop::figures::{self, matrix};
use acm_eval::closed_loop::page::beside;
use acm_eval::closed_loop::{page, separability_page, separability_summary, summary};
use acm_trace::finding::{
    Baselines, Confirmation, Doubt, Errors, Estimate, Finding, Level, Probe, Separability, Verdict, sentence::sentence,
    title::parameter_title,
};

/// Words of a page outside of tags, styles and drawings.
fn words(html: &str) -> String {
    let body = html.split_once("<body>").map_or(html, |(_, body)| body);
    // What is between the end of one script and the beginning of the next.
    let body: String = body.split("</script>").map(|part| part.split("<script").next().unwrap_or("")).collect();
    let mut text = String::new();
    for piece in body.split('<') {
        let shown = piece.split_once('>').map_or("", |(_, shown)| shown);
        text.push_str(shown);
        text.push(' ');
    }
    text.replace('\u{a0}', " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

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

/// A page that fetches nothing can be mailed; and no number, name or empty list may break it.
#[test]
fn whatever_was_found_the_page_is_whole() {
    let pages = findings::all().into_iter().map(|(name, finding)| (name, page(&finding)));
    for (name, html) in pages.chain([("separability", separability_page(&findings::separability()))]) {
        assert!(html.starts_with("<!DOCTYPE html>") && html.ends_with("</html>"), "{name}");
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

/// A page and what lies beside it, in a folder.
fn written(html: &str, files: Vec<(String, Vec<u8>)>) -> (tempfile::TempDir, std::path::PathBuf) {
    let root = tempfile::tempdir().unwrap();
    ["figures", "tables"].iter().for_each(|inside| std::fs::create_dir(root.path().join(inside)).unwrap());
    files.iter().for_each(|(name, bytes)| std::fs::write(root.path().join(name), bytes).unwrap());
    let page = root.path().join("page.html");
    std::fs::write(&page, html).unwrap();
    (root, page)
}

#[test]
fn every_link_leads_to_a_file_and_every_file_is_linked() {
    for (name, finding) in findings::all() {
        let (_root, page) = written(&page(&finding), beside::of_finding(&finding).unwrap());
        eprintln!("{name}");
        browser::links_resolve(&page);
    }
    let separability = findings::separability();
    let (_root, page) = written(&separability_page(&separability), beside::of_separability(&separability).unwrap());
    browser::links_resolve(&page);
}

/// Oracle: the fixture's own numbers, which the files hold with every digit.
#[test]
fn tables_beside_the_page_have_every_digit() {
    let finding = findings::form_imperfect();
    let files = beside::of_finding(&finding).unwrap();
    let table = |name: &str| {
        let found = files.iter().find(|(file, _)| *file == format!("tables/{name}.csv"));
        String::from_utf8(found.unwrap_or_else(|| panic!("no {name}")).1.clone()).unwrap()
    };
    let parameters = table("parameters");
    assert!(parameters.starts_with("Effect,Carried by,Parameter,Value,95 % from,95 % to,Unit,"), "{parameters}");
    assert!(parameters.contains("width_q1,0.05236,0.0511,0.0537,rad"), "{parameters}");
    let effects = table("effects");
    assert!(
        effects.starts_with("Effect,Carried by,Size [m],Confidence,Share of resamples,Chosen in its place"),
        "{effects}"
    );
    assert!(effects.contains("backlash,q1,0.0083,sure,0.97,creep(q2) 0.02; no effect 0.01"), "{effects}");
    let steps = table("steps");
    assert!(steps.contains("+ backlash,0.00266,0.87,0.021,14.2,yes,3") && steps.contains(",0.3,no,2"), "{steps}");
    let before = table("before-and-after");
    assert!(
        before.starts_with("Model,Error [m],")
            && before.contains("at its place in the model\",confirmed")
            && before.contains("white noise,0.0026,,,"),
        "{before}"
    );
    assert!(table("networks").contains("nominal + effect + network,0.00271,0.00004"));
    assert!(table("candidates").contains("+ backlash,prandtl_ishlinskii,0.00267"));
    assert!(
        beside::of_finding(&findings::no_effect()).unwrap().iter().all(|(file, _)| file != "tables/parameters.csv")
    );
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
