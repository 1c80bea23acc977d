//! Trials that stay on the disk teach the same as trials in memory: every record and every table, to the bit.

mod campaign;

use std::slice;

use acm_train::config;
use acm_train::run::progress::Progress;
use acm_train::run::record::RunRecord;
use acm_train::run::stop::Stop;
use acm_train::schedule::engine::queue;
use acm_train::schedule::ready::{Campaigns, Ready};
use acm_train::schedule::request::Request;
use campaign::{Campaign, bytes_below, timeless};

/// Runs `tiny.toml` with some values replaced; data with more samples than `hold` stay on the disk.
fn learn(campaign: &Campaign, out: &str, hold: usize, set: &[&str]) -> Vec<RunRecord> {
    let edits: Vec<String> = set.iter().map(ToString::to_string).collect();
    let (experiment, source) = config::read(&campaign.path("tiny.toml"), &edits).unwrap();
    let (progress, stop, out) = (Progress::Quiet, Stop::default(), campaign.path(out));
    let request = Request::new(&out, &progress, &stop);
    let ready = Ready::new(experiment, &source, &request, &mut Campaigns::holding(hold)).unwrap();
    assert_eq!(ready.data.is_held(), hold > 0);
    let folder = ready.claim(&out, request.hold()).unwrap();
    queue::run(slice::from_ref(&ready), slice::from_ref(&folder), &request).unwrap().concat()
}

/// Oracle: the same runs with all trials in memory.
#[test]
fn a_stream_of_trials_gives_the_bits_of_trials_in_memory() {
    let campaign = Campaign::new();
    for (name, set) in [
        ("folds", &["protocol.cross_validation=true"][..]),
        ("filtered", &["inputs.domain_filter=\"hull\"", "windows.elapsed=\"one\""]),
        ("shuffled", &["inputs.shuffled=[\"q1\"]"]),
        ("ridge", &["baseline.kind=\"ridge\""]),
        ("without", &["nominal.model=\"none\""]),
    ] {
        let (held, streamed) = (format!("{name}-held"), format!("{name}-streamed"));
        let records = timeless(learn(&campaign, &held, usize::MAX, set));
        assert!(records == timeless(learn(&campaign, &streamed, 0, set)), "{name}: records differ");
        let (held, streamed) = (bytes_below(&campaign.path(&held)), bytes_below(&campaign.path(&streamed)));
        assert!(held == streamed, "{name}: files differ");
    }
}
