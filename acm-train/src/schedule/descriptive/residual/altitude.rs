//! Residual by altitude: trials at the same height form a group.
//!
//! Trials are sorted by mean altitude; a step larger than the tolerance between neighbours begins a new group.

use acm_datasets::{Campaign, Role, Trial, manifest::Signal, rig::rig};

use super::{
    asked::Asked,
    described::Described,
    record::{AltitudeGroup, ResidualStudy},
};
use crate::{
    config::{ConfigError, Source},
    schedule::descriptive::rms::Rms,
};

/// Returns the context column that is the altitude; `None`, with a note, where the data have none.
///
/// # Errors
/// The file names a signal that the data do not have.
pub fn column(
    asked: &Asked,
    campaign: &Campaign,
    study: &Source,
    notes: &mut Vec<String>,
) -> Result<Option<usize>, ConfigError> {
    let names: Vec<&str> = campaign.manifest.context.iter().map(Signal::name).collect();
    let Some(named) = &asked.altitude else {
        let used: Vec<&Trial> = campaign.trials.iter().filter(|trial| trial.role != Role::Excluded).collect();
        let found = rig(campaign, &used).altitude.filter(|column| *column < names.len());
        if found.is_none() {
            notes.push("No context signal is an altitude, so nothing is shown by altitude.".into());
        }
        return Ok(found);
    };
    let missing = || {
        let key = ["residual_study".to_string(), "altitude".to_string()];
        let what = format!("`residual_study.altitude` is \"{named}\", which is no context signal");
        let help = match names.as_slice() {
            [] => "these data have none; leave the key out".to_string(),
            names => format!("context signals are {}", names.join(", ")),
        };
        Box::new(study.complaint(&key, what, help))
    };
    Ok(Some(names.iter().position(|name| name == named).ok_or_else(missing)?))
}

/// Groups by rising altitude.
pub fn groups(described: &[Described], record: &ResidualStudy) -> Vec<AltitudeGroup> {
    let altitudes: Vec<f64> = record.trials.iter().filter_map(|trial| trial.altitude).collect();
    let group = |members: Vec<usize>| {
        let residuals = members.iter().map(|&place| &described[place].residual);
        let rms = Rms::of_all(residuals);
        let sum: f64 = members.iter().map(|&place| altitudes[place] * described[place].trial.samples() as f64).sum();
        let trials = members.iter().map(|&place| described[place].trial.name.clone()).collect();
        AltitudeGroup { altitude: sum / rms.samples.max(1) as f64, trials, rms }
    };
    grouped(&altitudes, record.asked.altitude_tolerance).into_iter().map(group).collect()
}

/// Returns the indices of `values` that belong together, by rising value; within a group in their order.
fn grouped(values: &[f64], tolerance: f64) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut groups: Vec<Vec<usize>> = vec![];
    for (rank, &place) in order.iter().enumerate() {
        match groups.last_mut() {
            Some(group) if values[place] - values[order[rank - 1]] <= tolerance => group.push(place),
            _ => groups.push(vec![place]),
        }
    }
    groups.iter_mut().for_each(|group| group.sort_unstable());
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn a_step_beyond_the_tolerance_begins_a_group() {
        assert_eq!(grouped(&[1.3, 0.98, 1.35, 2.0, 1.01], 0.1), [vec![1, 4], vec![0, 2], vec![3]]);
        assert_eq!(grouped(&[2.0, 1.0], 0.0), [vec![1], vec![0]]);
        assert_eq!(grouped(&[], 0.1), Vec::<Vec<usize>>::new());
    }
}
