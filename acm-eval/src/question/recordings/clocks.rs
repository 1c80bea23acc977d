//! Clock offsets that were estimated from the recordings: their effect on the conclusion.

use std::collections::{BTreeMap, BTreeSet};

use acm_datasets::Campaign;
use acm_datasets::join::Alignment;

/// Consequences of estimated offsets.
pub(super) struct Clocks {
    /// A sentence for each source with an estimated offset.
    pub cautions: Vec<String>,
    /// Half of the 95 % interval of the offset between actuators and outputs, s, in the trial with the widest one.
    pub interval: f64,
}

/// Returns the clocks of a campaign that were estimated.
pub(super) fn estimated(campaign: &Campaign) -> Clocks {
    let columns = |names: Vec<&str>| -> BTreeSet<String> {
        names.iter().filter_map(|name| name.split_once('.')).map(|(source, _)| source.to_string()).collect()
    };
    let actuators = columns(campaign.manifest.actuator.iter().map(|a| a.column.as_str()).collect());
    let outputs = columns(campaign.manifest.measured.iter().map(|m| m.column.as_str()).collect());
    // what moves both moves neither against the other
    let between: BTreeSet<&String> = actuators.symmetric_difference(&outputs).collect();
    let (mut widest, mut trials) = (BTreeMap::<&str, f64>::new(), BTreeMap::<&str, f64>::new());
    for alignment in campaign.alignments.iter().filter(|alignment| alignment.is_estimated()) {
        let known = widest.entry(&alignment.source).or_default();
        *known = known.max(alignment.interval);
        if between.contains(&alignment.source) {
            let trial = trials.entry(&alignment.trial).or_default();
            *trial = trial.hypot(alignment.interval);
        }
    }
    let caution =
        |(source, half): (&&str, &f64)| sentence(source, *half, between.iter().any(|name| name == source), campaign);
    Clocks { cautions: widest.iter().map(caution).collect(), interval: trials.into_values().fold(0.0, f64::max) }
}

fn sentence(source: &str, half: f64, delays: bool, campaign: &Campaign) -> String {
    let of_source = |alignment: &&Alignment| alignment.source == source && alignment.is_estimated();
    let trials = campaign.alignments.iter().filter(of_source).count();
    let said = format!(
        "The clock of source `{source}` was estimated from the motion (± {:.1} ms in the worst of {trials} trials)",
        1e3 * half
    );
    match delays {
        true => format!(
            "{said}: it holds what dead time there was, a delay that is found is what the estimate has left of it, and its interval is \
             wider by that of the clock. Give `offset` a value or an event to have a dead time told."
        ),
        false => format!("{said}."),
    }
}
