//! Groups of effects that cannot be distinguished, each with the experiment that would.

use super::Group;
use crate::finding::experiment::{to_separate, to_show, to_tell_from_calibration};

/// Share from which an effect counts as imitated.
const IMITATED: f64 = 0.9;

/// Returns first the sets of effects that imitate each other, largest first; then those that recalibration absorbs;
/// then those that cannot be seen.
pub fn groups(effects: &[String], imitated: &[Vec<f64>], by_recalibration: &[f64], unseen: &[String]) -> Vec<Group> {
    let names = |members: &[usize]| members.iter().map(|&k| effects[k].clone()).collect::<Vec<String>>();
    let (taken, own): (Vec<usize>, Vec<usize>) = (0..effects.len()).partition(|&k| by_recalibration[k] >= IMITATED);
    let imitates = |a: usize, b: usize| {
        let kept = 1.0 - by_recalibration[a];
        imitated[a][b] - by_recalibration[a] >= IMITATED * kept
    };
    let mut sets = connected(&own, |a, b| imitates(a, b) && imitates(b, a));
    sets.retain(|set| set.len() > 1);
    sets.sort_by_key(|set| std::cmp::Reverse(set.len()));
    let apart = |set: &Vec<usize>| {
        let effects = names(set);
        Group { experiment: to_separate(&effects).unwrap_or_default(), effects }
    };
    let mut groups: Vec<Group> = sets.iter().map(apart).collect();
    if !taken.is_empty() {
        let effects = names(&taken);
        groups.push(Group { experiment: to_tell_from_calibration(&effects), effects });
    }
    if !unseen.is_empty() {
        groups.push(Group { experiment: to_show(unseen), effects: unseen.to_vec() });
    }
    groups
}

/// Returns the connected sets, in the order of their first members.
fn connected(members: &[usize], joined: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut left = members.to_vec();
    let mut sets = Vec::new();
    while !left.is_empty() {
        let mut set = vec![left.remove(0)];
        let mut next = 0;
        while next < set.len() {
            let from = set[next];
            let (near, far) = left.into_iter().partition(|&other| joined(from, other));
            set.extend::<Vec<usize>>(near);
            left = far;
            next += 1;
        }
        set.sort_unstable();
        sets.push(set);
    }
    sets
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand. a and b imitate each other, c imitates a and b but not the other way round, d is calibration.
    #[test]
    fn groups_by_hand() {
        let names: Vec<String> = ["backlash", "actuator_lag", "creep", "scale"].map(String::from).into();
        let imitated = vec![
            vec![1.0, 0.95, 0.99, 0.1],
            vec![0.92, 1.0, 0.97, 0.0],
            vec![0.3, 0.3, 1.0, 0.0],
            vec![0.96, 0.96, 0.96, 1.0],
        ];
        let groups = groups(&names, &imitated, &[0.0, 0.0, 0.0, 0.95], &["downwash".into()]);
        let members: Vec<Vec<&str>> =
            groups.iter().map(|group| group.effects.iter().map(String::as_str).collect()).collect();
        assert_eq!(members, [vec!["backlash", "actuator_lag"], vec!["scale"], vec!["downwash"]]);
        assert!(groups.iter().all(|group| !group.experiment.is_empty()));
    }

    /// What recalibration leaves counts: 0.93 of which 0.5 are recalibration's is 0.86 of the rest.
    #[test]
    fn only_what_recalibration_leaves_counts() {
        let names: Vec<String> = ["backlash", "creep"].map(String::from).into();
        let imitated = vec![vec![1.0, 0.93], vec![0.99, 1.0]];
        assert!(groups(&names, &imitated, &[0.5, 0.0], &[]).is_empty());
        assert_eq!(groups(&names, &imitated, &[0.0, 0.0], &[]).len(), 1);
    }

    #[test]
    fn chains_are_one_set() {
        let joined = |a: usize, b: usize| a.abs_diff(b) == 2;
        assert_eq!(connected(&[0, 1, 2, 3, 4], joined), [vec![0, 2, 4], vec![1, 3]]);
    }
}
