//! Sums of angles that a nominal form may have terms of.
//!
//! ```text
//! a·cos(n·q) + b·sin(n·q),   n_j = −1, 0, 1 for actuators in rad, else 0
//! ```
//!
//! Places of a chain of revolute joints, and torques of its weight, are linear in them (Siciliano et al. 2009, Robotics, ch. 2 and 7).

use acm_core::rig::Rig;

/// Returns the multiples n of each sum of at most `joined` angles, one of n and −n.
pub fn sums(rig: &Rig, joined: usize) -> Vec<Vec<i8>> {
    let mut all = vec![vec![]];
    for actuator in &rig.actuators {
        let multiples: &[i8] = if actuator.unit == "rad" { &[0, 1, -1] } else { &[0] };
        let longer = |sum: Vec<i8>| multiples.iter().map(move |n| [&sum[..], &[*n]].concat());
        all = all.into_iter().flat_map(longer).filter(|sum| is_one_of_both(sum) && count(sum) <= joined).collect();
    }
    all.retain(|sum| count(sum) > 0);
    all
}

/// Returns the number of actuators that are angles.
pub fn angles(rig: &Rig) -> usize {
    rig.actuators.iter().filter(|actuator| actuator.unit == "rad").count()
}

fn count(sum: &[i8]) -> usize {
    sum.iter().filter(|n| **n != 0).count()
}

fn is_one_of_both(sum: &[i8]) -> bool {
    sum.iter().find(|n| **n != 0).is_none_or(|first| *first == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::bench;

    /// Oracle: by hand; three angles make 13 sums of up to three, since 3³ patterns of signs are two of each and zero.
    #[test]
    fn each_sum_is_there_once() {
        let two = bench::rig(&["a", "b"], &[], &["y"]);
        assert_eq!(sums(&two, 1), [[0, 1], [1, 0]]);
        assert_eq!(sums(&two, 2), [[0, 1], [1, 0], [1, 1], [1, -1]]);
        let mut three = bench::rig(&["a", "b", "c"], &[], &["y"]);
        assert_eq!((sums(&three, 3).len(), angles(&three)), (13, 3));
        three.actuators[1].unit = "V".into();
        assert_eq!((sums(&three, 3).len(), angles(&three)), (4, 2));
    }
}
